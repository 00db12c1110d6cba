"""The table of the documentation that says where the lock files can be installed: ``make portability``."""

from collections.abc import Iterable

from tests.paths import ROOT
from tests.portability.lock import GPU, LOCK, SLURM
from tests.portability.wheels import PLATFORMS, PYTHONS, Fit, Line, Platform, fitting, lines, wanted

PAGE = ROOT / "docs/portability.md"
BEGIN, END = "<!-- table: make portability -->\n\n", "\n<!-- end -->"


def table() -> str:
    """The table, from what the index has now.

    Raises:
        SystemExit: the index cannot be reached, or lacks a version.
    """
    pinned, for_a_gpu = [*lines(LOCK), *lines(SLURM)], lines(GPU)
    rows = [["", *(platform.name for platform in PLATFORMS)], ["---"] * (1 + len(PLATFORMS))]
    for python in PYTHONS:
        version = ".".join(map(str, python))
        rows.append([f"Python {version}", *(_cell(pinned, each, python) for each in PLATFORMS)])
    rows.append(["needs at least", *(_system(pinned, each) for each in PLATFORMS)])
    rows.append(["only for a GPU", *(_gpu(for_a_gpu, each) for each in PLATFORMS)])
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _cell(pinned: list[Line], platform: Platform, python: tuple[int, int]) -> str:
    """How many lines are installed there, how large their wheels are, and what has none."""
    here = {line.name: fitting(line, platform, python) for line in wanted(pinned, platform, python)}
    without = [f"`{name}`" for name, fit in here.items() if fit is None]
    has = f"{len(here) - len(without)} of {len(here)} have a wheel, {_size(here.values())}"
    return f"{has}; built: {', '.join(without)}" if without else has


def _system(pinned: list[Line], platform: Platform) -> str:
    """The oldest system that all wheels can be used on, whichever Python."""
    found = [
        fit.needs
        for python in PYTHONS
        for line in wanted(pinned, platform, python)
        if (fit := fitting(line, platform, python)) is not None
    ]
    return f"{platform.system} {'.'.join(map(str, max(found)))}"


def _gpu(for_a_gpu: list[Line], platform: Platform) -> str:
    """What torch for a GPU needs besides."""
    fits = [fitting(line, platform, PYTHONS[0]) for line in wanted(for_a_gpu, platform, PYTHONS[0])]
    return f"{len(fits)} more, {_size(fits)}" if fits else "nothing"


def _size(fits: Iterable[Fit | None]) -> str:
    total = sum(fit.size for fit in fits if fit is not None)
    return f"{total / 1e9:.1f} GB"


def stored() -> str:
    """The table as it stands on the page."""
    return PAGE.read_text("utf-8").split(BEGIN)[1].split(END)[0]


def main() -> None:
    """Renew the table on the page."""
    PAGE.write_text(PAGE.read_text("utf-8").replace(stored(), table()), "utf-8")
    print(f"{PAGE.relative_to(ROOT)}: renewed")


if __name__ == "__main__":
    main()
