"""What the README shows of the results: a table of verdicts, two figures, the deviations."""

from pathlib import Path

import pandas as pd
from PIL import Image

from upswing.analysis.robustness.tables import OF_A_SELECTION, SELECTION
from upswing.report import words
from upswing.runs.files.atomic import written
from upswing.runs.files.table import read_table
from upswing.runs.files.tables import VERDICTS, read_verdicts
from upswing.study.errors import BadInput
from upswing.study.yaml_file import read_yaml

FIGURES = ("overview", "step-sizes")
"""The figures that the README shows."""

TABLE = "verdicts.csv"
COLOURS = 64


def write_readme(results: Path, templates: Path, readme: Path) -> None:
    """Renew the generated parts of ``readme``, and what they come from below ``templates``.

    Raises:
        BadInput: the results have no verdicts or figures, or the README no place for a part.
    """
    if not (results / VERDICTS).exists():
        raise BadInput([f"{results / VERDICTS}: missing; `make reproduce` makes it"])
    verdicts = verdicts_of(read_verdicts(results))
    with written(templates / TABLE) as beside:
        verdicts.to_csv(beside, index=False)
    if (results / SELECTION).exists():
        selection = read_table(results / SELECTION, OF_A_SELECTION, "`make readings` makes it")
        with written(templates / "selection.csv") as beside:
            selection.to_csv(beside, index=False, float_format="%.6g")
    for name in FIGURES:
        source = results / "figures" / f"{name}.png"
        if not source.exists():
            raise BadInput([f"{source}: missing; `upswing figure {name} {results}` makes it"])
        with Image.open(source) as image, written(templates / "pictures" / source.name) as beside:
            image.convert("RGB").quantize(COLOURS).save(beside, format="PNG", optimize=True)
    text = renewed(readme.read_text("utf-8"), templates)
    with written(readme) as beside:
        beside.write_text(text, "utf-8")


def verdicts_of(verdicts: pd.DataFrame) -> pd.DataFrame:
    """The table of verdicts as the README shows it: one row a claim, all of it text."""
    rows = [{str(k): v for k, v in row.items()} for row in verdicts.to_dict("records")]
    return pd.DataFrame(
        {
            "claim": [row["claim"] for row in rows],
            "the thesis says": [row["statement"] for row in rows],
            "verdict": [words.verdict(row) for row in rows],
            "measured": [row["measure"] for row in rows],
            "estimate [95 %]": [words.interval(row) for row in rows],
            "threshold": [row["threshold"] for row in rows],
            "n": [str(row["n"]) for row in rows],
        }
    )


def counted(table: pd.DataFrame) -> str:
    """How many claims got which verdict, in a sentence."""
    of = table.groupby("verdict", sort=False)["claim"].agg(list)
    parts = [f"{len(claims)} {verdict} ({', '.join(claims)})" for verdict, claims in of.items()]
    return f"Of {len(table)} claims: {'; '.join(parts)}."


def renewed(readme: str, templates: Path) -> str:
    """The README with its generated parts made anew from what is below ``templates``."""
    table = pd.read_csv(templates / TABLE, dtype=str, keep_default_na=False)
    lines = [" | ".join(row) for row in [list(table.columns), ["---"] * len(table.columns)]]
    lines += [" | ".join(part.replace("|", r"\|") for part in row) for row in table.to_numpy()]
    deviations = read_yaml(templates / "deviations.yaml")["deviations"]
    parts = {
        "verdicts": counted(table) + "\n\n" + "\n".join(f"| {line} |" for line in lines),
        "deviations": "\n".join(f"{number}. {text}" for number, text in enumerate(deviations, 1)),
    }
    for name, content in parts.items():
        mark, end = f"<!-- {name}: make readme -->\n", "<!-- end -->"
        before, begun, rest = readme.partition(mark)
        _, ended, after = rest.partition(end)
        if not (begun and ended):
            raise BadInput([f"README.md: there is no place for {name}, {mark.strip()} … {end}"])
        readme = f"{before}{mark}\n{content}\n\n{end}{after}"
    return readme
