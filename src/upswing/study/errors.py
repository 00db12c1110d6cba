"""Bad input as one message: file, key, value, what would be right, and a near name for a typo."""

import json
from collections.abc import Callable, Iterable, Sequence
from difflib import get_close_matches
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel, RootModel, ValidationError
from pydantic_core import ErrorDetails

EXPECTED = {
    "tuple_type": "must be a list: [a, b]",
    "list_type": "must be a list: [a, b]",
    "string_type": "must be text",
    "int_type": "must be a whole number",
    "int_from_float": "must be a whole number",
    "float_type": "must be a number",
    "bool_type": "must be true or false",
    "dict_type": "must hold keys and values",
    "model_type": "must hold keys and values",
    "model_attributes_type": "must hold keys and values",
    "finite_number": "must be a finite number",
}
"""What would be right, in a reader's words rather than Python's."""

Place = tuple[int | str, ...]

MOST_SHOWN = 100
"""Largest number of problems that are printed: 10,000 wrong seeds need not be read one by one."""

LONGEST = 60
"""Of a value that is shown [characters]."""


class BadInput(ValueError):
    """Input that cannot be used; its text says all that is wrong with it."""

    def __init__(self, problems: Sequence[str]) -> None:
        self.problems = list(problems)
        count = "1 problem" if len(self.problems) == 1 else f"{len(self.problems)} problems"
        lines = [f"  {problem}" for problem in self.problems[:MOST_SHOWN]]
        if more := len(self.problems) - len(lines):
            lines.append(f"  … and {more} more")
        super().__init__("\n".join([f"{count}:", *lines]))


def explained(
    model: type[BaseModel], error: ValidationError, source_of: Callable[..., str]
) -> list[str]:
    """One line for each problem of ``error`` with input for ``model``.

    ``source_of`` names the file that a key is from, by its place: the top-level key first.
    """
    return [
        _explain(source_of(*map(str, details["loc"])), model, details) for details in error.errors()
    ]


def problem(source: str, key: str, value: Any, right: str) -> str:
    """The line for one problem."""
    return f"{source}: {key or '(top level)'}: {shown(value)}: {right}"


def near(name: object, known: Iterable[str]) -> str:
    """A hint at the known name that ``name`` may have meant, or what there is."""
    names = sorted(known)
    close = get_close_matches(str(name), names, n=1)
    return f"did you mean {close[0]!r}?" if close else f"there are {', '.join(names)}"


def shown(value: Any) -> str:
    """A value as a reader would recognise it, at most ``LONGEST`` characters.

    It is written piece by piece and no further: aliases in YAML make a few lines a value without end.
    """
    text = ""
    try:
        for piece in json.JSONEncoder(ensure_ascii=False, default=str).iterencode(value):
            text += piece
            if len(text) > LONGEST:
                break
    except (TypeError, ValueError):  # a key that is no text, or a value that holds itself
        text = text or str(type(value).__name__)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def key_of(place: Place) -> str:
    """``("experiments", 0, "alphas")`` as ``experiments[0].alphas``."""
    text = ""
    for part in place:
        text += f"[{part}]" if isinstance(part, int) else f".{_readable(part)}"
    return text.removeprefix(".")


def _readable(key: str) -> str:
    """A key on one line, and not endless, whatever was written."""
    text = key if key.isprintable() and key else repr(key)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _explain(source: str, model: type[BaseModel], details: ErrorDetails) -> str:
    place, value = details["loc"], details["input"]
    if place and place[-1] == "[key]":  # a name in a mapping, which is the value too
        place = place[:-1]
    match details["type"]:
        case "extra_forbidden":
            known = _fields_at(model, place[:-1])
            return f"{source}: {key_of(place)}: unknown key: {near(place[-1], known)}"
        case "unknown_option":
            return f"{source}: {key_of(place)}: {details['msg']}"
        case "missing":
            return f"{source}: {key_of(place)}: missing"
        case "literal_error":
            choices = details["ctx"]["expected"]
            names = [name.strip("'") for name in choices.replace(" or ", ", ").split(", ")]
            hint = get_close_matches(str(value), names, n=1)
            suggestion = f"; did you mean {hint[0]!r}?" if hint else ""
            return problem(source, key_of(place), value, f"must be {choices}{suggestion}")
        case "float_type" | "int_type" if _is_number(value):
            right = f"this is text, not a number; write {float(value):.12g}"
            return problem(source, key_of(place), value, right)
        case "value_error":
            return problem(source, key_of(place), value, str(details["ctx"]["error"]))
        case "too_short":
            least = details["ctx"]["min_length"]
            return problem(source, key_of(place), value, f"must have at least {least}")
    said = EXPECTED.get(details["type"]) or _lower_first(details["msg"])
    return problem(source, key_of(place), value, said.replace("input should", "must"))


def _fields_at(model: type[BaseModel], place: Place) -> list[str]:
    """The keys that ``model`` knows at ``place``."""
    current: Any = model
    if issubclass(model, RootModel):
        current = model.model_fields["root"].annotation
    for part in place:
        current = _bare(current)
        if isinstance(current, type) and issubclass(current, BaseModel):
            field = current.model_fields.get(str(part))
            current = field.annotation if field else None
        else:  # a list or a mapping: its elements are of the last type argument
            current = next((a for a in reversed(get_args(current)) if a is not Ellipsis), None)
    current = _bare(current)
    if isinstance(current, type) and issubclass(current, BaseModel):
        return list(current.model_fields)
    return []


def _bare(annotation: Any) -> Any:
    """A type without what else is said of it."""
    while get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    return annotation


def _is_number(value: Any) -> bool:
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return isinstance(value, str)


def _lower_first(text: str) -> str:
    return text[:1].lower() + text[1:]
