"""What a run learned, followed greedily from a start of one's choice, with a push if one likes."""

from contextlib import AbstractContextManager
from math import degrees, isfinite, radians
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.physics.environment import NEVER, Trajectory
from upswing.physics.pendulum import step_cart
from upswing.physics.tasks import wrapped
from upswing.physics.track import ends_run
from upswing.recordings.asked_to_end import ended_by_signals
from upswing.recordings.live import Live, Plan
from upswing.recordings.looking import Looking
from upswing.recordings.slide import Slide, write_slide
from upswing.recordings.watch import about
from upswing.runs.learned import WEIGHTS, Learned, learned_by, load_learned
from upswing.runs.metrics import UPRIGHT
from upswing.runs.recording.frames import Stretch
from upswing.runs.recording.happenings import Event
from upswing.runs.snapshots import look, snapshots
from upswing.runs.success import SUCCESS
from upswing.study.errors import BadInput
from upswing.study.ids import run_of

FASTEST = 100.0
"""Largest |φ̇| at the start and of a push [rad/s]."""

LONGEST = 600.0
"""Of what is played [s]."""

HELD = 0.5
"""Upright for so long is up, and not passing by [s]."""

JUDGED = 4
"""The last one of so many parts says whether it stands: 5 s of 20 s."""


class Start(NamedTuple):
    """Where it starts, and what is done to it."""

    angle: float  # [°]
    velocity: float = 0.0  # [rad/s]
    push: float = 0.0  # [rad/s]
    at: float = 5.0  # when it is pushed [s]
    seconds: float = 20.0  # how long it is followed


class Played(NamedTuple):
    """What happened."""

    learned: Learned
    start: Start
    trajectory: Trajectory  # up to a fall that ends the task
    ends_in_fall: bool

    @property
    def steps(self) -> int:
        """Number of steps until the end, or until a fall that ends the task."""
        return len(self.trajectory.angle)

    @property
    def time_step(self) -> float:
        """The time step of the run [s]."""
        return self.learned.setting.body.time_step

    @property
    def pushed_at(self) -> int | None:
        """The step before which it is pushed; None if it is not."""
        return _pushed_at(self.start, self.time_step)

    @property
    def ends_at_track_end(self) -> bool:
        """Whether its last step takes the cart to an end of the track where the task ends."""
        setting, last = self.learned.setting, self.trajectory
        position, _ = step_cart(
            setting.body,
            float(last.cart_position[-1]),
            float(last.cart_velocity[-1]),
            setting.body.accelerations[last.action[-1]],
        )
        # What is kept of a position has seven digits.
        return bool(ends_run(setting.task.track, position * (1 + 1e-6)))

    @property
    def upright(self) -> NDArray[np.bool_]:
        """Whether it is upright: (steps,); |φ| ≤ 20° on any turn is a large cosine."""
        return np.asarray(np.cos(self.trajectory.angle) >= np.cos(UPRIGHT))


def learned_of(what: str, results: Path) -> Learned:
    """What a run learned, by a file of weights or by the run's id in a folder of results.

    Raises:
        BadInput: there is none, or it cannot be read.
    """
    if what.endswith(f".{WEIGHTS}") or Path(what).is_file():
        return load_learned(Path(what))
    return learned_by(results, run_of(what))


def first_start(learned: Learned) -> float:
    """Where its task begins to try out what was learned [°]: hanging, or a little off upright."""
    angle = degrees(learned.spec.task.greedy_starts[0])
    return 180.0 if angle == -180 else angle


def follow(learned: Learned, start: Start) -> Played:
    """Follow the greedy policy.

    Raises:
        BadInput: the start is none of the task, or the rest of it makes no sense.
    """
    _check(learned, start)
    angle, time_step = radians(start.angle), learned.setting.body.time_step
    if learned.setting.task.wraps:
        angle = wrapped(angle)
    pushed_at, steps = _pushed_at(start, time_step), round(start.seconds / time_step)
    pushes = {} if pushed_at is None else {pushed_at: start.push}
    trajectory = learned.simulate(angle, start.velocity, steps, pushes)
    falls = np.flatnonzero(trajectory.reset)
    # After a fall the task begins anew at a start of its own, which nobody has asked for.
    steps = int(falls[0]) + 1 if len(falls) else steps
    columns = {name: column[:steps] for name, column in trajectory._asdict().items()}
    columns["td_error"] = np.full(steps, np.nan, np.float32)  # nothing is learned
    columns["diverged_at"] = trajectory.diverged_at
    return Played(learned, start, Trajectory(**columns), bool(len(falls)))


def _pushed_at(start: Start, time_step: float) -> int | None:
    """The step before which it is pushed, of so many seconds each; None if it is not."""
    return round(start.at / time_step) if start.push else None


def _check(learned: Learned, start: Start) -> None:
    time_step = learned.setting.body.time_step
    critical = degrees(learned.setting.task.critical_angle)
    limit = min(180.0, critical)
    because = f": {learned.spec.task.name} ends beyond it" if critical < 180 else ""
    problems = []
    if not abs(start.angle) <= limit:
        problems.append(f"--from: {start.angle:g}: must be from −{limit:g}° to {limit:g}°{because}")
    for name, value in (("--velocity", start.velocity), ("--push", start.push)):
        if not abs(value) <= FASTEST:
            problems.append(f"{name}: {value:g}: must be from −{FASTEST:g} to {FASTEST:g} rad/s")
    if not (isfinite(start.seconds) and time_step <= start.seconds <= LONGEST):
        right = f"must be a time from {time_step:g} to {LONGEST:g} s"
        problems.append(f"--seconds: {start.seconds:g}: {right}")
    elif start.push and not (
        0 <= start.at < start.seconds
        and round(start.at / time_step) < round(start.seconds / time_step)
    ):
        right = f"must be a time before the end, {start.seconds:g} s"
        problems.append(f"--at: {start.at:g}: {right}")
    if problems:
        raise BadInput(problems)


def in_words(played: Played) -> str:
    """When it got upright, what the push did, and whether it stands at the end."""
    if played.trajectory.diverged_at[0] != NEVER:
        return (
            "The run diverged: what it learned is no finite number, and what it does means nothing."
        )
    said, pushed_at, time_step = [], played.pushed_at, played.time_step
    until = played.steps if pushed_at is None else min(pushed_at, played.steps)
    said.append(_got_up(played, 0, until))
    if pushed_at is not None and pushed_at < played.steps:
        said.append(
            f"The push of {played.start.push:+g} rad/s at {pushed_at * time_step:g} s: "
            + _got_up(played, pushed_at, played.steps).lower()
        )
    end = f"at {played.steps * time_step:.2f} s"
    if played.ends_in_fall and played.ends_at_track_end:
        end = f"The cart came to the end of its track {end}"
        return " ".join([*said, f"{end}, which ends {played.learned.spec.task.name}."])
    if played.ends_in_fall:
        return " ".join([*said, f"It fell {end}, which ends {played.learned.spec.task.name}."])
    judged = max(1, played.steps // JUDGED)
    share = float(np.mean(played.upright[-judged:]))
    verdict = "it stands" if share >= SUCCESS else "it does not stand"
    said.append(
        f"At the end, {verdict}: upright for {100 * share:.3g} % of the last {judged * time_step:.3g} s."
    )
    return " ".join(said)


def _got_up(played: Played, first: int, after: int) -> str:
    """Whether and when it got upright between two steps."""
    upright = played.upright[first:after]
    if len(upright) and upright.all():
        farthest = degrees(float(np.arccos(np.cos(played.trajectory.angle[first:after]).min())))
        return f"It stayed upright, at most {farthest:.1f}° away."
    so_far = np.concatenate([[0], np.cumsum(upright)])
    held = max(1, round(HELD / played.time_step))
    found = np.flatnonzero(so_far[held:] - so_far[:-held] == held)
    if not len(found):
        return "It did not get upright."
    return f"It was upright after {found[0] * played.time_step:.2f} s."


def play_in(viewer: AbstractContextManager[Looking], played: Played) -> None:
    """Show it in a viewer, again and again, until it is closed, or Ctrl-C."""
    with ended_by_signals(), viewer as looking:
        print(f"{_title(played)}, {looking.says}\n{in_words(played)}", flush=True)
        live = _live(played)
        try:
            live.stream.connect_grpc(looking.url)
            _draw(live, played)
        except BaseException:
            live.abandon()
            raise
        live.end()
        looking.until_closed()


def play_into(path: Path, played: Played) -> None:
    """Write it as a recording (.rrd), as a picture that moves (.gif) or as one that does not (.png).

    Raises:
        OSError: it cannot be written.
    """
    if path.suffix.lower() == ".rrd":
        live = _live(played)
        live.remember()
        _draw(live, played)
        live.write(path)
        live.end()
    else:
        setting, limit = played.learned.setting, played.learned.spec.task.angle_limit
        track = setting.task.track.limit
        slide = Slide(setting.body, played.trajectory, played.pushed_at, limit, track)
        write_slide(path, slide)
    print(f"{path}: {_title(played)}\n{in_words(played)}")


def check_name(path: Path) -> None:
    """``BadInput`` if nothing can be written under this name."""
    ending = path.suffix.lower()
    if ending == ".mp4":
        raise BadInput([f"--to: {path}: there is no encoder for MP4 here; a .gif moves as well"])
    if ending not in (".gif", ".png", ".rrd"):
        raise BadInput([f"--to: {path}: must end with .gif, .png or .rrd"])


def _title(played: Played) -> str:
    seconds = played.steps * played.time_step
    return f"{played.learned.run} from {played.start.angle:g}° for {seconds:g} s"


def _live(played: Played) -> Live:
    start, border = played.start, played.pushed_at
    name = f"from {start.angle:g}°"
    named: tuple[Stretch, ...] = (Stretch(0, played.steps, name),)
    if border is not None and 0 < border < played.steps:
        named = (Stretch(0, border, name), Stretch(border, played.steps, "after the push"))
    plan = Plan.of(np.ones(played.steps, np.bool_), name, played.time_step)
    plan = plan._replace(frames=plan.frames._replace(named=named))
    body = played.learned.setting.body
    return Live(played.learned.spec, body, plan, played.trajectory, "played")


def _draw(live: Live, played: Played) -> None:
    setting = played.learned.setting
    known = snapshots(setting.encoder, [(0, look(setting.learner, setting.encoder))])
    live.begin("playing")
    live.draw_learned(known)
    live.draw(0, played.steps, known)
    at, push = played.pushed_at, played.start.push
    events = [Event(0, "INFO", f"start: {played.start.angle:g}°")]
    if at is not None and at < played.steps:
        events.append(Event(at, "WARN", f"push: {push:+g} rad/s"))
    live.tell(events)
    news = f"What it learned, followed greedily from {played.start.angle:g}°. {in_words(played)}"
    live.say(0, about(played.learned.spec, news, over_the_whole_run=False))
