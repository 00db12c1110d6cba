"""From runs to tables."""

import numpy as np
import pandas as pd
import pytest

from tests.helpers import ARCHITECTURES
from upswing.analysis.aggregate import summarise
from upswing.runs.rows import collected
from upswing.runs.train import train
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix


@pytest.fixture
def results(tmp_path):
    """A folder with a small study that was run, and its matrix."""
    matrix = Matrix(
        validated(
            {
                "study": {
                    "seeds": 3,
                    "tasks": {"balancing": {"kind": "balancing", "steps": 1_000}},
                    "architectures": {
                        "table": ARCHITECTURES["table"],
                        "idle": ARCHITECTURES["idle"],
                    },
                    "experiments": [
                        {"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]},
                        {"tasks": ["balancing"], "architectures": ["idle"]},
                    ],
                }
            }
        )
    )
    for spec in matrix.cells.values():
        train(spec, tmp_path)
    return tmp_path, matrix


def test_one_row_for_each_run(results):
    runs = collected(results[0], results[1].cells.values())
    assert list(runs["run"]) == list(results[1].runs)
    assert runs["alpha"].isna().tolist() == [False] * 3 + [True] * 3


def test_a_missing_run_is_named(results):
    folder, matrix = results
    (folder / "runs/balancing/idle/alpha-none/seed-2.windows.parquet").unlink()
    with pytest.raises(BadInput, match=r"alpha-none/seed-2\.windows\.parquet: missing"):
        collected(folder, matrix.cells.values())


def test_a_mislabelled_run_is_caught(results):
    folder, matrix = results
    cells = folder / "runs/balancing"
    (cells / "idle/alpha-none/seed-0.windows.parquet").rename(
        cells / "table/alpha-1/seed-0.windows.parquet"
    )
    with pytest.raises(
        BadInput, match=r"table/alpha-1/seed-0\.windows\.parquet: is of another spec"
    ):
        collected(folder, matrix.cells.values())


RUNS = {
    "run": [f"balancing/table/alpha-1/seed-{seed}" for seed in range(5)],
    "task": "balancing",
    "architecture": "table",
    "alpha": 1.0,
    "steps": 100,
    "falls": [5, 4, 3, 2, 1],
    "falls_last_fifth": [0, 0, 0, 1, 2],
    "upright_share": [1.0, 0.95, 0.9, 0.5, 0.0],
    "upright_at_end": [0.9, 0.0, 0.0, 0.0, 0.95],
    "above_horizontal_share": 1.0,
    "mean_reward": np.linspace(-1, 0, 5),
    "first_stable_step": pd.array([10, 20, None, None, None], dtype="Int64"),
    "diverged_at": pd.array([None] * 5, dtype="Int64"),
    "greedy_success_share": [1.0, 0.5, 1.0, 0.0, 0.25],
    "steps_per_second": 1.0,
}


def test_a_cell_is_summed_up_over_its_runs():
    (cell,) = summarise(pd.DataFrame(RUNS)).to_dict("records")
    assert cell["runs"] == 5
    assert cell["runs_diverged"] == 0
    assert cell["runs_stable"] == 2
    assert cell["runs_without_fall_in_last_fifth"] == 3
    assert cell["runs_upright"] == 3
    assert cell["runs_upright_at_end"] == 2
    assert cell["runs_kept"] == 1  # of the two that stood, one had been stable
    assert cell["frozen_success_share"] == pytest.approx(0.55)
    assert cell["runs_frozen_all"] == 2
    assert cell["falls_median"] == 3
    assert cell["falls_p05"] == pytest.approx(1.2)
    # Most runs never became stable, and so neither did the median run.
    assert cell["first_stable_step_median"] == np.inf
    assert cell["falls_mean"] == 3
    assert cell["falls_mean_low"] < 3 < cell["falls_mean_high"]


def test_runs_that_diverged_are_counted_apart_and_nowhere_else():
    """The cell is that of the other runs; both that diverged had been stable, upright and without a fall."""
    runs = pd.DataFrame(RUNS)
    runs.loc[:1, "diverged_at"] = [50, 99]
    (cell,) = summarise(runs).to_dict("records")
    (others,) = summarise(runs.iloc[2:]).to_dict("records")
    assert (cell.pop("runs_diverged"), others.pop("runs_diverged")) == (2, 0)
    assert (cell["runs_stable"], cell["runs_kept"], cell["runs_frozen_all"]) == (0, 0, 1)
    pd.testing.assert_series_equal(pd.Series(cell), pd.Series(others))
