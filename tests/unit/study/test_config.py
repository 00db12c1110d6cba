"""What the user may write, and what is said of anything else."""

import json
from copy import deepcopy

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from tests.paths import ROOT
from upswing.study.config import from_snakemake, load, validated
from upswing.study.errors import BadInput
from upswing.study.json_schema import schema
from upswing.study.key_reference import reference
from upswing.study.matrix import Matrix
from upswing.study.names import alpha_text
from upswing.study.readings import Readings
from upswing.study.spec import parse
from upswing.study.yaml_file import read_yaml

STUDY = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))
TABLES, CONTROLS = (
    next(
        number
        for number, one in enumerate(STUDY["experiments"])
        if (task, architecture) == (one["tasks"][-1], one["architectures"][0])
    )
    for task, architecture in (("full-control", "table"), ("full-control", "idle"))
)
"""The experiments of a table on full control, and of controls."""


def problems_of(change):
    content = deepcopy(STUDY)
    change(content)
    with pytest.raises(BadInput) as caught:
        validated({"study.yaml": content})
    return caught.value.problems


def put(*place_and_value):
    *place, key, value = place_and_value

    def change(content):
        for part in place:
            content = content[part]
        content[key] = value

    return change


BAD = {
    "unknown key": (put("epsilom", 0.1), "epsilom: unknown key: did you mean 'epsilon'?"),
    "unknown key below": (put("tasks", "balancing", "step", 5), "tasks.balancing.step: unknown key: did you mean 'steps'?"),
    "negative seed": (put("seeds", [-1, 0]), "seeds[0]: -1: "),
    "negative count": (put("seeds", -3), "seeds: -3: write how many"),
    "seed twice": (put("seeds", [1, 1]), "seeds: [1, 1]: 1 stands there twice"),
    "no seeds": (put("seeds", 0), "seeds: 0: write how many"),
    "seeds without a count": (put("seeds", {"first": 10}), "seeds: {\"first\": 10}: write {first: 10000, count: 30}"),
    "seeds with another key": (put("seeds", {"first": 1, "count": 2, "last": 2}), "write {first: 10000, count: 30}"),
    "first seed as truth": (put("seeds", {"first": True, "count": 2}), "write {first: 10000, count: 30}"),
    "first seed negative": (put("seeds", {"first": -1, "count": 2}), "seeds lie between 0 and 4294967295"),
    "no seeds from one on": (put("seeds", {"first": 1, "count": 0}), "seeds lie between 0 and 4294967295"),
    "seeds beyond the largest": (put("seeds", {"first": 4294967295, "count": 2}), "seeds lie between 0 and 4294967295"),
    "too many seeds": (put("experiments", 0, "seeds", {"first": 0, "count": 10_001}), "experiments[0].seeds: "),
    "alpha 0": (put("experiments", 0, "alphas", [0]), "experiments[0].alphas[0]: 0: "),
    "alpha above 1": (put("experiments", 0, "alphas", [1, 1.5]), "experiments[0].alphas[1]: 1.5: "),
    "alpha as text": (put("experiments", 0, "alphas", ["1e-3"]), 'alphas[0]: "1e-3": this is text, not a number; write 0.001'),
    "alpha not a number": (put("experiments", 0, "alphas", [float("nan")]), "experiments[0].alphas[0]"),
    "alpha of a control": (put("experiments", CONTROLS, "alphas", [1]), "idle does not learn and has no α"),
    "no alpha": (put("experiments", 0, "alphas", []), "experiments[0].alphas: missing: table learns"),
    "unknown task": (put("experiments", 0, "tasks", ["balancin"]), "did you mean 'balancing'?"),
    "unknown architecture": (put("experiments", 0, "architectures", ["tabel"]), "did you mean 'table'?"),
    "unknown kind": (put("tasks", "balancing", "kind", "balance"), "must be 'balancing' or 'full-control'"),
    "unknown reading": (put("readings", "zero_of_angel", "upright"), "did you mean 'zero_of_angle'?"),
    "unknown option": (put("readings", "ties", "randon"), "readings.ties: \"randon\": must be 'random' or 'first'; did you mean 'random'?"),
    "unknown rate": (put("readings", "learning_rate", 0.25), "readings.learning_rate: 0.25: must be one of 0.03, 0.05, 0.07, 0.1, 0.11, 0.12, 0.13, 0.15, 0.2, 0.3, 0.5, 1"),
    "network of size 0": (put("architectures", "networks-5", "hidden", [0]), "architectures.networks-5.hidden[0]: 0: "),
    "three layers": (put("architectures", "networks-5", "hidden", [1, 2, 3]), "architectures.networks-5.hidden"),
    "network without size": (put("architectures", "networks-5", "hidden", []), "architectures.networks-5.hidden: []: must have at least 1"),
    "duplicate cell": (put("experiments", TABLES, "tasks", ["balancing"]), "balancing/table/alpha-1\": duplicate cell: experiments[0]"),
    "steps 0": (put("tasks", "balancing", "steps", 0), "tasks.balancing.steps: 0: "),
    "steps as truth": (put("tasks", "balancing", "steps", True), "tasks.balancing.steps: true: "),
    "discount 1": (put("discount", 1), "discount: 1: "),
    "name that leaves": (put("tasks", "../elsewhere", {"kind": "balancing", "steps": 5}), "tasks.../elsewhere"),
    "name with a space": (put("architectures", "a b", {"learner": "table"}), "a name has small letters"),
    "not a mapping": (put("tasks", ["balancing"]), "tasks: [\"balancing\"]: "),
    "results nowhere": (put("results", ""), "results"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_input_names_file_key_value_and_what_would_be_right(name):
    change, expected = BAD[name]
    problems = problems_of(change)
    assert any(expected in problem for problem in problems), problems
    assert all(problem.startswith("study.yaml: ") for problem in problems)


def test_all_problems_are_in_one_message():
    def change(content):
        put("seeds", -1)(content)
        put("epsilom", 1)(content)
        put("readings", "ties", "x")(content)

    assert len(problems_of(change)) == 3


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("seeds: 3\nseeds: 4\n", "line 2: seeds: duplicate key"),
        ("tasks:\n  a: {kind: balancing, kind: balancing}\n", "line 2: kind: duplicate key"),
        ("- 1\n", "must hold keys and values"),
        ("a: [1\n", "is not YAML"),
        ("1: 2\n", "a key must be text"),
        ("", "must hold keys and values"),
    ],
)
def test_yaml_that_cannot_be_meant(tmp_path, text, expected):
    path = tmp_path / "mine.yaml"
    path.write_text(text, "utf-8")
    with pytest.raises(BadInput, match=expected) as caught:
        read_yaml(path)
    assert str(path) in str(caught.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(BadInput, match="cannot be read"):
        load(tmp_path / "none.yaml")


@pytest.mark.parametrize("name", ["config.yaml", "smoke.yaml"])
def test_our_own_configurations_are_good(name):
    assert load(ROOT / "config" / name).readings == Readings()


def test_the_matrix_of_the_thesis():
    matrix = Matrix(load(ROOT / "config/config.yaml"))
    assert len(matrix.cells) == 36
    runs = list(matrix.runs)
    assert len(set(runs)) == len(runs) == sum(len(spec.seeds) for spec in matrix.cells.values())
    assert matrix.cells["full-control-long/table/alpha-0.001"].task.steps == 5_000_000


def test_an_experiment_has_its_own_seeds_or_the_studys():
    content = deepcopy(STUDY) | {"seeds": 3}
    for experiment in content["experiments"]:
        experiment.pop("seeds", None)
    content["experiments"][TABLES]["seeds"] = {"first": 7, "count": 2}
    content["experiments"][CONTROLS]["seeds"] = [9, 5]
    cells = Matrix(validated({"x": content})).cells
    own = {"full-control/table/alpha-0.1": (7, 8), "balancing/idle/alpha-none": (5, 9)}
    for cell in (*own, "balancing/table/alpha-1", "full-control/modular-table/alpha-1"):
        assert cells[cell].seeds == own.get(cell, (0, 1, 2))


def test_smoke_has_the_cells_of_the_thesis():
    thesis, smoke = (Matrix(load(ROOT / f"config/{name}.yaml")) for name in ("config", "smoke"))
    assert list(thesis.cells) == list(smoke.cells)


ONE_CELL = {
    "tasks": {"balancing": {"kind": "balancing", "steps": 5}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]}],
}


def blocks(seeds, size=30):
    study = validated({"x": {**ONE_CELL, "seeds": seeds, "seeds_per_job": size}})
    return list(Matrix(study).blocks)


def test_more_seeds_only_add_blocks():
    assert blocks(100)[:2] == blocks(60)
    assert [block.seeds for block in blocks([1000, 1020])] == [(1000,), (1020,)]
    names = [block.name for block in blocks([0, 1, 2, 31, 35])]
    assert names == ["seeds_0_to_2", "seeds_31_to_35_of_which_2"]


@given(st.integers(0, 500), st.integers(1, 200), st.integers(1, 60))
def test_blocks_have_every_seed_once_between_fixed_borders(first, count, size):
    found = blocks({"first": first, "count": count}, size)
    assert [seed for block in found for seed in block.seeds] == list(range(first, first + count))
    for block in found:
        assert {seed // size for seed in block.seeds} == {block.number}


@pytest.fixture
def two_experiments(tmp_path):
    """A study in a file, with seeds of its own and an experiment that has its own."""
    content = deepcopy(ONE_CELL) | {"seeds": {"first": 10_000, "count": 5}}
    content["experiments"].append(
        {**content["experiments"][0], "alphas": [0.1], "seeds": [7, 9, 10_003]}
    )
    path = tmp_path / "study.yaml"
    path.write_text(yaml.safe_dump(content), "utf-8")
    return path, content


@pytest.mark.parametrize(
    ("number", "of_study", "own"),
    [
        (2, (10_000, 10_001), (7, 9)),
        (5, (10_000, 10_001, 10_002, 10_003, 10_004), (7, 9, 10_003)),
        (6, tuple(range(10_000, 10_006)), (7, 9, 10_003)),
    ],
)
def test_a_number_of_seeds_on_the_command_line_is_of_the_seeds_there_are(
    two_experiments, number, of_study, own
):
    path, content = two_experiments
    study = from_snakemake([path], {**content, "seeds": number})
    assert [spec.seeds for spec in Matrix(study).cells.values()] == [of_study, own]


def test_too_many_seeds_on_the_command_line_are_refused(two_experiments):
    path, content = two_experiments
    for number in (10_001, 0, -1, True):
        with pytest.raises(BadInput, match="--config: seeds: "):
            from_snakemake([path], {**content, "seeds": number})
    with pytest.raises(BadInput, match="come to 10,003 runs"):
        from_snakemake([path], {**content, "seeds": 10_000})


def test_cells_share_the_blocks_of_the_seeds_that_they_share():
    content = deepcopy(ONE_CELL) | {"seeds": 60, "seeds_per_job": 30}
    content["experiments"].append({**content["experiments"][0], "alphas": [0.1], "seeds": 40})
    matrix = Matrix(validated({"x": content}))
    one, other = matrix.cells
    cells = {block.name: own for block, own in matrix.blocks.items()}
    assert cells == {
        "seeds_0_to_29": [one, other], "seeds_30_to_39": [other], "seeds_30_to_59": [one],
    }  # fmt: skip
    for cell, spec in matrix.cells.items():
        jobs = [matrix.job(cell, block) for block in matrix.blocks_of(spec)]
        assert [seed for job in jobs for seed in job.seeds] == list(spec.seeds)


def test_command_line_values_are_laid_over_the_file():
    path = ROOT / "config/config.yaml"
    assert len(from_snakemake([path], {**STUDY, "seeds": 2}).seeds) == 2
    with pytest.raises(BadInput, match="--config: seeds: -2"):
        from_snakemake([path], {**STUDY, "seeds": -2})


def test_schema_and_key_reference_are_those_of_the_types():
    assert json.loads((ROOT / "config/schema.json").read_text("utf-8")) == schema(), "make schema"
    assert (ROOT / "config/README.md").read_text("utf-8") == reference(), "make schema"


def test_specs_come_back_from_their_text():
    for spec in Matrix(load(ROOT / "config/config.yaml")).cells.values():
        assert parse(spec.canonical()).canonical() == spec.canonical()


def test_1_and_1_point_0_are_one_spec():
    one, other = deepcopy(STUDY), deepcopy(STUDY)
    other["experiments"][0]["alphas"][0] = 1.0
    one["readings"]["initial_weights"] = 1
    other["readings"]["initial_weights"] = 1.0
    specs = [Matrix(validated({"x": content})).cells for content in (one, other)]
    cell = "balancing/networks-5/alpha-1"
    assert specs[0][cell].canonical() == specs[1][cell].canonical()


def test_a_reading_of_networks_is_no_part_of_a_tables_spec():
    content = deepcopy(STUDY)
    content["readings"]["learning_rate"] = 0.5
    before, after = (Matrix(validated({"x": c})).cells for c in (STUDY, content))
    changed = {cell for cell in before if before[cell].canonical() != after[cell].canonical()}
    assert changed == {cell for cell in before if "networks" in cell}


@given(st.floats(1e-9, 1).map(lambda x: float(np.round(x, 9))).filter(lambda x: x > 0))
def test_alphas_come_back_from_their_text(alpha):
    text = alpha_text(alpha)
    assert float(text) == alpha
    assert "e" not in text
    assert not text.endswith(".")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("{", "is not JSON"),
        ("[]", "must be a JSON object"),
        ("{}", "spec: task: missing"),
        ('{"seeds": [1], "seeds": [2]}', "seeds: duplicate key"),
    ],
)
def test_specs_that_are_none(text, expected):
    with pytest.raises(BadInput, match=expected):
        parse(text)


def test_bad_values_in_a_spec():
    good = json.loads(
        next(iter(Matrix(load(ROOT / "config/config.yaml")).cells.values())).canonical()
    )
    for key, value, expected in [
        ("alpha", 2, "spec: alpha: 2: "),
        ("alpha", None, "a control has null, a learner a number"),
        ("seeds", [-1], r"spec: seeds\[0\]: -1"),
        ("seeds", [], "spec: seeds"),
        ("speed", 1, "spec: speed: unknown key: did you mean 'seeds'"),
        ("readings", {"ties": "never"}, "spec: readings.ties"),
    ]:
        with pytest.raises(BadInput, match=expected):
            parse(json.dumps({**good, key: value}))
