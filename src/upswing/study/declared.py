"""What a part says of itself: the class ``Options`` in its own file, read without importing the file.

A learner may want torch and a feature encoder numba, and neither is needed to check a configuration. So
only the class is run, with what the file imports from ``LIGHT``; it may use nothing else.
"""

import ast
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from functools import cache
from typing import Any, Generic, TypeVar

from pydantic import (
    AfterValidator,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WithJsonSchema,
    WrapValidator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError

from upswing.study.errors import near
from upswing.study.loading import module_of, parts, source_of
from upswing.study.values import Strict

S = TypeVar("S", bound=Strict)
N = TypeVar("N", bound=Strict)

LIGHT = ("collections.abc", "math", "pydantic", "typing", "upswing.study")
"""The modules, and packages, that a class ``Options`` may use."""


def part_name(kind: str) -> AfterValidator:
    """A validator of the names of a kind of parts, which are the names of their files."""

    def known(name: str) -> str:
        if name not in (there := parts(kind)):
            *others, last = [repr(one) for one in there]
            hint = get_close_matches(name, there, n=1)
            suggestion = f"; did you mean {hint[0]!r}?" if hint else ""
            raise ValueError(f"must be {', '.join(others)} or {last}{suggestion}")
        return name

    return AfterValidator(known)


def part_schema(kind: str) -> WithJsonSchema:
    """The JSON schema of such a name."""
    return WithJsonSchema({"type": "string", "enum": parts(kind)})


@cache
def declared(kind: str, name: str, base: type[S]) -> type[S]:
    """The options of a part: its class ``Options``, or ``base`` where it has none.

    Raises:
        ValueError: the class cannot be run, or is no subclass of ``base``.
    """
    path = source_of(kind, name)
    try:
        statements = ast.parse(path.read_text("utf-8")).body
        body = [node for node in statements if _is_light(node) or _is_options(node)]
        namespace: dict[str, Any] = {"__name__": f"{module_of(kind, name)}.options"}
        # This is our own source, which `import` would run as well.
        exec(compile(ast.Module(body, []), str(path), "exec"), namespace)  # noqa: S102
    except Exception as error:  # noqa: BLE001 - whatever a class body may raise
        said = str(error).splitlines()[0]
        allowed = ", ".join(LIGHT)
        raise ValueError(
            f"{path}: Options: {said}; it may use only what comes from {allowed}"
        ) from None
    options = namespace.get("Options", base)
    if not (isinstance(options, type) and issubclass(options, base)):
        raise ValueError(f"{path}: Options: must be a class Options({base.__name__})")
    return options


def _is_light(node: ast.stmt) -> bool:
    if isinstance(node, ast.ImportFrom):
        module = node.module or ""
        return node.level == 0 and any(f"{module}.".startswith(f"{name}.") for name in LIGHT)
    return isinstance(node, ast.Import) and all(alias.name in LIGHT for alias in node.names)


def _is_options(node: ast.stmt) -> bool:
    return isinstance(node, ast.ClassDef) and node.name == "Options"


class Family(Generic[S]):
    """Values whose keys depend on the parts that some of the keys choose: a discriminated union.

    Args:
        base: the keys that all of them have.
        choices: the kind of part that each choosing key names: ``{"learner": "learners", …}``.
    """

    def __init__(self, base: type[S], choices: Mapping[str, str]) -> None:
        self.base, self.choices = base, choices

    def options(self, key: str, name: str) -> type[S]:
        """What the part says of itself that ``key`` chooses by ``name``."""
        return declared(self.choices[key], name, self.base)

    def make(self, named: type[N], values: Mapping[str, Any]) -> N:
        """``values`` with the options of the parts that they choose, as a ``named`` value."""
        chosen = [self.options(key, values.get(key, self._default(key))) for key in self.choices]
        model: type[N] = united(named, *dict.fromkeys(chosen))
        try:
            return model.model_validate(values)
        except ValidationError as error:
            lines = list(self._explained(error, model))
            raise ValidationError.from_exception_data(error.title, lines) from None

    def chooser(self, named: type[Strict]) -> WrapValidator:
        """A validator that makes a ``named`` value."""

        def choose(value: Any, as_it_is: ValidatorFunctionWrapHandler) -> Any:
            if not isinstance(value, dict) or not self._names_parts(value):
                return as_it_is(value)  # which says what is wrong with it
            return self.make(named, value)

        return WrapValidator(choose)

    def owners(self, option: str) -> list[str]:
        """The parts that an option belongs to, as they are written in a configuration."""
        return [
            f"`{key}: {name}`"
            for key, kind in self.choices.items()
            for name in parts(kind)
            if option in own_options(self.options(key, name), self.base)
        ]

    def _default(self, key: str) -> Any:
        return self.base.model_fields[key].default

    def _names_parts(self, value: Mapping[str, Any]) -> bool:
        return all(
            value.get(key, self._default(key)) in parts(kind) for key, kind in self.choices.items()
        )

    def _explained(self, error: ValidationError, model: type[Strict]) -> Iterator[InitErrorDetails]:
        """The same problems; of an unknown key it is said whose option it is."""
        for details in error.errors(include_url=False):
            problem: Any = details["type"]
            place = details["loc"]
            if problem == "extra_forbidden" and len(place) == 1:
                of = self.owners(str(place[0]))
                hint = f"goes with {' or '.join(of)}" if of else near(place[0], model.model_fields)
                problem = PydanticCustomError(
                    "unknown_option", "unknown key: {hint}", {"hint": hint}
                )
            yield InitErrorDetails(
                type=problem, loc=place, input=details["input"], ctx=details.get("ctx", {})
            )


@cache
def united(named: type[N], *options: type[Strict]) -> type[N]:
    """A class ``named`` with all of ``options``."""
    bases = dict.fromkeys([named, *options])
    # A class cannot stand before one that is made from it.
    own = [
        one
        for one in bases
        if not any(issubclass(other, one) for other in bases if other is not one)
    ]
    content = {"__module__": named.__module__, "__doc__": named.__doc__}
    return type(named.__name__, tuple(own), content)


def own_options(options: type[Strict], base: type[Strict]) -> list[str]:
    """The keys that a part adds to those of all."""
    return [key for key in options.model_fields if key not in base.model_fields]
