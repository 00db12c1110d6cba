"""The page: what each part of the template is given."""

import base64
import json
from collections import Counter
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from upswing import figures
from upswing.claims import WEAKEST_FIRST
from upswing.config import read_yaml
from upswing.pendulum import Pendulum
from upswing.problems import BadInput
from upswing.readings import Readings
from upswing.report import words
from upswing.report.cost import BENCHMARK, costs, totals
from upswing.report.scale import strip
from upswing.store.files import written
from upswing.store.provenance import provenance
from upswing.study import read_study
from upswing.sweeps.results import DECISIVE, READINGS, ROBUST, SELECTION
from upswing.tables import CELLS, EVIDENCE, RUNS, VERDICTS

PAGE = "report/index.html"
CAUSES, LIKELIEST = 3, 8
"""So many readings that decide a claim, and so many of the most likely ones, are shown."""

Row = dict[str, Any]


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
    environment.filters.update(words.FILTERS)
    verdicts = _verdicts(results)
    cells = _rows(results / CELLS)
    runs = _rows(results / RUNS)
    page = environment.get_template("index.html.j2").render(
        study=study,
        body=Pendulum(),
        cells=cells,
        cell={row["cell"]: row for row in cells},
        runs=runs,
        verdicts=verdicts,
        counts=_counts(verdicts),
        figures={figure["name"]: figure for figure in _figures(results)},
        readings=_readings(study.readings),
        swept=_swept(results),
        deviations=read_yaml(templates / "deviations.yaml")["deviations"],
        costs=costs(results),
        totals=totals(results, sum(row["seconds"] for row in runs)),
        benchmark=_rows(results / BENCHMARK) if (results / BENCHMARK).exists() else [],
        provenance=provenance(),
        style=_own(templates / "style.css"),
        script=_own(templates / "page.js"),
        drawings={path.stem: _own(path) for path in sorted((templates / "drawings").glob("*.svg"))},
    )
    with written(results / PAGE) as beside:
        beside.write_text(page, "utf-8")


def _own(path: Path) -> Markup:
    """A file of ours, which is no data and so is not escaped."""
    return Markup(path.read_text("utf-8"))  # noqa: S704


def _rows(path: Path) -> list[Row]:
    if not path.exists():
        raise BadInput([f"{path}: missing; `upswing tables` makes it"])
    return [
        {str(name): value for name, value in row.items()}
        for row in pd.read_parquet(path).to_dict("records")
    ]


def _verdicts(results: Path) -> list[Row]:
    """Each verdict with its evidence, and each comparison with its strip."""
    evidence = _rows(results / EVIDENCE)
    verdicts = _rows(results / VERDICTS)
    for row in evidence:
        row["strip"] = strip(row)
    for verdict in verdicts:
        own = [row for row in evidence if row["claim"] == verdict["claim"]]
        verdict["evidence"] = own
        verdict["decisive"] = next(
            row for row in own
            if (row["cells"], row["threshold"]) == (verdict["cells"], verdict["threshold"])
        )  # fmt: skip
        verdict["decisive"]["several"] = (
            sum(row["part"] == verdict["decisive"]["part"] for row in own) > 1
        )
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


def _figures(results: Path) -> list[Row]:
    """Each figure with its words and its picture; ``missing`` where it could not be drawn."""
    pages = []
    for name, declared in figures.FIGURES.items():
        place = results / "figures" / name
        page: Row = {"name": name, **declared._asdict(), "missing": True}
        if place.with_suffix(".json").exists():
            said = json.loads(place.with_suffix(".json").read_text("utf-8"))
            page |= {**said, "picture": _picture(place.with_suffix(".svg")), "missing": False}
        pages.append(page)
    return pages


def _swept(results: Path) -> Row:
    """What the sweeps over readings came to; empty if they were not run."""
    if not (results / ROBUST).exists():
        return {"robust": []}
    decisive = _rows(results / DECISIVE)
    robust = _rows(results / ROBUST)
    selection = _rows(results / SELECTION) if (results / SELECTION).exists() else []
    judged = pd.read_parquet(results / READINGS, columns=["sweep", "n"])
    return {
        "robust": robust,
        "seeds": int(judged["n"].max()),
        "decisive": {
            row["claim"]: [cause for cause in decisive if cause["claim"] == row["claim"]][:CAUSES]
            for row in robust
        },
        "pictures": [
            {"name": name, "data": _picture(results / "figures" / f"readings-{name}.svg")}
            for name in judged["sweep"].unique()
        ],
        "selection": selection[:LIKELIEST],
        "selected_of": len(selection),
    }


def _picture(path: Path) -> str:
    """A picture as an address that holds all of it."""
    return f"data:image/svg+xml;base64,{base64.b64encode(path.read_bytes()).decode()}"


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
