"""The pendulums of a study, as the page shows them: one for all of its tasks, or a table of them."""

from collections.abc import Sequence
from math import degrees
from pathlib import Path
from typing import Any, NamedTuple

from markupsafe import Markup

from upswing.agents.features.grid import tiles_for
from upswing.figures.lengths import end_of, in_steps
from upswing.figures.phases import held
from upswing.physics import tasks as kinds
from upswing.physics.actions import listed, pushes, signed
from upswing.physics.braking import highest_stoppable_speed
from upswing.physics.pendulum import Pendulum, ThesisActions, body_of
from upswing.runs.metrics import STABLE_STEPS
from upswing.study.config import Study, narrowed, pendulum_of_bound
from upswing.study.physical import PendulumOptions, StartOptions, TileOptions, TrackOptions

THESIS = PendulumOptions(), TrackOptions()

NUMBERS = {2: "two", 3: "three", 4: "four", 5: "five", 6: "six", 7: "seven", 8: "eight", 9: "nine"}
LEFT_RIGHT_AND_NONE = 3


class Shown(NamedTuple):
    """A pendulum of a study, on its track."""

    tasks: list[str]
    body: Pendulum
    track: str  # in words
    held: str  # where the strongest push, for ever, holds the rod from upright
    stoppable: float  # the speed at the horizontal above which nothing stops it [rad/s]
    is_thesis: bool

    @property
    def accelerations(self) -> str:
        """Those of the actions [m/s²]: ``−10, 0 or +10``."""
        return pushes(self.body.accelerations, "or")


class Cut(NamedTuple):
    """How a task cuts the state into tiles, where its runs start, what is added to its reward."""

    task: str
    words: str


def pendulums(study: Study) -> list[Shown]:
    """The different pendulums of a study, in the order of its tasks."""
    found: dict[tuple[PendulumOptions, TrackOptions], list[str]] = {}
    for name, task in study.tasks.items():
        found.setdefault((task.pendulum, task.track), []).append(name)
    return [
        _shown(names, pendulum, track, (pendulum, track) == THESIS)
        for (pendulum, track), names in found.items()
    ]


def _shown(
    names: list[str], pendulum: PendulumOptions, track: TrackOptions, is_thesis: bool
) -> Shown:
    body = body_of(pendulum)
    return Shown(
        names, body, track_in_words(track), held_in_words(pendulum), highest_stoppable_speed(body),
        is_thesis,
    )  # fmt: skip


def body_of_bound(study: Study) -> Pendulum:
    """The pendulum that the bound is about."""
    return body_of(pendulum_of_bound(study))


def held_by_push(study: Study) -> str:
    """Where a cart that is pushed one way for ever holds the rods of full control: ``±134°``."""
    moved = [one.pendulum for one in study.tasks.values() if one.judged_by == "upright"]
    return " or ".join(dict.fromkeys(map(held_in_words, moved or [PendulumOptions()])))


def held_in_words(pendulum: PendulumOptions) -> str:
    """Where the strongest push to either side, for ever, holds the rod: ``±134°``."""
    right, left = (f"{angle:.0f}°" for angle in held(pendulum))
    return f"±{right}" if right == left else f"{right} or −{left}"


def track_in_words(track: TrackOptions) -> str:
    """How far the cart can go, and what happens there."""
    if track.limit is None:
        return "no end"
    happens = "a run is reset" if track.at_end == "falls" else "it stops dead"
    return f"±{track.limit:g} m, where {happens}"


def own_tiles(study: Study) -> list[Cut]:
    """How tasks cut φ and φ̇ that do not as the thesis does; nothing where all do."""
    found = []
    for name, task in study.tasks.items():
        if task.tiles != TileOptions():
            made = kinds.create(task.kind, study.readings, task.model_dump())
            tiles = tiles_for(made, False, study.readings, task.tiles)
            words = (
                f"the angle, up to ±{degrees(tiles.angle_limit):.0f}°, is cut into "
                f"{tiles.angle_parts} parts, and the velocity, up to ±{tiles.velocity_limit:g} rad/s, "
                f"into {tiles.velocity_parts}"
            )
            found.append(Cut(name, words))
    return found


def own_starts(study: Study) -> list[Cut]:
    """Where runs of tasks start that say so themselves; nothing where none does."""
    found = []
    for name, task in study.tasks.items():
        if task.start != StartOptions():
            made = kinds.create(task.kind, study.readings, task.model_dump())
            within, middle = degrees(made.start_angle), degrees(made.start_middle)
            words = f"within ±{within:.3g}° of {middle:.3g}°".replace("-", "−")
            if made.start_velocity:
                words += f", turning with up to {made.start_velocity:g} rad/s"
            found.append(Cut(name, words))
    return found


def own_rewards(study: Study) -> list[Cut]:
    """What tasks add to the reward that is learned from; nothing where none does."""
    found = []
    for name, task in study.tasks.items():
        if task.velocity_weight:
            found.append(Cut(name, f"−{task.velocity_weight:g}·φ̇² is added to it"))
        if task.shaping:
            found.append(
                Cut(name, f"it is shaped by a potential of energy, {task.shaping:g} rad² high")
            )
    return found


THREE_ACTIONS = (
    "three arrows at the cart are the three actions: accelerate by minus 10, by 0 or by plus 10 metres "
    "per second squared"
)
"""What the drawing of the cart says of its actions to those who do not see it."""


def drawn_for(svg: str, shown: Sequence[Shown]) -> str:
    """A drawing of the thesis's cart with the strongest pushes of these pendulums."""
    pairs = {(one.body.accelerations[0], one.body.accelerations[-1]) for one in shown}
    left, right = (f"{signed(one)} m/s²" for one in pairs.pop()) if len(pairs) == 1 else "−+"
    if any(tuple(one.body.accelerations) != ThesisActions() for one in shown):
        strongest = f"arrows at the cart are its strongest actions, {left} and {right}"
        svg = svg.replace(THREE_ACTIONS, strongest)
    return svg.replace(">−10 m/s²<", f">{left}<").replace(">+10 m/s²<", f">{right}<")


def length_of_a_step(study: Study) -> str:
    """How long a step is, in words: ``5 ms``; where tasks differ ``5 or 10 ms``."""
    lengths = sorted({float(task.pendulum.time_step) for task in study.tasks.values()})
    return f"{listed([f'{1000 * one:g}' for one in lengths], 'or')} ms"


class Choices(NamedTuple):
    """What an agent can do, in words for everybody."""

    how_many: str
    where: str  # the cart is accelerated


def choices(study: Study) -> Choices:
    """How many actions there are, and what they do."""
    of = [task.pendulum.accelerations for task in study.tasks.values()]
    numbers = sorted({len(accelerations) for accelerations in of})
    words = listed([NUMBERS.get(number, str(number)) for number in numbers], "or")
    may_rest = all(0 in accelerations for accelerations in of)
    if max(numbers) > LEFT_RIGHT_AND_NONE:
        where = "to the left or to the right, more or less strongly"
    else:
        where = "to the left, to the right" if may_rest else "to the left or to the right"
    return Choices(words, f"{where}, or not at all" if may_rest else where)


def lengths(study: Study) -> dict[str, str]:
    """The stretches by which full control is judged, in steps of its tasks."""
    upright = [task for task in study.tasks.values() if task.judged_by == "upright"]
    return {"stable": in_steps(STABLE_STEPS, upright), "end": end_of(study.tasks.values())}


def system(whole: Study, templates: Path) -> dict[str, Any]:
    """What the page is given of what moves in a study; ``templates`` has the folder of drawings."""
    study = narrowed(whole)
    found = pendulums(study)
    sole = {one.accelerations for one in found}
    kinds_of = {task.judged_by for task in study.tasks.values()}
    usual = {task.judged_by for task in study.tasks.values() if task.start == StartOptions()}
    drawings = {path.stem: path for path in sorted((templates / "drawings").glob("*.svg"))}
    return {
        "pendulums": found,
        "accelerates": sole.pop() if len(sole) == 1 else "",
        "choices": choices(study),
        "length_of_a_step": length_of_a_step(study),
        "lengths": lengths(study),
        "held": held_by_push(study),
        "own_tiles": own_tiles(study),
        "tiles_of_thesis": len(own_tiles(study)) < len(study.tasks),
        "own_rewards": own_rewards(study),
        "tasks": list(study.tasks),
        "architectures": study.architectures,
        "has_falls": "falls" in kinds_of,
        "has_upright": "upright" in kinds_of,
        "usual_starts": usual,
        "own_starts": own_starts(study),
        "own_rules": any(
            one.epsilon is not None or one.discount is not None
            for one in study.architectures.values()
        ),
        "drawings": {
            name: Markup(drawn_for(path.read_text("utf-8"), found))  # noqa: S704  a file of ours
            for name, path in drawings.items()
        },
    }
