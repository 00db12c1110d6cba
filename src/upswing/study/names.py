"""What may name something in a file of configuration.

Names become folders, files, wildcards of the workflow and words of a command. So each has one of the
types below, and nothing that is special to any of these is in any of them.
"""

import re
from decimal import Decimal
from typing import Annotated

from pydantic import AfterValidator, Field

LONGEST = 60
"""Largest length of a name [characters]."""

DIGITS = 12
"""Largest number of significant digits of an α: two that differ can then be told apart."""

SMALLEST_ALPHA = 1e-9
NO_ALPHA = "none"
"""What a path says in place of α for a control, which has none."""


def _named(name: str) -> str:
    if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", name) or len(name) > LONGEST:
        raise ValueError("a name has small letters, digits and single hyphens, a letter first")
    return name


def _claimed(name: str) -> str:
    if not re.fullmatch(r"[A-Z][A-Za-z0-9]*(-[A-Za-z0-9]+)*", name) or len(name) > LONGEST:
        raise ValueError(
            "a claim's name has letters, digits and single hyphens, a capital first: C1"
        )
    return name


def _written(text: str) -> str:
    if not text.replace("\n", " ").isprintable():
        raise ValueError("a text has no control characters")
    return text


def _stepped(alpha: float) -> float:
    if float(f"{alpha:.{DIGITS}g}") != alpha:
        raise ValueError(f"α has at most {DIGITS} digits; write {alpha:.{DIGITS}g}")
    if alpha < SMALLEST_ALPHA:
        raise ValueError(f"α must be at least {SMALLEST_ALPHA:g}")
    return alpha


def _cell(text: str) -> str:
    task, _, rest = text.partition("/")
    architecture, _, alpha = rest.partition("/")
    try:
        _named(task)
        _named(architecture)
    except ValueError:
        raise ValueError(
            "a cell is task/architecture/alpha-α: balancing/table/alpha-0.75"
        ) from None
    number = alpha.removeprefix("alpha-")
    if number == alpha or (number != NO_ALPHA and not re.fullmatch(r"[0-9]+(\.[0-9]+)?", number)):
        raise ValueError("a cell ends with its α: alpha-0.75, or alpha-none for a control")
    if number != NO_ALPHA and number != alpha_text(float(number)):
        raise ValueError(f"α is written shortest: alpha-{alpha_text(float(number))}")
    return text


def alpha_text(alpha: float | None) -> str:
    """α written shortest: ``1``, ``0.75``, ``0.001``."""
    return NO_ALPHA if alpha is None else f"{Decimal(repr(float(alpha))).normalize():f}"


Name = Annotated[str, AfterValidator(_named)]
"""Of a task, an architecture or a sweep."""

Text = Annotated[str, AfterValidator(_written)]
"""For readers: it names nothing, but a NUL in it would still end a command."""

ClaimName = Annotated[str, AfterValidator(_claimed)]
CellName = Annotated[str, AfterValidator(_cell)]
Alpha = Annotated[float, Field(gt=0, le=1, allow_inf_nan=False), AfterValidator(_stepped)]
