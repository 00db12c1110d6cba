"""What was read out of sources, kept between processes by a file's path, size and time.

Every job of a study asks for fingerprints, and each would parse the same hundred files. The cache may be
deleted, damaged or written by several processes at once: what it lacks is read from the source again.
"""

import json
import os
import sys
import time
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from platformdirs import user_cache_path

FORMAT = f"1 {sys.version_info.major}.{sys.version_info.minor}"
"""What it means, and the Python whose syntax it is of: another one reads none of it."""

SETTLED = 2_000_000_000
"""Age of a file from which on its time tells its content [ns]: two edits in one tick have one time."""


class Read(NamedTuple):
    """What is known of a source."""

    digest: str  # of its syntax
    imports: tuple[str, ...]  # what it imports: modules, and names in them


class SourceCache:
    """What is known of the sources of a package.

    Args:
        package: the folder of the package; each has a cache of its own.
    """

    def __init__(self, package: Path) -> None:
        key = sha256(str(package.resolve()).encode()).hexdigest()[:16]
        self.path = user_cache_path("upswing") / "sources" / f"{key}.json"
        self.known: dict[str, list[object]] | None = None
        self.is_new = False

    def get(self, source: Path) -> Read | None:
        """What is known of a file as it is now; None if it must be read."""
        found = self._known().get(str(source))
        try:
            stamp, digest, imports = found  # type: ignore[misc]
            if stamp == _stamp(source) and isinstance(digest, str):
                return Read(digest, tuple(map(str, imports)))  # type: ignore[arg-type]
        except (TypeError, ValueError):
            pass
        return None

    def put(self, source: Path, read: Read) -> None:
        """Keep what was read, if the file's time can be trusted."""
        stamp = _stamp(source)
        if time.time_ns() - stamp[1] > SETTLED:
            self._known()[str(source)] = [stamp, read.digest, list(read.imports)]
            self.is_new = True

    def save(self) -> None:
        """Write what is new, if that is possible at all."""
        if not self.is_new:
            return
        self.is_new = False
        beside = self.path.with_name(f"{self.path.name}.{os.getpid()}.part")
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            beside.write_text(json.dumps({"format": FORMAT, "sources": self.known}), "utf-8")
            beside.replace(self.path)
        except OSError:
            beside.unlink(missing_ok=True)

    def _known(self) -> dict[str, list[object]]:
        if self.known is None:
            self.known = {}
            try:
                content = json.loads(self.path.read_text("utf-8"))
                if content["format"] == FORMAT and isinstance(content["sources"], dict):
                    self.known = content["sources"]
            except (OSError, ValueError, KeyError, TypeError):
                pass
        return self.known


def _stamp(source: Path) -> list[int]:
    state = source.stat()
    return [state.st_size, state.st_mtime_ns]
