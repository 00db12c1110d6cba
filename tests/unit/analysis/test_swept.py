"""Sweeps that are run: their runs, their rounds, and the tables and figures that come of them."""

import json
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.unit.analysis.small_sweeps import STUDY, loaded, run
from upswing.analysis.robustness.outdated import outdated
from upswing.analysis.robustness.read import read_sweep
from upswing.analysis.robustness.selection import select, write_finalists
from upswing.analysis.robustness.shipped import over_readings
from upswing.analysis.robustness.tables import LEDGER_OF_READINGS
from upswing.analysis.robustness.write import write_readings
from upswing.figures.readings import draw_readings
from upswing.runs.files.ledger import ledger_path, read_ledger, seal
from upswing.runs.files.provenance import provenance
from upswing.runs.rows import collected
from upswing.runs.study_file import canonical, write_study
from upswing.runs.sweep import write_group
from upswing.runs.train import train
from upswing.study.claims import load_claims
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.paths import DECISIVE, READINGS, ROBUST, SELECTION, group_of_sweep
from upswing.study.readings import Readings
from upswing.study.sweeps import canonical_of, groups, readings_of, specs
from upswing.study.swept_from import ledger_of_group

CLAIMS = load_claims(Path("config/claims.yaml"))


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A folder in which the small sweeps were run, and the sweeps."""
    folder = tmp_path_factory.mktemp("swept")
    sweeps = loaded(folder)
    run(folder, sweeps)
    return folder, sweeps


def test_a_swept_run_is_the_run_that_training_makes(swept, tmp_path):
    folder, sweeps = swept
    under = {"first_q": "pessimistic"}
    rows = pd.read_parquet(folder / "readings/tables/as-the-study.parquet")
    rows = rows[rows["readings"] == canonical_of(under)]
    study = STUDY.model_copy(update={"readings": Readings(first_q="pessimistic"), "seeds": (0, 1)})
    matrix = Matrix(study)
    write_study(canonical(study), tmp_path)
    for spec in specs(sweeps["tables"], STUDY, under):
        train(spec, tmp_path)
    cells = {spec.cell for spec in specs(sweeps["tables"], STUDY, under)}
    for cell in set(matrix.cells) - cells:
        train(matrix.cells[cell], tmp_path)
    trained = collected(tmp_path, matrix.cells.values()).set_index("run")
    assert len(rows) == 6
    for row in rows.to_dict("records"):
        compared = [
            "falls", "upright_share", "upright_at_end", "mean_reward", "greedy_success_share"
        ]  # fmt: skip
        if row["architecture"] == "table":  # a control's TD errors are stored as unknown
            compared.append("digest")
        for name in compared:
            assert row[name] == trained.at[row["run"], name], (row["run"], name)


def finalists(folder, number):
    text = (folder / f"readings/networks/round-{number}.json").read_text("utf-8")
    return [canonical_of(overrides) for overrides in json.loads(text)]


def test_the_likeliest_readings_go_on_and_no_others(swept):
    folder, sweeps = swept
    sweep = sweeps["networks"]
    every = {canonical_of(overrides) for overrides in readings_of(sweep, STUDY)}
    for number, count in ((2, 4), (3, 1)):
        before = read_sweep(folder, "networks", sweep, STUDY, before=number)
        ranked = select(before, sweep.reports)["readings"]
        assert finalists(folder, number) == ranked[:count].tolist()
        assert set(finalists(folder, number)) < every
    assert set(finalists(folder, 3)) < set(finalists(folder, 2))


def test_every_reading_has_the_runs_of_the_rounds_that_it_was_in(swept):
    folder, sweeps = swept
    runs = read_sweep(folder, "networks", sweeps["networks"], STUDY)
    seeds = runs.groupby(["readings", "cell"])["seed"].agg(sorted).unstack()
    second, third = finalists(folder, 2), finalists(folder, 3)
    for reading, row in seeds.drop(index="{}").iterrows():
        count = 5 if reading in third else 4 if reading in second else 2
        own = list(range(1000, 1000 + count))
        assert row["balancing/networks-5/alpha-1"] == own
        assert row["full-control/modular-networks-5/alpha-1"] == own
        assert row["full-control/networks-30/alpha-1"] == own[::3]
        of_rounds = row["full-control/networks-5/alpha-1"]
        assert of_rounds == own[2:] if count > 2 else np.isnan(of_rounds)
        assert np.isnan(row["balancing/table/alpha-1"])
    assert seeds.loc["{}", "balancing/table/alpha-1"] == [1000, 1001, 1002]
    assert seeds.loc["{}"].notna().sum() == 2
    assert not runs.duplicated(["readings", "run"]).any()


def test_its_tables_and_figures_are_made(swept):
    folder, sweeps = swept
    names = ("C1", "C2", "C3", "C4", "C12", "C13", "C14", "C15", "C16")
    robust = write_readings(folder, sweeps, {name: CLAIMS[name] for name in names})
    robust = robust.set_index("claim")
    judged = pd.read_parquet(folder / READINGS)
    assert robust.loc[["C12", "C13"], "readings"].tolist() == [9, 9]
    assert robust.at["C1", "readings"] == 1 + 5 + 6
    assert robust.at["C3", "readings"] == 1 + 5  # one of its cells is run for single changes alone
    assert "C16" not in robust.index
    of_networks = {"C4", "C12", "C13", "C14", "C15"}
    assert set(judged.loc[judged["sweep"] == "networks", "claim"]) == of_networks
    verdicts = ["reproduced", "partly", "inconclusive", "not reproduced"]
    assert (robust[verdicts].sum(axis=1) == robust["readings"]).all()
    assert judged.groupby("claim")["is_default"].sum().eq(1).all()
    assert robust["left_out"].to_dict() == {
        "C1": "p5", "C2": "p5", "C3": "p5", "C4": "p7", **dict.fromkeys(["C12", "C13", "C14", "C15"], "p11"),
    }  # fmt: skip
    assert judged["probability"].between(0, 1).all()
    for share in ("held_share", "weighted_share", "weighted_low", "weighted_high"):
        assert robust[share].between(0, 1).all()
    assert (robust["weighted_low"] <= robust["weighted_high"]).all()
    selection = pd.read_parquet(folder / SELECTION)
    # A reading's runs of the reports: of the simple, the modular and every third of the large networks.
    assert selection["runs"].tolist() == [5 + 5 + 2, *[4 + 4 + 2] * 3, *[2 + 2 + 1] * 5]
    assert set(pd.read_parquet(folder / DECISIVE).columns) >= {
        "claim",
        "readings",
        "effect",
        "under",
    }
    assert len(pd.read_parquet(folder / ROBUST)) == len(robust)
    for path in draw_readings(folder, sweeps):
        assert path.stat().st_size > 5_000
        assert path.with_suffix(".png").exists()


def test_missing_groups_are_named(swept, tmp_path):
    _, sweeps = swept
    write_study(canonical(STUDY), tmp_path)
    with pytest.raises(BadInput, match="`make readings` makes them"):
        write_readings(tmp_path, sweeps, CLAIMS)
    with pytest.raises(BadInput, match="no such group; did you mean 'as-the-study'"):
        write_group(tmp_path, STUDY, "tables", sweeps["tables"], "as-the-studi", "")
    with pytest.raises(BadInput, match="`make readings` makes them"):
        write_finalists(tmp_path, STUDY, "networks", sweeps["networks"], 2)


@pytest.mark.parametrize(
    ("text", "said"),
    [(None, "missing"), ("[]", "says not"), ("{", "says not"), ("[1]", "says not")],
)
def test_a_round_without_finalists_says_how_they_are_named(swept, tmp_path, text, said):
    _, sweeps = swept
    sweep, path = sweeps["networks"], tmp_path / "readings/networks/round-2.json"
    if text is not None:
        path.parent.mkdir(parents=True)
        path.write_text(text, "utf-8")
    later = next(group for group in groups(sweep, STUDY) if group.round == 2)
    with pytest.raises(
        BadInput, match=f"{said}.*; `upswing finalists networks 2 {tmp_path}` makes it"
    ):
        write_group(tmp_path, STUDY, "networks", sweep, later.name, "")


def test_what_changed_since_the_sweeps_is_said(swept, tmp_path):
    """Of the code and the settings of a sweep, of the code that judges, and of claims."""
    folder = tmp_path / "results"
    shutil.copytree(swept[0], folder)
    sweeps, claims = swept[1], {name: CLAIMS[name] for name in ("C1", "C2", "C12")}
    write_readings(folder, sweeps, claims)

    def changed(sweeps=sweeps, claims=claims, study=STUDY):
        return outdated(folder, sweeps, claims, study).changed

    assert outdated(folder, sweeps, claims, STUDY).commit == provenance().git_commit
    assert changed() == []
    other = STUDY.model_copy(update={"epsilon": 0.02})
    assert changed(study=other) == ["the sweeps of networks and tables"]
    more = {**sweeps, "tables": sweeps["tables"].model_copy(update={"seeds": 3})}
    assert changed(sweeps=more) == ["the sweep of tables"]
    part = CLAIMS["C2"].parts[0].model_copy(update={"at_least": 0.123})
    stricter = CLAIMS["C2"].model_copy(update={"parts": (part, *CLAIMS["C2"].parts[1:])})
    now = {**claims, "C2": stricter}
    assert changed(claims=now) == ["C2"]
    assert set(over_readings(folder, tmp_path, now)[0]) == {"C1", "C12"}
    group = groups(sweeps["tables"], STUDY)[0].name
    ledger = ledger_path(folder, ledger_of_group("tables", group))
    made = read_ledger(ledger).made_from
    table = folder / group_of_sweep("tables", group)
    seal(folder, ledger_of_group("tables", group), [table], **{**made, "code": "older"})
    assert changed() == ["the sweep of tables"]
    ledger_path(folder, LEDGER_OF_READINGS).unlink()  # of a version that kept nothing of this
    assert changed() == ["the sweep of tables", "the code that judges"]
