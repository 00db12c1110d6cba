"""One colour for an architecture, in figures and recordings alike."""

from upswing.study.ids import CellId

# Okabe and Ito's palette, told apart by colour-blind readers too; one colour for an architecture.
COLOURS = {
    "table": "#0072B2",
    "networks-5": "#D55E00",
    "networks-20-5": "#CC79A7",
    "networks-30": "#A65628",
    "modular-table": "#56B4E9",
    "modular-networks-5": "#009E73",
    "idle": "#777777",
    "random": "#333333",
}


def colour(cell: str) -> str:
    """The colour of a cell, as ``#RRGGBB``: that of its architecture."""
    return COLOURS.get(CellId.parse(cell).architecture, "#000000")


def rgb(cell: str) -> tuple[int, int, int]:
    """The colour of a cell as three numbers up to 255."""
    red, green, blue = bytes.fromhex(colour(cell)[1:])
    return red, green, blue
