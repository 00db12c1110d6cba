"""What is no agent, or cannot be adopted, is said in a line, and nothing is left of it."""

from pathlib import Path

import pytest

from tests.unit.runs.adopting import asked, copied_results, small_study  # noqa: F401  fixtures
from upswing.runs.adopt import adopt
from upswing.runs.adopted import declared
from upswing.runs.results import Results
from upswing.runs.train import RunsFailed
from upswing.study.errors import BadInput


def files(results):
    return {path: path.stat().st_mtime_ns for path in results.rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("function", "said"),
    [
        ("nothing", r"agents.py:nothing: asked at \[1, 0, 0\]: answers None: must be 0, 1 or 2"),
        ("four", r"answers 3: must be 0, 1 or 2"),
        ("half", r"answers 0.5: must be"),
        ("truth", r"answers True: must be"),
        ("several", r"answers array\(\[1, 2\]\): must be"),
        ("broken", r"ZeroDivisionError: division by zero \(agents.py, line \d+\)"),
        ("fruitless", r"made for a seed: 5 is no function"),
        ("number", r"agents.py:number: is no function but int"),
        ("two", r"takes observation, state: must take an observation, or `seed`"),
        ("lena", r"agents.py has no lena; did you mean 'lean'\?"),
    ],
)
def test_an_agent_that_is_none_is_refused_before_anything_is_written(results, function, said):
    before = files(results)
    with pytest.raises(BadInput, match=said) as refused:
        adopt(results, asked(function))
    assert len(refused.value.problems) == 1
    assert files(results) == before


def test_what_an_action_is_depends_on_the_task(results):
    with pytest.raises(BadInput, match="5: must be 0, 1, 2, 3 or 4, an index into −20, −10, 0, "):
        adopt(results, asked("sixth", "five"))
    with pytest.raises(BadInput, match="4: must be 0, 1 or 2, an index into −10, 0 and \\+10 m/s²"):
        adopt(results, asked("hard", "balancing"))


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"agent": "agents.py"}, r"agent: agents.py: must be file.py:function or module:function"),
        ({"agent": "lost.py:lean"}, r"agent: lost.py:lean: there is no file lost.py"),
        ({"agent": "./results:lean"}, r"there is no file ./results"),
        ({"agent": "no.such:f"}, r"cannot be imported: ModuleNotFoundError: No module named 'no'$"),
        ({"agent": "fails:f"}, r"cannot be imported: KeyError: 'here' \(fails.py, line 2\)"),
        ({"seeds": (2**32,)}, r"seed: 4294967296: must be a whole number from 0 to 4294967295"),
        ({"agent": "wrong.py:f"}, r"cannot be imported: SyntaxError"),
        ({"agent": "leaves.py:f"}, r"cannot be imported: SystemExit: 3 \(leaves.py, line 1\)"),
        ({"task": "balance"}, r"task: balance: no task of results; did you mean 'balancing'\?"),
        ({"name": "table"}, r"name: table: is an architecture of results"),
        ({"name": "PPO"}, r"adopt: name: \"PPO\": a name has small letters"),
        ({"reads": [Path("lost.zip")]}, r"file: lost.zip: there is no such file"),
        ({"seeds": (3, 3)}, r"seed: \(3, 3\): one stands there twice"),
    ],
)
def test_what_cannot_be_adopted_is_said_in_a_line(results, changed, said):
    Path("wrong.py").write_text("def f(:\n", "utf-8")
    Path("fails.py").write_text("\n{}['here']\n", "utf-8")
    Path("leaves.py").write_text("raise SystemExit(3)\n", "utf-8")
    before = files(results)
    with pytest.raises(BadInput, match=said) as refused:
        adopt(results, asked("lean")._replace(**changed))
    assert len(refused.value.problems) == 1
    assert files(results) == before


def test_an_agent_that_fails_in_a_run_leaves_no_run_and_no_cell(results):
    with pytest.raises(RunsFailed, match=r"late: asked at .*: KeyError: 'lost' \(agents.py, line"):
        adopt(results, asked("late"))
    assert declared(results) == []
    assert not list((results / "runs/balancing").glob("mine/*/*"))
    assert "balancing/mine/alpha-none" not in Results(results).cells
