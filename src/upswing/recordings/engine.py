"""The viewer that runs in a browser: its script and its WebAssembly, kept for a version of Rerun.

Only the viewer's own server hands them out, and packing them takes seconds; so they are kept in the
user's cache. What is kept becomes a script of the report. It is therefore read only from a folder and
files that are ours and that nobody else can write, and only if it has its checksum; else it is
fetched anew.
"""

import hashlib
import mmap
import os
import stat
import subprocess
import time
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple
from urllib.error import URLError
from urllib.request import urlopen

from platformdirs import user_cache_path

from upswing.recordings.ports import LOOPBACK, free_port
from upswing.recordings.processes import running
from upswing.recordings.program import RERUN
from upswing.recordings.singly import compressed
from upswing.runs.files.atomic import written

PATIENCE = 20.0
"""Time limit for the viewer's own server to start [s]."""

FILES = ("re_viewer.js", "re_viewer_bg.wasm")
DIGEST = 64
"""Letters of a checksum in hexadecimal; it stands before what it is of."""


class Engine(NamedTuple):
    """The two files, compressed with gzip; the same bytes for the same version of Rerun."""

    script: bytes
    program: bytes


def engine() -> Engine:
    """The installed viewer's files: what was kept of this version, or fetched and then kept."""
    folder = _own_folder()
    if folder is not None:
        kept = [_taken(folder / f"{name}.gz") for name in FILES]
        if kept[0] is not None and kept[1] is not None:
            return Engine(kept[0], kept[1])
    packed = [compressed(content) for content in _fetched()]
    if folder is not None:
        for name, content in zip(FILES, packed, strict=True):
            with suppress(OSError):  # then it is fetched again the next time
                _keep(folder / f"{name}.gz", content)
    return Engine(*packed)


def _own_folder() -> Path | None:
    """The folder of what is kept for this version; None where there is none that is ours alone."""
    base = user_cache_path("upswing") / "viewer"
    folder = base / f"rerun-{version('rerun-sdk')}-{RERUN.stat().st_size}"
    try:
        base.parent.mkdir(parents=True, exist_ok=True)
        for each in (base, folder):
            each.mkdir(mode=0o700, exist_ok=True)
            found = each.lstat()
            if not stat.S_ISDIR(found.st_mode) or not _ours_alone(found):
                return None
    except OSError:
        return None
    return folder


def _ours_alone(found: os.stat_result) -> bool:
    """Whether it belongs to us and nobody else can write it."""
    return found.st_uid == os.geteuid() and not found.st_mode & 0o022


def _taken(path: Path) -> bytes | None:
    """What is kept in a file; None if it is not there, not ours alone or not whole."""
    try:
        handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW)
        with os.fdopen(handle, "rb") as file:
            found = os.fstat(handle)
            if not stat.S_ISREG(found.st_mode) or not _ours_alone(found):
                return None
            content = file.read()
    except OSError:
        return None
    digest, content = content[:DIGEST], content[DIGEST:]
    return content if digest == _digest(content) else None


def _keep(path: Path, content: bytes) -> None:
    with written(path) as beside:
        handle = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
        with os.fdopen(handle, "wb") as file:
            file.write(_digest(content) + content)


def _digest(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode("ascii")


def _fetched() -> list[bytes]:
    """The files from the viewer's own server, and surely its own."""
    port, other = free_port(), free_port()
    command = [str(RERUN), "--serve-web", "--bind", LOOPBACK, "--port", str(other)]
    with running(
        [*command, "--web-viewer-port", str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ):
        files = [_answered(f"http://{LOOPBACK}:{port}/{name}") for name in FILES]
    # Another program may have taken the port just before; the viewer's files stand in its program.
    with RERUN.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as program:
        for name, content in zip(FILES, files, strict=True):
            if not content or program.find(content) < 0:
                raise RuntimeError(f"{name}: port {port} answered with what is not of {RERUN}")
    return files


def _answered(address: str) -> bytes:
    until = time.monotonic() + PATIENCE
    while True:
        try:
            with urlopen(address, timeout=PATIENCE) as answer:  # noqa: S310  our own server
                content: bytes = answer.read()
                return content
        except (URLError, ConnectionError, TimeoutError):
            if time.monotonic() > until:
                raise RuntimeError(f"{address}: the viewer did not start") from None
            time.sleep(0.05)
