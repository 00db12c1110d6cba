"""What recordings that compare runs say, and how they are coloured and scaled."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from tests.unit.recordings.test_studies import study_of
from tests.unit.runs.recorded import read_back
from upswing.analysis.verdicts import judge
from upswing.recordings.comparison import write_comparison
from upswing.recordings.shades import VISIBLE, shades
from upswing.runs.results import OwnRuns, Results
from upswing.study.claims import load_claims

CLAIMS = load_claims(Path("config/claims.yaml"))

MODULAR = {
    "seeds": 2,
    "tasks": {"full-control": {"kind": "full-control", "steps": 3_000}},
    "architectures": {
        "table": {"learner": "table"},
        "modular-table": {"learner": "table", "modular": True},
    },
    "experiments": [
        {
            "tasks": ["full-control"],
            "architectures": ["table", "modular-table"],
            "alphas": [1, 0.1],
        },
    ],
}


def text_of(path):
    ((_, (text,)),) = read_back(path)["/about"]["TextDocument:text"]
    return text


@pytest.mark.parametrize("name", ["C1", "C2", "C13"])
def test_the_recording_of_a_claim_states_it_its_verdict_and_why_these_runs(results, name):
    text = text_of(write_comparison(results, CLAIMS, f"claim-{name}"))
    claim = CLAIMS[name]
    assert claim.statement in text
    for row in judge(results, name, claim):
        assert f"asked for {row.threshold}: **{row.verdict}**" in text
        if not np.isnan(row.estimate):
            assert f"**{row.estimate:.3g}**" in text
    order = list(results.task(str(claim.cell)).order_of_runs)
    for rank, (_, row) in zip(
        ("worst", "median", "best"), results.three_of(str(claim.cell)).iterrows(), strict=True
    ):
        assert f"| {rank} | {row['seed']} | {row[order[0]]:,.4g} |" in text
    assert "200 frames a second" in text


def test_the_recording_of_a_claim_has_its_pendulum_s_length_and_speed(tmp_path):
    import rerun as rr

    own = {"length": 0.4, "time_step": 0.01, "accelerations": [-20, -10, 0, 10, 20]}
    study = {
        "seeds": 3,
        "readings": {"zero_of_angle": "hanging"},
        "tasks": {"balancing": {"kind": "balancing", "steps": 9_000, "pendulum": own}},
        "architectures": {"table": {"learner": "table"}},
        "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]}],
    }
    study_of(study, tmp_path)
    path = write_comparison(Results(tmp_path), CLAIMS, "claim-C2")
    text = text_of(path)
    assert "100 frames a second" in text
    assert "the first and the last 1,250 steps" in text
    found = read_back(path)
    for rank in ("worst", "median", "best"):
        rods = found[f"/{rank}/pendulum/rod"]["LineStrips2D:strips"]
        assert [time["step"] for time, _ in rods][:3] == [0, 2, 4]
        for time, ((base, tip),) in rods[:20]:
            assert np.linalg.norm(np.subtract(tip, base)) == pytest.approx(0.4, rel=1e-6), time
            assert tip[1] > base[1]  # downwards: φ = 0 hangs under this reading
    reader = rr.chunk.RrdReader(path)
    (store,) = reader.blueprints()
    speeds = [
        batch["TimePanelBlueprint:fps"].to_pylist()
        for chunk in reader.stream(store=store)
        for batch in [chunk.to_record_batch()]
        if "TimePanelBlueprint:fps" in batch.schema.names
    ]
    assert speeds == [[[100.0]]]


def test_the_recording_of_a_claim_is_judged_by_its_own_runs_and_words_alone(results, tmp_path):
    """It needs no table, and so waits for none."""
    folder = tmp_path / "without-tables"
    shutil.copytree(results.folder, folder, ignore=shutil.ignore_patterns("tables"))
    own = OwnRuns(folder, None)
    text = text_of(write_comparison(own, CLAIMS, "claim-C2"))
    low = {"at_least": 0.01, "partly": 0.001}
    parts = tuple(part.model_copy(update=low) for part in CLAIMS["C2"].parts)
    changed = {**CLAIMS, "C2": CLAIMS["C2"].model_copy(update={"parts": parts})}
    other = text_of(write_comparison(own, changed, "claim-C2"))
    assert "**Verdict: inconclusive.**" in text  # 3 runs of 3 cannot say more of 80 %
    assert "**Verdict: reproduced.**" in other


def test_identical_cells_of_a_task_are_said_once_and_all_views_have_one_scale(tmp_path):
    import rerun as rr

    study_of(MODULAR, tmp_path)
    path = write_comparison(Results(tmp_path), CLAIMS, "task-full-control")
    found = read_back(path)
    assert sorted({entity.split("/")[2] for entity in found if entity.startswith("/cells")}) == [
        "table"
    ]
    names = {
        row[0]
        for entity, columns in found.items()
        if entity.startswith("/medians")
        for _, row in columns["SeriesLines:names"]
    }
    assert names == {"table = modular-table, α = 1", "table = modular-table, α = 0.1"}
    assert "modular-table, α = 1 (in table, α = 1)" in text_of(path)
    reader = rr.chunk.RrdReader(path)
    (store,) = reader.blueprints()
    ranges = [
        str(batch[name].to_pylist())
        for chunk in reader.stream(store=store)
        for batch in [chunk.to_record_batch()]
        for name in batch.schema.names
        if name == "ScalarAxis:range"
    ]
    assert len(ranges) == 3  # of the medians and of two cells
    assert len(set(ranges)) == 1


def test_shades_of_an_architecture_go_from_dark_to_light_and_all_can_be_seen():
    cells = [f"t/table/alpha-{alpha}" for alpha in ("0.01", "1", "0.5", "0.001")]
    found = shades([*cells, "t/networks-5/alpha-1", "t/push/alpha-none", "t/random/alpha-none"])
    light = {cell: sum(colour) for cell, colour in found.items()}
    ordered = sorted(cells, key=light.__getitem__)
    assert [cell.rpartition("-")[2] for cell in ordered] == ["1", "0.5", "0.01", "0.001"]
    assert found["t/networks-5/alpha-1"] == (213, 94, 0)
    assert all(max(colour) >= VISIBLE * 0.65 for colour in found.values())
    assert len({found[cell] for cell in cells}) == 4
