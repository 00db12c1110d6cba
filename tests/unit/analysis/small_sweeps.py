"""A small study and its sweeps, run in seconds."""

from tests.helpers import ARCHITECTURES
from upswing.analysis.robustness.selection import write_finalists
from upswing.runs.study_file import canonical, write_study
from upswing.runs.sweep import write_group
from upswing.study import jobs
from upswing.study.config import validated
from upswing.study.sweeps import groups, load_sweeps

NAMES = ("table", "networks-5", "networks-30", "modular-networks-5", "random")
STUDY = validated(
    {
        "study": {
            "seeds": 3,
            "tasks": {
                "balancing": {"kind": "balancing", "steps": 2_000},
                "full-control": {"kind": "full-control", "steps": 2_000},
            },
            "architectures": {name: ARCHITECTURES[name] for name in NAMES},
            "experiments": [
                {"tasks": ["balancing"], "architectures": ["table", "networks-5"], "alphas": [1]},
                {"tasks": ["balancing"], "architectures": ["table"], "alphas": [0.001]},
                {"tasks": ["balancing"], "architectures": ["random"]},
                {"tasks": ["full-control"], "alphas": [1],
                 "architectures": ["networks-5", "networks-30", "modular-networks-5"]},
            ],
        }
    }
)  # fmt: skip
SWEEPS = """
networks:
  vary: [biases, initial_weights]
  how: grid
  first_seed: 1000
  seeds: 2
  cells: [balancing/networks-5/alpha-1, full-control/networks-30/alpha-1, full-control/modular-networks-5/alpha-1]
  every: {full-control/networks-30/alpha-1: 3}
  beside: [balancing/random/alpha-none, balancing/table/alpha-1]
  seeds_beside: 3
  reports:
    p7: {figure: 7, cell: balancing/networks-5/alpha-1, shows: success}
    p9: {figure: 9, cell: full-control/networks-30/alpha-1, shows: failure}
    p11: {figure: 11, cell: full-control/modular-networks-5/alpha-1, shows: both}
  rounds: [{readings: 4, seeds: 4}, {readings: 1, seeds: 5}]
  cells_of_rounds: [full-control/networks-5/alpha-1]
tables:
  vary: [first_q, reset, wrap]
  how: pairs
  without: [[reset, wrap]]
  seeds: 2
  cells: [balancing/random/alpha-none, balancing/table/alpha-1]
  cells_of_singles: [balancing/table/alpha-0.001]
  reports:
    p5: {figure: 5, cell: balancing/table/alpha-1, shows: failure}
"""


def loaded(folder):
    """The sweeps, from a file in a folder."""
    (folder / "readings.yaml").write_text(SWEEPS, "utf-8")
    return load_sweeps(folder / "readings.yaml", STUDY)


def run(folder, sweeps):
    """Run every group of the sweeps, round by round."""
    write_study(canonical(STUDY), folder)
    for name, sweep in sweeps.items():
        said = {1}
        for group in groups(sweep, STUDY):
            if group.round not in said:
                write_finalists(folder, STUDY, name, sweep, group.round)
                said.add(group.round)
            write_group(
                folder, STUDY, name, sweep, group.name, jobs.sweep(sweep, STUDY).fingerprint
            )
