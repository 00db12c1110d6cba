"""The tables of a page as its reader sees them: rows of text, with what tells which row it is."""

import re
from html.parser import HTMLParser
from typing import NamedTuple


class Row(NamedTuple):
    """A row of a table."""

    name: str  # the id of the row, or else the text of its head
    claim: str  # the claim in whose details it stands; empty elsewhere
    cells: list[str]  # the texts of its data


class Tables(HTMLParser):
    """The tables of a page by what their region is called."""

    def __init__(self, page: str) -> None:
        super().__init__(convert_charrefs=True)
        self.found: dict[str, list[Row]] = {}
        self._region, self._details, self._texts = "", [""], list[str]()
        self._id, self._head, self._in = "", "", ""
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if given.get("role") == "region":
            self._region = given.get("aria-label") or ""
        if tag == "details":
            self._details.append(given.get("id") or "")
        if tag == "tr":
            self._id, self._head, self._texts = given.get("id") or "", "", []
        if tag in ("td", "th"):
            self._in = tag
            if tag == "td":
                self._texts.append("")
        if tag == "br" and self._texts:
            self._texts[-1] += " "

    def handle_endtag(self, tag: str) -> None:
        if tag == "details":
            self._details.pop()
        if tag in ("td", "th"):
            self._in = ""
        if tag == "tr" and self._texts:
            name = self._id or " ".join(self._head.split())
            rows = self.found.setdefault(self._region, [])
            rows.append(Row(name, self._details[-1], [" ".join(t.split()) for t in self._texts]))

    def handle_data(self, data: str) -> None:
        if self._in == "td":
            self._texts[-1] += data
        elif self._in == "th":
            self._head += data


NUMBER = re.compile(r"−?\d[\d,]*(?:\.\d+)?")


def numbers(text: str) -> list[str]:
    """The numbers in a text, as they are written."""
    return NUMBER.findall(text)


def is_shown_as(written: str, value: float) -> bool:
    """Whether a number of a page is ``value``, rounded to as many digits as it shows."""
    digits = len(written.partition(".")[2])
    shown = float(written.replace("−", "-").replace(",", ""))
    return abs(shown - value) <= 0.5 * 10**-digits + 1e-5 * max(1.0, abs(value))
