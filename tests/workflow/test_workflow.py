"""The real Snakemake on a small matrix: what runs, what it leaves, what it says of bad input."""

import json
import os
import re
import subprocess

import pandas as pd
import pyarrow.parquet as pq
import pytest
import yaml

from tests.paths import ROOT
from tests.workflow.small_study import BIN, FIGURES_OF_SMALL, RAN, SMALL, Study, as_run
from upswing.figures import FIGURES

EVERYTHING = {
    "study": 1, "train_seeds_0_to_1": 5, "tables": 1, "verdicts": 1, "history": 1, "comparison": 8,
    "figure": FIGURES_OF_SMALL, "viewer": 1, "report": 1,
}  # fmt: skip


@pytest.fixture(scope="module")
def study(once, tmp_path_factory):
    """A study that ran once."""
    assert json.loads((once / RAN).read_text("utf-8")) == EVERYTHING
    return as_run(once, tmp_path_factory.mktemp("study"))


def test_a_second_run_has_nothing_to_do(study):
    assert study.jobs() == {}


def test_everything_of_the_contract_is_there(study):
    results = study.folder / "results"
    runs = pd.read_parquet(results / "tables/runs.parquet")
    assert len(runs) == 10
    needed = (
        "run task architecture alpha seed steps falls falls_last_fifth upright_share "
        "above_horizontal_share mean_reward first_stable_step recording seconds steps_per_second "
        "git_commit dirty spec"
    )
    assert set(needed.split()) <= set(runs.columns)
    for row in runs.itertuples():
        assert (results / row.recording).is_file()
        for kind in ("trajectory.parquet", "windows.parquet", "weights.safetensors"):
            assert (results / f"runs/{row.run}.{kind}").is_file()
    cells = pd.read_parquet(results / "tables/cells.parquet")
    assert list(cells["runs"]) == [2] * 5
    assert b"upswing" in pq.read_schema(results / "tables/runs.parquet").metadata
    for number in (5, 7, 8):
        for ending in ("svg", "png"):
            assert (results / f"figures/fig{number:02d}.{ending}").stat().st_size > 5_000
    assert (results / "report/index.html").stat().st_size > 20_000


def test_every_claim_has_a_verdict(study):
    verdicts = pd.read_parquet(study.folder / "results/tables/verdicts.parquet").set_index("claim")
    needed = "statement section measure threshold estimate low high n verdict figure recordings"
    assert set(needed.split()) <= set(verdicts.columns)
    assert list(verdicts.index) == [f"C{number}" for number in range(1, 17)]
    assert verdicts.at["C16", "verdict"] == "reproduced"
    assert verdicts.at["C15", "verdict"] == "not in this study"
    assert "full-control/modular-networks-5/alpha-1" in verdicts.at["C15", "measure"]
    # Two runs decide nothing that takes 30.
    assert verdicts.at["C2", "verdict"] == "inconclusive"
    for path in verdicts.at["C2", "recordings"]:
        assert (study.folder / "results" / path).is_file()


def shown(page, number):
    """What the page has for a figure of the thesis."""
    _, _, after = page.partition(f'<figure id="fig{number:02d}"')
    return after.partition("</figure>")[0]


def test_the_page_says_which_figures_it_has_not_and_what_they_need(study):
    page = (study.folder / "results/report/index.html").read_text("utf-8")
    for number in (5, 7, 8):
        assert "<svg" in shown(page, number)
    for number in (6, 9, 10, 11):
        assert f"Figure {number}.</strong>" in page
        assert "<svg" not in shown(page, number)
        assert all(cell in page for cell in FIGURES[f"fig{number:02d}"].cells)


def test_the_page_needs_no_network(study):
    page = (study.folder / "results/report/index.html").read_text("utf-8")
    links = re.findall(r"""<[^>]*?(?:src|href)=["']([^"']+)""", page)
    assert links
    shown = page[: page.index('id="runs-table"')]
    for link in re.findall(r"""<[^>]*?(?:src|href)=["']([^"']+)""", shown):
        assert link.startswith(("data:", "#", "viewer/index.html#", "runs.csv", "evidence.csv")), (
            link
        )
        if link.startswith("viewer/"):  # what the page shows is kept beside it
            recording = link.partition("#")[2]
            assert (study.folder / f"results/report/viewer/recordings/{recording}.js").is_file()


def test_the_command_in_a_log_repeats_its_run(study, tmp_path):
    log = study.folder / "results/logs/train/balancing/networks-5/alpha-1/seeds_0_to_1.log"
    (command,) = [
        line.split(": ", 1)[1]
        for line in log.read_text("utf-8").splitlines()
        if "to repeat it" in line and '"seeds":[1]' in line
    ]
    shell = command.replace("--results results", f"--results {tmp_path}")
    assert shell != command
    path = f"{BIN}:{os.environ['PATH']}"
    subprocess.run(shell, shell=True, check=True, env={**os.environ, "PATH": path}, cwd=tmp_path)  # noqa: S602
    for kind in ("trajectory", "windows"):
        name = f"runs/balancing/networks-5/alpha-1/seed-1.{kind}.parquet"
        one, other = (
            pq.read_table(base / name).to_pandas() for base in (study.folder / "results", tmp_path)
        )
        assert one.equals(other)


def test_every_rule_has_a_log_and_a_benchmark_and_calls_one_verb():
    rules = 0
    for path in sorted((ROOT / "workflow/rules").glob("*.smk")):
        for body in re.split(r"^ *rule(?: \w+)?:", path.read_text("utf-8"), flags=re.MULTILINE)[1:]:
            rules += 1
            for part in ("log", "benchmark", "shell"):
                found = re.findall(rf"^ +{part}:", body, re.MULTILINE)
                assert len(found) == 1, f"{path.name}: {part}"
            assert len(re.findall(r'"\{params.upswing:q\} \w+', body)) == 1, path.name
            assert not re.search(r"\b(run|script):", body), path.name
            for need in ("mem_mb", "runtime"):
                assert len(re.findall(rf"^ +{need}=", body, re.MULTILINE)) == 1, path.name
    assert rules == 18


def test_logs_and_benchmarks_are_written(study):
    results = study.folder / "results"
    assert len(list((results / "benchmarks").rglob("*.tsv"))) == sum(EVERYTHING.values())
    logs = list((results / "logs").rglob("*.log"))
    assert len(logs) == sum(EVERYTHING.values())
    for log in logs:
        assert "to repeat it: upswing " in log.read_text("utf-8"), log


# The tests from here on change the study, each back to what it was.


def test_snakemakes_own_report_shows_the_figures(study):
    done = study.snakemake("--report", "own.html")
    assert done.returncode == 0, done.stdout + done.stderr
    page = (study.folder / "own.html").read_text("utf-8")
    for part in ("Figures", "The page", "fig05", "every claim and its verdict"):
        assert part in page


def test_a_touched_source_reruns_nothing(study):
    for path in study.folder.rglob("*.smk"):
        path.touch()
    (study.folder / "config/small.yaml").touch()
    assert study.jobs() == {}


def test_a_threshold_judges_again_and_remakes_the_page(study):
    claims = study.folder / "config/claims.yaml"
    claims.write_text(
        claims.read_text("utf-8").replace("at_least: 0.98", "at_least: 0.97"), "utf-8"
    )
    assert study.jobs() == {"verdicts": 1, "history": 1, "report": 1}


def test_a_deleted_run_is_made_again(study):
    missing = "results/runs/balancing/table/alpha-1/seed-1.windows.parquet"
    (study.folder / missing).unlink()
    assert study.jobs("--", missing) == {"train_seeds_0_to_1": 1}
    assert (study.folder / missing).is_file()


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ({**SMALL, "seeds": -1}, ["config/small.yaml: seeds: -1: write how many"]),
        ({**SMALL, "epsilom": 1, "discount": 2}, ["epsilom: unknown key", "discount: 2: "]),
        (yaml.safe_dump(SMALL) + "seeds: 3\n", ["seeds: duplicate key"]),
    ],
)
def test_bad_configuration_is_one_message_and_nothing_is_written(tmp_path, content, expected):
    study = Study(tmp_path)
    study.write(content)
    done = study.snakemake()
    output = done.stdout + done.stderr
    assert done.returncode != 0
    assert all(part in output for part in expected), output
    assert "Traceback" not in output
    assert not (tmp_path / "results").exists()
