"""How an architecture is shown: one colour in figures and recordings, a shade of it for text, a label.

A study may say both (``colour``, ``label``). What it does not say follows from the architecture's name.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from typing import NamedTuple
from zlib import crc32

from upswing.study.config import Study
from upswing.study.contrast import OF_LINES as OF_LINES
from upswing.study.contrast import OF_TEXT as OF_TEXT
from upswing.study.contrast import channels, darkened, distance
from upswing.study.contrast import contrast as contrast
from upswing.study.ids import CellId

# Okabe and Ito's palette, told apart by colour-blind readers too; one colour for an architecture. Each
# is at least 3:1 against white, which for the modular table takes a darker blue than theirs.
COLOURS = {
    "table": "#0072B2",
    "networks-5": "#D55E00",
    "networks-20-5": "#CC79A7",
    "networks-30": "#A65628",
    "modular-table": "#3A97D3",
    "modular-networks-5": "#009E73",
    "idle": "#777777",
    "random": "#333333",
}

# Each was the farthest from all before it and from those above (in OKLab, also as somebody sees it who
# lacks the green cones), of 16 × 16 × 16 colours with a contrast from 3.2 to 10.
OTHERS = (
    "#0000FF", "#661199", "#9944FF", "#006622", "#884477", "#4444CC", "#FF4477", "#005566", "#CC00AA",
    "#DD22FF", "#8866CC", "#BB0055", "#663344", "#EE44CC", "#AA2200", "#6633FF", "#554488", "#AA00DD",
    "#778844", "#0033BB",
)  # fmt: skip
"""Colours of architectures for which nobody named one."""

APART = 0.08
"""How far such a colour is from those that a study names, while there is one so far (``distance``)."""


class Shown(NamedTuple):
    """How an architecture is shown."""

    colour: str  # ``#RRGGBB``
    label: str


_SHOWN: ContextVar[Mapping[str, Shown]] = ContextVar("shown")


def shown_of(study: Study, adopted: Iterable[str] = ()) -> dict[str, Shown]:
    """How each architecture of a study is shown, by name.

    A colour that is not named follows from the architecture's name, and where two would have the same,
    from their order in the study: one more at the end changes none before it.

    Args:
        study: the study.
        adopted: names of architectures that it does not have itself.
    """
    names = dict.fromkeys((*study.architectures, *adopted))
    said = {name: one.colour for name, one in study.architectures.items() if one.colour is not None}
    taken = {shade for shade in OTHERS if any(distance(shade, of) < APART for of in said.values())}
    found = {}
    for name in names:
        one = study.architectures.get(name)
        shade = said.get(name) or COLOURS.get(name)
        if shade is None:
            shade = _of_name(name, taken)
            taken.add(shade)
        found[name] = Shown(shade, one.label if one and one.label else name)
    return found


def _of_name(name: str, taken: Collection[str] = ()) -> str:
    """The colour that follows from a name: one that is not taken, while there is any."""
    begin = crc32(name.encode()) % len(OTHERS)
    ordered = [*OTHERS[begin:], *OTHERS[:begin]]
    return next((shade for shade in ordered if shade not in taken), ordered[0])


@contextmanager
def shown_as(study: Study, adopted: Iterable[str] = ()) -> Iterator[None]:
    """Show architectures as a study says, within."""
    before = _SHOWN.set(shown_of(study, adopted))
    try:
        yield
    finally:
        _SHOWN.reset(before)


def _shown(architecture: str) -> Shown:
    found = _SHOWN.get({}).get(architecture)
    if found is not None:
        return found
    return Shown(COLOURS.get(architecture) or _of_name(architecture), architecture)


def colour(cell: str) -> str:
    """The colour of a cell, as ``#RRGGBB``: that of its architecture."""
    return _shown(CellId.parse(cell).architecture).colour


def name_of(architecture: str) -> str:
    """What an architecture is called: its label, or its name."""
    return _shown(architecture).label


def label(cell: str) -> str:
    """A cell without its task, for readers: ``table, α = 0.75``."""
    one = CellId.parse(cell)
    return one._replace(architecture=name_of(one.architecture)).label


def rgb(cell: str) -> tuple[int, int, int]:
    """The colour of a cell as three numbers up to 255."""
    return channels(colour(cell))


@cache
def of_text(shade: str) -> str:
    """The lightest shade of the same hue, ``#RRGGBB``, that can be read as text on white."""
    return darkened(shade, OF_TEXT)
