"""Snakemake in forks of a process that has imported it: importing it takes most of the time of a plan.

No module of the project is in the process that is forked: each call reads those that its environment names.
It is a program of its own: a line of its input is a call, and a line of its output how the call ended.
"""

import json
import os
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

from tests.paths import ROOT

BIN = Path(sys.executable).parent


def snakemake(arguments, cwd, env) -> subprocess.CompletedProcess[str]:
    """What the program ``snakemake`` does and says, called with these arguments, there and so."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        # The fork opens them anew, for it has none of this process's.
        files = {name: f"/proc/{os.getpid()}/fd/{file.fileno()}" for name, file in (("out", out), ("err", err))}  # fmt: skip
        call = {"arguments": arguments, "cwd": str(cwd), "env": env, **files}
        server = _server()
        server.stdin.write(json.dumps(call) + "\n")
        server.stdin.flush()
        code = int(server.stdout.readline())
        said = [file.seek(0) or file.read().decode("utf-8") for file in (out, err)]
        return subprocess.CompletedProcess(["snakemake", *arguments], code, *said)


@cache
def _server():
    """The process that is forked: one for each process of tests."""
    kept = {key: text for key, text in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    return subprocess.Popen(
        [sys.executable, "-m", __name__], cwd=ROOT, env=kept, text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip


def end() -> None:
    """End that process, if there is one."""
    if _server.cache_info().currsize:
        _server().communicate()
        _server.cache_clear()


def _become(call) -> None:
    """Be the program that was called, as far as it can tell."""
    for number, (path, flags) in enumerate(
        ((os.devnull, os.O_RDONLY), (call["out"], os.O_WRONLY), (call["err"], os.O_WRONLY))
    ):
        opened = os.open(path, flags | os.O_APPEND if number else flags)
        os.dup2(opened, number)
        os.close(opened)
    os.chdir(call["cwd"])
    os.environ.clear()
    os.environ.update(call["env"])
    first = [part for part in call["env"].get("PYTHONPATH", "").split(os.pathsep) if part]
    own = [path for path in sys.path if path not in ("", str(ROOT))]
    sys.path[:] = [str(BIN), *first, *own]
    sys.argv[:] = [str(BIN / "snakemake"), *call["arguments"]]


def main() -> None:
    """Fork for each call, until there are no more."""
    # What Snakemake imports as it goes on, too.
    import numpy
    import pydantic.root_model
    import smart_open
    import snakemake.report.html_reporter
    import snakemake_logger_plugin_rich
    import yte
    from snakemake.cli import main as program

    assert all((numpy, pydantic, smart_open, snakemake, snakemake_logger_plugin_rich, yte))
    assert not [name for name in sys.modules if name.split(".")[0] == "upswing"]
    while line := sys.stdin.readline():
        if (child := os.fork()) == 0:
            _become(json.loads(line))
            sys.exit(program())
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)


if __name__ == "__main__":
    main()
