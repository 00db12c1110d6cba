"""What a kind of job imports: every job begins by it, so it is most of what a short one costs."""

import json
import subprocess
import sys

import pytest

MODULES = {
    "the package itself, for its version": ("upswing", set(), 100),
    "a notebook that opens a study": ("upswing.api", {"pandas", "numba"}, 1_400),
    "planning": (
        "upswing.report.targets, upswing.runs.records, upswing.study.check, upswing.study.jobs",
        set(),
        600,
    ),
    "training a table": ("upswing.runs.train", {"numba", "rerun"}, 1_500),
    "acting by a deep Q-network": ("upswing.agents.held", {"numba"}, 900),
    "a figure": (
        "upswing.figures.panels, upswing.figures.style, upswing.figures.success_share, upswing.runs.results",
        {"pandas", "matplotlib"},
        1_300,
    ),
    "verdicts": ("upswing.analysis.verdicts", {"pandas"}, 1_900),
    "the page": ("upswing.report.page", {"pandas", "jinja2", "numba"}, 1_300),
}
"""Of each job what it starts from, the costly packages that it needs, and a generous number of modules."""

COSTLY = {
    "pandas", "torch", "scipy.stats", "numba", "rerun", "matplotlib", "snakemake", "jinja2",
    "stable_baselines3", "gymnasium",
}  # fmt: skip


@pytest.mark.parametrize("job", MODULES)
def test_a_job_imports_what_it_needs(job):
    modules, needed, most = MODULES[job]
    program = f"import sys, json, {modules}; print(json.dumps(sorted(sys.modules)))"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    imported = set(json.loads(done.stdout))
    assert imported & COSTLY == needed
    assert len(imported) <= most
