"""Figures 5–11 of the thesis and those that sum them up, drawn from our runs: one file of code each."""

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from upswing.figures.declaration import Declaration
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import seal
from upswing.study.errors import BadInput, near
from upswing.study.loading import load

NAMES = (
    "overview", "step-sizes", "learning-curves",
    "fig05", "fig06", "fig07", "fig08", "fig09", "fig10", "fig11",
    "bound", "changes",
)  # fmt: skip


class _Declarations(Mapping[str, Declaration]):
    """Each read when it is asked for, so that the job of one figure knows no other's code."""

    def __getitem__(self, name: str) -> Declaration:
        if name not in NAMES:
            raise KeyError(name)
        declared: Declaration = load("figures", name).FIGURE
        return declared

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)

    def __len__(self) -> int:
        return len(NAMES)


FIGURES: Mapping[str, Declaration] = _Declarations()
"""What each figure shows, by its name; in the thesis ``fig05`` is figure 5."""


def drawable(cells: Iterable[str], changes: bool = False) -> list[str]:
    """The figures that can be drawn of a study with these cells, perhaps of changes to the thesis."""
    known = set(cells)
    return [
        name
        for name, figure in FIGURES.items()
        if set(figure.cells) <= known and (changes or not figure.tables)
    ]


def draw(name: str, results: Path) -> None:
    """Draw a figure from ``results``: ``figures/NAME.svg``, ``.png`` and its words in ``.json``."""
    name = f"fig{int(name):02d}" if name.isdigit() else name
    if name not in FIGURES:
        raise BadInput([f"figure: {name}: no such figure; {near(name, FIGURES)}"])
    from upswing.figures.style import save
    from upswing.runs.results import Results

    declared = FIGURES[name]
    drawing = load("figures", name).draw(Results(results))
    place = results / "figures" / name
    save(drawing.figure, place)
    with written(place.with_suffix(".json")) as beside:
        words = {
            "title": declared.title,
            "section": declared.section,
            "claims": declared.claims,
            "caption": drawing.caption,
            "runs": drawing.runs,
        }
        beside.write_text(json.dumps(words, indent=1, ensure_ascii=False) + "\n", "utf-8")
    seal(
        results, f"figures/{name}",
        [place.with_suffix(ending) for ending in (".svg", ".png", ".json")],
    )  # fmt: skip
