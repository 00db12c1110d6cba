"""What the page's script is given: places held against the SVG, estimates against the table of cells."""

import base64
import json
import shutil
from xml.etree import ElementTree as ET

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from upswing.figures.interaction import Alone, Curves, Dots, described, remember
from upswing.report.interactive import embedded, endings, panels_of, shown_figures
from upswing.report.step_size_numbers import step_size_numbers
from upswing.runs.results import Results
from upswing.study import paths
from upswing.study.errors import BadInput

CELL = "balancing/table/alpha-1"


def unpacked(text, kind):
    return np.frombuffer(base64.b64decode(text), kind).astype(float)


def drawn(figure, path):
    figure.savefig(path, format="svg")
    return ET.parse(path).getroot()  # noqa: S314  our own


def uses(root):
    """Where markers stand in an SVG."""
    found = [one for one in root.iter() if one.tag.endswith("}use") and one.get("x")]
    return np.array([(float(one.get("x")), float(one.get("y"))) for one in found])


@pytest.mark.parametrize("scale", ["linear", "symlog"])
def test_dots_are_where_they_are_drawn(tmp_path, scale):
    figure = Figure(figsize=(5, 3), layout="constrained")
    above, axes = figure.subplots(2, 1)
    above.set_title("another")
    x, y = np.array([0.0, 3.0, 40.0, 200.0]), np.array([0.0, 1.0, 0.5, 0.25])
    axes.plot(x, y, "o", gid="dots")
    axes.set_xscale(scale)
    remember(axes, Dots(CELL, [3, 4, 5, 9], x, y))
    root = drawn(figure, tmp_path / "a.svg")
    group = next(one for one in root.iter() if one.get("id") == "dots")
    (panel,) = described(figure)
    (runs,) = panel["runs"]
    assert runs["seeds"] == [[3, 5], [9, 9]]
    left, top, width, height = panel["box"]
    across = left + width * unpacked(runs["x"], "<u2") / 65_535
    down = top + height * (1 - unpacked(runs["y"], "<u2") / 65_535)
    assert np.abs(uses(group) - np.stack([across, down], axis=1)).max() < 0.1  # a tenth of a point


def test_lines_are_where_they_are_drawn_and_end_where_they_end(tmp_path):
    figure = Figure(figsize=(5, 3), layout="constrained")
    axes = figure.subplots()
    x = np.arange(1_000.0)
    y = np.stack([np.sqrt(x), 0.03 * x, np.where(x < 500, x / 20, np.nan)])
    axes.plot(x[::10], y[1, ::10], "o", gid="second")
    axes.plot(x, y.T)
    axes.set_xlim(0, 800)
    remember(axes, Curves(CELL, [7, 8, 9], x, y))
    remember(axes, Alone(CELL, 7))
    root = drawn(figure, tmp_path / "a.svg")
    (panel,) = described(figure)
    curves, alone = panel["runs"]
    assert (alone["kind"], alone["seeds"]) == ("alone", [[7, 7]])
    left, top, width, height = panel["box"]
    across = left + width * unpacked(curves["x"], "<u2") / 65_535
    heights = unpacked(curves["y"], "<u1").reshape(3, -1)
    assert heights.shape[1] <= 100
    assert (heights[:2] < 255).all()  # two runs reach the end of the panel …
    assert (heights[2] == 255).mean() == pytest.approx(300 / 800, abs=0.02)  # … and one does not
    placed = uses(next(one for one in root.iter() if one.get("id") == "second"))
    placed = placed[placed[:, 0] <= left + width]
    down = np.interp(placed[:, 0], across, top + height * (1 - heights[1] / 254))
    assert np.abs(down - placed[:, 1]).max() < height / 254


def test_a_figure_that_remembers_nothing_has_no_panels(tmp_path):
    figure = Figure()
    figure.subplots()
    drawn(figure, tmp_path / "a.svg")
    assert described(figure) == []


GOOD = {"kind": "dots", "cell": CELL, "seeds": [[0, 1]], "x": "AAAAAA==", "y": "AAAAAA=="}


def given(**changed):
    return {"panels": [{"box": [0, 0, 9, 9], "runs": [{**GOOD, **changed}]}]}


def test_what_a_figure_says_is_taken(tmp_path):
    (panel,) = panels_of(given(), tmp_path / "a.json", "fig05")
    assert panel["runs"][0]["seeds"] == ((0, 1),)
    assert panels_of({}, tmp_path / "a.json", "fig05") == []


@pytest.mark.parametrize(
    "words",
    [
        {"panels": "none"},
        {"panels": [{"box": [0, 0, 9], "runs": []}]},
        given(seeds=[[0, 10**12]]),
        given(seeds=[[1, 0]]),
        given(kind="spirals"),
        given(x="<script>"),
        given(x="AAAA"),
        given(cell="</script><script>alert(1)</script>"),
        given(more=1),
    ],
)
def test_what_no_figure_says_is_refused(tmp_path, words):
    with pytest.raises(BadInput, match=r"a\.json: panels: .*upswing figure fig05"):
        panels_of(words, tmp_path / "a.json", "fig05")


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"title": 1}'])
def test_words_that_no_figure_has_are_refused(results, tmp_path, text):
    shutil.copy(results.folder / "study.json", tmp_path)
    path = tmp_path / paths.figure("overview", "json")
    path.parent.mkdir()
    path.write_text(text, "utf-8")
    with pytest.raises(BadInput, match=r"overview\.json: .*upswing figure overview"):
        shown_figures(tmp_path)


def test_data_cannot_end_the_element_that_holds_them(results):
    text = embedded([{"name": "</script><!--", "panels": [1]}], {}, results.study)
    assert "<" not in text
    assert json.loads(text)["figures"] == {"</script><!--": [1]}


def test_how_runs_end_is_said_of_each(results):
    ends = endings(results.runs, results.study)
    for row in results.runs.to_dict("records"):
        if row["task"] == "balancing":
            assert ends[row["run"]] == ("falls" if row["falls_last_fifth"] else "balances")
        else:
            assert ends[row["run"]] == (
                "stands" if row["upright_at_end"] >= 0.9 else "does not stand"
            )
    lost = results.runs.assign(diverged_at=pd.array([5] * len(results.runs), "Int64"))
    assert set(endings(lost, results.study).values()) == {"diverged"}


def test_step_sizes_are_those_of_the_table_of_cells(results):
    folder = Results(results.folder)
    cells = pd.read_parquet(results.folder / "tables/cells.parquet")
    found = step_size_numbers(cells.to_dict("records"), folder.study)
    (task,) = found["tasks"]  # full control has one step size
    assert task["task"] == "balancing"
    (line,) = task["lines"]
    assert (line["name"], line["alphas"]) == ("table", [0.1, 1.0])
    own = cells[(cells["task"] == "balancing") & (cells["architecture"] == "table")].sort_values(
        "alpha"
    )
    for label, columns, factor in (
        ("falls", ["falls_mean", "falls_mean_low", "falls_mean_high"], 1),
        (
            "cost in the last fifth (mean of φ²)",
            ["mean_reward_mean", "mean_reward_mean_high", "mean_reward_mean_low"],
            -1,
        ),
    ):
        assert np.allclose(line["values"][label], factor * own[columns].to_numpy(), rtol=1e-5)
    assert not np.any(np.isinf(np.array(line["values"]["steps to the first stable window"], float)))
