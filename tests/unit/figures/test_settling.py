"""The figure of how value and policy settle: a line a method, and a caption asked of the table."""

import pandas as pd
import pytest

from upswing.figures.style import plt
from upswing.optimal.settling import GENERALIZED, METHODS, POLICY_ITERATION, VALUE_ITERATION, Row
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.study import loading
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.paths import SETTLING

STUDY = {
    "seeds": 1, "tasks": {"full-control": {"kind": "full-control", "steps": 1_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["full-control"], "architectures": ["table"], "alphas": [0.1]}],
}  # fmt: skip
ENDS = {VALUE_ITERATION: 1_200, GENERALIZED: 500, POLICY_ITERATION: 6_700}


@pytest.fixture
def results(tmp_path):
    write_study(canonical(validated({"study": STUDY})), tmp_path)
    rows = [
        Row(method, discount, round(end * part), n, 10.0 ** (2 - 8 * part), 0.5 * (1 - part) ** 2)
        for discount in (0.7, 0.97)
        for method, end in ENDS.items()
        for n, part in enumerate((0.01, 0.5, 0.9, 1.0))
    ]
    write_table(tmp_path / SETTLING, pd.DataFrame(rows))
    return Results(tmp_path)


def test_each_method_has_a_line_for_each_discount(results):
    drawing = loading.load("figures", "settling").draw(results)
    panels = drawing.figure.axes
    assert [axes.get_title() or axes.get_title(loc="left") for axes in panels[:2]] == [
        "γ = 0.7",
        "γ = 0.97",
    ]
    assert [len(axes.lines) for axes in panels] == [len(METHODS)] * 4
    for line, method in zip(panels[0].lines, METHODS, strict=True):
        assert line.get_xdata()[-1] == ENDS[method]
    (legend,) = drawing.figure.legends
    assert [text.get_text() for text in legend.get_texts()] == list(METHODS)
    assert (
        f"{GENERALIZED}, 500; {VALUE_ITERATION}, 1,200; {POLICY_ITERATION}, 6,700"
        in drawing.caption
    )
    assert "after 1,080 of the sweeps of value iteration, 99.5 % of the states" in drawing.caption
    assert drawing.alt.startswith(f"With γ = 0.97, {GENERALIZED} needs 500 sweeps")
    plt.close(drawing.figure)


def test_an_empty_table_says_what_makes_it(results):
    path = results.folder / SETTLING
    write_table(path, pd.read_parquet(path).head(0))
    with pytest.raises(BadInput, match="has no rows; `upswing settling` makes it"):
        loading.load("figures", "settling").draw(results)
