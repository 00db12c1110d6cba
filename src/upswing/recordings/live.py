"""A recording that grows while its run learns, with the layout and the drawings of a stored one.

A stored recording is drawn at once, by functions of ``runs/recording`` that send what they draw to a
stream. Here the same functions are called again and again, each time for the steps that are new and
some before them, from which a line or a trail leads on; ``Stream`` lets through what is new.
"""

import atexit
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import pyarrow as pa
import rerun as rr
import rerun.blueprint as rrb
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory
from upswing.physics.pendulum import Pendulum
from upswing.runs.files.atomic import written
from upswing.runs.recording.frames import (
    FRAME,
    STEP,
    Frames,
    Steps,
    Stretch,
    drawn_every,
    real_time,
    so_long,
    time_columns,
)
from upswing.runs.recording.happenings import Event, passages
from upswing.runs.recording.layout import run_layout
from upswing.runs.recording.pictures import draw_learned, draw_pendulum, draw_phase_plane, trail
from upswing.runs.recording.write import draw_envelope, draw_lines
from upswing.runs.simulation import REWARD_SCALES
from upswing.runs.snapshots import Snapshots
from upswing.study.ids import recording_id
from upswing.study.measured import Windows
from upswing.study.spec import Spec

REMEMBERED = 4_000
"""How long ago the pendulum may have been below the horizontal when it gets up [steps of 5 ms]."""


class _Rows(NamedTuple):
    """A column of times or of values without its first rows."""

    column: Any
    first: int

    def timeline_name(self) -> str:
        return str(self.column.timeline_name())

    def component_descriptor(self) -> Any:
        return self.column.component_descriptor()

    def as_arrow_array(self) -> pa.Array:
        return self.column.as_arrow_array()[self.first :]


class Stream(rr.RecordingStream):
    """A stream of data on which nothing is sent twice."""

    since = 0
    """The first step that was not sent yet."""

    def __init__(self, application: str, identity: str) -> None:
        super().__init__(application, recording_id=identity)
        self._static: dict[tuple[str, str], pa.Array] = {}

    def log(
        self,
        entity_path: str | list[object],
        entity: Any,
        *extra: Any,
        static: bool = False,
        strict: bool | None = None,
    ) -> None:
        """As the original; what holds at all times is sent only if it is new or has changed."""
        if static:
            parts = {
                (str(entity_path), str(part.component_descriptor())): part.as_arrow_array()
                for one in (entity, *extra)
                for part in one.as_component_batches()
            }
            if all(self._static.get(key) == part for key, part in parts.items()):
                return
            self._static |= parts
        super().log(entity_path, entity, *extra, static=static, strict=strict)

    def send_columns(
        self,
        entity_path: str,
        indexes: Iterable[Any],
        columns: Iterable[Any],
        *,
        strict: bool | None = None,
    ) -> None:
        """As the original; the rows are in the order of steps, and those before ``since`` stay here."""
        times = list(indexes)
        steps = next(time for time in times if time.timeline_name() == STEP).as_arrow_array()
        first = int(np.searchsorted(steps.to_numpy(), self.since))
        if first < len(steps):
            rows: list[Any] = [_Rows(column, first) for column in columns]
            super().send_columns(
                entity_path,
                [_Rows(time, first) for time in times],
                rows,
                strict=strict,
            )


class Plan(NamedTuple):
    """Which steps of a run are shown; it is known before the run begins."""

    frames: Frames
    drawn: Steps  # at which pictures are drawn

    @classmethod
    def of(cls, shown: NDArray[np.bool_], name: str, time_step: float) -> "Plan":
        """From whether each step [s] is shown, shape (steps,), and what is said of all of them."""
        ends = np.flatnonzero(shown & ~np.append(shown[1:], False)) + 1
        rows = np.union1d(np.flatnonzero(shown), ends)
        named = (Stretch(0, len(shown), name),)
        frames = Frames(rows, ~np.append(shown, False)[rows], time_step, named)
        return cls(frames, frames.drawn)

    def shows(self, step: int) -> bool:
        """Whether a step is shown."""
        row = int(np.searchsorted(self.frames.steps, step))
        found = row < len(self.frames.steps) and self.frames.steps[row] == step
        return bool(found and not self.frames.gap[row])

    def piece(self, first: int, last: int) -> "Frames | None":
        """The rows from step ``first`` up to ``last``; None if there are none."""
        begin, end = np.searchsorted(self.frames.steps, (first, last))
        if begin == end:
            return None
        piece = _Piece(
            self.frames.steps[begin:end], self.frames.gap[begin:end], self.frames.time_step
        )
        piece.of = self
        return piece


class _Piece(Frames):
    """Some rows of a plan, numbered as in the whole."""

    of: Plan

    @property
    def drawn(self) -> Steps:
        """The steps at which pictures are drawn."""
        first, last = np.searchsorted(self.of.drawn, (self.steps[0], self.steps[-1] + 1))
        return self.of.drawn[first:last]

    def at(self, steps: Steps) -> Steps:
        """The first frame at or after each of ``steps``; the last frame if there is none."""
        return self.of.frames.at(steps)


class Live:
    """A run that is recorded while it happens.

    Args:
        spec: of the run alone; it has the layout of its task.
        body: the pendulum that is drawn.
        plan: which steps are shown.
        trajectory: which holds the steps when they are drawn.
        name: added to that of the run: in one viewer it is not the stored recording.
    """

    def __init__(
        self, spec: Spec, body: Pendulum, plan: Plan, trajectory: Trajectory, name: str = "live"
    ) -> None:
        rr.set_strict_mode(True)  # otherwise errors become warnings and data is dropped
        run = spec.run(spec.seeds[0])
        self.stream = Stream(f"upswing-{spec.task.name}", recording_id(f"{run}-{name}"))
        self._name, self._task, self._body = f"{run} ({name})", spec.task, body
        self._plan, self._trajectory = plan, trajectory
        self._unit = REWARD_SCALES[spec.readings.reward_unit]
        # Drawing begins as far before the new steps as a trail is long [steps].
        self._lead = trail(body.time_step)[0] * drawn_every(body.time_step)
        self._told = 0  # the first step of whose events nothing was told
        self.falls = 0  # before it

    def begin(self, play_state: Literal["following", "playing"]) -> None:
        """Say what it is, and how to look: at what comes, or again and again in real time."""
        rr.send_recording_name(self._name, recording=self.stream)
        layout = run_layout(self._task)
        layout.time_panel = rrb.TimePanel(
            timeline=FRAME,
            state="collapsed",
            play_state=play_state,
            fps=real_time(self._body.time_step),
            loop_mode="all" if play_state == "playing" else None,
        )
        self.stream.send_blueprint(layout)

    def draw(self, first: int, last: int, learned: Snapshots) -> None:
        """Draw the steps from ``first`` up to ``last``, the state over the map of what is known."""
        end = len(self._trajectory.angle)
        self.stream.since = first
        # The row that ends the last line stands after the last step.
        piece = self._plan.piece(max(0, first - self._lead), last + (last == end))
        if piece is not None:
            draw_lines(self.stream, piece, self._trajectory, self._body)
            draw_pendulum(self.stream, piece, self._trajectory, self._body, self._task.track.limit)
            draw_phase_plane(self.stream, piece, self._trajectory, learned)
        self._name_stretches(first, last)
        # Whether a step passes the horizontal is known with the next one.
        self._tell_of(last if last == end else last - 1)

    def draw_learned(self, learned: Snapshots) -> None:
        """Draw the maps of some moments in one scale."""
        self.stream.since = 0
        draw_learned(self.stream, self._plan.frames, learned, self._body, self._unit)

    def draw_envelope(self, windows: Windows) -> None:
        """Draw the lowest and the highest angle over the whole run."""
        self.stream.since = 0
        draw_envelope(self.stream, windows, self._plan.frames)

    def tell(self, events: Sequence[Event]) -> None:
        """Put events, in the order of their steps, into the log."""
        if events:
            self._send(
                "events",
                [event.step for event in events],
                rr.TextLog.columns(
                    text=[event.text for event in events], level=[event.level for event in events]
                ),
            )

    def say(self, step: int, text: str) -> None:
        """What is to be read about the run from a step on, in Markdown."""
        words = rr.TextDocument.columns(text=[text], media_type=["text/markdown"])
        self._send("about", [step], words)

    def remember(self) -> None:
        """Keep everything in memory, for ``write``; nothing must have been sent yet."""
        self._memory = self.stream.memory_recording()

    def write(self, path: Path) -> None:
        """Write all that was kept in memory.

        Raises:
            OSError: it cannot be written; the disk may be full.
        """
        # Rerun's own writing of files ends at a full disk without saying so.
        with written(path) as beside:
            beside.write_bytes(self._memory.drain_as_bytes())

    def end(self) -> None:
        """Have everything arrive, and let go of whoever looks at it."""
        self.stream.disconnect()

    def abandon(self) -> None:
        """Let go where nobody looks any more; to have everything arrive would take seconds, in vain."""
        atexit.unregister(rr.rerun_shutdown)

    def _name_stretches(self, first: int, last: int) -> None:
        """Say where stretches begin, of what has come: a viewer follows the last that it has."""
        begun = [one for one in self._plan.frames.named if first <= one.first < last]
        if begun:
            names = rr.StateChange.columns(state=[one.name for one in begun])
            self._send("stretch", [one.first for one in begun], names)

    def _send(self, entity: str, steps: list[int], columns: Any) -> None:
        self.stream.since = 0
        indexes = time_columns(np.array(steps), self._plan.frames)
        self.stream.send_columns(entity, indexes, columns)

    def _tell_of(self, after: int) -> None:
        """Tell what happened up to step ``after`` since it was last told, where it is shown."""
        if after <= self._told:
            return
        first = max(0, self._told - so_long(REMEMBERED, self._body.time_step))
        found = passages(self._trajectory, first, after)
        falls = found.falls[found.falls >= self._told].tolist()
        arrived = {
            int(step): f"arrives above the horizontal at {speed:.1f} rad/s"
            for step, speed in zip(found.arrivals, found.speeds, strict=True)
        }
        risen = dict.fromkeys(found.risen.tolist(), "gets up: upright")
        events = [
            Event(step, "INFO", text)
            for step, text in (*arrived.items(), *risen.items())
            if step >= self._told
        ]
        reset = self._trajectory.reset
        events += [
            Event(step, "WARN", f"fall {number:,}" + (": reset to a new start" * bool(reset[step])))
            for number, step in enumerate(falls, self.falls + 1)
        ]
        events.sort(key=lambda event: event.step)
        self.tell([event for event in events if self._plan.shows(event.step)])
        self._told, self.falls = after, self.falls + len(falls)
