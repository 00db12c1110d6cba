"""The command as its readers run it: in a terminal of a certain width, or in a pipe."""

import fcntl
import os
import re
import struct
import subprocess
import sys
import termios
import unicodedata
from pathlib import Path

UPSWING = Path(sys.executable).parent / "upswing"
BOXES = re.compile("[\u2500-\u257f]")
ANSI = re.compile("\x1b\\[[0-9;]*m")


def in_pipe(*words: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run ``upswing`` with its output in pipes."""
    return subprocess.run(
        [UPSWING, *map(str, words)], capture_output=True, encoding="utf-8", check=False,
        env={**os.environ, **environment},
    )  # fmt: skip


def in_terminal(columns: int, *words: object, **environment: str) -> str:
    """What ``upswing`` shows in a terminal of so many columns."""
    ours, its = os.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    inherited = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    process = subprocess.Popen(
        [UPSWING, *map(str, words)], stdout=its, stderr=its, stdin=its,
        env={**inherited, "TERM": "xterm", **environment},
    )  # fmt: skip
    os.close(its)
    shown = b""
    try:
        while piece := os.read(ours, 65_536):
            shown += piece
    except OSError:  # so Linux says that the other side is closed
        pass
    os.close(ours)
    process.wait()
    return shown.decode("utf-8").replace("\r\n", "\n")


def columns_of(line: str) -> int:
    """Number of columns that a line takes: colours and combining marks take none."""
    return sum(not unicodedata.combining(letter) for letter in ANSI.sub("", line))
