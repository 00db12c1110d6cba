"""Agents from elsewhere in the workflow: drawn where they must be, never trained; and the documentation's example."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from tests.paths import ROOT
from tests.workflow.small_study import BIN, as_run, surroundings
from upswing.analysis.aggregate import write_tables
from upswing.analysis.doctor import delete_orphans, examine
from upswing.runs.adopt import Asked, adopt
from upswing.runs.adopted import file_of_cell
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.runs.train import train
from upswing.study.config import validated
from upswing.study.matrix import Matrix

BLOCK = re.compile(r'^```(\w+)(?: title="(.+?)")?\n(.*?)^```$', re.MULTILINE | re.DOTALL)
AGENT = "def policy(observation):\n    return 0 if observation[1] > 0 else 2\n"
STUDY = {
    "seeds": 2,
    "tasks": {"balancing": {"kind": "balancing", "steps": 6_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]}],
}


@pytest.mark.heavy
def test_the_next_run_of_the_study_draws_it_and_trains_nothing(once, tmp_path, monkeypatch):
    study = as_run(once, tmp_path)
    monkeypatch.chdir(tmp_path)
    results = Path("results")
    page = results / "report/index.html"
    verdicts = pd.read_parquet(results / "tables/verdicts.parquet")
    Path("mine.py").write_text(AGENT, "utf-8")
    spec = adopt(results, Asked("mine.py:policy", "balancing", "mine", (0,)))
    windows = results / f"runs/{spec.run(0)}.windows.parquet"
    before = windows.stat().st_mtime_ns

    ran = study.jobs()
    assert not any(rule.startswith("train") for rule in ran)
    # Tables and what follows; figures of all cells; the comparison of its task.
    assert (ran["tables"], ran["figure"], ran["comparison"], ran["report"]) == (1, 3, 1, 1)
    assert windows.stat().st_mtime_ns == before
    assert "an agent from elsewhere, mine.py:policy" in page.read_text("utf-8")
    assert f"{spec.run(0)}" in page.read_text("utf-8")
    pd.testing.assert_frame_equal(verdicts, pd.read_parquet(results / "tables/verdicts.parquet"))
    assert examine(results, tmp_path / "config/claims.yaml").findings == []
    assert study.jobs() == {}
    assert delete_orphans(results) == []

    file_of_cell(results, spec).unlink()
    ran = study.jobs()
    assert not any(rule.startswith("train") for rule in ran)
    assert (ran["tables"], ran["figure"], ran["comparison"], ran["report"]) == (1, 3, 1, 1)
    assert "mine.py:policy" not in page.read_text("utf-8")
    assert len(delete_orphans(results)) == 4
    assert examine(results, tmp_path / "config/claims.yaml").findings == []


STAND_IN = """
class PPO:
    @classmethod
    def load(cls, path, device):
        assert open(path).read() == "learned"
        return cls()

    def predict(self, observation, deterministic):
        return (0 if observation[1] + 0.2 * observation[2] > 0 else 2), None
"""
"""In place of Stable-Baselines3: of what it has learned nothing is kept but that it balances."""


@pytest.mark.parametrize("learned", [False, pytest.param(True, marks=pytest.mark.heavy)])
def test_the_example_of_the_documentation_works_as_it_stands(learned, tmp_path):
    folder = tmp_path / "results"
    study = validated({"study": STUDY})
    write_study(canonical(study), folder)
    for spec in Matrix(study).cells.values():
        train(spec, folder)
    write_tables(folder, Matrix(study))
    blocks = BLOCK.findall((ROOT / "docs/adopt.md").read_text("utf-8"))
    for _, title, text in blocks:
        if title:
            (tmp_path / title).write_text(text, "utf-8")
    titles = [title for _, title, _ in blocks]
    assert titles[:3] == ["train_ppo.py", "ppo.py", ""]

    def run(*command):
        done = subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, check=False,
            env={**surroundings(), "PYTHONPATH": "" if learned else str(tmp_path / "beside")},
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    if learned:
        run(sys.executable, "train_ppo.py")
    else:
        (tmp_path / "beside").mkdir()
        (tmp_path / "beside/stable_baselines3.py").write_text(STAND_IN, "utf-8")
        (tmp_path / "ppo.zip").write_text("learned", "utf-8")
    (command,) = (text for kind, _, text in blocks if kind == "sh")
    program, *words = shlex.split(command)
    assert program == ".venv/bin/upswing"
    run(BIN / "upswing", *words)
    found = Results(folder)
    cell = "balancing/ppo/alpha-none"
    row = found.cell(cell).iloc[0]
    assert "stable_baselines3 " in row["origin"]
    assert row["falls_last_fifth"] == 0  # 8,000 steps are enough for it to balance
    assert set(pd.read_parquet(folder / "tables/cells.parquet")["cell"]) == set(found.cells)
    run(BIN / "upswing", "figure", "overview", "results")
    assert ">ppo<" in (folder / "figures/overview.svg").read_text("utf-8")
    assert f"{cell}/seed-0" in run(BIN / "upswing", "browse", "--print", "balancing/ppo")

    # Trained with several seeds, and made by seed.
    (tmp_path / "ppo-7.zip").write_bytes((tmp_path / "ppo.zip").read_bytes())
    asked = "from upswing.agents.elsewhere import *; print(Acting(find('by_seed.py:agent'), 7, (-10, 0, 10)).action(0.3, 0.0))"
    assert run(sys.executable, "-c", asked) == "0\n"
