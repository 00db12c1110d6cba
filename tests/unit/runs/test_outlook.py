"""What is there of a study, and what is to come: counted from a real folder, estimated from its jobs."""

import shutil
import time

import pytest
import yaml

from tests.helpers import make_spec
from tests.paths import ROOT
from upswing.cli.shown.study import outlook_in_words
from upswing.runs.outlook import OF_A_RUN, START, Outlook, outlook, usual
from upswing.runs.train import train
from upswing.study.config import validated
from upswing.study.matrix import Matrix

STUDY = {
    "seeds": 4,
    "seeds_per_job": 2,
    "tasks": {"balancing": {"kind": "balancing", "steps": 1_000}},
    "architectures": {"table": {"learner": "table"}, "networks-5": {"learner": "networks", "hidden": [5]}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table", "networks-5"], "alphas": [1]}],
}  # fmt: skip
CELL = "balancing/table/alpha-1"
HEADER = "s\th:m:s\tmax_rss\tmax_vms\tmax_uss\tmax_pss\tio_in\tio_out\tmean_load\tcpu_time\n"


def matrix(**changes):
    return Matrix(validated({"study": {**STUDY, **changes}}))


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    """The first job of the table's cell, trained."""
    folder = tmp_path_factory.mktemp("outlook")
    asked = matrix()
    train(asked.job(CELL, asked.blocks_of(asked.cells[CELL])[0]), folder)
    return folder


@pytest.fixture
def folder(trained, tmp_path):
    return shutil.copytree(trained, tmp_path / "results")


def benchmark(folder, cell, block, seconds):
    path = folder / "benchmarks/train" / cell / f"{block}.tsv"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{HEADER}{seconds}\t0:00:01\t1\t1\t1\t1\t1\t1\t1\t{seconds}\n", "utf-8")


def test_of_a_folder_that_is_not_there_nothing_is_there(tmp_path):
    found = outlook(matrix(), tmp_path / "none")
    assert (found.runs, found.there, found.anew, found.to_train) == (8, 0, 0, 8)
    assert not found.measured
    assert not (tmp_path / "none").exists()


def test_what_is_there_is_counted_by_job(folder):
    assert outlook(matrix(), folder)[:3] == (8, 2, 0)
    (folder / f"runs/{CELL}/seed-1.rrd").unlink()  # its job is to be made again
    assert outlook(matrix(), folder)[:3] == (8, 0, 0)


@pytest.mark.parametrize(
    "change",
    [{"epsilon": 0.02}, {"readings": {"reset": "terminal"}}, {"discount": 0.8}],
    ids=str,
)
def test_what_was_made_of_another_configuration_is_to_be_made_anew(folder, change):
    assert outlook(matrix(**change), folder)[:3] == (8, 0, 2)


def test_what_other_code_made_is_to_be_made_anew(folder, monkeypatch):
    from upswing.study.code import Code

    monkeypatch.setattr(Code, "fingerprint", property(lambda _: "another"))
    assert outlook(matrix(), folder)[:3] == (8, 0, 2)


def test_more_seeds_are_new_and_what_is_there_stays(folder):
    assert outlook(matrix(seeds=6), folder)[:3] == (12, 2, 0)


def test_what_a_cell_took_here_is_what_its_next_job_will_take(folder):
    before = outlook(matrix(), folder)
    benchmark(folder, CELL, "seeds_0_to_1", 400.0)
    found = outlook(matrix(), folder)
    assert found.measured
    # Its other job takes as long; those of networks are estimated by the same factor.
    factor = 400 / usual(matrix().cells[CELL], 2)
    of_networks = usual(matrix().cells["balancing/networks-5/alpha-1"], 2) * factor
    expected = (400 + 2 * of_networks) * 1.3 / found.processors
    assert found.seconds == pytest.approx(expected, rel=0.05)
    assert before.seconds < 60
    # A job that is being run has an empty measurement.
    (folder / f"benchmarks/train/{CELL}/seeds_0_to_1.tsv").write_text("", "utf-8")
    assert not outlook(matrix(), folder).measured


def test_where_all_is_there_nothing_is_to_come(folder):
    asked = matrix(experiments=[{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]}], seeds=2)  # fmt: skip
    found = outlook(asked, folder)
    assert (found.there, found.to_train, found.seconds) == (2, 0, 0.0)
    size = sum(path.stat().st_size for path in (folder / "runs").rglob("*") if path.is_file())
    assert found.megabytes == pytest.approx(size / 1e6)


def test_the_usual_size_and_time_are_about_right(tmp_path):
    spec = make_spec(steps=20_000, seeds=(0, 1, 2))
    train(make_spec(steps=20_000), tmp_path / "first")  # compiles
    begin = time.process_time()
    train(spec, tmp_path / "results")
    took = time.process_time() - begin
    size = sum(p.stat().st_size for p in (tmp_path / "results/runs").rglob("*") if p.is_file())
    asked = Matrix(validated({"study": {**STUDY, "tasks": {"balancing": {"kind": "balancing", "steps": 20_000}}}}))  # fmt: skip
    found = outlook(asked, tmp_path / "none")
    assert found.megabytes * 1e6 / found.runs == pytest.approx(size / 3, rel=0.4)
    assert (usual(spec, 3) - START) / took == pytest.approx(1, abs=0.9)
    assert OF_A_RUN < usual(spec, 1) - START < 1


def test_ten_thousand_runs_are_looked_through_at_once(tmp_path):
    content = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))
    for experiment in content["experiments"]:
        experiment.pop("seeds", None)
    asked = Matrix(validated({"study": {**content, "seeds": 277, "seeds_per_job": 30}}))
    assert len(list(asked.runs)) > 9_900
    for cell, spec in asked.cells.items():
        folder = tmp_path / "runs" / cell
        folder.mkdir(parents=True)
        for seed in spec.seeds:
            for kind in ("trajectory.parquet", "windows.parquet", "weights.safetensors", "rrd"):
                (folder / f"seed-{seed}.{kind}").touch()
    begin = time.process_time()
    found = outlook(asked, tmp_path)
    assert time.process_time() - begin < 2
    assert found.to_train == 0  # nobody knows how they were made: they are taken as they are


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (Outlook(8, 8, 0, 0.0, 2, 5.0, True), "F: all 8 runs are there, none is to be trained; the runs take about 5 MB"),
        (Outlook(8, 0, 0, 12.0, 2, 5.0, False), "F: none is there, 8 are to be trained: about 10 s on 2 processors, by what such jobs usually take; the runs take about 5 MB"),
        (Outlook(3_500, 3_450, 0, 600.0, 4, 2_240.0, True), "F: 3,450 of 3,500 runs are there, 50 are to be trained: about 10 minutes on 4 processors, by what its jobs took before; the runs take about 2.2 GB"),
        (Outlook(8, 0, 8, 7_200.0, 1, 5.0, False), "F: 0 of 8 runs are there, 8 are to be trained, 8 of them anew, for the configuration or the code has changed: about 2.0 hours on 1 processors, by what such jobs usually take; the runs take about 5 MB"),
    ],
)  # fmt: skip
def test_it_is_said_in_a_line(found, said):
    assert outlook_in_words(found, "F") == said
