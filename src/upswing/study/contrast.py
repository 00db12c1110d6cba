"""Colours of sRGB as ``#RRGGBB``: how well they are seen on white, and darker shades that are."""

from math import dist

OF_LINES, OF_TEXT = 3.0, 4.5
"""The contrast that what is drawn needs, and that of text (WCAG 2.2, 1.4.11 and 1.4.3)."""

WHITE = "#FFFFFF"


def contrast(one: str, other: str = WHITE) -> float:
    """How much two colours ``#RRGGBB`` differ in lightness, from 1 to 21 (WCAG 2.2)."""
    dark, light = sorted((_luminance(one), _luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def darkened(shade: str, least: float) -> str:
    """The lightest shade of the same hue whose contrast to white is at least ``least``."""
    for part in range(100, -1, -1):
        found = "#" + "".join(f"{channel * part // 100:02X}" for channel in channels(shade))
        if contrast(found) >= least:
            return found
    return "#000000"


def channels(shade: str) -> tuple[int, int, int]:
    """Red, green and blue of ``#RRGGBB``, up to 255."""
    red, green, blue = bytes.fromhex(shade.removeprefix("#"))
    return red, green, blue


def _linear(shade: str) -> tuple[float, float, float]:
    """Red, green and blue as amounts of light, from 0 to 1."""
    red, green, blue = (
        x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4
        for x in (channel / 255 for channel in channels(shade))
    )
    return red, green, blue


def _luminance(shade: str) -> float:
    """Relative luminance of a colour of sRGB, from 0 to 1."""
    red, green, blue = _linear(shade)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def distance(one: str, other: str) -> float:
    """How far two colours lie apart for an eye: in OKLab, in which white is 1 from black."""
    return dist(_oklab(one), _oklab(other))


def _oklab(shade: str) -> tuple[float, float, float]:
    """Lightness, and how much it is red against green and yellow against blue (Ottosson 2020)."""
    red, green, blue = _linear(shade)
    long = (0.4122214708 * red + 0.5363325363 * green + 0.0514459929 * blue) ** (1 / 3)
    middle = (0.2119034982 * red + 0.6806995451 * green + 0.1073969566 * blue) ** (1 / 3)
    short = (0.0883024619 * red + 0.2817188376 * green + 0.6299787005 * blue) ** (1 / 3)
    return (
        0.2104542553 * long + 0.7936177850 * middle - 0.0040720468 * short,
        1.9779984951 * long - 2.4285922050 * middle + 0.4505937099 * short,
        0.0259040371 * long + 0.7827717662 * middle - 0.8086757660 * short,
    )
