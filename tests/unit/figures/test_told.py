"""Sentences made of results that have little or nothing in them."""

import pytest

from upswing.figures import learning_curves, overview, success_share, told
from upswing.figures.success_share import Share

NONE = Share(float("nan"), float("nan"), float("nan"), 0, 0)
CELLS = {
    "balancing/networks-5/alpha-1": NONE,
    "balancing/networks-5/alpha-0.5": Share(20.0, 5.0, 50.0, 2, 10),
    "balancing/networks-5/alpha-0.1": Share(70.0, 40.0, 90.0, 7, 10),
}
ALPHAS = {1.0: "balancing/networks-5/alpha-1", 0.5: "balancing/networks-5/alpha-0.5",
          0.1: "balancing/networks-5/alpha-0.1"}  # fmt: skip


@pytest.fixture(autouse=True)
def shares(monkeypatch):
    for module in (told, success_share):
        monkeypatch.setattr(module, "share", lambda _, cell: CELLS[cell])


def test_a_cell_of_which_every_run_diverged_is_passed_over():
    words = told.over_alpha(None, "balancing", "networks-5", ALPHAS)
    assert "20 % to 70 % of runs succeed, most with α = 0.1" in words
    first = {alpha: cell for alpha, cell in ALPHAS.items() if alpha == 1}
    assert told.over_alpha(None, "balancing", "networks-5", first) == (
        "of networks-5 (balancing) every run diverged"
    )


def test_it_is_never_the_best():
    assert "at best 7 of 10 with" in overview._best(None, "balancing", list(CELLS))
    worst = [learning_curves._succeeds(None, cell) for cell in CELLS]
    assert worst == [-1.0, 20.0, 70.0]
