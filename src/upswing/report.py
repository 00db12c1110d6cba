"""Tables and figures → one page that needs nothing else; templates and styles are in ``report/``."""

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from upswing import figures
from upswing.claims import words_of
from upswing.problems import BadInput
from upswing.readings import Readings
from upswing.recordings.names import recording_id
from upswing.spec import alpha_text
from upswing.store.files import written
from upswing.store.provenance import provenance
from upswing.study import read_study
from upswing.tables import CELLS, RUNS, VERDICTS

PAGE = "report/index.html"


def write_report(results: Path, templates: Path) -> None:
    """Write the page of a folder of results, from the templates in the folder ``templates``."""
    study = read_study(results)
    environment = Environment(
        loader=FileSystemLoader(templates), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.filters.update(
        number=_number,
        percent=_percent,
        spread=_spread,
        alpha=_alpha,
        verdict=_verdict,
        recording=_recording,
    )
    style = (templates / "style.css").read_text("utf-8")
    page = environment.get_template("index.html.j2").render(
        study=study,
        cells=_rows(results / CELLS),
        runs=len(_rows(results / RUNS)),
        verdicts=_rows(results / VERDICTS),
        figures=_figures(results),
        readings=_readings(study.readings),
        provenance=provenance(),
        style=Markup(style),  # noqa: S704  our own file, not the configuration's
    )
    with written(results / PAGE) as beside:
        beside.write_text(page, "utf-8")


def _rows(path: Path) -> list[dict[str, Any]]:
    if not path.exists():
        raise BadInput([f"{path}: missing; `upswing tables` makes it"])
    return [
        {str(name): value for name, value in row.items()}
        for row in pd.read_parquet(path).to_dict("records")
    ]


def _figures(results: Path) -> list[dict[str, Any]]:
    """Each figure with its words and its picture; ``missing`` where it could not be drawn."""
    pages = []
    for number, declared in figures.FIGURES.items():
        place = results / "figures" / f"fig{number:02d}"
        page: dict[str, Any] = {"number": number, **declared._asdict(), "missing": True}
        if place.with_suffix(".json").exists():
            picture = base64.b64encode(place.with_suffix(".svg").read_bytes()).decode()
            words = json.loads(place.with_suffix(".json").read_text("utf-8"))
            page |= {**words, "picture": f"data:image/svg+xml;base64,{picture}", "missing": False}
        pages.append(page)
    return pages


def _readings(readings: Readings) -> list[dict[str, Any]]:
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


def _number(value: float | None, digits: int = 0) -> str:
    known = value is not None and np.isfinite(value)
    return f"{value:,.{digits}f}" if known else "–"


def _percent(value: float | None) -> str:
    return "–" if value is None or pd.isna(value) else f"{100 * value:.1f} %"


def _spread(row: dict[str, Any], measure: str, digits: int = 0, factor: float = 1) -> str:
    """The median of a measure, and its 5th to 95th percentile over runs."""
    middle, low, high = (
        _number(factor * row[f"{measure}_{part}"], digits) for part in ("median", "p05", "p95")
    )
    return f"{middle} ({low} – {high})"


def _alpha(value: float | None) -> str:
    return "–" if value is None or pd.isna(value) else alpha_text(value)


def _recording(run: str) -> str:
    """The name of a run's recording, from its id or its path."""
    return recording_id(run.removeprefix("runs/").removesuffix(".rrd"))


def _verdict(row: dict[str, Any]) -> str:
    return words_of(row["verdict"], row["could_be_better"])
