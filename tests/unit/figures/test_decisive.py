"""What decides a claim, drawn: the numbers of the verdicts, the runs behind them, and no other claim's."""

from types import SimpleNamespace

import numpy as np
import pytest

from upswing.figures import FIGURES, claims_of
from upswing.figures.decided import decided
from upswing.figures.decisive import draw, height
from upswing.figures.measures import axis_of, threshold_of
from upswing.figures.style import plt, stacks_and_panels
from upswing.report.targets import Targets
from upswing.runs.files.tables import read_evidence
from upswing.study.claims import Claim
from upswing.study.paths import TILES

OF_THE_THESIS = [name for name in FIGURES if FIGURES[name].number]
NUMBERS = ["estimate", "low", "high", "n", "method"]


@pytest.fixture(scope="module", params=OF_THE_THESIS)
def shown(request, study, claims):
    """Of a figure what decides its claims, and it drawn."""
    found, lacking = decided(study, claims_of(request.param, claims), FIGURES[request.param].beside)
    stacked = stacks_and_panels(1, 1, below=height(found))
    drawn = draw(stacked.figure, stacked.below, found, study)
    plt.close(stacked.figure)
    return SimpleNamespace(name=request.param, found=found, lacking=lacking, drawn=drawn)


def test_every_claim_with_a_figure_is_shown_there(claims):
    shown = [claim for name in OF_THE_THESIS for claim in claims_of(name, claims)]
    assert sorted(shown) == sorted(name for name, claim in claims.items() if claim.figure)
    for name in OF_THE_THESIS:
        assert set(claims_of(name, claims)) <= set(FIGURES[name].claims)


def test_the_numbers_are_those_of_the_table_of_evidence(shown, study, claims):
    table = read_evidence(study.folder)
    own = table[table["claim"].isin(list(claims_of(shown.name, claims)))]
    there = own[own["verdict"] != "not in this study"]
    assert len(there) == sum(len(one.evidence) for one in shown.found) > 0
    assert sorted(set(own["claim"][own["verdict"] == "not in this study"])) == sorted(shown.lacking)
    expected = list(there[NUMBERS].itertuples(index=False, name=None))
    found = [tuple(row.estimate) for one in shown.found for row in one.rows if not row.beside]
    np.testing.assert_equal(found, expected)


def test_what_is_drawn_is_these_numbers(shown):
    for one, panel in zip(shown.found, shown.drawn, strict=True):
        part = one.part
        at = [line.get_xdata()[0] for line in panel.strip.lines if line.get_marker() != "o"]
        assert at == [part.threshold, part.partly]
        (side,) = [patch.get_x() for patch in panel.strip.patches]
        assert (side == part.threshold) == part.is_lower
        known = [row.estimate for row in one.rows if np.isfinite(row.estimate[:3]).all()]
        dots = [line.get_xdata()[0] for line in panel.strip.lines if line.get_marker() == "o"]
        assert dots == [estimate.value for estimate in known]
        bars = [tuple(lines.get_segments()[0][:, 0]) for lines in panel.strip.collections]
        assert bars == [(estimate.low, estimate.high) for estimate in known]
        low, high = sorted(panel.strip.get_xlim())
        for value in (part.threshold, part.partly, *dots, *(x for bar in bars for x in bar)):
            assert low <= value <= high
        for row, text in zip(one.rows, panel.texts, strict=True):
            if row.estimate in known:
                value, interval = text.replace("−", "-").split(" ", 1)
                assert abs(float(value) - row.estimate.value) <= 0.005
                ends = [float(end) for end in interval.strip("[]").split(",")]
                np.testing.assert_allclose(ends, row.estimate[1:3], atol=0.0051)


def test_the_dots_beyond_the_line_are_the_share(shown):
    """A run is on the side of the line on which it is counted, and the estimate counts them."""
    for one in shown.found:
        if one.part.kind != "share":
            continue
        line, scale = threshold_of(one.part).at, axis_of(one.part).factor
        (bound,) = one.part.where.values()
        for row in one.rows:
            (dots,) = row.dots
            beyond = np.sign(scale * dots.values - line)
            counted = (beyond >= 0) if bound.at_least is not None else (beyond < 0)
            n = row.estimate.n
            assert counted.sum() == (round(row.estimate.value * n) if n else 0)
            assert len(dots.seeds) == len(dots.values) >= n


def test_a_share_of_another_step_size_stands_beside_it_and_is_none_of_the_evidence(study, claims):
    found, _ = decided(study, claims_of("fig06", claims), FIGURES["fig06"].beside)
    (of_networks,) = [one for one in found if one.claim == "C6" and one.part.kind == "share"]
    assert [row.dots[0].cell for row in of_networks.rows if row.beside] == [
        "balancing/networks-5/alpha-0.5"
    ]
    assert len(of_networks.evidence) == 1


def test_claims_that_lack_cells_are_named_in_the_caption(study, claims, drawings):
    assert "Of C8 this study has not all cells" in drawings["fig08"].caption
    assert "has not all cells" not in drawings["fig05"].caption
    assert "has not all cells" in drawings["fig06"].caption  # C6 asks for α = 0.1


def targets(study, claims):
    return Targets(study.study, claims, {})


def test_a_figure_depends_on_its_own_claims_and_on_no_other(study, claims):
    before = targets(study, claims)
    part = claims["C2"].parts[0].model_copy(update={"at_least": 0.81})
    edited = claims["C2"].model_copy(update={"parts": (part,)})
    after = targets(study, {**claims, "C2": Claim.model_validate(edited.model_dump())})
    changed = [
        name for name in FIGURES if before.words_of_figure(name) != after.words_of_figure(name)
    ]
    assert changed == ["fig05"]


def test_a_figure_depends_on_the_cells_that_its_claims_name_and_the_study_has(study, claims):
    files = targets(study, claims)
    assert files.cells_of_figure("fig05") == ["balancing/table/alpha-1", "balancing/random/alpha-none"]  # fmt: skip
    assert "balancing/networks-5/alpha-0.5" in files.cells_of_figure("fig06")
    of_fig08 = files.cells_of_figure("fig08")
    assert {"full-control/table/alpha-0.01", "full-control-long/table/alpha-0.001"} < set(of_fig08)
    assert set(of_fig08) < set(study.cells)
    assert any(path.endswith(TILES) for path in files.of_figure("fig08"))
    assert not any(path.endswith(TILES) for path in files.of_figure("fig05"))


def test_a_figure_of_ones_own_decides_nothing(study, claims):
    assert targets(study, claims).words_of_figure("overview") == ""
    assert claims_of("overview", claims) == {}
