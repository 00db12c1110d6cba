"""One colour for an architecture, in figures and recordings alike, and a shade of it for text."""

from functools import cache

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

OF_TEXT = 4.5
"""The contrast that text needs (WCAG 2.2, 1.4.3)."""

OF_LINES = 3.0
"""… and what is drawn (1.4.11)."""

WHITE = "#FFFFFF"


def colour(cell: str) -> str:
    """The colour of a cell, as ``#RRGGBB``: that of its architecture."""
    return COLOURS.get(CellId.parse(cell).architecture, "#000000")


def rgb(cell: str) -> tuple[int, int, int]:
    """The colour of a cell as three numbers up to 255."""
    return _channels(colour(cell))


def contrast(one: str, other: str = WHITE) -> float:
    """How much two colours ``#RRGGBB`` differ in lightness, from 1 to 21 (WCAG 2.2)."""
    dark, light = sorted((_luminance(one), _luminance(other)))
    return (light + 0.05) / (dark + 0.05)


@cache
def of_text(shade: str) -> str:
    """The lightest shade of the same hue, ``#RRGGBB``, that can be read as text on white."""
    channels = _channels(shade)
    for part in range(100, -1, -1):
        found = "#" + "".join(f"{channel * part // 100:02X}" for channel in channels)
        if contrast(found) >= OF_TEXT:
            return found
    return "#000000"


def _luminance(shade: str) -> float:
    """Relative luminance of a colour of sRGB, from 0 to 1."""
    red, green, blue = (
        x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4
        for x in (channel / 255 for channel in _channels(shade))
    )
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def _channels(shade: str) -> tuple[int, int, int]:
    red, green, blue = bytes.fromhex(shade.removeprefix("#"))
    return red, green, blue
