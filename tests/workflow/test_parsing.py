"""What Snakemake does while it reads the rules: it names files, and asks the disk for none of the results."""

import json
import re
import subprocess
import sys

import pytest

from tests.paths import ROOT
from tests.workflow.small_study import SMALL, Study
from upswing.report.targets import Targets
from upswing.study.check import asked

MOST_LINES = 40
WATCH = """
import builtins, io, json, os, sys
import upswing.study.check

# Whether the folder may take results is a part of checking the configuration, which is read here.
upswing.study.check.check_results = lambda *_: None
seen = {"parsing": [], "planning": []}
phase = "parsing"

def watched(function):
    def call(path=".", *rest, **more):
        # Its own folder is not meant: report/ in it has the templates.
        if not isinstance(path, int) and os.fspath(path).startswith("results"):
            seen[phase].append(str(path))
        return function(path, *rest, **more)
    return call

for name in ("stat", "lstat", "scandir", "listdir", "access", "open"):
    setattr(os, name, watched(getattr(os, name)))
builtins.open = io.open = watched(io.open)

from snakemake.cli import main
from snakemake.dag import DAG

init = DAG.init
outputs = []

async def planned(self, *rest, **more):
    global phase
    phase = "planning"
    outputs.extend(str(o) for rule in self.workflow.rules if not rule.has_wildcards() for o in rule.output)
    return await init(self, *rest, **more)

DAG.init = planned
try:
    main([*sys.argv[1:], "--dry-run", "--quiet", "all", "--configfile", "config/small.yaml"])
finally:
    print(json.dumps({**seen, "outputs": outputs}))
"""


@pytest.fixture(scope="module", params=["a study", "a study of changes"])
def watched(request, tmp_path_factory):
    """A plan of a study whose page could show sweeps and a chapter, and the paths that it asked for."""
    study = Study(tmp_path_factory.mktemp("watched"))
    content = SMALL
    if request.param == "a study of changes":
        titled = [{**experiment, "title": "A change"} for experiment in SMALL["experiments"]]
        content = {**SMALL, "experiments": titled}
    study.write(content)
    for name in ("tables/robust.parquet", "beyond/tables/changes.parquet", "figures/fig05.svg"):
        path = study.folder / "results" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    done = subprocess.run(
        [sys.executable, "-c", WATCH], cwd=study.folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return study, json.loads(done.stdout.splitlines()[-1])


def test_no_result_is_asked_for_while_the_rules_are_read(watched):
    _, told = watched
    assert told["parsing"] == []
    # So the watch does see them.
    assert "results/tables/robust.parquet" in told["planning"]
    assert "results/runs/balancing/table/alpha-1" in told["planning"]


def test_the_rules_make_what_a_study_is_said_to_come_to(watched):
    """Records are mended for what ``Targets`` names, so no output of a rule may be missing there."""
    study, told = watched
    folder = study.folder / "config"
    files = Targets(
        *asked(
            [folder / "small.yaml"], {},
            claims=folder / "claims.yaml", sweeps=folder / "readings.yaml",
        )
    )  # fmt: skip
    made = set(told["outputs"])
    optional = {path for path in made if "/tables/" in path or "/figures/readings" in path}
    assert made - optional <= {*files.quick, *files.slow}
    with_wildcards = {
        *files.pictures("svg", "png", "json"), *files.swept, *files.comparisons,
    }  # fmt: skip
    assert {*files.quick, *files.slow} - with_wildcards <= made


def test_the_snakefile_has_includes_and_targets_only():
    text = (ROOT / "Snakefile").read_text("utf-8")
    assert len(text.splitlines()) <= MOST_LINES
    begun = [line for line in text.splitlines() if re.match(r"[^\s#]", line)]
    assert all(re.match(r"include: |rule \w+:", line) for line in begun), begun
    for rule in re.split(r"^rule \w+:\n", text, flags=re.MULTILINE)[1:]:
        assert set(re.findall(r"^    (\w+):", rule, re.MULTILINE)) == {"input"}
