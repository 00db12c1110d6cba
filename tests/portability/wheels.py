"""Where a wheel of every pinned line can be had: on which platform, for which Python, from the index in use.

uv tells the files that the index has of each line; which of them fit where follows from their names.
"""

import re
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from packaging.markers import Marker
from packaging.tags import Tag, compatible_tags, cpython_tags
from packaging.utils import parse_wheel_filename

from tests.portability.lock import FOR_ALL, uv

PYTHONS = ((3, 11), (3, 12), (3, 13), (3, 14))
ANYWHERE = "any"


class Platform(NamedTuple):
    """A kind of machine."""

    name: str
    marker: dict[str, str]  # what markers ask of it
    tag: re.Pattern[
        str
    ]  # of wheels for it; its groups are the version that they need of the system
    system: str  # what that is a version of


LINUX = {"sys_platform": "linux", "platform_system": "Linux", "os_name": "posix"}
MACOS = {"sys_platform": "darwin", "platform_system": "Darwin", "os_name": "posix"}
CPYTHON = {"implementation_name": "cpython", "platform_python_implementation": "CPython"}
PLATFORMS = (
    Platform("Linux x86-64", {**LINUX, "platform_machine": "x86_64"}, re.compile(r"manylinux_(2)_(\d+)_x86_64"), "glibc"),
    Platform("Linux arm64", {**LINUX, "platform_machine": "aarch64"}, re.compile(r"manylinux_(2)_(\d+)_aarch64"), "glibc"),
    Platform("macOS arm64", {**MACOS, "platform_machine": "arm64"}, re.compile(r"macosx_(\d+)_(\d+)_(?:arm64|universal2)"), "macOS"),
)  # fmt: skip
OF_OLD = {
    "manylinux2014": "manylinux_2_17",
    "manylinux2010": "manylinux_2_12",
    "manylinux1": "manylinux_2_5",
}
"""What older names of tags mean."""


class File(NamedTuple):
    """A file that the index has of a line."""

    name: str
    size: int  # [bytes]


class Line(NamedTuple):
    """A line of a lock file, and what the index has of it."""

    name: str
    marker: Marker | None
    wheels: tuple[File, ...]
    checksums: frozenset[str]  # of all its files, as algorithm:digits


class Fit(NamedTuple):
    """A wheel that fits a platform and a Python."""

    needs: tuple[int, ...]  # the version of the system, at least; () if any will do
    size: int  # [bytes]


def lines(lock: Path) -> list[Line]:
    """The lines of a lock file.

    Raises:
        SystemExit: the index cannot be reached, or lacks a version.
    """
    found = tomllib.loads(
        uv("pip", "compile", str(lock), "--no-deps", "--format", "pylock.toml", *FOR_ALL)
    )
    return [_line(package) for package in found["packages"]]


def _line(package: dict[str, Any]) -> Line:
    files = [*package.get("wheels", ()), *([package["sdist"]] if "sdist" in package else ())]
    wheels = (
        File(each["url"].rsplit("/", 1)[1], each["size"]) for each in package.get("wheels", ())
    )
    return Line(
        name=package["name"],
        marker=Marker(package["marker"]) if "marker" in package else None,
        wheels=tuple(wheels),
        checksums=frozenset(
            f"{kind}:{digits}" for each in files for kind, digits in each["hashes"].items()
        ),
    )


def wanted(found: Iterable[Line], platform: Platform, python: tuple[int, int]) -> list[Line]:
    """The lines that are installed there."""
    version = ".".join(map(str, python))
    environment = {
        **platform.marker, **CPYTHON, "python_version": version, "python_full_version": f"{version}.9",
        "implementation_version": f"{version}.9", "platform_release": "", "platform_version": "", "extra": "",
    }  # fmt: skip
    return [line for line in found if line.marker is None or line.marker.evaluate(environment)]


def fitting(line: Line, platform: Platform, python: tuple[int, int]) -> Fit | None:
    """The wheel that needs the oldest system there; None if the line has none for it."""
    fits = [
        Fit(needs, wheel.size)
        for wheel in line.wheels
        for tag in parse_wheel_filename(wheel.name.replace("%2B", "+"))[3]
        for needs in _needed(tag, platform, python)
    ]
    return min(fits, default=None)


def _needed(tag: Tag, platform: Platform, python: tuple[int, int]) -> Iterator[tuple[int, ...]]:
    """The version of the system that a tag needs, if it is of this platform and Python."""
    if (tag.interpreter, tag.abi, tag.platform == ANYWHERE) not in _interpreters(python):
        return
    name, _, rest = tag.platform.partition("_")
    if tag.platform == ANYWHERE:
        yield ()
    elif found := platform.tag.fullmatch(
        f"{OF_OLD[name]}_{rest}" if name in OF_OLD else tag.platform
    ):
        yield tuple(map(int, found.groups()))


def _interpreters(python: tuple[int, int]) -> set[tuple[str, str, bool]]:
    """Interpreter and interface of every tag that fits a Python, and whether it is of any platform."""
    short = f"cp{python[0]}{python[1]}"
    tags = [
        *cpython_tags(python, abis=[short], platforms=["here"]),
        *compatible_tags(python, interpreter=short, platforms=["here"]),
    ]
    return {(tag.interpreter, tag.abi, tag.platform == ANYWHERE) for tag in tags}
