"""What a figure declares before it is drawn; light, so that the workflow can read it."""

from typing import NamedTuple


class Declaration(NamedTuple):
    """A figure: one of the thesis, or one of ours that sums up its claims."""

    title: str
    section: str  # where in the thesis; empty for ours
    claims: tuple[str, ...]  # ids of the claims it bears on
    cells: tuple[str, ...] = ()  # ids of the cells it is drawn from; none: whatever the study has
    number: int | None = None  # in the thesis; with it, the claims that name it are drawn too
    beside: tuple[str, ...] = ()  # cells that it shows too, where the study has them
    tables: tuple[
        str, ...
    ] = ()  # of the chapter beyond the thesis; with them it is drawn there alone
