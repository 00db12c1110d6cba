"""Made-up runs of three cells, whose truth is known, and parts of claims about them."""

import numpy as np
import pandas as pd

from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.study.claim_parts import Part
from upswing.study.config import validated
from upswing.study.paths import RUNS

ONE, OTHER, THIRD = (f"balancing/table/alpha-{alpha}" for alpha in ("1", "0.5", "0.1"))
N = 60
STUDY = {
    "seeds": N,
    "tasks": {"balancing": {"kind": "balancing", "steps": 1_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.5, 0.1]}],
}


def made_up(folder, **columns):
    """A folder of results with made-up measures: of each column three arrays, one for each cell.

    No run diverged, unless a column ``diverged_at`` says when: NaN for those that did not.
    """
    study = validated({"study": STUDY})
    write_study(canonical(study), folder)
    frames = []
    for number, cell in enumerate((ONE, OTHER, THIRD)):
        frame = pd.DataFrame({"seed": range(N)})
        frame["run"] = [f"{cell}/seed-{seed}" for seed in range(N)]
        frame["recording"] = [f"runs/{cell}/seed-{seed}.rrd" for seed in range(N)]
        frame["steps"], frame["falls"], frame["falls_last_fifth"] = 1_000, range(N), 0
        frame["digest"] = [f"{number}-{seed}" for seed in range(N)]
        frame["diverged_at"] = np.nan
        for name, values in columns.items():
            frame[name] = values[number]
        frames.append(frame)
    runs = pd.concat(frames, ignore_index=True).astype({"diverged_at": "Int64"})
    write_table(folder / RUNS, runs)
    for recording in runs["recording"]:
        (folder / recording).parent.mkdir(parents=True, exist_ok=True)
        (folder / recording).touch()
    return Results(folder)


def part(kind, cells, **settings):
    return Part.model_validate(
        {"says": "…", "because": "…", "kind": kind, "cells": list(cells), **settings}
    )


def share_of(value):
    """N numbers, of which a share is 1 and the rest 0."""
    return (np.arange(N) < round(value * N)).astype(float)


NOISE = np.random.default_rng(0).normal(0, 0.05, N)
ZERO = np.zeros(N)
FROM = {"at_least": 0.8, "partly": 0.5}
UP_TO = {"at_most": 0.2, "partly": 0.5}
