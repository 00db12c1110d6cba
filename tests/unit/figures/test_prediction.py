"""The figure of prediction: a line a method, where it goes, and a caption asked of the tables."""

import pandas as pd
import pytest

from tests.predicted import HIDDEN, PROBLEMS, error_at_the_end, limit_of, made_up_prediction
from upswing.figures.style import plt
from upswing.optimal.prediction import METHODS
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.study import loading
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.paths import PREDICTION, PREDICTION_LIMITS

STUDY = {
    "seeds": 1, "tasks": {"full-control": {"kind": "full-control", "steps": 1_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["full-control"], "architectures": ["table"], "alphas": [0.1]}],
}  # fmt: skip


@pytest.fixture
def results(tmp_path):
    write_study(canonical(validated({"study": STUDY})), tmp_path)
    made_up_prediction(tmp_path)
    return Results(tmp_path)


def test_each_method_has_a_line_and_a_mark_where_it_goes(results):
    drawing = loading.load("figures", "prediction").draw(results)
    panels = drawing.figure.axes
    titles = [axes.get_title() or axes.get_title(loc="left") for axes in panels]
    assert titles == ["γ = 0.7, 80 tiles", "γ = 0.9, 80 tiles", "γ = 0.9, 320 tiles"]
    for axes, problem in zip(panels, PROBLEMS, strict=True):
        lines = [line for line in axes.lines if len(line.get_xdata()) > 1]
        marks = [line for line in axes.lines if len(line.get_xdata()) == 1]
        for line, method in zip(lines, METHODS, strict=True):
            assert line.get_ydata()[-1] == pytest.approx(error_at_the_end(problem, method))
        expected = [limit_of(problem, method) for method in METHODS if method != HIDDEN]
        assert [float(mark.get_ydata()[0]) for mark in marks] == pytest.approx(expected)
        assert len({line.get_color() for line in lines}) == len(METHODS)
    (legend,) = drawing.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == list(METHODS)
    plt.close(drawing.figure)


def test_the_words_are_asked_of_the_tables(results):
    drawing = loading.load("figures", "prediction").draw(results)
    for words in (
        "the mean over 50 seeds and a band of the middle 80 %",
        "What to see with γ = 0.9, where V is of the size of 12.3 rad²",
        "(0.18 rad² off with 80 tiles, 0.27 rad² off with 320 tiles)",
        "vary by 1.11 rad², and V inside one of the 80 tiles by 2.22 rad²",
        "after 10,000 steps [rad²]: TD(0) 0.20, 4-step TD 0.40",
    ):
        assert words in drawing.caption
    assert "with γ = 0.9 and 320 tiles from 0.3 rad² (TD(0)) to 1.8 (every-visit" in drawing.alt
    plt.close(drawing.figure)


@pytest.mark.parametrize("name", [PREDICTION, PREDICTION_LIMITS])
def test_an_empty_table_says_what_makes_it(results, name):
    path = results.folder / name
    write_table(path, pd.read_parquet(path).head(0))
    with pytest.raises(BadInput, match="has no rows; `upswing prediction` makes it"):
        loading.load("figures", "prediction").draw(results)
