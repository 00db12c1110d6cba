"""The page: what each part of the template is given."""

import json
from collections import Counter
from math import atan, degrees
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined, UndefinedError
from markupsafe import Markup

from upswing import figures
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import ACCELERATIONS
from upswing.recordings.content_policy import source_of
from upswing.report import words
from upswing.report.animation import drawn, stretches
from upswing.report.chapter import chapter
from upswing.report.cost import OF_A_BENCHMARK, OF_AN_EDIT, OF_GROWTH, costs, totals
from upswing.report.exploratory import exploratory
from upswing.report.findings import findings
from upswing.report.pictures import data_of, picture
from upswing.report.readings_shown import over_readings, rows, swept
from upswing.report.registered import registered
from upswing.report.scale import strip
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import seal
from upswing.runs.files.provenance import provenance
from upswing.runs.files.tables import read_cells, read_evidence, read_runs, read_verdicts
from upswing.runs.files.typed_table import Columns, read_table
from upswing.runs.results import Results
from upswing.runs.study_file import read_study
from upswing.study import paths
from upswing.study.claim_parts import WEAKEST_FIRST
from upswing.study.errors import BadInput
from upswing.study.ids import cell_of
from upswing.study.matrix import Matrix
from upswing.study.paths import (
    BENCHMARK,
    EDITS,
    EVIDENCE,
    EVIDENCE_CSV,
    GROWTH,
    PAGE,
    RUNS_CSV,
)
from upswing.study.readings import Readings
from upswing.study.yaml_file import read_yaml

Row = dict[str, Any]

OF_A_SHOWN_RUN: Columns = {
    "task": "text", "architecture": "text", "alpha": "number", "seconds": "number",
    "steps_per_second": "number", "falls": "number", "falls_last_fifth": "number",
    "upright_share": "number", "above_horizontal_share": "number", "mean_reward": "number",
    "first_stable_step": "whole?", "greedy_success_share": "number", "upright_at_end": "number",
}  # fmt: skip
"""What the page shows of each run, besides which it is."""


def write_report(results: Path, templates: Path) -> None:
    """Write the page of a folder of results.

    Args:
        results: the folder, with its tables; figures that are missing are named in the page.
        templates: the folder of templates, styles and texts.
    """
    study = read_study(results)
    environment = Environment(
        loader=FileSystemLoader(templates), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.filters.update(words.FILTERS, source_of=source_of)
    matrix = Matrix(study)
    evidence = read_evidence(results)
    verdicts = _verdicts(results, evidence)
    cells = rows(read_cells(results, matrix.cells))
    table = read_runs(results, list(matrix.runs), OF_A_SHOWN_RUN)
    runs = rows(table)
    sizes = sorted({len(spec.seeds) for spec in matrix.cells.values()})
    shown = {
        "study": study,
        "seeds_of_a_cell": f"{sizes[0]} to {sizes[-1]}" if len(sizes) > 1 else str(sizes[0]),
        "solving": [row for row in cells if study.tasks[row["task"]].judged_by == "upright"],
        "animation": _animation(results),
        "findings": findings({row["cell"]: row for row in cells}, verdicts),
        "registered": registered(results, study),
        "exploratory": exploratory(templates),
        "over": over_readings(results, templates, verdicts),
        "body": Pendulum(),
        "held": _held(Pendulum()),
        "cells": cells,
        "greedy": _greedy(runs),
        "cell": {row["cell"]: row for row in cells},
        "runs": runs,
        "verdicts": verdicts,
        "counts": _counts([row for row in verdicts if not row["check"]]),
        "checks": [row for row in verdicts if row["check"]],
        "figures": {figure["name"]: figure for figure in _figures(results)},
        "own_figures": [name for name in study.figures if name not in figures.NAMES],
        "beyond": _beyond(results),
        "readings": _readings(study.readings),
        "swept": swept(results, study),
        "deviations": read_yaml(templates / "deviations.yaml")["deviations"],
        "costs": costs(results),
        "totals": totals(results, sum(row["seconds"] for row in runs)),
        "benchmark": _optional(results / BENCHMARK, OF_A_BENCHMARK, "`make bench` makes it"),
        "edits": _optional(results / EDITS, OF_AN_EDIT, "`make bench-edits` makes it"),
        "growth": _optional(results / GROWTH, OF_GROWTH, "`make bench-growth` makes it"),
        "provenance": provenance(),
        "style": _own(templates / "style.css"),
        "script": _own(templates / "page.js"),
        "drawings": {
            path.stem: _own(path) for path in sorted((templates / "drawings").glob("*.svg"))
        },
    }
    try:
        page = environment.get_template("index.html.j2").render(shown)
    except UndefinedError as error:  # a table has its columns, but not the rows that the page shows
        said = f"{results}: the tables lack what the page shows: {error.message}"
        raise BadInput([f"{said}; `upswing doctor {results}` says which is damaged"]) from None
    for name, frame in ((RUNS_CSV, table), (EVIDENCE_CSV, evidence)):
        with written(results / name) as beside:
            frame.to_csv(beside, index=False)
    with written(results / PAGE) as beside:
        beside.write_text(page, "utf-8")
    seal(results, "report", [results / name for name in (PAGE, RUNS_CSV, EVIDENCE_CSV)])


def _own(path: Path) -> Markup:
    """A file of ours, which is no data and so is not escaped."""
    return Markup(path.read_text("utf-8"))  # noqa: S704


def _optional(path: Path, columns: Columns, remedy: str) -> list[Row]:
    """The rows of a table that need not be there."""
    return rows(read_table(path, columns, remedy)) if path.exists() else []


def _verdicts(results: Path, comparisons: pd.DataFrame) -> list[Row]:
    """Each verdict with its evidence, and each comparison with its strip."""
    evidence = rows(comparisons)
    verdicts = rows(read_verdicts(results))
    for row in evidence:
        row["strip"] = strip(row)
    for verdict in verdicts:
        own = [row for row in evidence if row["claim"] == verdict["claim"]]
        verdict["evidence"] = own
        same = [
            row for row in own
            if (row["cells"], row["threshold"]) == (verdict["cells"], verdict["threshold"])
        ]  # fmt: skip
        if not same:
            raise BadInput(
                [
                    f"{results / EVIDENCE}: {verdict['claim']}: has no row for its verdict; "
                    f"`upswing verdicts {results}` makes both tables"
                ]
            )
        verdict["decisive"] = same[0]
        for row in own:
            row["several"] = sum(other["part"] == row["part"] for other in own) > 1
            row["many_cells"] = len(str(row["cells"]).split(" : ")) > 1
        verdict["held"] = [
            next(row["says"] for row in own if row["part"] == part)
            for part in sorted({row["part"] for row in own})
            if all(row["verdict"] == "reproduced" for row in own if row["part"] == part)
        ]
        verdict["figure"] = None if pd.isna(verdict["figure"]) else int(verdict["figure"])
    return verdicts


def _counts(verdicts: list[Row]) -> list[tuple[str, list[str]]]:
    """Each verdict that was given, the best first, with its claims."""
    given = Counter(row["verdict"] for row in verdicts)
    return [
        (word, [row["claim"] for row in verdicts if row["verdict"] == word])
        for word in reversed(WEAKEST_FIRST)
        if given[word]
    ]


def _greedy(runs: list[Row]) -> dict[str, float]:
    """Of each cell, the mean share of starts from which what was learned succeeds without exploring."""
    frame = pd.DataFrame(runs)
    cells = frame["run"].map(cell_of)
    return {
        str(k): float(v) for k, v in frame.groupby(cells)["greedy_success_share"].mean().items()
    }


def _figures(results: Path) -> list[Row]:
    """Each figure with its words and its picture; ``missing`` where it could not be drawn."""
    pages = []
    for name in dict.fromkeys((*figures.NAMES, *read_study(results).figures)):
        declared = figures.FIGURES[name]
        page: Row = {"name": name, **declared._asdict(), "missing": True}
        words = results / paths.figure(name, "json")
        if words.exists():
            drawn = picture(results / paths.figure(name, "svg"))
            page |= {**json.loads(words.read_text("utf-8")), "picture": drawn, "missing": False}
        pages.append(page)
    return pages


def _held(body: Pendulum) -> float:
    """Where a cart that is pushed one way for ever holds the rod, from upright [degrees] (eq. 13)."""
    return 180 - degrees(atan(max(ACCELERATIONS) / body.gravity))


def _animation(results: Path) -> str:
    """The moving picture as an address that holds all of it; empty without the cells that it shows."""
    panels = stretches(Results(results))
    return data_of(drawn(panels).encode()) if panels else ""


def _beyond(results: Path) -> Row:
    """The chapter beyond the thesis, with its pictures."""
    found = chapter(results)
    if found["folder"] is not None:
        found["figures"] = {figure["name"]: figure for figure in _figures(found["folder"])}
    return found


def _readings(readings: Readings) -> list[Row]:
    """Every reading: its number, question, options and the chosen one."""
    rows = []
    properties = Readings.model_json_schema()["properties"]
    for name, field in properties.items():
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
