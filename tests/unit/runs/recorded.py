"""A run and its recording, read back."""

from tests.helpers import make_spec
from upswing.physics.environment import empty_trajectory
from upswing.runs.endings import endings
from upswing.runs.outcome import outcome_of
from upswing.runs.recording.frames import stretches
from upswing.runs.recording.write import write_recording
from upswing.runs.train import _properties, learn


class Recorded:
    """A run of its own, and what its recording says when it is read back."""

    def __init__(self, path, *spec):
        self.spec = spec[0] if len(spec) == 1 else make_spec(*spec)
        self.trajectory = empty_trajectory(self.spec.task.steps)
        learned = learn(self.spec, 0, self.trajectory)
        self.measures, self.windows, _, row = outcome_of(
            self.spec, 0, learned.setting, self.trajectory
        )
        outcome = {**row, **endings(self.windows), "seconds": 1.0, "steps_per_second": 1.0}
        self.properties = _properties(self.spec, 0, outcome)
        self.learned, self.body = learned.learned, learned.setting.body
        self.frames = stretches(
            self.trajectory, self.windows, self.measures.first_stable_step, self.body.time_step
        )
        write_recording(
            path, self.spec.run(0), self.trajectory, self.windows, self.measures, self.learned,
            self.body, self.properties,
        )  # fmt: skip
        self.columns = read_back(path)

    def texts(self, entity, component, timeline=None):
        """The texts of an entity, by the time on a timeline."""
        return [
            (time[timeline] if timeline else None, row[0])
            for time, row in self.columns[entity][component]
            if timeline is None or timeline in time
        ]


def read_back(path):
    """Rows of a recording: entity → component → list of (its times, its values)."""
    import rerun as rr

    reader = rr.chunk.RrdReader(path)
    (store,) = reader.recordings()
    found = {}
    for chunk in reader.stream(store=store):
        batch = chunk.to_record_batch()
        columns = {name: batch[name].to_pylist() for name in batch.schema.names}
        times = [name for name in columns if name in ("frame", "step", "sim_time")]
        for name, rows in columns.items():
            if ":" in name and not name.startswith("rerun"):
                of = found.setdefault(str(chunk.entity_path), {}).setdefault(name, [])
                of += [
                    ({time: columns[time][i] for time in times}, row)
                    for i, row in enumerate(rows)
                    if row is not None
                ]
    return found
