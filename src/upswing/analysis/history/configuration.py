"""How configurations differ, key by key: any number of them, side by side."""

import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

ABSENT = "–"
"""What stands for a key that a configuration does not have."""

LONGEST = 160
"""Of a value that is shown [characters]."""

BY_CONTENT = "experiments"
"""The list whose elements are known by what they are about: one put in between changes no other."""


class Difference(NamedTuple):
    """A key that is not the same everywhere."""

    key: str  # dotted: claims.C3.parts[0].at_least
    values: tuple[str, ...]  # one for each configuration; ``ABSENT`` where it has none


class _Missing:
    """The value of a key that is not there: None is a value."""


MISSING = _Missing()


def differences(configurations: Sequence[Mapping[str, Any]]) -> list[Difference]:
    """Every key whose value is not the same in all configurations, in the order in which they stand.

    Args:
        configurations: plain values, as in JSON.
    """
    return list(_differ("", list(configurations)))


def _differ(key: str, values: list[Any]) -> Iterator[Difference]:
    if all(value == values[0] for value in values[1:]):
        return
    there = [value for value in values if value is not MISSING]
    if len(there) == len(values) and all(isinstance(value, Mapping) for value in values):
        for name in _union(values):
            yield from _differ(
                f"{key}.{name}" if key else name, [value.get(name, MISSING) for value in values]
            )
    elif len(there) == len(values) and all(_of_mappings(value) for value in values):
        of = _experiments if key == BY_CONTENT else _by_place
        labels, aligned = of(values)
        for label, elements in zip(labels, aligned, strict=True):
            yield from _differ(f"{key}[{label}]", elements)
        if of is _experiments:
            yield from _order(key, values, aligned)
    else:
        yield Difference(key, tuple(text_of(value) for value in values))


def _union(mappings: Sequence[Mapping[str, Any]]) -> list[str]:
    return list(dict.fromkeys(name for mapping in mappings for name in mapping))


def _of_mappings(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(one, Mapping) for one in value)


def _by_place(lists: list[list[Any]]) -> tuple[list[str], list[list[Any]]]:
    longest = max(map(len, lists))
    aligned = [[own[at] if at < len(own) else MISSING for own in lists] for at in range(longest)]
    return [str(at) for at in range(longest)], aligned


def _experiments(lists: list[list[Any]]) -> tuple[list[str], list[list[Any]]]:
    """Experiments about the same stand beside each other, wherever they are in their lists."""
    rows: list[list[Any]] = []
    for side, own in enumerate(lists):
        left = list(own)
        for alike in (_about, _nearly, _of_tasks):
            for one in tuple(left):
                row = next(
                    (row for row in rows if row[side] is MISSING and alike(_first(row), one)), None
                )
                if row is not None:
                    row[side] = one
                    left.remove(one)
        for one in left:
            rows.append([MISSING] * len(lists))
            rows[-1][side] = one
    labels: list[str] = []
    for row in rows:
        one = _first(row)
        label = f"{', '.join(one.get('tasks', ()))}: {', '.join(one.get('architectures', ()))}"
        labels.append(f"{label} #{labels.count(label) + 1}" if label in labels else label)
    return labels, rows


def _first(row: list[Any]) -> Mapping[str, Any]:
    found: Mapping[str, Any] = next(value for value in row if value is not MISSING)
    return found


def _about(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Whether they have the same tasks and architectures, and share a step size (or have none)."""
    same = all(one.get(key) == other.get(key) for key in ("tasks", "architectures"))
    alphas, others = (set(each.get("alphas") or ()) for each in (one, other))
    return same and (alphas == others or bool(alphas & others))


def _nearly(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    return all(one.get(key) == other.get(key) for key in ("tasks", "architectures"))


def _of_tasks(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Whether they share a task and an architecture."""
    return all(
        bool(set(one.get(key) or ()) & set(other.get(key) or ()))
        for key in ("tasks", "architectures")
    )


def _order(key: str, lists: list[list[Any]], aligned: list[list[Any]]) -> Iterator[Difference]:
    """A line if the experiments that all have do not stand in the same order."""
    common = [row for row in aligned if MISSING not in row]
    places = [[own.index(row[side]) for row in common] for side, own in enumerate(lists)]
    if not all(a < b for own in places for a, b in pairwise(own)):
        words = tuple(
            "the first order" if own == sorted(own) else "another order" for own in places
        )
        yield Difference(f"{key} (their order)", words)


def text_of(value: Any) -> str:
    """A value in a line; seeds are written short, and of a mapping only what it says."""
    if value is MISSING:
        return ABSENT
    if isinstance(value, list) and len(value) > 3 and all(type(one) is int for one in value):
        ranges = _ranges(value)
        if len(ranges) < len(value):
            return f"{', '.join(ranges)} ({len(value)})"
    if isinstance(value, Mapping):
        said = {name: one for name, one in value.items() if _says_something(one)}
        text = ", ".join(f"{name}: {text_of(one)}" for name, one in said.items())
        text = f"{{{text}}}"
    elif isinstance(value, list):
        text = f"[{', '.join(map(text_of, value))}]"
    elif isinstance(value, float):
        text = f"{value:.12g}"
    elif isinstance(value, str):
        text = value or "(empty)"
    else:
        text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def _says_something(value: Any) -> bool:
    empty = isinstance(value, str | list | Mapping) and not value
    return not (value is None or value is False or empty)


def _ranges(numbers: Sequence[int]) -> list[str]:
    """Whole numbers in words: ``10000 to 10049``, or each alone."""
    texts: list[str] = []
    first = last = numbers[0]
    for number in (*numbers[1:], None):
        if number is not None and number == last + 1:
            last = number
            continue
        texts.append(f"{first}" if first == last else f"{first} to {last}")
        if number is not None:
            first = last = number
    return texts
