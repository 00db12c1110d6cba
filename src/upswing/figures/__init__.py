"""Figures 5–11 of the thesis, drawn from our runs: one file of code each."""

import json
from importlib import import_module
from pathlib import Path

from upswing.figures.declaration import Declaration
from upswing.problems import BadInput
from upswing.store.files import written

NUMBERS = range(5, 12)


def _module(number: int) -> str:
    return f"upswing.figures.fig{number:02d}"


FIGURES: dict[int, Declaration] = {
    number: import_module(_module(number)).FIGURE for number in NUMBERS
}
"""What each figure shows, by its number in the thesis."""


def draw(number: int, results: Path) -> None:
    """Draw a figure from ``results``: ``figures/figNN.svg``, ``.png`` and its words in ``.json``."""
    if number not in FIGURES:
        raise BadInput([f"figure: {number}: there are figures 5 to 11"])
    from upswing.figures.style import save
    from upswing.runs import Results

    drawing = import_module(_module(number)).draw(Results(results))
    place = results / "figures" / f"fig{number:02d}"
    save(drawing.figure, place)
    with written(place.with_suffix(".json")) as beside:
        declared = FIGURES[number]
        words = {
            "number": number,
            "title": declared.title,
            "section": declared.section,
            "claims": declared.claims,
            "caption": drawing.caption,
            "runs": drawing.runs,
        }
        beside.write_text(json.dumps(words, indent=1, ensure_ascii=False) + "\n", "utf-8")
