"""Ten numbers of the page, other ones each time, computed again from the runs' own files."""

import secrets
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from tests.oracles import recomputed
from tests.unit.report.tables import Row, Tables, is_shown_as, numbers
from upswing.runs.study_file import read_study
from upswing.study.claims import load_claims
from upswing.study.matrix import Matrix
from upswing.study.paths import EVIDENCE_CSV, PAGE

HOW_MANY = 10


class Shown(NamedTuple):
    """A number of the page and what it must be."""

    where: str
    written: str
    computed: float


@pytest.fixture(params=["small", "thesis"])
def folder(request):
    """The results whose page is looked at: those of a small study, and of the thesis's where it was run."""
    if request.param == "small":
        return request.getfixturevalue("whole").folder
    request.getfixturevalue("thesis_page")  # skips where there is none
    return Path("results")


@pytest.fixture
def page(request, folder):
    name = "small_page" if str(folder) != "results" else "thesis_page"
    text = Path(request.getfixturevalue(name).removeprefix("file://")).read_text("utf-8")
    return Tables(text).found


def chosen(rows: list, how_many: int = HOW_MANY) -> list:
    """Some of them, others each time; a failure says the seed, and with it they are the same again."""
    seed = secrets.randbelow(1_000_000)
    print(f"chosen by default_rng({seed})")
    order = np.random.default_rng(seed).permutation(len(rows))
    return [rows[at] for at in order[:how_many]]


def wrong(shown: list[Shown]) -> list[Shown]:
    assert len(shown) >= HOW_MANY
    return [one for one in shown if not is_shown_as(one.written, one.computed)]


def test_ten_numbers_of_the_table_of_runs(folder, page):
    rows = chosen(page["The runs"])
    shown = [one for row in rows for one in _of_run(folder, row)]
    assert not wrong(chosen(shown, 30))


def _of_run(folder: Path, row: Row) -> Iterator[Shown]:
    run = recomputed.run(folder / "runs" / f"{row.name}.windows.parquet")
    percent = ("upright_share", "above_horizontal_share")
    columns = ("steps", "falls", "falls_last_fifth", *percent, "mean_reward", "first_stable_step")
    for name, text in zip(columns, row.cells[2:], strict=False):
        value = run[name] * (100 if name in percent else 1)
        if np.isnan(value):
            assert text == "–", f"{row.name}: {name}"
        else:
            yield Shown(f"{row.name}: {name}", text, value)
    yield Shown(f"{row.name}: upright at the end", row.cells[10], 100 * run["upright_at_end"])


def test_ten_numbers_of_the_table_of_cells(folder, page):
    study = read_study(folder)
    rows = [row for row in page["The cells"] if row.name.startswith("cell-")]
    assert [row.name.removeprefix("cell-") for row in rows] == list(Matrix(study).cells)
    shown = [one for row in chosen(rows, 4) for one in _of_cell(folder, study, row)]
    assert not wrong(chosen(shown))


def _of_cell(folder: Path, study, row: Row) -> Iterator[Shown]:
    cell = row.name.removeprefix("cell-")
    runs = recomputed.cell(folder, cell)
    stable = sum(not np.isnan(run["first_stable_step"]) for run in runs)
    by_falls = study.tasks[cell.partition("/")[0]].judged_by == "falls"
    succeed = sum(
        run["falls_last_fifth"] == 0 if by_falls else run["upright_at_end"] >= 0.9 for run in runs
    )
    counts = {"runs": len(runs), "succeed": succeed, "stable": stable}
    for (name, value), text in zip(counts.items(), row.cells, strict=False):
        yield Shown(f"{cell}: {name}", numbers(text)[0], value)
    spreads = {
        "falls": 1, "falls_last_fifth": 1, "upright_share": 100, "above_horizontal_share": 100, "mean_reward": 1,
    }  # fmt: skip
    for (name, factor), text in zip(spreads.items(), row.cells[4:], strict=True):
        values = factor * np.array([run[name] for run in runs])
        wanted = (np.median(values), *np.quantile(values, (0.05, 0.95))) if runs else ()
        for written, value in zip(numbers(text), wanted, strict=True):
            yield Shown(f"{cell}: {name}", written, value)


def test_ten_numbers_of_the_evidence(folder, page):
    claims = load_claims(Path("config/claims.yaml"))
    rows = {
        claim: [row for region, of in page.items() if region.startswith("Evidence") for row in of if row.claim == claim]
        for claim in claims
    }  # fmt: skip
    pool = []
    for claim, own in rows.items():
        asked = [
            (part, cells)
            for part in claims[claim].parts
            if all(
                getattr(read_study(folder).readings, key) == value
                for key, value in part.only_if.items()
            )
            for cells in part.comparisons
        ]
        assert len(own) == len(asked), claim
        pool += [(claim, *pair, row) for pair, row in zip(asked, own, strict=True)]
    there = Matrix(read_study(folder)).cells
    pool = [one for one in pool if one[2] and set(one[2]) <= there.keys()]
    shown = [one for row in chosen(pool, 12) for one in _of_evidence(folder, *row)]
    assert shown
    assert not [one for one in shown if not is_shown_as(one.written, one.computed)]
    assert (folder / EVIDENCE_CSV).exists()
    assert (folder / PAGE).exists()


def _of_evidence(folder: Path, claim, part, cells, row: Row) -> Iterator[Shown]:
    computed = recomputed.estimate(folder, part, cells)
    if computed is None:
        return
    estimate = next(text for text in row.cells if "[" in text)
    for written, value in zip(numbers(estimate), computed, strict=False):
        yield Shown(f"{claim}: {part.says}", written, value)


def test_a_number_that_is_not_so_is_found():
    assert is_shown_as("0.213", 0.21304)
    assert not is_shown_as("0.214", 0.21304)
    assert is_shown_as("−1,234", -1234.2)
    assert not is_shown_as("1,234", -1234.2)
