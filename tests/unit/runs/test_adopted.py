"""Agents from elsewhere: their runs are those of the study's own loop, and stand beside its own."""

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from safetensors.numpy import load_file

from tests.unit.runs.adopting import (  # noqa: F401  two are fixtures
    STUDY,
    adopted,
    asked,
    copied_results,
    small_study,
)
from upswing.analysis.aggregate import write_tables
from upswing.analysis.doctor import delete_orphans, examine
from upswing.analysis.verdicts import write_verdicts
from upswing.cli.commands.workflow import train as train_again
from upswing.figures import draw
from upswing.physics.pendulum import Pendulum
from upswing.recordings.catalog import catalog
from upswing.recordings.ports import free_port
from upswing.recordings.run_filter import select
from upswing.runs.adopt import adopt
from upswing.runs.adopted import declared, file_of_cell, joined
from upswing.runs.files.tables import read_cells
from upswing.runs.learned import learned_by
from upswing.runs.results import OwnRuns, Results
from upswing.runs.study_file import canonical, read_study, write_study
from upswing.study.architecture import architecture_named
from upswing.study.claims import load_claims
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.spec import parse


@pytest.mark.parametrize("task", STUDY["tasks"])
def test_its_runs_are_what_the_studys_loop_makes_of_the_same_behaviour(results, task):
    adopted(results, "hard" if task == "five" else "push", task, seeds=(3, 4))
    runs = Results(results).runs.set_index("run")
    ours = runs.loc[[f"{task}/push/alpha-none/seed-{seed}" for seed in (3, 4)]]
    theirs = runs.loc[[f"{task}/mine/alpha-none/seed-{seed}" for seed in (3, 4)]]
    assert list(ours["digest"]) == list(theirs["digest"])  # of all steps and windows
    what = ["architecture", "seconds", "steps_per_second", "recording", "spec", "origin", "cell"]
    pd.testing.assert_frame_equal(
        ours.drop(columns=what).reset_index(drop=True),
        theirs.drop(columns=what).reset_index(drop=True),
    )


def test_it_stands_in_tables_figures_and_catalog_with_its_origin(results):
    Path("weights.zip").write_bytes(b"weights")
    spec = adopted(results, "lean", seeds=(4, 3), reads=[Path("weights.zip")])
    found = Results(results)
    row = found.cell(spec.cell).iloc[0]
    assert row["origin"] == f"adopted: agents.py:lean (numpy {np.__version__})"
    assert set(found.cell("balancing/push/alpha-none")["origin"]) == {"study"}
    said = json.loads(row["spec"])["architecture"]
    assert set(said["checksums"]) == {"agents.py", "weights.zip"}
    assert row["greedy_success_share"] == 1.0
    assert row["falls"] == 0
    cells = read_cells(results, found.cells).set_index("cell")
    assert cells.loc[spec.cell, "runs_without_fall_in_last_fifth"] == 2
    draw("overview", OwnRuns(results))
    picture = (results / "figures/overview.svg").read_text("utf-8")
    assert ">mine<" in picture
    runs = select(found, ["architecture=mine"])
    assert list(runs["seed"]) == [3, 4]
    for name in ("rrd", "trajectory.parquet", "weights.safetensors", "windows.parquet"):
        assert (results / f"runs/{spec.run(3)}.{name}").is_file()
    named = [str(one.path) for one in examine(results).findings]
    assert not [path for path in named if "verdicts" not in path and "evidence" not in path]
    assert examine(results).orphans == []


def test_the_catalog_serves_it(results):
    adopted(results, "lean")
    found = Results(results)
    with catalog(found, found.runs[found.runs["task"] == "balancing"], free_port()) as served:
        assert served.runs == 5


def test_no_verdict_changes(results):
    claims = load_claims(Path(__file__).parents[3] / "config/claims.yaml")
    before = write_verdicts(OwnRuns(results), claims, {})
    adopted(results, "lean")
    after = write_verdicts(OwnRuns(results), claims, {})
    pd.testing.assert_frame_equal(before, after)
    assert (before["verdict"] != "not in this study").any()


def test_what_remembers_is_told_where_an_episode_begins(results):
    adopted(results, "hold", seeds=(3, 4))
    made = sys.modules["upswing_agent_agents"].MADE
    assert [one.seed for one in made] == [3, 3, 4]  # once to try it
    rows = Results(results).cell("balancing/mine/alpha-none")
    for agent, falls in zip(made[1:], rows["falls"], strict=True):
        map_of_it, episodes = agent.begun[: 120 * 120], agent.begun[120 * 120 :]
        assert set(map_of_it) == {1}
        # The run, an episode more for every fall, and the nine starts of the greedy evaluation.
        assert sum(episodes) == 3_000 + 9 * 2_000
        assert len(episodes) >= 1 + falls + 9


def test_reading_a_run_back_runs_no_code_and_follows_the_map(results):
    spec = adopted(results, "lean")
    Path("was-run").unlink()
    learned = learned_by(results, spec.run(3))
    states = np.random.default_rng(0).uniform(-1, 1, (200, 2)) * [np.pi / 2, 20.0]
    lean = np.sin(states[:, 0]) + 0.1 * states[:, 1]
    clear = np.abs(lean) > 0.1  # further from where it changes its mind than the parts are wide
    pushes = learned.policy(states[:, 0], states[:, 1])
    assert (pushes[clear] == np.where(lean > 0, *Pendulum().accelerations[::2])[clear]).all()
    trajectory = learned.simulate(0.1, steps=2_000)
    assert not trajectory.reset.any()
    with pytest.raises(BadInput, match="`upswing adopt` runs it"):
        train_again([spec.of_seed(3).canonical()], results)
    assert not Path("was-run").exists()


def test_the_map_has_the_agents_action_in_the_middle_of_each_part(results):
    spec = adopted(results, "lean", "full-control")
    actions = load_file(results / f"runs/{spec.run(3)}.weights.safetensors")["actions"]
    middles = (np.arange(120) + 0.5) / 60 - 1
    angle, velocity = np.meshgrid(middles * np.pi, middles * 20.0, indexing="ij")
    expected = np.where(np.sin(angle) + 0.1 * velocity > 0, 0, 2)
    assert (actions == expected).mean() > 0.999  # on the line itself it is a matter of rounding


def test_it_has_the_actions_of_its_task(results):
    spec = adopted(results, "grade", "five")
    learned = learned_by(results, spec.run(3))
    actions = load_file(results / f"runs/{spec.run(3)}.weights.safetensors")["actions"]
    assert set(actions.ravel()) == set(range(5))
    middles = (np.arange(120) + 0.5) / 60 - 1
    angle, velocity = np.meshgrid(middles * np.pi, middles * 30.0, indexing="ij")  # its own tiles
    expected = np.clip(np.round(2 - 2 * (np.sin(angle) + 0.1 * velocity)), 0, 4)
    assert (actions == expected).mean() > 0.999
    pushes = learned.policy(angle.ravel(), velocity.ravel())
    assert (pushes == np.array([-20, -10, 0, 10, 20])[actions.ravel()]).all()
    trajectory = Results(results).trajectory(spec.run(3))
    assert trajectory["action"].max() == 4
    assert trajectory["cart_position"].abs().max() <= 2.0
    assert np.radians(45) <= trajectory["angle"].iloc[0] <= np.radians(135)


def test_more_seeds_join_and_another_agent_is_refused(results):
    adopted(results, "lean", seeds=(3,))
    spec = adopted(results, "lean", seeds=(4,))
    assert spec.seeds == (3, 4)
    assert len(Results(results).cell(spec.cell)) == 2
    with pytest.raises(BadInput, match="name: mine: is in results already, another agent"):
        adopt(results, asked("push"))
    agents = Path("agents.py")
    agents.write_text(agents.read_text("utf-8") + "\n# another state of it\n", "utf-8")
    with pytest.raises(BadInput, match="another state of it"):
        adopt(results, asked("lean"))
    adopt(results, asked("lean", "full-control"))  # of another task
    assert [one.cell for one in declared(results)] == [
        "balancing/mine/alpha-none", "full-control/mine/alpha-none",
    ]  # fmt: skip


def test_without_its_file_its_runs_are_orphans(results):
    spec = adopted(results, "lean")
    assert delete_orphans(results) == []
    file_of_cell(results, spec).unlink()
    with pytest.raises(BadInput, match="is no run of this study"):
        _ = Results(results).runs
    write_tables(results, joined(results))
    assert spec.cell not in Results(results).runs["cell"].to_numpy()
    assert len(delete_orphans(results)) == 4
    assert not (results / "checksums/runs/balancing/mine").exists()


def test_what_was_adopted_into_another_study_is_left_out_and_kept(results):
    spec = adopted(results, "lean")
    longer = {
        **STUDY,
        "tasks": {**STUDY["tasks"], "balancing": {"kind": "balancing", "steps": 4_000}},
    }
    write_study(canonical(validated({"study": longer})), results)
    there = joined(results)
    assert (there.adopted, [one.cell for one in there.left_out]) == ((), [spec.cell])
    assert [path for path in examine(results).orphans if "mine" in str(path)] == []
    assert any(note.startswith(f"{spec.cell}: was adopted when") for note in examine(results).notes)
    again = adopt(results, asked("lean", seeds=(4,)))
    assert (again.task.steps, again.seeds) == (4_000, (4,))
    assert [one.cell for one in joined(results).adopted] == [spec.cell]
    # A reading of the networks changes nothing of what an agent does.
    other = {**longer, "readings": {"learning_rate": 0.2}}
    write_study(canonical(validated({"study": other})), results)
    assert joined(results).left_out == ()
    write_study(canonical(validated({"study": {**other, "readings": {"reset": "reset"}}})), results)
    assert len(joined(results).left_out) == 1


def test_a_damaged_file_of_an_adopted_cell_is_named(results):
    spec = adopted(results, "lean")
    path = file_of_cell(results, spec)
    text = path.read_text("utf-8")
    table = canonical(read_study(results))
    for wrong, said in (
        ("{", "is not JSON"),
        (text.replace('"agent":"agents.py:lean",', ""), "agent: missing"),
        (text.replace('"name":"mine"', '"name":"other"'), "is of balancing/other/alpha-none"),
        (table, "unknown key"),
    ):
        path.write_text(wrong, "utf-8")
        with pytest.raises(BadInput, match=f"adopted/balancing/mine.json: .*{said}"):
            joined(results)
    own = next(iter(Matrix(read_study(results)).cells.values()))
    path.write_text(own.canonical(), "utf-8")
    with pytest.raises(BadInput, match="is of no adopted agent but of a table"):
        joined(results)


def test_a_configuration_cannot_name_one():
    mine = {"learner": "adopted", "coding": "continuous", "agent": "agents.py:lean"}
    study = {**STUDY, "architectures": {**STUDY["architectures"], "mine": mine}}
    with pytest.raises(BadInput, match=r"mine.learner: .*joins a study by `upswing adopt`"):
        validated({"study": study})
    assert architecture_named("mine", **mine).in_words().endswith("agents.py:lean")


def test_a_specification_of_one_is_read_back_as_it_was_written(results):
    spec = adopted(results, "lean", seeds=(3, 4))
    assert declared(results) == [parse(spec.canonical())]
    assert parse(spec.canonical()).canonical() == spec.canonical()
