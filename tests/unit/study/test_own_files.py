"""Claims and figures that stand beside a configuration: found by name, and nowhere else."""

from pathlib import Path

import pytest
import yaml

from tests.paths import ROOT
from upswing.study import jobs
from upswing.study.check import asked, checked
from upswing.study.claim_parts import Part
from upswing.study.claims import Claim, load_claims
from upswing.study.config import from_snakemake, load, validated
from upswing.study.errors import BadInput
from upswing.study.own_figures import FigureFile

CELL = "balancing/table/alpha-1"
STUDY = {
    "results": "results/mine",
    "seeds": 2,
    "tasks": {"balancing": {"kind": "balancing", "steps": 500}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]}],
}
CLAIM = {
    "statement": "It balances.",
    "parts": [
        {"says": "runs balance", "kind": "share", "cells": [CELL], "because": "so many",
         "where": {"falls": {"at_most": 0}}, "at_least": 0.8, "partly": 0.5}
    ],
}  # fmt: skip
CODE = '''"""Words."""
from upswing.figures.declaration import Declaration

FIGURE = Declaration("Rewards", "", ())
'''


def written(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    text = content if isinstance(content, str) else yaml.safe_dump(content)
    path.write_text(text, "utf-8")
    return path


@pytest.fixture
def folder(tmp_path):
    """A folder ``config`` with a file of claims and one of a figure, and files beside it."""
    written(tmp_path / "config/own/claims.yaml", {"S1": CLAIM})
    written(tmp_path / "config/figures/mean_rewards.py", CODE)
    written(tmp_path / "others.yaml", {"S1": CLAIM})
    written(tmp_path / "evil.py", CODE)
    return tmp_path


def study(folder, **more):
    return written(folder / "config/mine.yaml", {**STUDY, **more})


def problems_of(folder, **more):
    with pytest.raises(BadInput) as refused:
        load(study(folder, **more))
    return refused.value.problems


def test_files_are_named_from_the_configurations_own_folder(folder, monkeypatch):
    monkeypatch.chdir(folder)
    written(
        folder / "config/mine.yaml",
        {**STUDY, "claims": "own/claims.yaml", "figures": ["mean-rewards"]},
    )
    path = Path("config/mine.yaml")
    for found in (load(path), from_snakemake([path], {})):
        assert found.claims == "config/own/claims.yaml"
        assert found.figures == (
            FigureFile(name="mean-rewards", file="config/figures/mean_rewards.py"),
        )
        assert found.figure_names == ("mean-rewards",)


def test_files_below_the_working_folder_are_named_from_it_however_the_configuration_was(
    folder, monkeypatch
):
    own = {"claims": "own/claims.yaml", "figures": ["mean-rewards"]}
    path = study(folder, **own)
    monkeypatch.chdir(folder)
    # Snakemake names its configuration files from the root.
    found = from_snakemake([str(path)], {**STUDY, **own})
    assert found == load(Path("config/mine.yaml"))
    assert found.claims == "config/own/claims.yaml"
    assert str(folder) not in found.model_dump_json()
    monkeypatch.chdir("/")
    assert from_snakemake([str(path)], {**STUDY, **own}).claims.endswith("config/own/claims.yaml")


def test_who_extends_a_configuration_has_its_files_where_they_are(folder):
    study(folder, claims="own/claims.yaml", figures=["mean-rewards"])
    child = written(
        folder / "config/below/mine.yaml", {"extends": "../mine.yaml", "results": "results/b"}
    )
    found = load(child)
    assert (folder / "config/own/claims.yaml").samefile(found.claims)
    assert (folder / "config/figures/mean_rewards.py").samefile(found.figures[0].file)


def test_an_overlay_is_named_from_the_configurations_folder_too(folder):
    found = from_snakemake([study(folder)], {**STUDY, "figures": ["mean-rewards"]})
    assert (folder / "config/figures/mean_rewards.py").samefile(found.figures[0].file)


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        ({"claims": "nothing.yaml"}, "claims: \"nothing.yaml\": there is no such file in "),
        ({"claims": "../others.yaml"}, "claims: \"../others.yaml\": must lie in "),
        ({"figures": ["mean-reward"]}, "did you mean 'mean-rewards'?"),
        ({"figures": ["../evil"]}, 'figures[0]: "../evil": no such figure'),
        ({"figures": [{"name": "evil", "file": "../evil.py"}]}, "figures[0].file: unknown key: write the name alone"),
        ({"figures": ["mean-rewards", "mean-rewards"]}, "'mean-rewards' stands there twice"),
        ({"figures": [3]}, "must be the name of a figure, or a mapping"),
        ({"claims": "x" * 5000}, "claims: "),
    ],
)  # fmt: skip
def test_what_is_not_beside_the_configuration_is_refused_in_one_line(folder, more, expected):
    (line,) = problems_of(folder, **more)
    assert expected in line
    assert "config/mine.yaml: " in line
    assert len(line) < 800


def test_problems_of_files_are_said_with_all_others(folder):
    lines = problems_of(folder, claims="nothing.yaml", figures=["nothing"], seeds=-1)
    assert len(lines) == 3


def test_a_link_that_leads_out_of_the_folder_is_refused(folder):
    (folder / "config/figures/evil.py").symlink_to(folder / "evil.py")
    (line,) = problems_of(folder, figures=["evil"])
    assert "must lie in" in line


def test_a_name_of_the_projects_figures_is_not_taken(folder):
    written(folder / "config/figures/overview.py", CODE)
    (line,) = problems_of(folder, figures=["overview"])
    assert "the project has a figure of this name" in line
    assert load(study(folder, figures=["bound"])).figures == ("bound",)


def test_a_study_is_judged_by_its_own_claims_and_by_no_other(folder):
    thesis, sweeps = ROOT / "config/claims.yaml", ROOT / "config/readings.yaml"
    path = study(folder, claims="own/claims.yaml")
    assert list(asked([path], {}, thesis, sweeps).claims) == ["S1"]
    assert len(asked([study(folder)], {}, thesis, sweeps).claims) == 16  # those of the thesis


def test_checking_names_what_is_wrong_with_own_claims(folder):
    wrong = {**CLAIM, "figure": "nowhere", "cell": "balancing/tabel/alpha-1"}
    written(folder / "config/own/claims.yaml", {"S1": wrong})
    with pytest.raises(BadInput) as refused:
        checked(study(folder, claims="own/claims.yaml"), None, folder / "none.yaml")
    assert "own/claims.yaml: S1.cell: " in str(refused.value)
    written(folder / "config/own/claims.yaml", {"S1": {**CLAIM, "figure": "mean-reward"}})
    path = study(folder, claims="own/claims.yaml", figures=["mean-rewards"])
    with pytest.raises(BadInput) as refused:
        checked(path, None, folder / "none.yaml")
    expected = "S1.figure: \"mean-reward\": no figure of this study; did you mean 'mean-rewards'?"
    assert expected in str(refused.value)


def test_checking_runs_no_code_of_a_figure(folder):
    written(folder / "config/figures/mean_rewards.py", "raise SystemExit(3)\n")
    checked(study(folder, figures=["mean-rewards"]), None, folder / "none.yaml")


def test_a_figures_job_depends_on_its_file_and_on_what_it_imports(folder):
    (figure,) = load(study(folder, figures=["mean-rewards"])).figures

    def code(text):
        written(folder / "config/figures/mean_rewards.py", text)
        return jobs.figure(figure)

    first = code(CODE).fingerprint
    assert code(CODE.replace("Words", "Others") + "# a comment\n").fingerprint == first
    assert code(CODE.replace("Rewards", "Costs")).fingerprint != first
    more = code(CODE + "\n\ndef draw(results):\n    from upswing.optimal.viability import viable\n")
    assert "upswing.optimal.viability" in more.modules - code(CODE).modules
    assert more.fingerprint != first
    written(folder / "config/figures/mean_rewards.py", "def (")
    assert jobs.figure(figure).fingerprint != first  # what is wrong is said when it is run


@pytest.mark.parametrize(
    ("figure", "expected"),
    [
        (12, "the thesis's figures of runs are 5 to 11"),
        (True, "must be a figure of the thesis, 5 to 11, or the name of one of the study's"),
        (7.5, "must be a figure of the thesis, 5 to 11, or the name of one of the study's"),
        ("Figure 7", "a name has small letters"),
    ],
)
def test_what_is_no_figure_is_refused(folder, figure, expected):
    path = written(folder / "config/own/claims.yaml", {"S1": {**CLAIM, "figure": figure}})
    with pytest.raises(BadInput) as refused:
        load_claims(path)
    (line,) = refused.value.problems
    assert "claims.yaml: S1.figure: " in line
    assert expected in line


def test_a_claim_leaves_out_what_it_has_not_and_a_seventeenth_is_as_good_as_the_others(folder):
    thesis = yaml.safe_load((ROOT / "config/claims.yaml").read_text("utf-8"))
    path = written(folder / "config/own/claims.yaml", {**thesis, "S17": CLAIM})
    found = load_claims(path)
    assert len(found) == len(thesis) + 1 == 17
    last = found["S17"]
    assert (last.figure, last.cell, last.section, last.check, last.note) == (None, None, "", "", "")


def test_every_key_of_a_claim_is_in_the_reference():
    reference = (ROOT / "config/README.md").read_text("utf-8")
    section = reference[reference.index("## A claim,") : reference.index("## A sweep,")]
    for model in (Claim, Part):
        for key, field in model.model_fields.items():
            assert f"| `{key}` |" in section
            assert field.description
            assert field.description in section


@pytest.mark.parametrize(
    ("own", "refused"),
    [({}, False), ({"pendulum": {"length": 0.4}}, True), ({"tiles": {"velocity_parts": 8}}, True)],
)
def test_what_a_table_can_represent_is_asked_of_the_thesiss_pendulum_alone(tmp_path, own, refused):
    claim = yaml.safe_load((ROOT / "config/claims.yaml").read_text("utf-8"))["C9"]
    path = tmp_path / "claims.yaml"
    path.write_text(yaml.safe_dump({"C9": claim}), "utf-8")
    task, architecture, _ = claim["cell"].split("/")
    tasks = {
        name: {"kind": "full-control", "steps": 1_000, **own} for name in (task, "full-control")
    }
    study = {
        "seeds": 1, "tasks": tasks, "architectures": {architecture: {"learner": "table"}},
        "experiments": [
            {"tasks": list(tasks), "architectures": [architecture], "alphas": [0.001, 0.01, 1]}
        ],
    }  # fmt: skip
    try:
        load_claims(path, validated({"study": study}))
        said = ""
    except BadInput as error:
        said = str(error)
    assert ("searched for the thesis's pendulum and tiles alone" in said) == refused
    assert (said == "") != refused
