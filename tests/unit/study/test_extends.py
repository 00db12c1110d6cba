"""A configuration that says only what differs from another."""

import pytest

from upswing.study.config import from_snakemake, load
from upswing.study.errors import BadInput

BASE = """
results: results/base
seeds: 2
epsilon: 0.02
tasks:
  balancing: {kind: balancing, steps: 500}
  full-control: {kind: full-control, steps: 500}
architectures:
  table: {learner: table}
experiments:
  - {tasks: [balancing], architectures: [table], alphas: [1]}
readings: {reset: terminal}
"""
MINE = """
extends: base.yaml
results: results/mine
tasks:
  full-control: {steps: 900, pendulum: {length: 0.4}}
experiments:
  - {tasks: [full-control], architectures: [table], alphas: [0.1]}
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "base.yaml").write_text(BASE)
    (tmp_path / "mine.yaml").write_text(MINE)
    return tmp_path


def test_mappings_are_joined_and_lists_replaced(folder):
    study = load(folder / "mine.yaml")
    assert (study.results, study.epsilon, study.seeds) == ("results/mine", 0.02, (0, 1))
    task = study.tasks["full-control"]
    assert (task.kind, task.steps, task.pendulum.length) == ("full-control", 900, 0.4)
    assert study.tasks["balancing"].steps == 500
    assert [one.tasks for one in study.experiments] == [("full-control",)]
    assert study.readings.reset == "terminal"


def test_snakemake_sees_the_same_and_what_is_laid_over_it(folder):
    path = folder / "mine.yaml"
    plain = load(path)
    merged = {"extends": "base.yaml", "results": "results/mine"}
    assert from_snakemake([path], merged) == plain
    assert from_snakemake([path], {**merged, "epsilon": 0.5}).epsilon == 0.5


def test_one_may_extend_one_that_extends(folder):
    (folder / "third.yaml").write_text("extends: mine.yaml\nresults: results/third\nseeds: 5\n")
    study = load(folder / "third.yaml")
    assert (len(study.seeds), study.tasks["full-control"].steps) == (5, 900)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("extends: bas.yaml\nresults: r\n", 'mine.yaml: extends: "bas.yaml": must be the name of'),
        ("extends: [base.yaml]\nresults: r\n", "must be the name of a configuration"),
        ("extends: base.yaml\n", "mine.yaml: results: missing: a study that extends another"),
        ("extends: mine.yaml\nresults: r\n", "extends itself"),
        ("extends: base.yaml\nresults: r\nepsilon: 2\n", "mine.yaml: epsilon: 2"),
        ("extends: base.yaml\nresults: r\ntasks: {balancing: {steps: 0}}\n", "mine.yaml: tasks.balancing.steps: 0"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_of_the_file_where_it_stands(folder, text, said):
    (folder / "mine.yaml").write_text(text)
    with pytest.raises(BadInput) as error:
        load(folder / "mine.yaml")
    (line,) = error.value.problems
    assert said in line


def test_so_it_is_of_the_file_that_is_extended(folder):
    (folder / "base.yaml").write_text(BASE.replace("kind: balancing", "kind: balancin"))
    with pytest.raises(BadInput) as error:
        load(folder / "mine.yaml")
    assert error.value.problems[0].startswith(f"{folder / 'base.yaml'}: tasks.balancing.kind")


def test_what_a_page_says_of_a_study_is_said_of_none_that_extends_it(folder):
    said = 'title: "Does it fall?"\nabout: It balances.\njudges: false\n'
    (folder / "base.yaml").write_text(BASE + said)
    base, mine = load(folder / "base.yaml"), load(folder / "mine.yaml")
    assert (base.title, base.about, base.judges) == ("Does it fall?", "It balances.", False)
    assert (mine.title, mine.about) == ("", "")
    assert not mine.judges  # it has as few seeds
    (folder / "mine.yaml").write_text(MINE + "title: Mine\n")
    assert load(folder / "mine.yaml").title == "Mine"
