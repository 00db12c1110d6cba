"""Two folders of results (two commits, two machines): what came out differently."""

from pathlib import Path
from typing import NamedTuple

import pandas as pd

from upswing.runs.files.typed_table import Columns, read_table
from upswing.study.paths import EVIDENCE, RUNS, VERDICTS

OF_A_COMPARED: Columns = {
    "claim": "text", "part": "whole", "cells": "text", "estimate": "number", "low": "number",
    "high": "number",
}  # fmt: skip


class Comparison(NamedTuple):
    """What differs between two folders, A and B."""

    changed_verdicts: list[tuple[str, str, str]]  # claim, verdict in A, verdict in B
    parted_estimates: list[
        tuple[str, str, float, float]
    ]  # claim, what, estimates outside each other
    changed_runs: list[str]  # runs of both that are not identical
    only_in_a: list[str]  # runs
    only_in_b: list[str]
    common_runs: int


def compare(a: Path, b: Path) -> Comparison:
    """What differs between the results in ``a`` and in ``b``.

    A verdict that only one of them has counts as changed. An estimate has parted if it lies outside
    the other's interval, either way round, or if only one of them has it.

    Raises:
        BadInput: a folder lacks a table, or has one that is empty or of another origin.
    """
    verdicts_a, verdicts_b = (_verdicts(folder).set_index("claim") for folder in (a, b))
    claims = [*verdicts_a.index, *verdicts_b.index.difference(verdicts_a.index)]
    changed = []
    for claim in claims:
        before, after = (
            str(verdicts.at[claim, "verdict"]) if claim in verdicts.index else "none"
            for verdicts in (verdicts_a, verdicts_b)
        )
        if before != after:
            changed.append((str(claim), before, after))
    key = ["claim", "part", "cells"]
    both = _evidence(a).merge(
        _evidence(b), on=key, how="outer", suffixes=("_a", "_b"), indicator=True
    )
    outside = (
        (both["estimate_a"] < both["low_b"])
        | (both["estimate_a"] > both["high_b"])
        | (both["estimate_b"] < both["low_a"])
        | (both["estimate_b"] > both["high_a"])
        | (both["_merge"] != "both")
    )
    parted = [
        (
            row["claim"],
            f"part {row['part']}, {row['cells']}",
            row["estimate_a"],
            row["estimate_b"],
        )
        for row in both[outside].to_dict("records")
    ]
    runs_a, runs_b = (_runs(folder).set_index("run")["digest"] for folder in (a, b))
    common = runs_a.index.intersection(runs_b.index)
    differ = runs_a[common] != runs_b[common]
    return Comparison(
        changed_verdicts=changed,
        parted_estimates=parted,
        changed_runs=list(common[differ]),
        only_in_a=list(runs_a.index.difference(common)),
        only_in_b=list(runs_b.index.difference(common)),
        common_runs=len(common),
    )


# Only what is compared is asked for, so that results of another version can be.


def _verdicts(folder: Path) -> pd.DataFrame:
    remedy = f"`upswing verdicts {folder}` makes it"
    return read_table(folder / VERDICTS, {"claim": "text", "verdict": "text"}, remedy)


def _evidence(folder: Path) -> pd.DataFrame:
    remedy = f"`upswing verdicts {folder}` makes it"
    return read_table(folder / EVIDENCE, OF_A_COMPARED, remedy)


def _runs(folder: Path) -> pd.DataFrame:
    remedy = f"`upswing tables {folder}` makes it"
    return read_table(folder / RUNS, {"run": "text", "digest": "text"}, remedy)
