"""Figures 5–11 of the thesis and those that sum them up, drawn from our runs: one file of code each.

A figure is a file of this folder that says what it shows (``FIGURE = Declaration(…)``) and draws it
(``def draw(results) -> Drawing``; those with a number in the thesis are also given the claims that name
it, which they show decided). Those of ``NAMES`` are drawn of every study that has their cells; any
other is drawn where a study names it under ``figures``. A study may also declare figures of its own, or
have their code beside its configuration (``own``).
"""

import json
from collections.abc import Collection, Iterable, Iterator, Mapping
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING

from upswing.analysis.colours import shown_as
from upswing.figures.declaration import Declaration as Declaration
from upswing.figures.own import WithOwn, load_file
from upswing.figures.own import declaration_of as declaration_of
from upswing.figures.own import own_of as own_of
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import seal
from upswing.study.errors import BadInput, near
from upswing.study.jobs import FROM_PANELS
from upswing.study.loading import load, parts, source_of
from upswing.study.own_figures import DeclaredFigure, OwnFigure
from upswing.study.paths import FIGURES as FIGURES_FOLDER

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results
    from upswing.study.claims import Claim
    from upswing.study.config import Study

NAMES = (
    "overview", "step-sizes", "learning-curves",
    "fig05", "fig06", "fig07", "fig08", "fig09", "fig10", "fig11",
    "bound", "settling", "prediction", "changes",
)  # fmt: skip
"""The figures of the thesis and of its chapters, in their order."""


class _Declarations(Mapping[str, Declaration]):
    """Each read when it is asked for, so that the job of one figure knows no other's code."""

    def __getitem__(self, name: str) -> Declaration:
        if name not in list(self):
            raise KeyError(name)
        declared = load("figures", name).FIGURE
        if not isinstance(declared, Declaration):
            raise BadInput([f"{source_of('figures', name)}: FIGURE: must be a Declaration(…)"])
        return declared

    def __iter__(self) -> Iterator[str]:
        yield from NAMES
        yield from (name for name in parts("figures") if name not in NAMES)

    def __len__(self) -> int:
        return len(list(iter(self)))


FIGURES: Mapping[str, Declaration] = _Declarations()
"""What each figure shows, by its name; in the thesis ``fig05`` is figure 5."""


def figures_of(study: "Study") -> Mapping[str, Declaration]:
    """What each figure shows, those of the study's own included."""
    return WithOwn(FIGURES, study)


def drawable(
    cells: Iterable[str],
    changes: bool = False,
    asked: Iterable[str] = (),
    figures: Mapping[str, Declaration] = FIGURES,
) -> list[str]:
    """The figures that can be drawn of a study.

    Args:
        cells: ids of its cells.
        changes: whether it is one of changes to the thesis.
        asked: the figures that it names itself.
        figures: what each figure shows (``figures_of``).

    Raises:
        BadInput: a figure that it names shows a cell that it does not have.
    """
    known = set(cells)
    if problems := [
        f"figures: {name}: shows {cell}, which is no cell of this study; {near(cell, known)[:200]}"
        for name in asked
        for cell in figures[name].cells
        if cell not in known
    ]:
        raise BadInput(problems)
    return [
        name
        for name in dict.fromkeys((*NAMES, *asked))
        if set(figures[name].cells) <= known and (changes or not figures[name].tables)
    ]


def named(name: str, figures: Collection[str] = FIGURES) -> str:
    """The name of a figure, from its name or its number in the thesis.

    Raises:
        BadInput: there is no such figure.
    """
    name = f"fig{int(name):02d}" if name.isdigit() else name
    if name not in list(figures):
        raise BadInput([f"figure: {name}: no such figure; {near(name, figures)}"])
    return name


def claims_of(name: str, claims: "Mapping[str, Claim]") -> "dict[str, Claim]":
    """The claims that a figure decides: those that name it, one of the thesis by its number."""
    by = FIGURES[name].number if name in NAMES else None
    return {key: one for key, one in claims.items() if one.figure == (by or name)}


def draw(name: str, results: "Results", claims: "Mapping[str, Claim] | None" = None) -> None:
    """Draw a figure: ``figures/NAME.svg``, ``.png`` and its words in ``.json``.

    Args:
        name: the figure's name, or its number in the thesis.
        results: the folder of results, read for drawing.
        claims: all claims; a figure shows what decides those that name it. Without, or where the study
            judges nothing: of none.

    Raises:
        BadInput: there is no such figure, or its file is not as it should be.
    """
    own = own_of(results.study)
    name = named(name, [*FIGURES, *own])
    from upswing.figures.style import save

    named_by = claims_of(name, (claims or {}) if results.study.judges else {})
    with shown_as(results.study, results.architectures):
        if name in own:
            declared, drawing = _drawn(own[name], results, named_by)
        else:
            declared = FIGURES[name]
            given = (named_by,) if declared.number else ()
            drawing = _checked(
                load("figures", name).draw(results, *given), source_of("figures", name)
            )
        place = results.folder / FIGURES_FOLDER / name
        panels = save(drawing.figure, place)
    with written(place.with_suffix(".json")) as beside:
        words = {
            "title": declared.title,
            "section": declared.section,
            "claims": list(dict.fromkeys((*declared.claims, *named_by))),
            "caption": drawing.caption,
            "alt": drawing.alt or f"{declared.title}.",
            "runs": drawing.runs,
            "panels": panels,
        }
        beside.write_text(json.dumps(words, indent=1, ensure_ascii=False) + "\n", "utf-8")
    seal(
        results.folder, f"figures/{name}",
        [place.with_suffix(ending) for ending in (".svg", ".png", ".json")],
    )  # fmt: skip


def _drawn(
    own: OwnFigure, results: "Results", claims: "Mapping[str, Claim]"
) -> "tuple[Declaration, Drawing]":
    """A figure of the study's own, with what it shows."""
    if isinstance(own, DeclaredFigure):
        return declaration_of(own), import_module(FROM_PANELS).draw(own, results, claims)
    path = Path(own.file)
    if path.resolve().is_relative_to(results.folder.resolve()):
        why = "is in the folder of results, and so is no code to run; it belongs beside a configuration"
        raise BadInput([f"{path}: {why}"])
    declared, code = declaration_of(own), load_file(own)
    drawing = getattr(code, "draw", None)
    if not callable(drawing):
        raise BadInput([f"{path}: draw: missing: a function draw(results) that draws the figure"])
    given = (claims,) if len(signature(drawing).parameters) > 1 else ()
    return declared, _checked(drawing(results, *given), path)


def _checked(drawing: object, path: Path) -> "Drawing":
    """What a figure's function returned, which must be a drawing."""
    from upswing.figures.panels import Drawing

    if not isinstance(drawing, Drawing):
        raise BadInput([f"{path}: draw: must return a panels.Drawing"])
    return drawing
