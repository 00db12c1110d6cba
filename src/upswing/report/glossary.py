"""The words that page, README and documentation explain, all from one file: ``report/words.yaml``."""

from collections.abc import Mapping
from pathlib import Path

from pydantic import RootModel, ValidationError

from upswing.study.errors import BadInput, explained
from upswing.study.values import Strict
from upswing.study.yaml_file import read_yaml

FILE = "words.yaml"


class Word(Strict):
    """A word and what it means."""

    term: str
    meaning: str
    more: str = ""  # what only the documentation adds, in Markdown
    short: bool = False  # whether the README has it
    aside: bool = False  # whether only the documentation has it


class _Words(RootModel[dict[str, Word]]):
    """All words by what a link calls them."""


def glossary(templates: Path) -> Mapping[str, Word]:
    """The words by what a link calls them (``cell``), in the order in which they are shown.

    Args:
        templates: the folder with the file of words.

    Raises:
        BadInput: the file cannot be read, or a word of it has not what it needs.
    """
    path = templates / FILE
    try:
        return _Words.model_validate(read_yaml(path)).root
    except ValidationError as error:
        raise BadInput(explained(_Words, error, lambda *_: str(path))) from None


def in_a_paragraph(words: Mapping[str, Word]) -> str:
    """The words of the README, in Markdown: each with its meaning, one after the other."""
    return " ".join(f"**{word.term}.** {word.meaning}" for word in words.values() if word.short)


def as_sections(words: Mapping[str, Word]) -> str:
    """All words in Markdown, each below a heading of its own."""
    return "\n\n".join(
        f"### {word.term[0].upper()}{word.term[1:]}\n\n{word.meaning}"
        + (f"\n{word.more}" if word.more else "")
        for word in words.values()
    )
