"""What another pendulum changes: tasks of full control that differ in a constant, held side by side."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.axes import Axes

    from upswing.analysis.outcomes import Outcome
    from upswing.analysis.over_pendulums import Differing, Line
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration("What the pendulum decides", "", ("C12", "C14", "C15"))
HEIGHT = 4.6
APART = 1.04
"""How far lines stand apart, as a factor of the constant."""


def draw(results: "Results") -> "Drawing":
    """Over the constant: runs that stand, when they are stable, arrivals too fast, and the bound."""
    import numpy as np
    import pandas as pd
    from matplotlib.ticker import LogLocator, NullFormatter

    from upswing.analysis.outcomes import outcomes
    from upswing.analysis.over_pendulums import differing, lines
    from upswing.figures import panels
    from upswing.figures.lengths import end_of
    from upswing.figures.style import WIDTH, subplots
    from upswing.physics.braking import highest_stoppable_speed
    from upswing.physics.pendulum import body_of
    from upswing.runs.success import SUCCESS
    from upswing.study.errors import BadInput

    tasks = {
        spec.task.name: spec.task
        for spec in results.cells.values()
        if spec.task.judged_by == "upright"
    }
    over = differing(tasks)
    if over is None:
        raise BadInput(
            [
                "figures: pendulums: needs two tasks of full control or more, which differ in one "
                f"constant of their pendulum; there are {', '.join(tasks) or 'none'}"
            ]
        )
    drawn = lines(results.cells, over)
    shown = [cell for line in drawn for cell in line.cells.values()]
    table = pd.concat([results.cell(cell) for cell in shown])
    found = {one.cell: one for one in outcomes(table, results.study)}
    speeds = {cell: _arriving(results, cell) for cell in shown}
    stoppable = {name: highest_stoppable_speed(body_of(tasks[name].pendulum)) for name in over.of}

    figure, axes = subplots(2, 2, figsize=(WIDTH, HEIGHT), sharex=True)
    stand, stable, too_fast, speed = axes.ravel()
    shares, times, fast, arriving = [], [], [], []
    for number, line in enumerate(drawn):
        apart = APART ** (number - (len(drawn) - 1) / 2)
        cells = line.cells
        shares.append(_line(stand, over, line, apart, {
            task: (100 * found[c].share.value, 100 * found[c].share.low, 100 * found[c].share.high)
            for task, c in cells.items()
        }))  # fmt: skip
        times.append(_line(stable, over, line, apart, {
            task: found[c].stable for task, c in cells.items()
        }))  # fmt: skip
        fast.append(_line(too_fast, over, line, apart, {
            task: (100 * one.value, 100 * one.low, 100 * one.high)
            for task, c in cells.items() if (one := found[c].too_fast) is not None
        }))  # fmt: skip
        arriving.append(_line(speed, over, line, apart, {
            task: (speeds[c],) * 3 for task, c in cells.items() if np.isfinite(speeds[c])
        }))  # fmt: skip
    speed.plot(
        list(over.of.values()), list(stoppable.values()), color="black", linewidth=1.2, marker="_"
    )
    speed.set_ylim(0, 1.15 * max([*stoppable.values(), *(s for s in speeds.values() if s == s)]))
    arriving.append((stoppable[list(over.of)[-1]], "can be stopped", "#000000"))
    for panel in (stand, too_fast):
        panel.set(ylim=(-4, 104), yticks=(0, 25, 50, 75, 100))
    stable.set_yscale("log")
    stable.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    stable.yaxis.set_major_formatter("{x:,g}")
    stable.yaxis.set_minor_formatter(NullFormatter())
    stand.set_title("Runs that stand at the end [%]")
    stable.set_title("First stable window, median [s]")
    too_fast.set_title("Arrivals too fast to be stopped, last fifth [%]")
    speed.set_title("Speed on arriving, mean of a run, median [rad/s]")
    for panel, ends in ((stand, shares), (too_fast, fast), (speed, arriving)):
        panels.label_ends(panel, [one for one in ends if one is not None])
    for panel in axes[1]:
        panel.set_xscale("log")
        panel.set_xticks(list(over.of.values()), [f"{value:g}" for value in over.of.values()])
        panel.set_xticks([], minor=True)
        panel.set_xlabel(over.words)
    said = _said(drawn, over, found, stoppable)
    caption = (
        f"Tasks of full control over the {over.name} of their pendulum. Above: the share of runs that "
        f"stand at the end (are upright for {100 * SUCCESS:.0f} % of the last "
        f"{end_of(tasks[name] for name in over.of)}) with its 95 % interval (Wilson), and the time by "
        "which half of the runs have been stable (Kaplan–Meier), where half of them ever are. Below: "
        "of all arrivals at the horizontal in the last fifth, the share that come up too fast for the "
        "strongest push to stop them (bootstrap over runs), and how fast the pendulum arrives, beside "
        "the speed up to which it can be stopped, computed from its equations. Lines stand a little "
        f"apart. What to see: {said}."
    )
    return panels.Drawing(figure, caption, [], f"{said[0].upper()}{said[1:]}.")


def _line(
    axes: "Axes", over: "Differing", line: "Line", apart: float,
    values: "Mapping[str, tuple[float, float, float]]",
) -> tuple[float, str, str] | None:  # fmt: skip
    """Draw a line through estimates with their intervals; returns where it ends, None if nowhere."""
    import numpy as np

    from upswing.analysis.colours import colour
    from upswing.figures.style import dashes, filled

    first = next(iter(line.cells.values()))
    shade = colour(first)
    known = {task: of for task, of in values.items() if np.isfinite(of[0])}
    if not known:
        return None
    x = [over.of[task] * apart for task in known]
    middle = [of[0] for of in known.values()]
    below = [max(of[0] - of[1], 0.0) if np.isfinite(of[1]) else 0.0 for of in known.values()]
    above = [max(of[2] - of[0], 0.0) if np.isfinite(of[2]) else 0.0 for of in known.values()]
    axes.errorbar(
        x, middle, yerr=[below, above], color=shade, fmt="o", linestyle=dashes(first), markersize=3.5,
        linewidth=1.4, elinewidth=1, capsize=2, markerfacecolor=shade if filled(first) else "white",
    )  # fmt: skip
    return middle[-1], line.label, shade


def _arriving(results: "Results", cell: str) -> float:
    """The median over runs of the mean speed with which one arrives at the horizontal [rad/s]."""
    values = results.counted(cell)["arrival_speed"].dropna()
    return float(values.median()) if len(values) else float("nan")


def _said(
    drawn: "Sequence[Line]", over: "Differing", found: "Mapping[str, Outcome]",
    stoppable: "Mapping[str, float]",
) -> str:  # fmt: skip
    """What came out: over the constant, what can be stopped, what is too fast, and how many stand."""
    first, *_, last = over.of
    speeds = (
        f"what can be stopped goes from {stoppable[first]:.1f} rad/s at {_at(over, first)} to "
        f"{stoppable[last]:.1f} rad/s at {_at(over, last)}"
    )
    told = [speeds]
    for line in drawn:
        counted = {task: found[cell] for task, cell in line.cells.items()}
        fast = {
            task: one.too_fast.value for task, one in counted.items() if one.too_fast is not None
        }
        words = [f"{line.label}: {_most(counted, over)}"]
        if fast:
            shares = ", ".join(f"{100 * v:.0f} % at {_at(over, task)}" for task, v in fast.items())
            words.append(f"too fast are {shares}")
        told.append("; ".join(words))
    return ". ".join(told)


def _most(counted: "Mapping[str, Outcome]", over: "Differing") -> str:
    """How many runs stand, at each value of the constant."""
    each = ", ".join(
        f"{one.succeed} of {one.runs} at {_at(over, task)}" for task, one in counted.items()
    )
    return f"stand at the end {each}"


def _at(over: "Differing", task: str) -> str:
    return f"{over.of[task]:g} {over.unit}"
