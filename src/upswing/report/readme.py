"""What README and documentation show of the results: verdicts, words, pictures, the deviations."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from PIL import Image

from upswing.analysis.robustness.shipped import write_shipped
from upswing.analysis.robustness.tables import OF_A_SELECTION
from upswing.report import words
from upswing.report.animation import drawn, stretches
from upswing.report.chapter import chapter
from upswing.report.deviations import deviations
from upswing.report.glossary import as_sections, glossary, in_a_paragraph
from upswing.report.lessons import (
    EXPECTED,
    SUCCEEDED,
    expected_of,
    lessons,
    read_told,
    succeeded_of,
)
from upswing.runs.files.atomic import written
from upswing.runs.files.tables import read_verdicts
from upswing.runs.files.typed_table import read_table
from upswing.runs.results import Results
from upswing.study.claims import Claim
from upswing.study.errors import BadInput
from upswing.study.paths import ROBUST, SELECTION, VERDICTS, figure

FIGURES = ("overview", "step-sizes")
"""The figures that the documentation shows."""

PICTURES = Path("docs/pictures")
"""Where the pictures are, beside the README."""

ANIMATION = "pendulum.svg"
README = Path("README.md")
PARTS = {
    README: ("verdicts", "words"),
    Path("docs/findings.md"): ("evidence", "expected"),
    Path("docs/report.md"): ("glossary",),
    Path("docs/thesis.md"): ("deviations",),
}
"""The pages with generated parts, by their place beside the README, and which parts they have."""

GLOSSARY = {"words": in_a_paragraph, "glossary": as_sections}
"""How the parts with explained words show them."""

TABLE = "verdicts.csv"
COLOURS = 64
END = "<!-- end -->"


def write_readme(
    results: Path,
    templates: Path,
    readme: Path,
    claims: Mapping[str, Claim] | None = None,
    made_from: Mapping[str, str] | None = None,
) -> None:
    """Renew the generated parts of ``readme`` and of the pages and pictures in ``docs`` beside it.

    What they come from is kept below ``templates``; so is what the sweeps say of ``claims``, with what
    it was ``made_from``. The animation stays as it is if the study has not the two cells that it shows,
    and so does what was expected beyond the thesis where the chapter has not been run.

    Raises:
        BadInput: the results have no verdicts or figures, or a page no place for a part.
    """
    if not (results / VERDICTS).exists():
        raise BadInput([f"{results / VERDICTS}: missing; `make reproduce` makes it"])
    places = {page: readme if page == README else readme.parent / page for page in PARTS}
    if lost := [place for place in places.values() if not place.exists()]:
        raise BadInput([f"{place}: there is no such page" for place in lost])
    verdicts = verdicts_of(read_verdicts(results))
    with written(templates / TABLE) as beside:
        verdicts.to_csv(beside, index=False)
    told = chapter(results)
    if expected := expected_of(told["changes"] if told["folder"] else ()):
        with written(templates / EXPECTED) as beside:
            pd.DataFrame(expected).to_csv(beside, index=False)
        with written(templates / SUCCEEDED) as beside:
            pd.DataFrame(succeeded_of(told["changes"])).to_csv(beside, index=False)
    if claims is not None and (results / ROBUST).exists():
        write_shipped(results, templates, claims, made_from or {})
    if (results / SELECTION).exists():
        selection = read_table(results / SELECTION, OF_A_SELECTION, "`make readings` makes it")
        with written(templates / "selection.csv") as beside:
            selection.drop(columns="readings").to_csv(beside, index=False, float_format="%.6g")
    pictures = readme.parent / PICTURES
    for name in FIGURES:
        source = results / figure(name, "png")
        if not source.exists():
            raise BadInput([f"{source}: missing; `upswing figure {name} {results}` makes it"])
        with Image.open(source) as image, written(pictures / source.name) as beside:
            image.convert("RGB").quantize(COLOURS).save(beside, format="PNG", optimize=True)
    if panels := stretches(Results(results)):
        with written(pictures / ANIMATION) as beside:
            beside.write_text(drawn(panels), "utf-8")
    for page, place in places.items():
        text = renewed(place.read_text("utf-8"), page, templates)
        with written(place) as beside:
            beside.write_text(text, "utf-8")


def verdicts_of(verdicts: pd.DataFrame) -> pd.DataFrame:
    """The table of verdicts as it is shown in full: one row a claim, all of it text."""
    rows = [{str(k): v for k, v in row.items()} for row in verdicts.to_dict("records")]
    return pd.DataFrame(
        {
            "claim": [row["claim"] for row in rows],
            "the thesis says": [row["statement"] for row in rows],
            "verdict": [words.verdict({**row, "own": False}) for row in rows],
            "over readings": [words.over_readings(row) for row in rows],
            "fragile": [row["fragile_because"] or "no" for row in rows],
            "check": [row["check"] for row in rows],
            "measured": [row["measure"] for row in rows],
            "estimate [95 %]": [words.interval(row) for row in rows],
            "threshold": [row["threshold"] for row in rows],
            "n": [str(row["n"]) for row in rows],
        }
    )


def counted(table: pd.DataFrame) -> str:
    """How many claims got which verdict, in a sentence."""
    empirical, checks = table[table["check"] == ""], table[table["check"] != ""]
    of = empirical.groupby("verdict", sort=False)["claim"].agg(list)
    parts = [f"{len(claims)} {verdict} ({', '.join(claims)})" for verdict, claims in of.items()]
    said = f"Of {len(empirical)} empirical claims: {'; '.join(parts)}."
    apart = ", ".join(f"{row['claim']} ({row['verdict']})" for _, row in checks.iterrows())
    return f"{said} No evidence but checks: {apart}." if apart else said


def in_short(table: pd.DataFrame) -> pd.DataFrame:
    """The verdicts as the README shows them: claim, estimate, verdict, and how sturdy it is."""
    fragile = table["fragile"].map(lambda why: "" if why == "no" else ", fragile")
    return pd.DataFrame(
        {
            "claim": table["claim"] + ": " + table["the thesis says"],
            "estimate [95 %]": table["estimate [95 %]"],
            "under our reading": table["verdict"] + fragile,
            "over readings": table["over readings"],
        }
    )


def markdown(table: pd.DataFrame) -> str:
    """A table in Markdown."""
    lines = [" | ".join(row) for row in [list(table.columns), ["---"] * len(table.columns)]]
    lines += [" | ".join(part.replace("|", r"\|") for part in row) for row in table.to_numpy()]
    return "\n".join(f"| {line} |" for line in lines)


def renewed(text: str, page: Path, templates: Path) -> str:
    """A page's ``text`` with its generated parts made anew from what is below ``templates``.

    Args:
        text: what the page says now.
        page: which of ``PARTS`` it is.
        templates: the folder with the tables and the deviations.

    Raises:
        BadInput: there is no place for a part.
    """
    for name in PARTS[page]:
        mark = f"<!-- {name}: make readme -->\n"
        before, begun, rest = text.partition(mark)
        _, ended, after = rest.partition(END)
        if not (begun and ended):
            raise BadInput([f"{page}: there is no place for {name}, {mark.strip()} … {END}"])
        text = f"{before}{mark}\n{_part(name, templates)}\n\n{END}{after}"
    return text


def _part(name: str, templates: Path) -> str:
    if name == "deviations":
        return "\n".join(
            f"{number}. {text}" for number, text in enumerate(deviations(templates), 1)
        )
    if name in GLOSSARY:
        return GLOSSARY[name](glossary(templates))
    if name == "expected":
        expected = read_told(templates, EXPECTED)
        said = expected["verdict"].value_counts(sort=False).items()
        counts = ", ".join(f"{number} {verdict}" for verdict, number in said)
        taught = "\n".join(f"- **{change}.** {one}" for change, one in lessons(templates).items())
        return f"Of {len(expected)} expectations: {counts}.\n\n{markdown(expected)}\n\n{taught}"
    table = pd.read_csv(templates / TABLE, dtype=str, keep_default_na=False)
    return f"{counted(table)}\n\n{markdown(in_short(table) if name == 'verdicts' else table)}"
