"""The page: what each part of the template is given."""

from collections.abc import Collection
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined, UndefinedError
from markupsafe import Markup

from upswing import figures
from upswing.analysis.colours import shown_as
from upswing.analysis.outcomes import OF_AN_OUTCOME, outcomes
from upswing.recordings.content_policy import source_of
from upswing.report import words
from upswing.report.animation import drawn, stretches
from upswing.report.cards import cards
from upswing.report.chapter import chapter
from upswing.report.citation import FILE as CITATION
from upswing.report.citation import citation
from upswing.report.command import commands
from upswing.report.cost import OF_A_BENCHMARK, OF_AN_EDIT, OF_GROWTH, costs, totals
from upswing.report.deviations import deviations
from upswing.report.exploratory import exploratory
from upswing.report.findings import findings
from upswing.report.glossary import glossary
from upswing.report.headline import headline
from upswing.report.history_shown import history
from upswing.report.interactive import embedded, endings, shown_figures
from upswing.report.judged import counts, judged, point_at_own
from upswing.report.kept import kept
from upswing.report.lessons import teach
from upswing.report.own import (
    counted,
    is_chapter,
    is_own,
    own_findings,
    own_headline,
    own_words,
    shown_verdicts,
)
from upswing.report.pendulums import body_of_bound, lengths, system
from upswing.report.pictures import data_of
from upswing.report.readings_shown import over_readings, rows, swept
from upswing.report.registered import registered
from upswing.report.step_size_numbers import step_size_numbers
from upswing.runs.adopted import joined
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import seal
from upswing.runs.files.provenance import provenance
from upswing.runs.files.tables import read_cells, read_evidence, read_runs
from upswing.runs.files.typed_table import Columns, read_table
from upswing.runs.results import Results
from upswing.runs.study_file import read_study
from upswing.study.claim_parts import NOT_HERE
from upswing.study.errors import BadInput
from upswing.study.ids import cell_of
from upswing.study.matrix import Matrix
from upswing.study.paths import (
    BENCHMARK,
    BEYOND,
    EDITS,
    EVIDENCE_CSV,
    GROWTH,
    PAGE,
    RUNS_CSV,
)
from upswing.study.readings import Readings

Row = dict[str, Any]

CONFIGURATIONS = Path("config")

OF_A_SHOWN_RUN: Columns = {
    "task": "text", "architecture": "text", "alpha": "number", "seconds": "number",
    "steps_per_second": "number", "falls": "number", "falls_last_fifth": "number",
    "upright_share": "number", "above_horizontal_share": "number", "mean_reward": "number",
    "first_stable_step": "whole?", "greedy_success_share": "number", "upright_at_end": "number",
    "diverged_at": "whole?", **OF_AN_OUTCOME,
}  # fmt: skip
"""What the page shows of each run, besides which it is."""


STYLES = ("style.css", "layout.css", "figures.css", "print.css")
SCRIPTS = ("page.js", "contents.js", "lit.js", "pointing.js", "step_sizes.js", "enlarge.js")


class Page(NamedTuple):
    """The page and the tables beside it."""

    html: str
    runs: pd.DataFrame
    evidence: pd.DataFrame

    def write(self, folder: Path, page: str, runs: str, evidence: str) -> None:
        """Write all three into a folder, each whole or not at all, under these names."""
        for name, frame in ((runs, self.runs), (evidence, self.evidence)):
            with written(folder / name) as beside:
                frame.to_csv(beside, index=False)
        with written(folder / page) as beside:
            beside.write_text(self.html, "utf-8")


def write_report(results: Path, templates: Path) -> None:
    """Write the page of a folder of results.

    Args:
        results: the folder, with its tables; figures that are missing are named in the page.
        templates: the folder of templates, styles and texts.
    """
    made = page_of(results, templates)
    made.write(results, PAGE, RUNS_CSV, EVIDENCE_CSV)
    seal(results, "report", [results / name for name in (PAGE, RUNS_CSV, EVIDENCE_CSV)])


def page_of(
    results: Path, templates: Path, lent: bool = True, chapter_at: str = f"../{BEYOND}/report/"
) -> Page:
    """The page of a folder of results.

    Args:
        results: the folder, with its tables; figures that are missing are named in the page.
        templates: the folder of templates, styles and texts.
        lent: whether the page also links the recordings that only our server hands out.
        chapter_at: the way from the page to the folder of the chapter's own page.
    """
    study = read_study(results)
    environment = Environment(
        loader=FileSystemLoader(templates), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.filters.update(words.FILTERS, source_of=source_of, cards=cards)
    matrix, there = Matrix(study), joined(results, study)
    evidence = read_evidence(results)
    verdicts = shown_verdicts(judged(results, evidence, bool(study.claims)), study)
    own = is_own(study, verdicts)
    cells = rows(read_cells(results, there.cells))
    table = read_runs(results, list(there.runs), OF_A_SHOWN_RUN)
    runs, ours = rows(table), set(matrix.runs)
    sizes = sorted({len(spec.seeds) for spec in matrix.cells.values()})
    of_each = f"{sizes[0]} to {sizes[-1]}" if len(sizes) > 1 else str(sizes[0])
    told = counted(len(matrix.cells), len(ours), of_each)
    by_name = {row["cell"]: row for row in cells}
    learned_by = [row for row in cells if row["cell"] in matrix.cells]
    found = own_findings(learned_by, study) if own else findings(by_name, verdicts)
    moves = system(study, templates)
    named = glossary(templates)
    drawn_figures = shown_figures(results)
    point_at_own(verdicts, drawn_figures, study.figure_names)
    with shown_as(study, [spec.architecture.name for spec in there.adopted]):
        over_step_sizes = step_size_numbers(cells, study)
        animation = "" if own else _animation(results)
    here = [row for row in verdicts if row["verdict"] != NOT_HERE]
    empirical = [row for row in here if not row["check"]]
    shown = {
        "study": study,
        "adopted": [spec.architecture for spec in there.adopted],
        "seeds_of_a_cell": of_each,
        "solving": [row for row in cells if study.tasks[row["task"]].judged_by == "upright"],
        "animation": animation,
        "findings": found,
        "own": own,
        "chapter": is_chapter(study),
        "commands": commands(study, CONFIGURATIONS),
        "counted": told,
        "headline": own_headline(study, told)
        if own
        else headline(by_name, found, len(empirical), len(ours)),
        "glossary": own_words(
            named, study, moves["lengths"], moves["length_of_a_step"], bool(verdicts)
        )
        if own
        else named,
        "outcomes": outcomes(table, study) if own and study.judges else [],
        "citation": citation(templates.parent / CITATION),
        "lent": lent,
        "kept": kept({row["task"] for row in cells}, drawn_figures, verdicts),
        "registered": registered(results, study) if is_chapter(study) or not study.claims else None,
        "exploratory": {} if study.claims else exploratory(templates),
        "over": over_readings(results, templates, verdicts, study),
        **moves,
        "cells": cells,
        "greedy": _greedy(runs),
        "cell": by_name,
        "runs": runs,
        "ends": endings(table, study),
        "interactive": embedded(drawn_figures, over_step_sizes, study),
        "over_step_sizes": over_step_sizes["tasks"],
        "verdicts": verdicts,
        "counts": counts(empirical),
        "judged": len(empirical),
        "new_runs": len(ours),
        "checks": [row for row in here if row["check"]],
        "figures": {figure["name"]: figure for figure in drawn_figures},
        "figures_of_thesis": [
            one for one in drawn_figures if one["number"] and not (own and one["missing"])
        ],
        "own_figures": [name for name in study.figure_names if name not in figures.NAMES],
        "beyond": _beyond(results, templates, chapter_at),
        "readings": _readings(study.readings, _touched(matrix)),
        "swept": swept(results, study),
        "deviations": deviations(templates, own),
        "history": history(results, judges=bool(verdicts), own=bool(study.claims)),
        "costs": costs(results),
        "totals": totals(results, sum(row["seconds"] for row in runs if row["run"] in ours)),
        "benchmark": _optional(results / BENCHMARK, OF_A_BENCHMARK, "`make bench` makes it"),
        "edits": _optional(results / EDITS, OF_AN_EDIT, "`make bench-edits` makes it"),
        "growth": _optional(results / GROWTH, OF_GROWTH, "`make bench-growth` makes it"),
        "provenance": provenance(),
        "style": _all(templates, STYLES),
        "script": _all(templates, SCRIPTS),
    }
    try:
        page = environment.get_template("index.html.j2").render(shown)
    except UndefinedError as error:  # a table has its columns, but not the rows that the page shows
        said = f"{results}: the tables lack what the page shows: {error.message}"
        raise BadInput([f"{said}; `upswing doctor {results}` says which is damaged"]) from None
    return Page(page, table, evidence)


def _own(path: Path) -> Markup:
    """A file of ours, which is no data and so is not escaped."""
    return Markup(path.read_text("utf-8"))  # noqa: S704


def _all(templates: Path, names: tuple[str, ...]) -> Markup:
    """Several files of ours, one after the other."""
    return Markup("\n").join(_own(templates / name) for name in names)


def _optional(path: Path, columns: Columns, remedy: str) -> list[Row]:
    """The rows of a table that need not be there."""
    return rows(read_table(path, columns, remedy)) if path.exists() else []


def _greedy(runs: list[Row]) -> dict[str, float]:
    """Of each cell, the mean share of starts from which what was learned succeeds without exploring."""
    frame = pd.DataFrame(runs)
    cells = frame["run"].map(cell_of)
    return {
        str(k): float(v) for k, v in frame.groupby(cells)["greedy_success_share"].mean().items()
    }


def _animation(results: Path) -> str:
    """The moving picture as an address that holds all of it; empty without the cells that it shows."""
    panels = stretches(Results(results))
    return data_of(drawn(panels).encode()) if panels else ""


def _beyond(results: Path, templates: Path, at: str) -> Row:
    """The chapter beyond the thesis, with its pictures and the recordings beside its own page."""
    found = chapter(results, at)
    if found["folder"] is not None:
        teach(found["changes"], templates)
        drawn_figures = shown_figures(found["folder"])
        found["figures"] = {figure["name"]: figure for figure in drawn_figures}
        found["kept"] = kept((), drawn_figures, ())
        study = read_study(found["folder"])
        found["body"], found["end"] = body_of_bound(study), lengths(study)["end"]
    return found


def _touched(matrix: Matrix) -> set[str]:
    """The names of the readings that some run depends on."""
    return {
        name
        for spec in matrix.cells.values()
        for name in spec.readings.touching(
            spec.architecture.learner, spec.task.kind, spec.architecture.is_modular
        )
    }


def _readings(readings: Readings, touched: Collection[str]) -> list[Row]:
    """Every reading that is ``touched``: its number, question, options and the chosen one."""
    rows = []
    properties = Readings.model_json_schema()["properties"]
    for name, field in properties.items():
        if name not in touched:
            continue
        number, question = field["description"].split(": ", 1)
        options = field.get("enum") or [field["const"]]
        rows.append(
            {
                "number": number,
                "name": name,
                "question": question,
                "options": options,
                "chosen": getattr(readings, name),
            }
        )
    return rows
