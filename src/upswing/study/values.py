"""The kinds of value that configurations are made of: strict models, seeds, steps, shares, lists."""

from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema

from upswing.study.errors import shown

T = TypeVar("T")

LARGEST_SEED = 2**32 - 1
LONGEST_RUN = 100_000_000
MOST_RUNS = 10_000
"""Largest number of runs of a study: Snakemake plans them in 4 to 6 s, even in one cell."""


class Strict(BaseModel):
    """A frozen value without unknown keys and without conversions."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


def _no_value_twice(values: tuple[T, ...]) -> tuple[T, ...]:
    seen = set[T]()
    for value in values:
        if value in seen:
            raise ValueError(f"{shown(value)} stands there twice")
        seen.add(value)
    return values


def listed(value: Any) -> Any:
    """Lists become tuples before strict validation, which takes no list for a tuple."""
    return tuple(value) if isinstance(value, list) else value


def _counted(value: Any) -> Any:
    if isinstance(value, dict):
        return _counted_from(value)
    if isinstance(value, int) and not isinstance(value, bool):
        if value < 1:
            raise ValueError("write how many seeds there are, 1 or more, or list them")
        if value > MOST_RUNS:
            raise ValueError(f"a study has at most {MOST_RUNS:,} runs")
        return tuple(range(value))
    return listed(value)


def _counted_from(value: dict[str, Any]) -> tuple[int, ...]:
    first, count = value.get("first"), value.get("count")
    if set(value) != {"first", "count"} or type(first) is not int or type(count) is not int:
        raise ValueError("write {first: 10000, count: 30}")
    if first < 0 or not 1 <= count <= MOST_RUNS or first + count - 1 > LARGEST_SEED:
        raise ValueError(
            f"seeds lie between 0 and {LARGEST_SEED}, and a study has at most {MOST_RUNS:,} runs"
        )
    return tuple(range(first, first + count))


once = AfterValidator(_no_value_twice)
"""A list in which nothing stands twice."""

Steps = Annotated[int, Field(ge=1, le=LONGEST_RUN)]
Count = Annotated[int, Field(ge=1, le=10_000_000)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
Discount = Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)]
LayerSizes = Annotated[
    tuple[Annotated[int, Field(ge=1, le=1000)], ...], BeforeValidator(listed), Field(max_length=2)
]
"""Numbers of units of a network's hidden layers, input side first."""

Seed = Annotated[int, Field(ge=0, le=LARGEST_SEED)]
Seeds = Annotated[
    tuple[Seed, ...],
    Field(min_length=1),
    BeforeValidator(_counted),
    once,
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "integer", "minimum": 1},
                {
                    "type": "object",
                    "properties": {
                        "first": {"type": "integer", "minimum": 0, "maximum": LARGEST_SEED},
                        "count": {"type": "integer", "minimum": 1, "maximum": MOST_RUNS},
                    },
                    "required": ["first", "count"],
                    "additionalProperties": False,
                },
                {
                    "type": "array",
                    "items": {"type": "integer", "minimum": 0, "maximum": LARGEST_SEED},
                    "minItems": 1,
                    "uniqueItems": True,
                },
            ]
        }
    ),
]
