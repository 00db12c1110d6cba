"""What git says of the checkout that this package is in; empty outside one."""

import subprocess
from pathlib import Path

MOST_OF_A_PATCH = 200_000
"""Of the difference of tracked files, as it is kept [bytes]."""


def patch() -> tuple[bytes, bool]:
    """The difference of the tracked files from the commit, and whether it is whole.

    Nothing of files that git does not know, and of binary files only that they differ.
    """
    command = [*_git(), "diff", "HEAD", "--no-color", "--no-ext-diff", "--no-textconv"]
    try:
        with subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL
        ) as git:
            assert git.stdout is not None  # noqa: S101  it is a pipe
            found = git.stdout.read(MOST_OF_A_PATCH + 1)
            git.kill()  # what is longer is not waited for
    except OSError:
        return b"", True
    if len(found) <= MOST_OF_A_PATCH:
        return found, True
    kept = found[:MOST_OF_A_PATCH]
    return kept[: kept.rfind(b"\n") + 1], False


def commit_of(revision: str) -> str:
    """The commit that a branch, a tag or ``HEAD~1`` stands for; empty if none does."""
    if not revision or revision.startswith("-"):
        return ""
    command = [*_git(), "rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}"]
    try:
        answer = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, ValueError, subprocess.CalledProcessError):
        return ""
    return answer.stdout.strip()


def _git() -> list[str]:
    here = Path(__file__).resolve().parent
    # Without its optional lock: a job that is killed must not leave one in the repository.
    return ["git", "--no-optional-locks", "-C", str(here)]
