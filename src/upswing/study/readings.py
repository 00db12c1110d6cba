"""The readings R1–R15: one meaning each for what the thesis leaves open or says in two ways."""

from collections.abc import Callable, Iterable
from functools import cache
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, WithJsonSchema

TABLE, NETWORKS = "table", "networks"
LEARNERS = (TABLE, NETWORKS)
EVERYONE = (*LEARNERS, "control")
KINDS = ("balancing", "full-control")


def _reading(
    number: int,
    default: Any,
    question: str,
    touches: Iterable[str] = EVERYONE,
    only: str | None = None,
) -> Any:
    """A reading: its number, its question, and which learners and tasks it can touch at all."""
    extra: dict[str, Any] = {"reading": f"R{number}", "touches": list(touches), "only": only}
    return Field(default=default, description=f"R{number}: {question}", json_schema_extra=extra)


def _check(options: tuple[float, ...]) -> Callable[[float], float]:
    def check(value: float) -> float:
        if value not in options:
            raise ValueError(f"must be one of {', '.join(f'{option:g}' for option in options)}")
        return value

    return check


WEIGHTS = (1, 0.5, 0.1)
RATES = (0.03, 0.05, 0.07, 0.1, 0.11, 0.12, 0.13, 0.15, 0.2, 0.3, 0.5, 1)
InitialWeights = Annotated[
    float, AfterValidator(_check(WEIGHTS)), WithJsonSchema({"enum": list(WEIGHTS)})
]
LearningRate = Annotated[
    float, AfterValidator(_check(RATES)), WithJsonSchema({"enum": list(RATES)})
]


class Readings(BaseModel):
    """One meaning for every open question.

    The rule in ``analysis/robustness/selection.py`` selected the defaults of R3 and R10–R12.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    zero_of_angle: Literal["upright", "hanging"] = _reading(
        1, "upright", "from where is φ measured? Eq. 13 says hanging, §4.4–4.5 say upright."
    )
    angle_unit: Literal["half_turn", "radians"] = _reading(
        2, "half_turn", "what is the π of §4.5–4.6: 90° (half_turn) or π rad?", LEARNERS
    )
    reward_unit: Literal["half_turn", "radians", "degrees"] = _reading(
        3, "half_turn", "the unit of −φ²: half_turn (π stands for 90°, so 4 × rad²), …", LEARNERS
    )
    wrap: Literal["wrapped", "unbounded"] = _reading(
        4, "wrapped", "full control: is φ kept within one turn?", only="full-control"
    )
    first_q: Literal["zero", "pessimistic", "random"] = _reading(
        5, "zero", "the first Q of a table; zero is optimistic, every reward being ≤ 0.", (TABLE,)
    )
    ties: Literal["random", "first"] = _reading(
        6, "random", "the greedy action among equals.", LEARNERS
    )
    reset: Literal["fallen", "terminal", "reset"] = _reading(
        7,
        "fallen",
        "s′ of a fall: the fallen state, the same without bootstrap, or the new start.",
        LEARNERS,
        only="balancing",
    )
    start_velocity: Literal["zero", "random"] = _reading(
        8, "zero", "φ̇ at a start: zero, or uniform in ±2 rad/s."
    )
    reward_state: Literal["next", "current"] = _reading(9, "next", "is r that of s′ or of s?")
    biases: Literal["none", "hidden", "both"] = _reading(
        10, "none", "which neurons of a network have a bias?", (NETWORKS,)
    )
    initial_weights: InitialWeights = _reading(
        11, 0.5, "the first weights are uniform in ± this.", (NETWORKS,)
    )
    learning_rate: LearningRate = _reading(
        12, 0.13, "backpropagation's own rate η, beside the α of the update rule.", (NETWORKS,)
    )
    error_sign: Literal["corrected", "printed"] = _reading(
        13, "corrected", "E = Q − (r + γ max Q′), or Q − r + γ max Q′ as printed.", (NETWORKS,)
    )
    hand_over: Literal["owner", "own", "terminal"] = _reading(
        14,
        "owner",
        "max Q(s′) when s′ is another module's: that module's value, the value of the module's own "
        "next state, or nothing.",
        LEARNERS,
        only="modular",
    )
    velocity_overflow: Literal["clip"] = _reading(
        15, "clip", "φ̇ beyond ±20 rad/s: the edge tile serves.", LEARNERS
    )

    def touching(self, learner: str, kind: str, modular: bool) -> dict[str, Any]:
        """Those readings that can change a run of this learner on this kind of task.

        Only they belong to a run's specification, so that a reading of the networks does not
        rerun a table. A learner or a kind of task beyond the
        thesis may be touched by any of them.
        """
        circumstances = {None, kind, "modular" if modular else "single"}
        return {
            name: getattr(self, name)
            for name, field in type(self).model_fields.items()
            if isinstance(extra := field.json_schema_extra, dict)
            and (learner in (extra["touches"] or ()) or learner not in EVERYONE)  # type: ignore[operator]
            and (extra["only"] in circumstances or (kind not in KINDS and extra["only"] in KINDS))
        }


def options_of(reading: str) -> list[Any]:
    """The options of a reading, the ledger's default first."""
    return list(_options()[reading])


@cache
def _options() -> dict[str, tuple[Any, ...]]:
    return {
        name: tuple(field["enum"]) if "enum" in field else (field["const"],)
        for name, field in Readings.model_json_schema()["properties"].items()
    }
