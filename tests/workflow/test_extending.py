"""The worked examples of docs/extend, as a reader would do them: one new file, named in a configuration."""

import re
import subprocess
import sys

import pandas as pd
import pytest
import yaml
from safetensors.numpy import load_file

from tests.paths import ROOT
from tests.workflow.small_study import Edited
from upswing.figures.phases import held
from upswing.optimal.body import natural_speed
from upswing.physics.braking import highest_stoppable_speed
from upswing.physics.pendulum import Pendulum, body_of
from upswing.study.physical import PendulumOptions

PAGES = sorted(path.stem for path in (ROOT / "docs/extend").glob("*.md") if path.stem != "index")
BESIDE = ("claim", "figure", "pendulum")  # which stand beside a configuration, or in it
PARTS = [page for page in PAGES if page not in BESIDE]
BLOCK = re.compile(r"^```(?:python|yaml) title=\"([^\"]+)\"\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(page):
    """The files that a page asks a reader to write, by their paths."""
    return dict(BLOCK.findall((ROOT / f"docs/extend/{page}.md").read_text("utf-8")))


def sources(folder):
    return {
        path.relative_to(folder): path.read_bytes()
        for path in folder.rglob("*")
        if path.suffix in (".py", ".smk") or path.name == "Snakefile"
    }


def followed(page, folder):
    """A copy of the project in which a reader has done what the page says."""
    study = Edited(folder)
    before = sources(folder)
    for path, text in blocks(page).items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_text(text, "utf-8")
    study.write((folder / "config/mine.yaml").read_text("utf-8"))
    after = sources(folder)
    assert {path for path in after if after[path] != before.get(path)} == {
        path for path in after if path not in before
    }
    return study, [path for path in after if path not in before]


def test_there_is_a_page_for_every_kind_of_part():
    assert PAGES == ["algorithm", "claim", "encoder", "figure", "learner", "pendulum", "task"]


@pytest.mark.parametrize("page", PARTS)
def test_a_part_is_one_new_file_that_a_configuration_names(page, tmp_path):
    study, new = followed(page, tmp_path)
    assert len(new) == 1, new
    # Its name stands on one line that defines it; an experiment then lists what is defined there.
    name = new[0].stem.replace("_", "-")
    config = (tmp_path / "config/mine.yaml").read_text("utf-8")
    key = {"learner": "learner: ", "encoder": "coding: ", "algorithm": "method: "}.get(page, "")
    assert len(re.findall(rf"{key or 'kind: '}{name}\b", config)) == 1
    assert study.plan()["train_seeds_0_to_1"] == len(yaml.safe_load(config)["experiments"][0]["alphas"])  # fmt: skip


@pytest.fixture(scope="module")
def together(tmp_path_factory):
    """A study of all of them, run to its page."""
    folder = tmp_path_factory.mktemp("together")
    study, _ = followed(PARTS[0], folder)
    content = {"results": "results/mine", "seeds": 2, "figures": ["rewards"]}
    for page in (*PARTS, "figure"):
        for path, text in blocks(page).items():
            if path.endswith(".py"):
                (folder / path).parent.mkdir(exist_ok=True)
                (folder / path).write_text(text, "utf-8")
            else:
                for key, value in yaml.safe_load(text).items():
                    if key in ("tasks", "architectures"):
                        content.setdefault(key, {}).update(value)
                    if key == "experiments" and page != "figure":
                        content.setdefault(key, []).extend(value)
    study.write(content)
    assert study.jobs()["train_seeds_0_to_1"] == 4
    return study


def test_a_study_of_all_of_them_runs_to_its_page(together):
    results = together.folder / "results/mine"
    assert (results / "figures/rewards.svg").is_file()
    page = (results / "report/index.html").read_text("utf-8")
    for words in (
        "The mean reward of every run",
        "the learner four-weights",
        "double-q",
        "quadrants",
    ):
        assert words in page
    assert together.plan() == {}


@pytest.mark.parametrize("page", PARTS)
def test_a_part_is_run_and_an_edit_of_it_makes_again_what_it_is_part_of(page, together):
    results = together.folder / "results/mine"
    runs = pd.read_parquet(results / "tables/runs.parquet")
    config = yaml.safe_load(blocks(page)["config/mine.yaml"])
    runs = runs[runs["task"].isin(config["tasks"])]
    runs = runs[runs["architecture"].isin(config["architectures"])]
    assert len(runs) == 2
    assert runs["mean_reward"].between(-11, 0).all()
    if page == "task":
        trajectory = pd.read_parquet(results / f"runs/{runs['run'].iloc[0]}.trajectory.parquet")
        assert abs(trajectory["angle"].iloc[0]) == pytest.approx(3.14159, abs=1e-4)
    (part,) = (path for path in blocks(page) if path.endswith(".py"))
    before, after = "\n\n\ndef ", "\n\n\nUNUSED = 1\n\n\ndef "
    together.edit(part, before, after)
    planned = together.plan()
    together.edit(part, after, before)
    assert planned["train_seeds_0_to_1"] == 1


def test_an_edit_of_a_figure_draws_it_anew(together):
    part, before, after = "config/figures/rewards.py", "\n\n\ndef ", "\n\n\nUNUSED = 1\n\n\ndef "
    together.edit(part, before, after)
    planned = together.plan()
    together.edit(part, after, before)
    assert planned == {"figure": 1, "viewer": 1, "report": 1}


@pytest.mark.parametrize("page", ["algorithm", "encoder", "learner"])
def test_a_part_learns_the_same_compiled_and_as_plain_python(page, together):
    config = yaml.safe_load(blocks(page)["config/mine.yaml"])
    config["tasks"]["balancing"]["steps"] = 400
    folder = together.folder
    (folder / "config/short.yaml").write_text(yaml.safe_dump(config), "utf-8")
    program = (
        "from pathlib import Path; from upswing.study.config import load;"
        "from upswing.study.matrix import Matrix; from upswing.runs.simulation import prepare;"
        "from upswing.physics.environment import empty_trajectory;"
        "spec = next(iter(Matrix(load(Path('config/short.yaml'))).cells.values()));"
        "setting = prepare(spec, 0); trajectory = empty_trajectory(400);"
        "setting.advance(trajectory, 0, 400);"
        "print(trajectory.angle.tobytes().hex(), trajectory.td_error.tobytes().hex());"
        "print(sum(abs(values).sum() for values in setting.learner.learned.values()) > 0)"
    )
    said = [
        subprocess.run(
            [sys.executable, "-c", program], cwd=folder, check=True, capture_output=True,
            text=True, env={**together.surroundings(), "NUMBA_DISABLE_JIT": off},
        ).stdout
        for off in ("0", "1")
    ]  # fmt: skip
    assert said[0] == said[1]
    assert said[0].endswith("True\n")


def test_another_pendulum_is_a_few_keys(tmp_path):
    study, new = followed("pendulum", tmp_path)
    assert new == []
    study.jobs("--", "results/mine/tables/runs.parquet")
    results = tmp_path / "results/mine"
    runs = pd.read_parquet(results / "tables/runs.parquet")
    assert sorted(runs["task"]) == ["full-control", "full-control", "stronger", "stronger"]
    for task, actions, parts in (("full-control", 3, 8 * 20), ("stronger", 5, 16 * 30)):
        path = results / f"runs/{runs.loc[runs['task'] == task, 'run'].iloc[0]}"
        trajectory = pd.read_parquet(f"{path}.trajectory.parquet")
        assert set(trajectory["action"]) == set(range(actions))
        assert (trajectory["cart_position"].abs().max() <= 2) == (task == "stronger")
        assert load_file(f"{path}.weights.safetensors")["q"].shape == (1, parts, actions)


def test_the_environment_of_the_page_is_what_it_says():
    page = (ROOT / "docs/extend/pendulum.md").read_text("utf-8")
    (program,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    told = {}
    exec(program, told)  # noqa: S102  our own page
    assert str(told["env"].action_space) == "Discrete(5)"
    assert told["env"].unwrapped.task.track.limit == 2.0


def test_the_numbers_of_the_page_are_those_of_its_pendulum():
    page = (ROOT / "docs/extend/pendulum.md").read_text("utf-8")
    tasks = yaml.safe_load(blocks("pendulum")["config/mine.yaml"])["tasks"]
    body = body_of(PendulumOptions(**tasks["stronger"]["pendulum"]))
    assert f"{highest_stoppable_speed(body):.1f} rad/s\n  here" in page
    assert f"{highest_stoppable_speed(Pendulum()):.1f} rad/s for the thesis's" in page
    assert f"{held(body)[0]:.0f}° from upright here and {held(Pendulum())[0]:.0f}°" in page
    scaled = 20 * natural_speed(body) / natural_speed(Pendulum())
    assert tasks["stronger"]["tiles"]["velocity_limit"] == round(scaled)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('takes: ClassVar[tuple[architecture.Features, ...]] = ("state",)', 'takes = np.zeros(3)', "Options: "),
        ('class Options(architecture.Architecture):', 'class Options:', "must be a class Options(Architecture)"),
    ],
)  # fmt: skip
def test_options_that_cannot_be_read_are_named_in_one_line(old, new, expected, tmp_path):
    study, [path] = followed("learner", tmp_path)
    study.edit(path, old, new)
    done = study.snakemake("--dry-run")
    said = done.stdout + done.stderr
    assert done.returncode != 0
    assert "Traceback" not in said
    assert any(str(path) in line and expected in line for line in said.splitlines()), said
