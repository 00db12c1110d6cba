"""Made-up tables of prediction, in which every error is known."""

import pandas as pd

from upswing.optimal.prediction import METHODS, Limit, Row
from upswing.optimal.prediction_tables import HALF_AS_FINE, SIZE, SPREAD, VARYING
from upswing.runs.files.tables import write_table
from upswing.study.paths import PREDICTION, PREDICTION_LIMITS

PROBLEMS = ((0.7, 80), (0.9, 80), (0.9, 320))
HIDDEN = "every-visit Monte Carlo"
"""The method whose limit is far below all errors."""


def error_at_the_end(problem, method):
    """The error after all steps that is made up [rad²]."""
    return (1 + list(METHODS).index(method)) * (1 + PROBLEMS.index(problem)) / 10


def limit_of(problem, method):
    """Where a method goes [rad²]."""
    return 0.001 if method == HIDDEN else 0.9 * error_at_the_end(problem, method)


def made_up_prediction(folder):
    """Both tables in a folder of results."""
    rows = [
        Row(*problem, method, 0.5, 3.0, seeds, 50, steps, error, 0.9 * error, 1.1 * error)
        for problem in PROBLEMS
        for method in METHODS
        for seeds in ("choosing", "shown")
        for steps, error in ((100, 5.0), (10_000, error_at_the_end(problem, method)))
    ]
    beside = {SIZE: 12.34, SPREAD: 2.22, VARYING: 1.11, HALF_AS_FINE: 0.05}
    limits = [
        Limit(*problem, quantity, value)
        for problem in PROBLEMS
        for quantity, value in {
            **beside,
            **{method: limit_of(problem, method) for method in METHODS},
        }.items()
    ]
    write_table(folder / PREDICTION, pd.DataFrame(rows))
    write_table(folder / PREDICTION_LIMITS, pd.DataFrame(limits))
