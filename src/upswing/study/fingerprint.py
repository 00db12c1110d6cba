"""What a result depends on in our own code: the modules a job reaches, and the packages that compute.

Snakemake's own code trigger sees the time stamp of a script and no imported module at all. A
fingerprint given to a job as a param does what a reader expects: an edited equation reruns what
used it, a comment or a docstring reruns nothing.
"""

import ast
import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.metadata import version
from pathlib import Path

from upswing.study.source_cache import Read, SourceCache

COMPUTING_PACKAGES = ("numpy", "numba", "llvmlite", "torch")
"""The packages whose version may change a trajectory."""


def fingerprint(*entries: str, packages: Iterable[str] = ()) -> str:
    """The fingerprint of the modules reachable from ``entries`` by import inside ``upswing``.

    Args:
        entries: dotted names of the modules a job starts from, ``"upswing.runs.train"`` for example.
        packages: distributions whose versions belong to the result.

    Returns:
        16 hexadecimal digits; equal for sources that differ in comments, docstrings or layout only.
    """
    digest = hashlib.sha256()
    for module in sorted(reachable(*entries)):
        digest.update(f"{module}\n{_read(module).digest}\n".encode())
    for package in sorted(packages):
        digest.update(f"{package}=={version(package)}\n".encode())
    CACHE.save()
    return digest.hexdigest()[:16]


def reachable(*entries: str) -> set[str]:
    """The modules of this package that the entries import, directly or not, the entries included."""
    found: set[str] = set()
    waiting = list(entries)
    while waiting:
        module = waiting.pop()
        if module not in found:
            found.add(module)
            # The name of a function or class inside a module has no source of its own.
            waiting.extend(name for name in _read(module).imports if _source(name) is not None)
            # To import a module is to import the packages it is in; the outermost says only a version.
            package = module.rpartition(".")[0]
            if "." in package:
                waiting.append(package)
    return found


PACKAGE = Path(__file__).parents[1]
CACHE = SourceCache(PACKAGE)


@cache
def _source(module: str) -> Path | None:
    """The file of a module, found without importing anything; None for any other name."""
    place = PACKAGE.joinpath(*module.split(".")[1:])
    candidates = (place / "__init__.py", place.with_suffix(".py"))
    return next((path for path in candidates if path.is_file()), None)


@cache
def _read(module: str) -> Read:
    """A checksum of a module's syntax; and what of this package it imports, modules and names."""
    path = _source(module)
    if path is None:
        raise ModuleNotFoundError(f"no source for module {module}")
    known = CACHE.get(path)
    if known is None:
        tree = _tree(path)
        digest = hashlib.sha256(ast.dump(tree).encode()).hexdigest()
        known = Read(digest, tuple(dict.fromkeys(_imported(tree))))
        CACHE.put(path, known)
    return known


def _tree(path: Path) -> ast.Module:
    """The syntax of a source without comments, docstrings, layout and what only type checkers read."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            node.body = [part for part in body if not _is_idle(part)]  # type: ignore[attr-defined]
    return tree


def _imported(tree: ast.Module) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        else:
            continue
        yield from (name for name in names if name.split(".")[0] == "upswing")


def _is_idle(node: ast.stmt) -> bool:
    """Whether a statement does nothing when the program runs."""
    if isinstance(node, ast.If):
        return isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
    # A bare string is a docstring: of a module, class, function or constant.
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )
