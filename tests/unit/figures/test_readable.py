"""Every text of every figure can be read, every axis of steps ends with its last, and words are true."""

import json

import numpy as np
import pytest
from matplotlib.colors import to_hex, to_rgba
from matplotlib.text import Text

from upswing.analysis.colours import COLOURS, OF_LINES, OF_TEXT, contrast, of_text
from upswing.figures import draw
from upswing.figures.labels import steps_axis
from upswing.figures.style import plt
from upswing.study.paths import figure as path_of


def texts(figure):
    """What is written in a figure: the text and its colour on white."""
    figure.canvas.draw()
    for text in figure.findobj(Text):
        if text.get_text().strip() and text.get_visible():
            red, green, blue, alpha = to_rgba(text.get_color(), text.get_alpha())
            on_white = [alpha * part + 1 - alpha for part in (red, green, blue)]
            yield text.get_text(), to_hex(on_white)


def test_every_text_has_enough_contrast(drawings):
    assert len(drawings) >= 10
    for name, drawing in drawings.items():
        found = list(texts(drawing.figure))
        assert len(found) > 10, name
        assert {text: shade for text, shade in found if contrast(shade) < OF_TEXT} == {}, name


def test_every_line_has_enough_contrast():
    assert {name: shade for name, shade in COLOURS.items() if contrast(shade) < OF_LINES} == {}


def test_contrast_is_that_of_the_standard():
    assert contrast("#000000") == pytest.approx(21)
    assert contrast("#FFFFFF") == pytest.approx(1)
    assert contrast("#767676") == pytest.approx(4.54, abs=0.005)  # the lightest grey for text
    assert contrast("#0000FF", "#FFFF00") == pytest.approx(8.00, abs=0.005)


@pytest.mark.parametrize("shade", [*COLOURS.values(), "#56B4E9", "#F0E442", "#FFFFFF"])
def test_a_shade_for_text_is_the_lightest_of_its_hue_that_can_be_read(shade):
    dark = of_text(shade)
    assert contrast(dark) >= OF_TEXT
    if dark != shade:
        assert contrast(dark) < OF_TEXT + 0.2
        light, less = (np.array(to_rgba(one)[:3]) for one in (shade, dark))
        assert np.ptp(less[light > 0] / light[light > 0]) < 0.02


@pytest.mark.parametrize(
    "last", [1, 300, 5_000, 6_000, 7_000, 50_000, 12_345, 1_000_000, 5_000_000]
)
def test_the_last_tick_stands_at_the_end_of_the_axis(last):
    figure, axes = plt.subplots()
    axes.set_xlim(0, last)
    steps_axis(axes, [])
    figure.canvas.draw()
    ticks = axes.get_xticks()
    assert (ticks[0], ticks[-1]) == (0, last)
    written = axes.get_xticklabels()[-1].get_text()
    factor = {"k": 1e3, "M": 1e6}.get(written[-1], 1)
    assert float(written.rstrip("kM")) * factor == pytest.approx(last, rel=1e-3)
    plt.close(figure)


def test_axes_of_steps_end_with_their_last_tick_in_every_figure(drawings):
    found = 0
    for drawing in drawings.values():
        for axes in drawing.figure.axes:
            if axes.get_xlabel() == "step of 5 ms" and axes.get_visible():
                assert axes.get_xticks()[-1] == axes.get_xlim()[1]
                found += 1
    assert found > 10


def test_captions_say_what_to_see_and_alt_texts_the_result(study, claims, drawings):
    for name, drawing in drawings.items():
        assert "What to see: " in drawing.caption, name
        assert any(character.isdigit() for character in drawing.alt), name
    draw("fig05", study, claims)
    words = json.loads((study.folder / path_of("fig05", "json")).read_text("utf-8"))
    assert words["alt"] == drawings["fig05"].alt


def test_what_is_said_follows_the_results(study, claims, drawings):
    """With other runs in the table, other sentences: no outcome is written in the code."""
    from tests.unit.figures.conftest import drawn
    from upswing.runs.results import Results

    other = Results(study.folder)
    runs = study.runs.copy()
    balancing = runs["task"] == "balancing"
    runs.loc[balancing, "falls_last_fifth"] = 17
    runs.loc[~balancing, "upright_at_end"] = 1.0
    runs.loc[~balancing, "first_stable_step"] = 123
    other.__dict__.update(study=study.study, cells=study.cells, runs=runs)
    said = {name: drawn(name, other, claims) for name in ("fig05", "fig06", "fig08", "fig11")}
    assert (
        said["fig05"].alt == "3 of 3 tables still fall in their last fifth, in the median 17 times."
    )
    assert said["fig06"].alt.startswith(
        "Runs without a fall in the last fifth: 0 of 3 with α = 1, 0 of 3"
    )
    assert "the smaller α, the more" not in said["fig06"].caption
    assert "3 of 3 runs stand at the end" in said["fig08"].alt
    assert (
        "the first of them from step 123 on (Kaplan–Meier median: step 123)"
        in said["fig08"].caption
    )
    assert "3 of 3 runs stand at the end" in said["fig11"].alt
    for name, drawing in said.items():
        assert drawing.alt != drawings[name].alt, name
