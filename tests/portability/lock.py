"""The lock files: ``make lock`` has uv resolve all platforms and Pythons at once, and splits what it finds.

Everything has the checksums of all its files, so no index can hand out others, and no addresses: any index
will do. torch has those of its CPU builds, too, which another index has than everything else.
"""

import re
import subprocess
import sys
from collections.abc import Iterable, Mapping
from os import environ
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.paths import ROOT

LOCK, SLURM, GPU = (ROOT / f"requirements{which}.lock" for which in ("", "-slurm", "-gpu"))
UV = Path(sys.executable).parent / "uv"
OLDEST = "3.11"
"""Versions fit every Python from this one on; where none does, a marker chooses."""

FOR_A_GPU = re.compile(r"(nvidia|cuda)-|triton$")
"""What torch for a GPU needs and its CPU build does not."""


class Pin(NamedTuple):
    """A line of a lock file, which may go on over several."""

    required: str  # name, version and marker
    checksums: tuple[str, ...]  # of all its files, as algorithm:digits

    @property
    def requirement(self) -> Requirement:
        """The same, taken apart."""
        return Requirement(self.required)

    @property
    def name(self) -> str:
        """Its name, as indices write it."""
        return canonicalize_name(self.requirement.name)

    def __str__(self) -> str:
        """As it stands in a file."""
        return " \\\n    ".join([self.required, *(f"--hash={each}" for each in self.checksums)])


def pins(text: str) -> list[Pin]:
    """The lines of a lock file, without its comments."""
    whole = re.sub(r"\\\n\s*", "", re.sub(r"^\s*#.*\n", "", text, flags=re.MULTILINE))
    found = (re.split(r"\s*--hash=", line.strip()) for line in whole.splitlines() if line.strip())
    return [Pin(required, tuple(sorted(checksums))) for required, *checksums in found]


def resolved(extras: Iterable[str], known: Iterable[Pin], *options: str) -> list[Pin]:
    """What the project needs with these extras, in the versions that are known unless they do not fit."""
    with TemporaryDirectory() as folder:
        out = Path(folder) / "all.lock"
        # Versions only: uv would keep the checksums, too, and add none of files that came later.
        out.write_text("\n".join(pin.required for pin in known), "utf-8")
        of_extras = [part for extra in extras for part in ("--extra", extra)]
        uv(
            "pip",
            "compile",
            "pyproject.toml",
            *of_extras,
            "--output-file",
            str(out),
            *FOR_ALL,
            *options,
        )
        return pins(out.read_text("utf-8"))


FOR_ALL = (
    "--universal", "--python-version", OLDEST,
    "--generate-hashes", "--no-annotate", "--no-header",
)  # fmt: skip


def uv(*arguments: str, given: str | None = None) -> str:
    """Call uv in the checkout, and return what it prints.

    Raises:
        SystemExit: it could not do it; it says why.
    """
    done = subprocess.run(
        [UV, "--quiet", *arguments],
        cwd=ROOT,
        input=given,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise SystemExit(f"upswing: uv {' '.join(arguments[:3])}: {done.stderr.strip()}")
    return done.stdout


def with_cpu_builds(found: Pin, known: Mapping[str, Pin], index: str) -> Pin:
    """The pin of torch with the checksums of its CPU builds: those that ``index`` has, else those that are known.

    Raises:
        SystemExit: it is another torch than the one that is known, and no index is named.
    """
    if index:
        (build,) = found.requirement.specifier
        asked = f"torch=={build.version}+cpu ; sys_platform == 'linux'"
        (cpu,) = pins(
            uv("pip", "compile", "-", "--no-deps", "--default-index", index, *FOR_ALL, given=asked)
        )
    elif found.name in known and known[found.name].required == found.required:
        cpu = known[found.name]
    else:
        raise SystemExit(
            f"upswing: {found.required} is new: name an index that has its builds for a CPU, "
            "make lock CPU_BUILDS=ADDRESS"
        )
    return found._replace(checksums=tuple(sorted({*found.checksums, *cpu.checksums})))


def write(path: Path, lines: Iterable[Pin]) -> None:
    """Write a lock file below the comments that it has."""
    comments = [line for line in path.read_text("utf-8").splitlines() if line.startswith("#")]
    path.write_text("\n".join([*comments, *map(str, lines)]) + "\n", "utf-8")


def main() -> None:
    """Renew all lock files; nothing is written unless all of it could be resolved."""
    known = [pin for path in (LOCK, GPU, SLURM) for pin in pins(path.read_text("utf-8"))]
    # The same versions on every Python, where the newest of some would differ.
    newest = ("--upgrade", "--fork-strategy", "fewest") if environ.get("NEWEST") else ()
    everywhere = resolved(("dev", "docs"), known, *newest)
    slurm = resolved(("dev", "docs", "slurm"), [*everywhere, *known])
    by_name = {pin.name: pin for pin in known}
    locked = [
        with_cpu_builds(pin, by_name, environ.get("CPU_BUILDS", "")) if pin.name == "torch" else pin
        for pin in everywhere
        if not FOR_A_GPU.match(pin.name)
    ]
    write(LOCK, locked)
    write(GPU, [pin for pin in everywhere if FOR_A_GPU.match(pin.name)])
    write(SLURM, [pin for pin in slurm if pin not in everywhere])


if __name__ == "__main__":
    main()
