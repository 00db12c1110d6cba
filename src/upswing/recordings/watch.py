"""A run that learns in front of one's eyes: the very run of a study, at a speed of one's choice."""

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from time import monotonic, sleep

import numpy as np

from upswing.physics.environment import Trajectory, empty_trajectory
from upswing.recordings.asked_to_end import ended_by_signals
from upswing.recordings.live import Live
from upswing.recordings.looking import Looking
from upswing.recordings.pace import BETWEEN, FAST, Pace
from upswing.runs.files.trajectory import read_metadata
from upswing.runs.metrics import STABLE_STEPS, UPRIGHT
from upswing.runs.outcome import Outcome, outcome_of
from upswing.runs.recording.happenings import Event, last_fall
from upswing.runs.recording.words import colours, story
from upswing.runs.simulation import Setting, prepare
from upswing.runs.snapshots import Snapshots, look, snapshots
from upswing.study.ids import file_of
from upswing.study.spec import Spec


class Closed(Exception):
    """Nobody looks any more, and the run has not ended."""


def watch(
    spec: Spec,
    pace: Pace,
    connect: Callable[[Live], None],
    is_looked_at: Callable[[], bool] = lambda: True,
    at_end: Callable[[Live], None] = lambda _: None,
) -> Outcome:
    """Learn a run and show it on the way.

    Args:
        spec: of this run alone.
        pace: how fast.
        connect: says where the recording goes.
        is_looked_at: whether somebody still looks.
        at_end: called when all is sent, before the stream is closed.

    Raises:
        Closed: nobody looks any more, and the run has not ended.
    """
    (seed,), steps = spec.seeds, spec.task.steps
    setting, trajectory = prepare(spec, seed), empty_trajectory(steps)
    setting.advance(trajectory, 0, 0)  # compiles, or fetches what was compiled
    live = Live(spec, setting.body, pace.plan(steps), _drawn(spec, trajectory))
    try:
        connect(live)
        live.begin("following")
        live.tell([Event(0, "INFO", "start")])
        looked = [_known(setting, 0)]
        live.draw_learned(looked[0])
        due, begun = pace.next_look(0), monotonic()
        for first, last in pace.pieces(steps):
            setting.advance(trajectory, first, last)
            live.draw(first, last, looked[-1])
            if last >= due or last == steps:
                looked.append(_known(setting, last))
                live.draw_learned(looked[-1])
                live.say(last - 1, _progress(spec, trajectory, last, live.falls))
                due = pace.next_look(last)
            _wait(begun + pace.due(last), is_looked_at)
        if spec.alpha is None:
            trajectory.td_error.fill(np.nan)  # a control has values, but learns nothing
        outcome = outcome_of(spec, seed, setting, trajectory)
        _tell_outcome(live, spec, trajectory, outcome, looked)
        at_end(live)
    except (Closed, KeyboardInterrupt):
        live.abandon()
        raise
    except BaseException:
        live.end()
        raise
    live.end()
    return outcome


def watch_in(
    viewer: AbstractContextManager[Looking], spec: Spec, speed: float, results: Path
) -> None:
    """Show a run in a viewer while it learns, and leave the viewer open until it is closed, or Ctrl-C.

    Args:
        viewer: opens when it is entered.
        spec: of this run alone.
        speed: in multiples of real time.
        results: where the same run may be stored.
    """
    steps, run = spec.task.steps, spec.run(spec.seeds[0])
    pace = Pace.of(speed, spec.task)
    seconds = "as fast as it goes" if speed == FAST else f"in {pace.due(steps):,.0f} s"
    with ended_by_signals(), viewer as looking:
        print(f"{run} learns {steps:,} steps {seconds}, {looking.says}", flush=True)
        try:
            outcome = watch(
                spec,
                pace,
                lambda live: live.stream.connect_grpc(looking.url),
                lambda: looking.looks,
            )
        except Closed:
            print("The viewer was closed before the run ended. Nothing is stored.")
            return
        print(_in_words(spec, outcome, results))
        print("It stays to be looked at, until you close it or press Ctrl-C.", flush=True)
        looking.until_closed()


def watch_into(path: Path, spec: Spec, speed: float, results: Path) -> None:
    """Write what would be shown of a run into a recording; ``results`` as for ``watch_in``.

    Raises:
        OSError: it cannot be written.
    """
    pace = Pace.of(speed, spec.task, waits=False)
    outcome = watch(spec, pace, Live.remember, at_end=lambda live: live.write(path))
    print(_in_words(spec, outcome, results))


def _in_words(spec: Spec, outcome: Outcome, results: Path) -> str:
    """What a run came to, and whether it is that which is stored."""
    measures, digest = outcome.measures, outcome.row["digest"]
    stored = stored_digest(spec, results)
    same = {
        None: f"no run of this specification is stored in {results}",
        digest: f"that of the run stored in {results}",
    }
    told = same.get(stored, f"the run stored in {results} has another, {stored}")
    return f"{story(spec.task, measures, None).replace('**', '')}\nDigest {digest}: {told}."


def _drawn(spec: Spec, trajectory: Trajectory) -> Trajectory:
    """What is shown of a trajectory while it grows: of a control no TD error, as in its files."""
    if spec.alpha is not None:
        return trajectory
    return trajectory._replace(td_error=np.full(spec.task.steps, np.nan, np.float32))


def _known(setting: Setting, step: int) -> Snapshots:
    """What is known before a step."""
    return snapshots(setting.encoder, [(step, look(setting.learner, setting.encoder))])


def _wait(until: float, is_looked_at: Callable[[], bool]) -> None:
    while is_looked_at():
        left = until - monotonic()
        if left <= 0:
            return
        sleep(min(left, BETWEEN))
    raise Closed


def _tell_outcome(
    live: Live, spec: Spec, trajectory: Trajectory, outcome: Outcome, looked: list[Snapshots]
) -> None:
    """Say what the run came to, and draw what is known only at its end."""
    measures, windows = outcome.measures, outcome.windows
    events = [Event(measures.steps - 1, "INFO", "end of the run")]
    if measures.first_stable_step is not None:
        events.append(Event(measures.first_stable_step, "INFO", "the first stable window begins"))
    if measures.diverged_at is not None:
        words = "diverged: a value is not finite, and nothing after it means anything"
        events.append(Event(measures.diverged_at, "ERROR", words))
    live.tell(sorted(events, key=lambda event: event.step))
    live.draw_envelope(windows)
    first = looked[0]
    whole = first._replace(
        steps=np.concatenate([one.steps for one in looked]),
        q=np.concatenate([one.q for one in looked]),
    )
    live.draw_learned(whole)  # again, all of them in one scale
    live.say(
        measures.steps - 1, about(spec, story(spec.task, measures, last_fall(trajectory, windows)))
    )


def _progress(spec: Spec, trajectory: Trajectory, step: int, falls: int) -> str:
    """How far a run is, in words."""
    time_step, steps = spec.task.pendulum.time_step, spec.task.steps
    recent = trajectory.angle[max(0, step - spec.task.steps_of(STABLE_STEPS)) : step]
    upright = float(np.mean(np.cos(recent) >= np.cos(UPRIGHT)))
    doing = "It is running" if spec.alpha is None else "It is learning"
    return about(
        spec,
        f"**{doing}: step {step:,} of {steps:,}**, {step * time_step:,.0f} s of "
        f"{steps * time_step:,.0f} s. Falls so far: {falls:,}; of its last {len(recent):,} steps "
        f"{100 * upright:.0f} % were upright.",
        over_the_whole_run=False,
    )


def about(spec: Spec, news: str, over_the_whole_run: bool = True) -> str:
    """The text beside what is shown live, in Markdown.

    Args:
        spec: of this run alone.
        news: what is new.
        over_the_whole_run: whether curves over the whole run are drawn, and so are to be explained.
    """
    said = colours(spec)
    if not over_the_whole_run:
        said = "\n\n".join(part for part in said.split("\n\n") if "the whole run" not in part)
    return f"## {spec.run(spec.seeds[0])}\n\n{news}\n\n{said}\n"


def stored_digest(spec: Spec, results: Path) -> str | None:
    """The digest of the same run in a folder of results; None if it is not there.

    Raises:
        BadInput: what is there cannot be read.
    """
    path = results / file_of(spec.run(spec.seeds[0]), "windows.parquet")
    if not path.is_file():
        return None
    found = read_metadata(path)
    same = found["spec"] == spec.canonical()
    return str(found["outcome"]["digest"]) if same else None
