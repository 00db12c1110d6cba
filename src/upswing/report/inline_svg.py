"""A figure's SVG as a part of the page: what a plot needs, and nothing that the page's policy blocks.

The page is to show folders of whatever origin. So an SVG passes by lists of what is allowed: elements,
attributes and the form of their values. Anything else is refused: scripts, links, foreign objects,
entities.
"""

import re
from collections.abc import Callable
from html import escape
from pathlib import Path
from xml.parsers import expat

from markupsafe import Markup

from upswing.study.errors import BadInput

NAMESPACES = ("http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink")
ELEMENTS = frozenset(
    [
        "svg",
        "g",
        "defs",
        "clipPath",
        "path",
        "rect",
        "circle",
        "ellipse",
        "line",
        "polyline",
        "polygon",
        "use",
        "image",
        "text",
        "tspan",
    ]
)
LEFT_OUT = frozenset(("metadata", "title", "desc"))
"""Elements that are left out, with all that is in them."""

OF_ALL = "*{stroke-linejoin: round; stroke-linecap: butt}"
"""matplotlib's style sheet; the root says the same (a page's policy blocks styles)."""

_NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:e[-+]?\d+)?(?:px|pt|%)?"
_NUMBERS = rf"{_NUMBER}(?:[\s,]+{_NUMBER})*"
_WORD = r"[a-zA-Z]+(?:-[a-z]+)*"
_COLOUR = rf"#[0-9a-fA-F]{{3,8}}|{_WORD}|rgba?\([\d\s,.%]+\)"
_TURNS = rf"(?:(?:translate|rotate|scale|matrix)\({_NUMBERS}\)\s*)+"
VALUES = {
    "geometry": re.compile(rf"{_NUMBERS}|none"),
    "path": re.compile(r"[MLHVCSQTAZmlhvcsqtaz\d\s,.eE+-]*"),
    "turns": re.compile(_TURNS),
    "colour": re.compile(_COLOUR),
    "word": re.compile(rf"{_WORD}|{_NUMBER}"),
    "families": re.compile(r"[\w\s,'-]+"),
    "id": re.compile(r"[\w.:-]+"),
    "part": re.compile(r"url\(#[\w.:-]+\)"),
    "used": re.compile(r"#[\w.:-]+"),
    "pixels": re.compile(r"data:image/png;base64,[A-Za-z0-9+/=\s]*"),
}
"""The forms of values; none holds a place outside of the page."""

ATTRIBUTES = {
    **dict.fromkeys(
        ("x", "y", "x1", "x2", "y1", "y2", "cx", "cy", "r", "rx", "ry", "dx", "dy", "width", "height",
         "viewBox", "points", "opacity", "fill-opacity", "stroke-opacity", "stroke-width",
         "stroke-dasharray", "stroke-dashoffset", "stroke-miterlimit", "font-size", "rotate"),
        "geometry",
    ),
    **dict.fromkeys(
        ("stroke-linecap", "stroke-linejoin", "fill-rule", "clip-rule", "text-anchor", "font-weight",
         "font-style", "font-variant", "font-stretch", "dominant-baseline", "preserveAspectRatio",
         "image-rendering"),
        "word",
    ),
    **dict.fromkeys(("fill", "stroke"), "colour"),
    "d": "path", "transform": "turns", "font-family": "families", "id": "id", "clip-path": "part",
}  # fmt: skip
"""The attributes, and properties of a ``style``, that pass, and the form of their values."""

LEFT_OUT_ATTRIBUTES = frozenset(("version", "class", "type", "gid"))
TO_ROUND = frozenset(("d", "x", "y", "width", "height", "points"))
LONG = re.compile(r"(\d+\.\d{2})\d+")
FAMILY = "DejaVu Sans, Verdana, sans-serif"
"""What the figures are laid out with, and what is as wide; once for all texts."""


def inline(path: Path, name: str, words: str) -> Markup:
    """The picture in a file as an ``<svg>`` for the page.

    Args:
        path: the file.
        name: the figure's; ids begin with it, so that no two figures share one.
        words: what the picture shows, for those who cannot see it.

    Raises:
        BadInput: it is no SVG, or has what no figure has.
    """
    try:
        text = path.read_text("utf-8")
    except UnicodeDecodeError:
        raise BadInput([f"{path}: is no text; {_remedy(name)}"]) from None
    return Markup(_Copy(path, name, words, text).made)  # noqa: S704


def _remedy(name: str) -> str:
    return f"`upswing figure {name}` draws it anew"


class _Copy:
    """Copies one SVG, part by part, as it is read."""

    def __init__(self, path: Path, name: str, words: str, text: str) -> None:
        self.path, self.name, self.words = path, name, words
        self.used = set(re.findall(r"""(?:url\(|href=["'])#([\w.:-]+)""", text))
        self.parts: list[str] = []
        self.ends: list[str] = []  # of the elements that are open
        self.hidden = 0  # depth below an element that is left out
        self.style: list[str] | None = None  # the text of a style sheet
        reader = expat.ParserCreate(namespace_separator=" ")
        reader.StartElementHandler = self._start
        reader.EndElementHandler = self._end
        reader.CharacterDataHandler = self._text
        reader.EntityDeclHandler = self._refused("declares an entity")
        reader.ProcessingInstructionHandler = self._refused("has a processing instruction")
        try:
            reader.Parse(text, True)
        except expat.ExpatError as error:
            self._wrong(f"is no SVG: {error}")
        self.made = "".join(self.parts)
        if not self.made.startswith("<svg"):
            self._wrong("is no SVG")

    def _wrong(self, what: str) -> None:
        raise BadInput([f"{self.path}: {what}; {_remedy(self.name)}"])

    def _refused(self, what: str) -> Callable[..., None]:
        return lambda *_: self._wrong(what)

    def _start(self, full: str, attributes: dict[str, str]) -> None:
        space, _, element = full.rpartition(" ")
        if self.hidden or element in LEFT_OUT:
            self.hidden += 1
        elif element == "style":
            self.hidden, self.style = 1, []
        elif space not in NAMESPACES or element not in ELEMENTS:
            self._wrong(f"<{element}>: is no part of a figure")
        else:
            kept = self._attributes(element, attributes)
            if element == "svg":
                kept = self._root(kept)
            if element == "g" and not kept:
                self.ends.append("")
                return
            said = "".join(f' {key}="{escape(value)}"' for key, value in kept.items())
            self.parts.append(f"<{element}{said}>")
            self.ends.append(f"</{element}>")

    def _end(self, _: str) -> None:
        if self.hidden:
            self.hidden -= 1
            if self.style is not None and "".join(self.style).strip() not in ("", OF_ALL):
                self._wrong("<style>: has rules of its own")
            self.style = None
        else:
            self.parts.append(self.ends.pop())

    def _text(self, text: str) -> None:
        if self.style is not None:
            self.style.append(text)
        elif not self.hidden and self.ends and self.ends[-1] in ("</text>", "</tspan>"):
            self.parts.append(escape(text))

    def _root(self, kept: dict[str, str]) -> dict[str, str]:
        if self.ends:
            self._wrong("<svg>: stands in another")
        if "viewBox" not in kept:
            self._wrong("<svg>: viewBox: must be given")
        return {
            "viewBox": kept["viewBox"], "role": "img", "aria-label": self.words,
            "font-family": FAMILY, "stroke-linejoin": "round", "stroke-linecap": "butt",
        }  # fmt: skip

    def _attributes(self, element: str, given: dict[str, str]) -> dict[str, str]:
        kept: dict[str, str] = {}
        for full, value in given.items():
            space, _, key = full.rpartition(" ")
            if key == "style" and not space:
                for declared in filter(None, map(str.strip, value.split(";"))):
                    name, _, told = declared.partition(":")
                    self._keep(kept, element, name.strip(), told.strip())
            elif key not in LEFT_OUT_ATTRIBUTES:
                self._keep(kept, element, key, value.strip())
        return kept

    def _keep(self, kept: dict[str, str], element: str, key: str, value: str) -> None:
        form = ATTRIBUTES.get(key)
        if key == "href":
            form = {"use": "used", "image": "pixels"}.get(element)
        if form is None:
            self._wrong(f"<{element}>: {key}: is no attribute of a figure")
        elif not VALUES[form].fullmatch(value):
            self._wrong(f"<{element}>: {key}: {value[:60]!r} is not allowed in a figure")
        elif key == "id":
            if value in self.used:
                kept[key] = f"{self.name}-{value}"
        elif form in ("used", "part"):
            kept[key] = value.replace("#", f"#{self.name}-", 1)
        elif key != "font-family":
            kept[key] = LONG.sub(r"\1", value) if key in TO_ROUND else value
            if form == "path":
                kept[key] = re.sub(r"\s*([A-Za-z])\s*", r"\1", kept[key]).strip()
