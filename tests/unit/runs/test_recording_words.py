"""What a recording says: its text, its events, its stretches, its axes; read back from real files."""

import re
from itertools import pairwise

import numpy as np
import pytest

from tests.unit.runs.recorded import Recorded, read_back
from upswing.runs.metrics import UPRIGHT, falls_at, physical
from upswing.runs.recording.happenings import passages
from upswing.runs.recording.labels import LABELS
from upswing.runs.recording.layout import run_layout
from upswing.runs.recording.words import story
from upswing.runs.recording.write import write_recording
from upswing.runs.simulation import prepare
from upswing.study.task import task_named


@pytest.fixture(
    scope="module", params=[("balancing", "table", 0.5), ("full-control", "table", 0.1)]
)
def recorded(request, tmp_path_factory):
    """A run of each task."""
    return Recorded(tmp_path_factory.mktemp("recorded") / "run.rrd", *request.param, 40_000)


def test_passages_are_those_that_are_measured(recorded):
    steps = recorded.measures.steps
    found = passages(recorded.trajectory, 0, steps)
    assert found.falls.tolist() == [t for t in range(steps) if falls_at(recorded.trajectory, t)]
    assert len(found.falls) == recorded.measures.falls
    assert len(found.arrivals) == recorded.measures.swing_ups
    if len(found.arrivals):
        assert found.speeds.mean() == pytest.approx(recorded.measures.arrival_speed, rel=1e-6)
    # In parts it is the same as at once.
    cuts = [0, 1, 5_000, 5_001, 33_333, steps]
    parts = [passages(recorded.trajectory, a, b) for a, b in pairwise(cuts)]
    for name in ("falls", "arrivals", "speeds"):
        np.testing.assert_array_equal(
            np.concatenate([getattr(part, name) for part in parts]), getattr(found, name)
        )


def test_risen_is_upright_for_the_first_time_since_below(recorded):
    steps = recorded.measures.steps
    tilts = [abs(physical(angle)) for angle in recorded.trajectory.angle.astype(float)]
    expected, was_below = [], tilts[0] > np.pi / 2
    for t in range(1, steps):
        was_below = was_below or tilts[t] > np.pi / 2
        if was_below and tilts[t] <= UPRIGHT:
            expected.append(t)
            was_below = False
    assert passages(recorded.trajectory, 0, steps).risen.tolist() == expected


def test_the_log_has_every_event_of_every_stretch_with_its_number(recorded):
    said = recorded.texts("/events", "TextLog:text", "step")
    steps, trajectory = recorded.measures.steps, recorded.trajectory
    frames = recorded.frames
    shown = set(frames.steps[~frames.gap].tolist())
    falls = [t for t in range(steps) if falls_at(trajectory, t)]
    numbers = {
        step: int(found[1].replace(",", ""))
        for step, text in said
        if (found := re.match(r"fall ([\d,]+) of", text))
    }
    assert {t: i for i, t in enumerate(falls, 1) if t in shown}.items() <= numbers.items()
    assert {falls[0]: 1, falls[-1]: len(falls)}.items() <= numbers.items()
    assert all(falls[number - 1] == step for step, number in numbers.items())
    begins = [step for step, text in said if text.startswith("▶ stretch")]
    assert begins == [one.first for one in frames.named]
    arrivals = passages(trajectory, 0, steps).arrivals.tolist()
    assert sum("arrival" in text for _, text in said) >= sum(t in shown for t in arrivals)
    on_frames = recorded.texts("/events", "TextLog:text", "frame")
    assert {text for step, text in said if step in shown} == {text for _, text in on_frames}


def test_a_lane_names_the_stretch_of_every_frame(recorded):
    frames = recorded.frames
    states = dict(recorded.texts("/stretch", "StateChange:state", "frame"))
    for one in frames.named:
        assert states[int(frames.at(np.array([one.first]))[0])] == one.name
    assert states[len(frames.steps) - 1] == "not shown"


def test_the_text_says_what_one_sees_and_what_happened(recorded):
    ((_, text),) = recorded.texts("/about", "TextDocument:text")
    spec, measures = recorded.spec, recorded.measures
    assert f"{spec.task.name}: table, step size α = {spec.alpha:g}, seed 0" in text
    falls = [t for t in range(measures.steps) if falls_at(recorded.trajectory, t)]
    assert story(spec.task, measures, falls[-1]) in text
    assert f"It fell {len(falls):,} times, the last time at step {falls[-1]:,} of" in text
    assert "**200 frames a second" in text
    for word in ("Blue", "orange", "Yellow", "purple"):
        assert word in text


@pytest.mark.parametrize(
    ("kind", "change", "expected"),
    [
        ("balancing", {"falls": 0, "falls_last_fifth": 0}, "never fell, and not once in its last"),
        ("balancing", {"falls": 1, "falls_last_fifth": 0}, "fell once, the last time at step 77 "),
        (
            "balancing",
            {"falls": 9, "falls_last_fifth": 2},
            "2 times in its last fifth: **it does n",
        ),
        (
            "balancing",
            {"first_stable_step": None},
            "never stable: there are no 5,000 steps (25 s) w",
        ),
        ("full-control", {"first_stable_step": 1_234}, "first time from step 1,234: 5,000 steps"),
        ("full-control", {"upright_at_end": 0.95}, "95 % of its last 10,000 steps: **it stands"),
        ("full-control", {"upright_at_end": 0.5}, "**it does not stand at the end**"),
        ("full-control", {"diverged_at": 4_321}, "**It diverged at step 4,321 of 50,000**"),
    ],
)
def test_two_sentences_say_how_a_run_went(recorded, kind, change, expected):
    given = {"steps": 50_000, "falls": 3, "first_stable_step": 7, **change}
    measures = recorded.measures._replace(**given)
    last = None if measures.falls == 0 else 77
    said = story(task_named(kind, kind=kind, steps=50_000), measures, last)
    assert expected in said
    assert said.count(". ") == 1


def test_the_scale_of_the_value_goes_down_to_the_lowest_in_rad2(recorded):
    ((_, labels),) = recorded.columns["/learned/marks"]["Points2D:labels"]
    best = recorded.learned.q.max(axis=-1)
    assert labels[-3:] == [f"{best.min() / 4:,.3g}", "0", "value: reward to come [rad²]"]
    limit = 90 if recorded.spec.task.kind == "balancing" else 180
    assert {f"−{limit}°", "φ = 0", f"+{limit}°", "−20", "+20", "φ̇ [rad/s]"} <= set(labels)
    ((_, legend),) = recorded.columns["/phase/marks"]["Points2D:labels"]
    assert legend[-4:] == ["−10 m/s²", "0 m/s²", "+10 m/s²", "undecided: dark"]


def test_a_run_is_played_in_real_time(tmp_path):
    import rerun as rr

    path = tmp_path / "layout.rbl"
    run_layout(task_named("balancing", kind="balancing", steps=1)).save("upswing-balancing", path)
    reader = rr.chunk.RrdReader(path)
    (store,) = reader.blueprints()
    panel = {
        name: batch[name].to_pylist()
        for chunk in reader.stream(store=store)
        if str(chunk.entity_path) == "/time_panel"
        for batch in [chunk.to_record_batch()]
        for name in batch.schema.names
    }
    assert panel["TimePanelBlueprint:fps"] == [[200.0]]
    assert panel["TimePanelBlueprint:playback_speed"] == [[1.0]]
    assert panel["TimePanelBlueprint:timeline"] == [["frame"]]


def test_every_property_of_a_run_has_a_name_for_readers(recorded):
    assert recorded.properties.keys() <= LABELS.keys()
    assert len(set(LABELS.values())) == len(LABELS)
    units = {name for name in LABELS if re.search("share|reward|speed|seconds", name)}
    assert [n for n in units if "[" not in LABELS[n] and "share" not in LABELS[n]] == []


def test_a_diverged_run_has_a_scale_and_says_so(tmp_path):
    diverged = Recorded(tmp_path / "run.rrd", "full-control", "table", 0.5, 6_000)
    q = diverged.learned.q.copy()
    q[-1, 0, 0] = -np.inf
    q[-1, 1, 1] = np.nan
    spec, measures = diverged.spec, diverged.measures._replace(diverged_at=4_000)
    write_recording(
        tmp_path / "other.rrd", spec.run(0), diverged.trajectory, diverged.windows, measures,
        diverged.learned._replace(q=q), prepare(spec, 0).body, diverged.properties,
    )  # fmt: skip
    columns = read_back(tmp_path / "other.rrd")
    ((_, labels),) = columns["/learned/marks"]["Points2D:labels"]
    finite = q.max(axis=-1)
    assert labels[-3] == f"{finite[np.isfinite(finite)].min() / 4:,.3g}"
    assert "**It diverged at step 4,000" in columns["/about"]["TextDocument:text"][0][1][0]
    assert any("diverged" in row[0] for _, row in columns["/events"]["TextLog:text"])
