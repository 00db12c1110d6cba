"""What is swept: readings, cells, seeds and rounds of the sweeps."""

import itertools
from pathlib import Path

import pytest

from tests.unit.analysis.small_sweeps import STUDY, loaded
from upswing.analysis.robustness.write import write_readings
from upswing.runs.study_file import canonical, write_study
from upswing.study.config import load
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.sweeps import (
    CHOOSING,
    SEEDS_OF_A_JOB,
    canonical_of,
    content_of,
    groups,
    load_sweeps,
    options_of,
    readings_of,
    specs,
)

TABLE = "balancing/table/alpha-1"


@pytest.fixture(scope="module")
def sweeps(tmp_path_factory):
    return loaded(tmp_path_factory.mktemp("sweeps"))


@pytest.fixture(scope="module")
def ours():
    """The project's own study and sweeps."""
    study = load(Path("config/config.yaml"))
    return study, load_sweeps(Path("config/readings.yaml"), study)


def test_a_grid_is_every_combination_once(sweeps):
    members = readings_of(sweeps["networks"], STUDY)
    expected = itertools.product(options_of("biases"), options_of("initial_weights"))
    assert [tuple(m.values()) for m in members] == list(expected)
    run = [m for group in groups(sweeps["networks"], STUDY) for m in group.members]
    assert run == [*members, {}]  # and once what is beside


def test_pairs_are_the_study_single_changes_and_two_at_a_time(sweeps):
    members = [m for group in groups(sweeps["tables"], STUDY) for m in group.members]
    assert len({canonical_of(m) for m in members}) == len(members)
    assert [len(m) for m in members].count(0) == 1
    singles = [m for m in members if len(m) == 1]
    assert len(singles) == 2 + 2 + 1  # first_q, reset, wrap
    pairs = [set(m) for m in members if len(m) == 2]
    assert len(pairs) == 2 * 2 + 2 * 1
    assert {"reset", "wrap"} not in pairs


def runs_of(sweep, group, overrides):
    """The seeds of each cell of a group under a reading."""
    return {spec.cell: spec.seeds for spec in specs(sweep, STUDY, overrides, group)}


def test_every_round_has_the_seeds_that_no_round_before_had(sweeps):
    sweep = sweeps["networks"]
    simple, large, modular, other = (
        "balancing/networks-5/alpha-1", "full-control/networks-30/alpha-1",
        "full-control/modular-networks-5/alpha-1", "full-control/networks-5/alpha-1",
    )  # fmt: skip
    own = {group.name: group for group in groups(sweep, STUDY)}
    first = next(iter(own))
    last = ["beside", "round-2_seeds-1002-to-1003", "round-3_seeds-1004-to-1004"]
    assert list(own)[-3:] == last
    reading = {"biases": "both", "initial_weights": 1}
    assert runs_of(sweep, own[first], reading) == {
        simple: (1000, 1001), modular: (1000, 1001), large: (1000,),
    }  # fmt: skip
    assert runs_of(sweep, own["beside"], {}) == dict.fromkeys(sweep.beside, (1000, 1001, 1002))
    # Of the large networks every third seed, counted from the first.
    assert runs_of(sweep, own[last[1]], reading) == {
        simple: (1002, 1003), modular: (1002, 1003), other: (1002, 1003), large: (1003,),
    }  # fmt: skip
    assert runs_of(sweep, own[last[2]], reading) == dict.fromkeys((simple, modular, other), (1004,))
    assert [own[name].round for name in (first, *last)] == [1, 1, 2, 3]
    assert sweep.last_seed == 1004


def test_a_long_round_is_several_jobs(ours):
    study, sweeps = ours
    sweep = sweeps["networks"]
    for number, one in enumerate(sweep.rounds, 2):
        own = [group.seeds for group in groups(sweep, study) if group.round == number]
        before = (sweep.seeds, *(other.seeds for other in sweep.rounds))[number - 2]
        first = sweep.first_seed
        assert [seed for seeds in own for seed in seeds] == list(
            range(first + before, first + one.seeds)
        )
        assert max(map(len, own)) <= SEEDS_OF_A_JOB


def test_a_costly_cell_of_singles_is_run_where_at_most_one_reading_differs(sweeps):
    sweep, costly = sweeps["tables"], "balancing/table/alpha-0.001"
    for group in groups(sweep, STUDY):
        for overrides in group.members:
            assert (costly in runs_of(sweep, group, overrides)) == (len(overrides) <= 1)


def test_the_project_s_own_sweeps_fit_its_study(ours):
    study, sweeps = ours
    assert set(sweeps) == {"networks", "tables"}
    assert CHOOSING in sweeps
    judged = {seed for spec in Matrix(study).cells.values() for seed in spec.seeds}
    for sweep in sweeps.values():
        assert sweep.seeds >= 10
        assert judged.isdisjoint(range(sweep.first_seed, sweep.last_seed + 1))
        assert {report.cell for report in sweep.reports.values()} <= set(sweep.cells)
    choosing = sweeps[CHOOSING]
    assert len(readings_of(choosing, study)) == 3 * 3 * 3 * 12
    shown = {name: (one.figure, one.shows) for name, one in choosing.reports.items()}
    assert shown == {"p7": (7, "success"), "p9": (9, "failure"), "p11": (11, "both")}
    sizes = [len(readings_of(choosing, study)), *(one.readings for one in choosing.rounds)]
    assert sizes == sorted(set(sizes), reverse=True)


def test_what_a_job_depends_on_is_in_its_checksum(sweeps):
    sweep = sweeps["networks"]
    by_round = {group.round: group for group in groups(sweep, STUDY) if group.name != "beside"}
    for group in by_round.values():

        def of(study=STUDY, swept=sweep, asked=group):
            return content_of(swept, study, asked, Matrix(study).cells)

        before = of()
        assert of(STUDY.model_copy(update={"seeds": (0, 1, 2, 3)})) == before
        assert of(STUDY.model_copy(update={"epsilon": 0.1})) != before
        readings = STUDY.readings.model_copy(update={"biases": "both"})
        # The grid fixes it anyway.
        assert of(STUDY.model_copy(update={"readings": readings})) == before
        rate = STUDY.readings.model_copy(update={"learning_rate": 0.5})
        assert of(STUDY.model_copy(update={"readings": rate})) != before
        assert of(swept=sweep.model_copy(update={"every": {}})) != before
        assert of(asked=group._replace(seeds=range(7, 9))) != before
        assert of(asked=group._replace(members=[{"biases": "both"}])) != before
        # Which rounds follow, and what the author reports, changes no run.
        assert of(swept=sweep.model_copy(update={"rounds": (), "reports": {}})) == before


NETWORKS = "networks: {vary: [biases], how: grid, seeds: 4, cells: [balancing/networks-5/alpha-1]"
REPORT = "reports: {p7: {figure: 7, cell: balancing/networks-5/alpha-1, shows: success}}"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("tables: {vary: [first_Q], how: pairs, seeds: 2, cells: [balancing/table/alpha-1]}", "did you mean 'first_q'"),
        ("tables: {vary: [ties], how: all, seeds: 2, cells: [balancing/table/alpha-1]}", "tables.how"),
        ("tables: {vary: [ties], how: grid, seeds: 0, cells: [balancing/table/alpha-1]}", "tables.seeds"),
        ("tables: {vary: [ties], how: grid, seeds: 2}", "tables.cells"),
        ("tables: {vary: [ties], without: [[ties, wrap]], how: grid, seeds: 2, cells: [balancing/table/alpha-1]}", "\"wrap\": no such reading"),
        ("- 3", "must hold keys and values"),
        (f"{NETWORKS}, rounds: [{{readings: 2, seeds: 9}}]}}", "networks.reports: missing: rounds need them"),
        (f"{NETWORKS}, {REPORT}, rounds: [{{readings: 2, seeds: 4}}]}}", "networks.rounds: [4, 4]: each round has more seeds"),
        (f"{NETWORKS}, {REPORT}, rounds: [{{readings: 0, seeds: 9}}]}}", "networks.rounds[0].readings: 0: "),
        (f"{NETWORKS}, {REPORT}, first_seed: 4294967290, rounds: [{{readings: 2, seeds: 9}}]}}", "the last is beyond"),
        (f"{NETWORKS}, {REPORT.replace('7,', '4,')}}}", "networks.reports.p7.figure: 4: "),
        (f"{NETWORKS}, {REPORT.replace('success', 'succes')}}}", "did you mean 'success'?"),
        (f"{NETWORKS}, {REPORT.replace('balancing', 'full-control')}}}", "networks.reports.p7: \"full-control/networks-5/alpha-1\": is run by no round"),
        (f"{NETWORKS}, every: {{{TABLE}: 2}}}}", f"networks.every: \"{TABLE}\": is run by no round"),
        (f"{NETWORKS}, every: {{balancing/networks-5/alpha-1: 0}}}}", "networks.every.balancing/networks-5/alpha-1: 0: "),
        (f"{NETWORKS}, beside: [balancing/table/alpha-0.7]}}", "networks.beside[0]"),
        (f"{NETWORKS}, cells_of_rounds: [balancing/table/alpha-0.7]}}", "networks.cells_of_rounds[0]"),
    ],
)  # fmt: skip
def test_bad_sweeps_are_explained(tmp_path, text, expected):
    path = tmp_path / "readings.yaml"
    path.write_text(text, "utf-8")
    with pytest.raises(BadInput) as caught:
        load_sweeps(path, STUDY)
    assert expected in str(caught.value)
    assert "readings.yaml" in str(caught.value)


def test_a_study_without_the_cells_sweeps_nothing(tmp_path):
    path = tmp_path / "readings.yaml"
    text = "a: {vary: [ties], how: grid, seeds: 1, cells: [full-control/table/alpha-1]}"
    path.write_text(text, "utf-8")
    with pytest.raises(BadInput, match="no study here has this cell"):
        load_sweeps(path, STUDY)
    (tmp_path / "config.yaml").write_text(
        "seeds: 1\ntasks: {full-control: {kind: full-control, steps: 10}}\n"
        "architectures: {table: {learner: table}}\n"
        "experiments: [{tasks: [full-control], architectures: [table], alphas: [1]}]\n",
        "utf-8",
    )
    assert load_sweeps(path, STUDY) == {}
    write_study(canonical(STUDY), tmp_path)
    with pytest.raises(BadInput, match="no sweep"):
        write_readings(tmp_path, {}, {})
