"""Text for readers: wrapped and coloured in a terminal, one line a row in a pipe or a file."""

import os
import shutil
import sys
import textwrap
from collections.abc import Collection, Mapping, Sequence
from unicodedata import combining, east_asian_width

import typer

GAP = 2
"""Number of spaces between two columns."""


def terminal_width() -> int | None:
    """Number of columns of the terminal; None in a pipe or a file, where no line is wrapped."""
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else None


def say(text: str, indent: int = 0) -> None:
    """Print one paragraph; in a terminal its further lines are indented by so many columns."""
    print(_wrapped(text, indent))


def print_table(
    header: Sequence[str],
    rows: Sequence[Sequence[str]],
    right: Collection[str] = (),
    words: Sequence[str] = (),
    below: Sequence[Sequence[str]] = (),
    colours: Mapping[str, str] | None = None,
) -> None:
    """Print rows of short cells side by side, each with words of any length.

    The words stand in the line of their row in a pipe, and in a terminal where all lines fit;
    elsewhere they stand below it, indented.

    Args:
        header: of every column, and, where there are words, of these.
        rows: the cells of each row.
        right: the headers of the columns that are aligned to the right.
        words: what each row is about, if it has words.
        below: further lines of each row, always below it.
        colours: of the cells with these texts, in a terminal.
    """
    titles, title = (header[:-1], header[-1:]) if words else (header, ())
    widths = [max(map(columns_of, column)) for column in zip(titles, *rows, strict=True)]
    indent = widths[0] + GAP
    room = terminal_width()
    longest = max(map(columns_of, (*title, *words)), default=0)
    beside = room is None or sum(widths) + GAP * len(widths) + longest <= room

    def line(cells: Sequence[str], last: str, paint: Mapping[str, str]) -> str:
        padded = []
        for name, cell, width in zip(titles, cells, widths, strict=True):
            space = " " * (width - columns_of(cell))
            shown = _coloured(cell, paint.get(cell))
            padded.append(space + shown if name in right else shown + space)
        return (" " * GAP).join([*padded, last]).rstrip()

    print(_coloured(line(titles, "".join(title) if beside else "", {}), "bright_black"))
    for number, cells in enumerate(rows):
        own = words[number] if words else ""
        print(line(cells, own if beside else "", colours or {}))
        for text in (*(() if beside or not own else (own,)), *(below[number] if below else ())):
            print(_wrapped(" " * indent + text, indent))


def has_room(header: Sequence[str], rows: Sequence[Sequence[str]]) -> bool:
    """Whether these cells fit side by side, as ``print_table`` prints them."""
    room = terminal_width()
    widths = [max(map(columns_of, column)) for column in zip(header, *rows, strict=True)]
    return room is None or sum(widths) + GAP * (len(widths) - 1) <= room


def columns_of(text: str) -> int:
    """Number of columns that a text takes in a terminal."""
    return sum(
        0 if combining(letter) else 2 if east_asian_width(letter) in "WF" else 1 for letter in text
    )


def _wrapped(text: str, indent: int) -> str:
    room = terminal_width()
    if room is None:
        return text
    return textwrap.fill(
        text, room, subsequent_indent=" " * indent, break_long_words=False, break_on_hyphens=False
    )


def _coloured(text: str, colour: str | None) -> str:
    if colour is None or not sys.stdout.isatty() or os.environ.get("NO_COLOR"):
        return text
    return typer.style(text, fg=colour)
