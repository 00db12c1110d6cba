"""How the inner loops are compiled, and how one listing serves several types.

Every function under ``@compiled`` also runs as plain Python with ``NUMBA_DISABLE_JIT=1``: that is
how it is debugged, and a test holds the two against each other.
"""

import atexit
import os
import shutil
import tempfile
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar

import numba
from numba.cpython.unsafe import tuple as numba_tuple
from numba.extending import overload
from platformdirs import user_cache_path

from upswing.study.fingerprint import fingerprint
from upswing.study.loading import compiled_modules

P = ParamSpec("P")
R = TypeVar("R")

config: Any = numba.config  # numba makes its settings when it is imported

OPTIONS: Any = {"error_model": "numpy", "_nrt": False}
"""Numpy's rules for division by zero; and no counting of references to arrays, which took most of a
step (an atomic operation for every array of a learner at every call). So compiled code makes no
arrays: it changes those it is given, which its Python caller holds."""


set_item: Any = numba_tuple.tuple_setitem

INLINED: Any = {**OPTIONS, "forceinline": True}
"""Calls cost most of a step otherwise: a learner is a hundred words, handed over by copying."""


def _choose_cache_directory() -> None:
    """Key numba's cache by what the compiled code is.

    Numba looks only at the file that holds the outermost function: after an edit in ``pendulum.py``
    a cached loop would go on with the old pendulum.
    """
    if os.environ.get("NUMBA_CACHE_DIR") or config.DISABLE_JIT:
        return
    key = fingerprint(*compiled_modules(), packages=("numba", "numpy"))
    directory = user_cache_path("upswing") / "compiled" / key
    if not _writable(directory):
        # No home, or a read-only one: what is compiled lasts as long as this process.
        directory = Path(tempfile.mkdtemp(prefix="upswing-"))
        atexit.register(shutil.rmtree, directory, ignore_errors=True)
    config.CACHE_DIR = str(directory)


def _writable(directory: Path) -> bool:
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(directory, os.W_OK)


_choose_cache_directory()


def inlined(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function`` into each place that calls it."""
    return numba.njit(cache=True, **INLINED)(function)  # type: ignore[no-any-return]


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function`` to machine code, kept on disk between processes.

    Strict IEEE arithmetic: no fast-math.
    """
    return numba.njit(cache=True, **OPTIONS)(function)  # type: ignore[no-any-return]


class ByType(Generic[P, R]):
    """A function whose body is chosen by the class of its first argument.

    Compiled code chooses while compiling, so that it costs nothing; plain Python looks the class up.
    A class without a body of its own has that of the declaration.
    """

    def __init__(self, declaration: Callable[P, R]) -> None:
        self.bodies: dict[type, Callable[..., R]] = {}
        bodies = self.bodies

        @wraps(declaration)
        def call(first: Any, *rest: Any) -> R:
            return bodies.get(type(first), declaration)(first, *rest)

        def choose(*types: Any) -> Callable[..., R]:
            return bodies.get(getattr(types[0], "instance_class", type(None)), declaration)

        overload(call, strict=False, jit_options=INLINED)(choose)
        self.call = call

    def register(self, kind: type) -> Callable[[Callable[..., R]], Callable[..., R]]:
        """Make the decorated function the body for first arguments of class ``kind``."""

        def remember(body: Callable[..., R]) -> Callable[..., R]:
            self.bodies[kind] = body
            return body

        return remember


def _with_item(values: tuple[float, ...], index: int, value: float) -> tuple[float, ...]:
    """The same numbers but for that at ``index``."""
    return (*values[:index], value, *values[index + 1 :])


@overload(_with_item, strict=False, jit_options=INLINED)
def _compiled_with_item(*_: Any) -> Any:
    return lambda values, index, value: set_item(values, index, value)


with_item = _with_item
"""``values`` with another number at ``index``: how compiled code fills a tuple of a given length."""
