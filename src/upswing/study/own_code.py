"""The code of a figure's own file, as the jobs of the workflow depend on it."""

import ast
import hashlib
from functools import cached_property
from pathlib import Path

from upswing.study.code import Code

# These are not public there: every training job depends on that file, which must not change for a name.
from upswing.study.fingerprint import _imported, _tree, reachable


class OwnCode:
    """The code of a job that runs a file from beside a configuration.

    Args:
        file: the file.
        entries: the modules of this package that the job starts from.
        packages: distributions whose versions belong to its result.
    """

    def __init__(self, file: Path, entries: tuple[str, ...], packages: tuple[str, ...]) -> None:
        self.file, self.entries, self.packages = file, entries, packages

    @cached_property
    def _syntax(self) -> ast.Module | None:
        """Without comments, docstrings and layout; None of a file that cannot be read as Python."""
        try:
            return _tree(self.file)
        except (OSError, SyntaxError, ValueError):
            return None

    @cached_property
    def code(self) -> Code:
        """The modules of this package that the job imports, by the file too."""
        imported = [] if self._syntax is None else list(_imported(self._syntax))
        known = []
        for name in dict.fromkeys(imported):
            try:
                reachable(name)
            except ModuleNotFoundError:  # a name inside a module, which stands there too
                continue
            known.append(name)
        return Code((*self.entries, *known), self.packages)

    @property
    def modules(self) -> set[str]:
        """Every module of this package that it may import."""
        return self.code.modules

    @property
    def fingerprint(self) -> str:
        """16 hexadecimal digits that change with the meaning of the file, and of what it imports."""
        own = "" if self._syntax is None else ast.dump(self._syntax)
        return hashlib.sha256(f"{self.code.fingerprint}\n{own}".encode()).hexdigest()[:16]
