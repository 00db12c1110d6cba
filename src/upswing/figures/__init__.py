"""Figures 5–11 of the thesis and those that sum them up, drawn from our runs: one file of code each.

A figure is a file of this folder that says what it shows (``FIGURE = Declaration(…)``) and draws it
(``def draw(results) -> Drawing``; those with a number in the thesis are also given the claims that name
it, which they show decided). Those of ``NAMES`` are drawn of every study that has their cells; any
other is drawn where a study names it under ``figures``.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import seal
from upswing.study.errors import BadInput, near
from upswing.study.loading import load, parts, source_of
from upswing.study.paths import FIGURES as FIGURES_FOLDER

if TYPE_CHECKING:
    from upswing.runs.results import Results
    from upswing.study.claims import Claim

NAMES = (
    "overview", "step-sizes", "learning-curves",
    "fig05", "fig06", "fig07", "fig08", "fig09", "fig10", "fig11",
    "bound", "changes",
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


def drawable(cells: Iterable[str], changes: bool = False, asked: Iterable[str] = ()) -> list[str]:
    """The figures that can be drawn of a study.

    Args:
        cells: ids of its cells.
        changes: whether it is one of changes to the thesis.
        asked: the figures that it names itself.

    Raises:
        BadInput: a figure that it names shows a cell that it does not have.
    """
    known = set(cells)
    if problems := [
        f"figures: {name}: shows {cell}, which is no cell of this study; {near(cell, known)[:200]}"
        for name in asked
        for cell in FIGURES[name].cells
        if cell not in known
    ]:
        raise BadInput(problems)
    return [
        name
        for name in dict.fromkeys((*NAMES, *asked))
        if set(FIGURES[name].cells) <= known and (changes or not FIGURES[name].tables)
    ]


def named(name: str) -> str:
    """The name of a figure, from its name or its number in the thesis.

    Raises:
        BadInput: there is no such figure.
    """
    name = f"fig{int(name):02d}" if name.isdigit() else name
    if name not in FIGURES:
        raise BadInput([f"figure: {name}: no such figure; {near(name, FIGURES)}"])
    return name


def claims_of(name: str, claims: "Mapping[str, Claim]") -> "dict[str, Claim]":
    """The claims that a figure of the thesis decides: those that name its number."""
    number = FIGURES[name].number
    return {key: one for key, one in claims.items() if number and one.figure == number}


def draw(name: str, results: "Results", claims: "Mapping[str, Claim] | None" = None) -> None:
    """Draw a figure: ``figures/NAME.svg``, ``.png`` and its words in ``.json``.

    Args:
        name: the figure's name, or its number in the thesis.
        results: the folder of results, read for drawing.
        claims: all claims; a figure of the thesis shows what decides its own. Without, or where the
            study judges nothing: of none.

    Raises:
        BadInput: there is no such figure, or its file is not as it should be.
    """
    name = named(name)
    from upswing.figures.panels import Drawing
    from upswing.figures.style import save

    declared = FIGURES[name]
    judged = (claims or {}) if results.study.judges else {}
    own = (claims_of(name, judged),) if declared.number else ()
    drawing = load("figures", name).draw(results, *own)
    if not isinstance(drawing, Drawing):
        raise BadInput([f"{source_of('figures', name)}: draw: must return a panels.Drawing"])
    place = results.folder / FIGURES_FOLDER / name
    panels = save(drawing.figure, place)
    with written(place.with_suffix(".json")) as beside:
        words = {
            "title": declared.title,
            "section": declared.section,
            "claims": declared.claims,
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
