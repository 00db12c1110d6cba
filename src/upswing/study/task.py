"""A task of §4.3 as it is configured, and what its kind says of how it is judged and drawn.

A kind of task is a file of ``physics/tasks``; what it says of itself stands in its class ``Options``.
"""

from collections.abc import Mapping
from math import pi
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, SerializeAsAny

from upswing.study.declared import Family, part_name, part_schema
from upswing.study.names import Name
from upswing.study.physical import (
    THESIS_TIME_STEP,
    PendulumOptions,
    StartOptions,
    TileOptions,
    TrackOptions,
)
from upswing.study.values import NotNegative, Steps, Strict


class Task(Strict):
    """A task of §4.3 and how long a run of it is.

    What is said here of a kind of task holds for one that says nothing else: it is judged by the share
    of steps upright, tried out from all around, and drawn over a whole turn.
    """

    kind: Annotated[str, part_name("tasks"), part_schema("tasks")] = Field(
        description="balancing: reset beyond 90°; full-control: any start, never reset."
    )
    steps: Steps = Field(description="Number of time steps in one run, of 5 ms in the thesis.")
    pendulum: PendulumOptions = Field(
        default=PendulumOptions(), description="What moves, where it is not the thesis's."
    )
    track: TrackOptions = Field(default=TrackOptions(), description="The ends of the cart's track.")
    start: StartOptions = Field(default=StartOptions(), description="Where a run starts.")
    tiles: TileOptions = Field(
        default=TileOptions(), description="How the state is cut, where it is not as in the thesis."
    )
    velocity_weight: NotNegative = Field(
        default=0.0, description="Beyond the thesis: −w·φ̇² is added to what is learned from [s²]."
    )
    shaping: NotNegative = Field(
        default=0.0,
        description="Beyond the thesis: the height of a potential of energy [rad²].",
    )

    judged_by: ClassVar[Literal["falls", "upright"]] = "upright"
    """Whether a run succeeds without a fall, or upright, for most of what is judged."""

    order_of_runs: ClassVar[Mapping[str, bool]] = {
        "upright_share": True, "mean_reward": True, "seed": True,
    }  # fmt: skip
    """Measures that order runs, the worst first, and whether they ascend; later ones break ties."""

    greedy_starts: ClassVar[tuple[float, ...]] = tuple(i * (2 * pi / 16) - pi for i in range(16))
    """Angles from which a policy is tried out, at rest [rad]."""

    greedy_steps: ClassVar[int] = 4_000
    """Number of steps of 5 ms for which a policy is followed from each start: 20 s."""

    greedy_judged: ClassVar[int] = 1_000
    """Number of these steps, the last ones, that are judged: 5 s."""

    angle_limit: ClassVar[int] = 180
    """Largest |φ| that a figure shows [°]."""

    first_measures: ClassVar[tuple[str, ...]] = ("upright_share", "above_horizontal_share", "falls")
    """Measures that a table of runs shows first; it is sorted by the first of them, the best first."""

    def steps_of(self, steps: int) -> int:
        """So many steps of the thesis, 5 ms each, in steps of this task: the same time."""
        return max(1, round(steps * THESIS_TIME_STEP / self.pendulum.time_step))


class NamedTask(Task):
    """A task and the name it has in the study."""

    name: Name


TASKS = Family(Task, {"kind": "tasks"})
AnyTask = Annotated[SerializeAsAny[Task], TASKS.chooser(Task)]
AnyNamedTask = Annotated[SerializeAsAny[NamedTask], TASKS.chooser(NamedTask)]


def kind_of_task(kind: str) -> type[Task]:
    """What a kind of task says of itself."""
    return TASKS.options("kind", kind)


def task_named(name: str, **keys: Any) -> NamedTask:
    """A task with a name, and the options of its kind."""
    return TASKS.make(NamedTask, {"name": name, **keys})
