"""What the step size decides, in other measures than successes: numbers for the page's script."""

from math import isfinite
from typing import Any, NamedTuple

from upswing.analysis import statistics
from upswing.analysis.colours import colour, name_of, of_text
from upswing.study.config import Study

Row = dict[str, Any]
Interval = list[float | None]
"""An estimate and its 95 % interval; ``None`` for what is unknown or infinite."""


class Measure(NamedTuple):
    """One measure over the step size, of the table of cells."""

    label: str  # where it is chosen
    axis: str  # over a panel
    columns: tuple[str, ...]  # the estimate and the ends of its interval, or a number of runs
    factor: float = 1.0
    judged_by: str | None = None  # the only tasks that it is of; None for all


def _mean(stem: str) -> tuple[str, ...]:
    return f"{stem}_mean", f"{stem}_mean_low", f"{stem}_mean_high"


SUCCEED = "runs that succeed (the figure as it is)"
FALLS_AT_END = "runs_without_fall_in_last_fifth"
STABLE = tuple(f"first_stable_step_{name}" for name in ("median", "low", "high"))
MEASURES = (
    Measure(SUCCEED, "runs without a fall in the last fifth [%]", (FALLS_AT_END,), 1, "falls"),
    Measure(SUCCEED, "runs that stand at the end [%]", ("runs_upright_at_end",), 1, "upright"),
    Measure("falls", "falls, mean over runs", _mean("falls"), 1, "falls"),
    Measure(
        "falls in the last fifth", "falls in the last fifth, mean", _mean("falls_last_fifth"), 1, "falls"
    ),
    Measure(
        "upright steps in the last fifth", "upright in the last fifth, mean [% of steps]",
        _mean("upright_share"), 100,
    ),
    Measure(
        "cost in the last fifth (mean of φ²)", "mean of φ² in the last fifth [rad²]",
        _mean("mean_reward"), -1,
    ),
    Measure("steps to the first stable window", "first stable step, median over runs", STABLE),
    Measure(
        "runs whose frozen policy succeeds from every start", "runs that succeed frozen, everywhere [%]",
        ("runs_frozen_all",),
    ),
    Measure(
        "starts from which the frozen policy succeeds", "starts from which it succeeds frozen [%]",
        ("frozen_success_share",), 100,
    ),
)  # fmt: skip
"""A measure of the same label is one choice."""


def step_size_numbers(cells: list[Row], study: Study) -> Row:
    """The estimates of every measure for every step size, by task and architecture.

    Args:
        cells: the rows of the table of cells.
        study: whose cells they are.
    """
    lines: dict[tuple[str, str], list[Row]] = {}
    for row in cells:
        if row["alpha"] is not None and isfinite(row["alpha"]) and row["task"] in study.tasks:
            lines.setdefault((row["task"], row["architecture"]), []).append(row)
    tasks = []
    for task in dict.fromkeys(task for task, _ in lines):
        own = {name: of for (where, name), of in lines.items() if where == task}
        if max(map(len, own.values())) < 2:  # nothing is drawn over one step size
            continue
        judged_by = study.tasks[task].judged_by
        measures = [one for one in MEASURES if one.judged_by in (None, judged_by)]
        tasks.append(
            {
                "task": task,
                "axes": {one.label: one.axis for one in measures},
                "lines": [
                    {
                        "name": name_of(name),
                        "modular": name in study.architectures
                        and study.architectures[name].is_modular,
                        "colour": colour(of[0]["cell"]),
                        "text": of_text(colour(of[0]["cell"])),
                        "alphas": [row["alpha"] for row in ordered],
                        "values": {
                            one.label: [_estimate(row, one) for row in ordered] for one in measures
                        },
                    }
                    for name, of in own.items()
                    for ordered in [sorted(of, key=lambda row: float(row["alpha"]))]
                ],
            }
        )
    return {"labels": list(dict.fromkeys(one.label for one in MEASURES)), "tasks": tasks[:2]}


def _estimate(row: Row, measure: Measure) -> Interval:
    value, *ends = (row.get(column) for column in measure.columns)
    if value is None:
        return [None, None, None]
    if measure.columns[0].startswith("runs_"):
        found = statistics.share(int(value), int(row["runs"]))
        return [_known(end, 100) for end in (found.value, found.low, found.high)]
    ends = ends if measure.factor > 0 else ends[::-1]
    return [_known(end, measure.factor) for end in (value, *(ends or (None, None)))]


def _known(value: float | None, factor: float = 1.0) -> float | None:
    """A finite number to six digits, which is more than a picture shows."""
    if value is None or not isfinite(value):
        return None
    return float(f"{factor * value:.6g}")
