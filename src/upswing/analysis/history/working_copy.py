"""What git says of the checkout that this package is in; empty outside one."""

from pathlib import Path
from tempfile import TemporaryDirectory

# Training knows that module, and so its text stays as it is.
from upswing.runs.files.provenance import _git as git

MOST_OF_A_PATCH = 200_000
"""Of the difference of tracked files, as it is kept [bytes]."""


def patch() -> tuple[bytes, bool]:
    """The difference of the tracked files from the commit, and whether it is whole.

    Nothing of files that git does not know, and of binary files only that they differ.
    """
    with TemporaryDirectory() as folder:
        file = Path(folder, "patch")  # it may be in any encoding
        git("diff", "HEAD", "--no-color", "--no-ext-diff", "--no-textconv", f"--output={file}")
        found = file.read_bytes() if file.is_file() else b""
    if len(found) <= MOST_OF_A_PATCH:
        return found, True
    kept = found[:MOST_OF_A_PATCH]
    return kept[: kept.rfind(b"\n") + 1], False


def commit_of(revision: str) -> str:
    """The commit that a branch, a tag or ``HEAD~1`` stands for; empty if none does."""
    if not revision or revision.startswith("-") or not revision.isprintable():
        return ""
    return git("rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}")
