"""The JSON schema of a study, for editors: each part's options where that part is chosen."""

from collections.abc import Iterator
from typing import Any

from upswing.study.architecture import ARCHITECTURES
from upswing.study.config import ADOPTED, Study
from upswing.study.declared import Family, own_options
from upswing.study.loading import parts
from upswing.study.task import TASKS

FAMILIES: dict[str, Family[Any]] = {"ShownArchitecture": ARCHITECTURES, "Task": TASKS}
"""The definitions whose keys depend on what is chosen."""


def schema() -> dict[str, Any]:
    """The schema; ``config/schema.json`` is this."""
    described = Study.model_json_schema()
    for name, family in FAMILIES.items():
        definition = described["$defs"][name]
        # Keys that a condition below allows are known too.
        del definition["additionalProperties"]
        definition["unevaluatedProperties"] = False
        for key in family.choices:
            known = definition["properties"][key]
            known["enum"] = [part for part in known["enum"] if part != ADOPTED]
        conditions = [_condition(family, *option) for option in _options(family)]
        if conditions:
            definition["allOf"] = conditions
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **described}


def sections_of_options() -> Iterator[tuple[str, dict[str, Any]]]:
    """A title and a schema for each part that has options of its own."""
    for family in FAMILIES.values():
        for key, part, options in _options(family):
            yield f"Options of `{key}: {part}`", options


def _options(family: Family[Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """The choosing key, the part's name and the schema of its own options, of each that has any."""
    for key, kind in family.choices.items():
        for part in (part for part in parts(kind) if part != ADOPTED):
            model = family.options(key, part)
            own = own_options(model, family.base)
            if own:
                whole = model.model_json_schema()
                yield (
                    key,
                    part,
                    {
                        "properties": {name: whole["properties"][name] for name in own},
                        "required": [name for name in whole.get("required", []) if name in own],
                    },
                )


def _condition(family: Family[Any], key: str, part: str, options: dict[str, Any]) -> dict[str, Any]:
    """If the part is chosen, its options are allowed, and those without a default needed."""
    chosen: dict[str, Any] = {"properties": {key: {"const": part}}}
    if family.base.model_fields[key].default != part:  # else it is chosen by saying nothing, too
        chosen["required"] = [key]
    return {"if": chosen, "then": options}
