"""What the page's script is given: where each run stands in the figures, and numbers to draw with.

It stands in the page as JSON, which a browser neither runs nor shows. The figures' part comes from
``figures/NAME.json``, which may be of any origin, and so is checked.
"""

import base64
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any, Literal

import pandas as pd
from markupsafe import Markup
from pydantic import BaseModel, ConfigDict, StringConstraints, ValidationError, model_validator

from upswing import figures
from upswing.report.inline_svg import inline
from upswing.report.words import UNKNOWN
from upswing.runs.study_file import read_study
from upswing.runs.success import succeeds
from upswing.study import paths
from upswing.study.config import Study
from upswing.study.errors import BadInput
from upswing.study.own_figures import DeclaredFigure

Row = dict[str, Any]
Packed = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9+/]*=*$")]
Cell = Annotated[str, StringConstraints(pattern=r"^[\w./-]+$")]

ENDS = {
    ("falls", True): "balances",
    ("falls", False): "falls",
    ("upright", True): "stands",
    ("upright", False): "does not stand",
}
"""How a run ends, by how its task judges it and whether it succeeds."""


def shown_figures(results: Path) -> list[Row]:
    """Each figure with its words, picture and panels; ``missing`` where it could not be drawn.

    Raises:
        BadInput: a figure's files are not as its job writes them.
    """
    shown, study = [], read_study(results)
    for name in dict.fromkeys((*figures.NAMES, *study.figure_names)):
        page: Row = {"name": name, **_declared(name, study)._asdict(), "missing": True}
        path = results / paths.figure(name, "json")
        if path.exists():
            words = _words(path, name)
            said = f"{words['title']}. {words.get('alt') or words['caption']}"
            page |= {
                **words,
                "missing": False,
                "picture": inline(results / paths.figure(name, "svg"), name, said),
                "panels": panels_of(words, path, name),
            }
        if study.claims and name in figures.NAMES:  # those that it bears on are the thesis's
            page["claims"] = ()
        shown.append(page)
    return shown


def _declared(name: str, study: Study) -> figures.Declaration:
    """What a figure shows, where that can be told without running somebody's file."""
    own = figures.own_of(study).get(name)
    if own is None:
        return figures.FIGURES[name]
    if isinstance(own, DeclaredFigure):
        return figures.declaration_of(own)
    return figures.Declaration(name, "", ())


def _words(path: Path, name: str) -> Row:
    """What a figure's job wrote about it."""
    try:
        words = json.loads(path.read_text("utf-8"))
    except ValueError as error:
        raise BadInput([f"{path}: is no JSON: {error}; {_remedy(name)}"]) from None
    if not isinstance(words, dict) or not {"title", "caption", "runs"} <= words.keys():
        raise BadInput([f"{path}: title, caption and runs must be there; {_remedy(name)}"])
    return words


def _remedy(name: str) -> str:
    return f"`upswing figure {name}` draws it anew"


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class RunsShown(_Strict):
    """Runs in a panel: as ``figures.interaction`` describes them."""

    kind: Literal["alone", "dots", "curves"]
    cell: Cell
    seeds: tuple[tuple[int, int], ...]
    x: Packed = ""
    y: Packed = ""
    drawn: bool = True

    @model_validator(mode="after")
    def _as_many_as_said(self) -> "RunsShown":
        number = sum(last - first + 1 for first, last in self.seeds)
        across, up = (len(base64.b64decode(packed, validate=True)) for packed in (self.x, self.y))
        fits = {
            "alone": number == 1 and across == up == 0,
            "dots": across == up == 2 * number,
            "curves": across % 2 == 0 and 2 * up == number * across,
        }
        if not fits[self.kind] or any(last < first for first, last in self.seeds):
            raise ValueError("seeds, x and y must be of the same runs")
        return self


class Panel(_Strict):
    """A panel of a figure: its place in the SVG [pt], and its runs."""

    box: tuple[float, float, float, float]
    runs: tuple[RunsShown, ...]


def panels_of(words: Row, path: Path, name: str) -> list[Row]:
    """The panels in a figure's ``words``, checked; none of a figure that was drawn without them.

    Raises:
        BadInput: they are not as a figure describes them.
    """
    given = words.get("panels", [])
    try:
        if not isinstance(given, list):
            raise TypeError("must be a list")
        return [Panel.model_validate(one).model_dump() for one in given]
    except (ValidationError, TypeError) as error:
        where = ""
        if isinstance(error, ValidationError):
            first = error.errors()[0]
            where = f"{'.'.join(map(str, first['loc']))}: {first['msg']}"
        raise BadInput([f"{path}: panels: {where or error}; {_remedy(name)}"]) from None


def endings(table: pd.DataFrame, study: Study) -> dict[str, str]:
    """How each run of the table of runs ends, in a word or two."""
    ends: dict[str, str] = {}
    for task, runs in table.groupby("task", sort=False):
        if task not in study.tasks:
            ends |= dict.fromkeys(runs["run"], UNKNOWN)
            continue
        judged_by = study.tasks[str(task)].judged_by
        for run, well, diverged in zip(
            runs["run"], succeeds(runs, study.tasks[str(task)]), runs["diverged_at"].notna(),
            strict=True,
        ):  # fmt: skip
            ends[run] = "diverged" if diverged else ENDS[judged_by, bool(well)]
    return ends


def embedded(drawn: Iterable[Row], step_sizes: Row, study: Study) -> Markup:
    """The data of the page's script as JSON that may stand in an element."""
    shown = {one["name"]: one["panels"] for one in drawn if one.get("panels")}
    judged = {name: task.judged_by for name, task in study.tasks.items()}
    text = json.dumps(
        {"figures": shown, "stepSizes": step_sizes, "judged": judged},
        ensure_ascii=False, allow_nan=False, separators=(",", ":"),
    )  # fmt: skip
    return Markup(text.replace("<", "\\u003c").replace("&", "\\u0026"))  # noqa: S704
