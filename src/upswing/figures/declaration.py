"""What a figure declares before it is drawn; light, so that the workflow can read it."""

from typing import NamedTuple


class Declaration(NamedTuple):
    """A figure of the thesis."""

    title: str
    section: str  # where in the thesis
    claims: tuple[str, ...]  # ids of the claims it bears on
    cells: tuple[str, ...]  # ids of the cells it is drawn from
