"""What the page says of readings: how the claims do over them, how the default was chosen."""

import json
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from upswing.analysis.robustness.outdated import Outdated, outdated
from upswing.analysis.robustness.shipped import read_shipped
from upswing.analysis.robustness.tables import (
    OF_A_CAUSE,
    OF_A_READING,
    OF_A_SELECTION,
    OF_A_SUMMARY,
    REMEDY,
)
from upswing.report.inline_svg import inline
from upswing.runs.files.typed_table import read_table
from upswing.study import paths
from upswing.study.claims import file_of_claims, load_claims
from upswing.study.config import Study
from upswing.study.paths import DECISIVE, READINGS, ROBUST, SELECTION
from upswing.study.places import CLAIMS, SWEEPS
from upswing.study.sweeps import load_sweeps

SELECTED = ("reward_unit", "biases", "initial_weights", "learning_rate")
CAUSES, LIKELIEST = 3, 8
"""Number of readings shown: of those that decide a claim, and of the most likely ones."""

Row = dict[str, Any]


def over_readings(results: Path, templates: Path, verdicts: list[Row], study: Study) -> Row:
    """How the claims do over readings: where that is from, and of which claims it is known."""
    own = (results / ROBUST).exists()
    known = [row["claim"] for row in verdicts if not pd.isna(row["weighted_share"])]
    shipped = read_shipped(templates)
    # This study's own sweeps, beside those that the project brings along.
    differs = [
        row["claim"]
        for row in verdicts
        if own
        and row["claim"] in shipped.claims
        and row["grade"] != shipped.claims[row["claim"]]["grade"]
    ]
    return {
        "own": own, "known": known, "made_from": shipped.made_from, "differs": differs,
        "outdated": _outdated(results, templates.parent, study) if own else None,
    }  # fmt: skip


def _outdated(results: Path, project: Path, study: Study) -> Outdated | None:
    """What has changed since the sweeps; None where nothing has, or nobody says what is asked now."""
    asked_for = project / SWEEPS, file_of_claims(study, otherwise=project / CLAIMS)
    if not all(path.is_file() for path in asked_for):
        return None
    sweeps, claims = load_sweeps(asked_for[0], study), load_claims(asked_for[1], study)
    found = outdated(results, sweeps, claims, study)
    return found if found.changed else None


def swept(results: Path, study: Study) -> Row:
    """What the sweeps over readings came to; empty if they were not run."""
    if not (results / ROBUST).exists():
        return {"robust": []}
    decisive = rows(read_table(results / DECISIVE, OF_A_CAUSE, REMEDY, empty=True))
    robust = rows(read_table(results / ROBUST, OF_A_SUMMARY, REMEDY))
    selection = _selection(results)
    judged = read_table(results / READINGS, OF_A_READING, REMEDY)
    return {
        "robust": robust,
        "seeds": int(judged["n"].max()),
        "decisive": {
            row["claim"]: [cause for cause in decisive if cause["claim"] == row["claim"]][:CAUSES]
            for row in robust
        },
        "pictures": [
            {"name": name, "svg": _picture(results / paths.figure_of_sweep(name, "svg"), name)}
            for name in judged["sweep"].unique()
            if (results / paths.figure_of_sweep(name, "svg")).is_file()
        ],
        "judged": {row["claim"]: row for row in robust},
        "turning": {claim: _turning(judged, claim) for claim in ("C8", "C9")},
        "selection": selection[:LIKELIEST],
        "chosen_first": bool(selection)
        and all(getattr(study.readings, name) == selection[0][name] for name in SELECTED),
        "selected_of": len(selection),
    }


def _picture(path: Path, sweep: str) -> Markup:
    said = (
        f"The verdicts of every claim under every reading of the sweep of {sweep}; the table above sums "
        "it up."
    )
    return inline(path, f"readings-{sweep}", said)


def _turning(judged: pd.DataFrame, claim: str) -> list[str]:
    """The readings that alone make a claim hold, by its estimates, that does not under the study's."""
    own = judged[judged["claim"] == claim]
    default = own.loc[own["is_default"], "estimate_holds"]
    if own.empty or default.empty or bool(default.iloc[0]):
        return []
    alone = own[own["readings"].map(lambda text: len(json.loads(text)) == 1)]
    return [str(label) for label in alone.loc[alone["estimate_holds"], "label"]]


def rows(frame: pd.DataFrame) -> list[Row]:
    """The rows of a table by their columns' names."""
    return [{str(name): value for name, value in row.items()} for row in frame.to_dict("records")]


def _selection(results: Path) -> list[Row]:
    path = results / SELECTION
    return rows(read_table(path, OF_A_SELECTION, REMEDY)) if path.exists() else []
