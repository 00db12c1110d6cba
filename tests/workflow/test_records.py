"""What Snakemake has forgotten, or remembers wrongly: a change is computed or said all the same."""

import json
import shutil
from base64 import urlsafe_b64encode

import pytest

from tests.workflow.small_study import SMALL, as_run
from upswing.runs.files.ledger import ledger_path, read_ledger
from upswing.runs.files.trajectory import read_metadata
from upswing.runs.train import train
from upswing.study.spec import parse

pytestmark = pytest.mark.heavy  # it runs a study again and again

TRAIN, CELLS = "train_seeds_0_to_1", 5
FOLLOWS = {"tables", "verdicts", "history", "comparison", "figure", "viewer", "report"}
RUN = "balancing/table/alpha-1/seed-0"
WINDOWS = f"results/runs/{RUN}.windows.parquet"
FORGOTTEN = "There is no record of how"


@pytest.fixture
def study(once, tmp_path):
    """A study that has been run, to damage."""
    return as_run(once, tmp_path)


def records(study):
    return [path for path in (study.folder / ".snakemake/metadata").rglob("*") if path.is_file()]


def record_of(study, output):
    name = urlsafe_b64encode(output.encode()).decode()
    return study.folder / ".snakemake/metadata" / name


def remove(study):
    shutil.rmtree(study.folder / ".snakemake/metadata")


def remove_all(study):
    shutil.rmtree(study.folder / ".snakemake")


def with_content(content):
    def spoil(study):
        for path in records(study):
            path.write_bytes(content)

    return spoil


def remove_those_of_training(study):
    for path in records(study):
        if json.loads(path.read_bytes())["rule"].startswith("train"):
            path.unlink()


def take_another_jobs(study):
    """Every record is that of the table of verdicts."""
    content = record_of(study, "results/tables/verdicts.parquet").read_bytes()
    for path in records(study):
        path.write_bytes(content)


def keep_only_another_studys(study):
    """There are records, none of which is of these results."""
    remove(study)
    path = record_of(study, "results/smoke/study.json")
    path.parent.mkdir()
    path.write_text('{"rule": "study", "params": [], "record_format_version": 6}', "utf-8")


def lose_the_params(study):
    for path in records(study):
        path.write_text(json.dumps({**json.loads(path.read_bytes()), "params": None}), "utf-8")


DAMAGES = [
    remove,
    remove_all,
    with_content(b""),
    with_content(b"nonsense"),
    with_content(b"\xff\xfe\x00"),
    with_content(b"[1, 2]"),
    with_content(b'{"rule": 7, "params": "x"}'),
    remove_those_of_training,
    take_another_jobs,
    keep_only_another_studys,
    lose_the_params,
]
NAMES = [
    "removed", "all of .snakemake removed", "empty", "nonsense", "binary", "a list", "wrong types",
    "training's removed", "of another job", "of another study only", "without params",
]  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGES, ids=NAMES)
def test_with_damaged_records_a_changed_epsilon_is_trained(study, damage):
    damage(study)
    study.write({**SMALL, "epsilon": 0.02})
    planned = study.jobs("--dry-run")
    assert planned.pop(TRAIN) == CELLS
    assert set(planned) == {*FOLLOWS, "study"}


@pytest.mark.parametrize(
    "damage",
    [remove, take_another_jobs, keep_only_another_studys],
    ids=lambda damage: damage.__name__,
)
def test_with_damaged_records_nothing_is_trained_that_is_as_asked(study, damage):
    damage(study)
    planned = study.jobs("--dry-run")
    assert TRAIN not in planned
    assert set(planned) <= {*FOLLOWS, "study"}


def test_what_was_planned_is_computed_and_then_nothing_is_left_to_do(study):
    remove_those_of_training(study)
    study.write({**SMALL, "epsilon": 0.02})
    wanted = ("--", "results/tables/verdicts.parquet")
    done = study.snakemake(*wanted)
    assert done.returncode == 0, done.stdout + done.stderr
    ledger = read_ledger(ledger_path(study.folder / "results", f"runs/{RUN}"))
    assert parse(ledger.made_from["spec"]).epsilon == 0.02
    assert study.jobs("--dry-run", *wanted) == {}


def test_records_that_say_what_is_asked_of_files_that_are_not_so_are_mended(study):
    """The records of a study with another ε, over the results of this one."""
    for path in records(study):
        text = path.read_text("utf-8")
        path.write_text(text.replace('\\"epsilon\\":0.01', '\\"epsilon\\":0.02'), "utf-8")
        path.write_text(path.read_text().replace('"epsilon":0.01', '"epsilon":0.02'), "utf-8")
    study.write({**SMALL, "epsilon": 0.02})
    assert study.jobs("--dry-run")[TRAIN] == CELLS


def test_without_a_ledger_the_windows_say_what_they_were_made_from(study):
    remove(study)
    shutil.rmtree(study.folder / "results/checksums")
    assert TRAIN not in study.jobs("--dry-run")
    remove(study)
    study.write({**SMALL, "epsilon": 0.02})
    assert study.jobs("--dry-run")[TRAIN] == CELLS


def test_what_nobody_knows_is_said(study):
    remove(study)
    for seed in (0, 1):
        run = f"balancing/table/alpha-1/seed-{seed}"
        ledger_path(study.folder / "results", f"runs/{run}").unlink()
        (study.folder / f"results/runs/{run}.windows.parquet").write_bytes(b"damaged")
    study.write({**SMALL, "epsilon": 0.02})
    done = study.snakemake("--dry-run")
    output = done.stdout + done.stderr
    assert f"{FORGOTTEN} 2 files in results were made" in output
    assert "results/runs/balancing/table/alpha-1/seed-0.windows.parquet first" in output


def test_whole_records_are_left_as_they_are(study):
    before = {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in records(study)}
    done = study.snakemake("--dry-run")
    assert FORGOTTEN not in done.stdout + done.stderr
    assert study.jobs("--dry-run") == {}
    assert {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in records(study)} == before


def test_a_run_repeated_by_hand_makes_nothing_run(study):
    spec = read_metadata(study.folder / WINDOWS)["spec"]
    train(parse(spec), study.folder / "results")
    assert TRAIN not in study.jobs("--dry-run")


def test_fewer_seeds_on_the_command_line_train_nothing_and_leave_nothing_to_train(study):
    planned = study.jobs("--dry-run", "--config", "seeds=1")
    assert not [rule for rule in planned if rule.startswith("train")]
    assert set(planned) == {*FOLLOWS, "study"}
    assert study.jobs("--dry-run") == {}


def test_more_seeds_on_the_command_line_train_those_that_are_missing(study):
    planned = study.jobs("--dry-run", "--config", "seeds=3")
    trained = {rule: jobs for rule, jobs in planned.items() if rule.startswith("train")}
    assert trained == {"train_seeds_2_to_2": CELLS}


def test_fewer_seeds_of_another_study_are_trained(study):
    study.write({**SMALL, "seeds": 2, "epsilon": 0.02})
    assert study.jobs("--dry-run", "--config", "seeds=1")["train_seeds_0_to_0"] == CELLS
