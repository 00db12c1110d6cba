"""All studies of a folder in one catalog: which there are, what is left out, what is said on the way."""

import json
import shutil
from pathlib import Path

import pytest

from upswing.analysis.aggregate import write_tables
from upswing.recordings import catalog as catalog_module
from upswing.recordings.catalog import catalog_of
from upswing.recordings.identical import once
from upswing.recordings.ports import free_port
from upswing.recordings.studies import choose, studies_in
from upswing.runs.recording.labels import LABELS
from upswing.runs.recording.layout import table_layout
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.runs.train import train
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.task import task_named

OTHER = {
    "seeds": 2,
    "tasks": {
        "balancing": {"kind": "balancing", "steps": 7_000},
        "full-control": {"kind": "full-control", "steps": 2_000},
    },
    "architectures": {
        "table": {"learner": "table"},
        "modular-table": {"learner": "table", "modular": True},
        "idle": {"learner": "control", "behaviour": "idle"},
    },
    "experiments": [
        {"tasks": ["full-control"], "architectures": ["table", "modular-table"], "alphas": [0.5]},
        # Two seeds of a cell that the study above has as well.
        {"tasks": ["balancing"], "architectures": ["idle"]},
    ],
}


def study_of(content, folder):
    study = validated({"study": content})
    matrix = Matrix(study)
    write_study(canonical(study), folder)
    for spec in matrix.cells.values():
        train(spec, folder)
    write_tables(folder, matrix)


@pytest.fixture(scope="module")
def folder(results, tmp_path_factory):
    """A folder of results with a study below it, a broken one, one of tables only, and a history."""
    folder = tmp_path_factory.mktemp("all") / "found"
    shutil.copytree(results.folder, folder)
    study_of(OTHER, folder / "mine")
    shutil.copytree(folder / "mine", folder / "tables-only", ignore=shutil.ignore_patterns("*.rrd"))
    shutil.copytree(folder / "mine", folder / "broken")
    (folder / "broken/study.json").write_text("{", "utf-8")
    (folder / "unfinished").mkdir()
    shutil.copy(folder / "mine/study.json", folder / "unfinished/study.json")
    entry = folder / "history/20261126-063000"
    entry.mkdir(parents=True)
    shutil.copy(folder / "mine/study.json", entry / "study.json")
    return folder


def test_studies_are_found_right_below_a_folder_and_the_history_is_none(folder):
    names = [found.folder.name for found in studies_in(folder)]
    assert names == ["found", "broken", "mine", "tables-only"]
    assert [found.folder for found in studies_in(folder / "mine")] == [folder / "mine"]


def test_what_is_left_out_is_said(folder):
    chosen, remarks = choose(folder, [])
    assert [one.study for one in chosen] == ["found", "mine"]
    said = "\n".join(remarks)
    assert "broken is left out: " in said
    assert "tables-only is left out: 6 of 6 runs have no recording" in said
    # Identical cells once: two modules of the table are the table, and these idle runs are known.
    assert "mine: modular-table is listed once, as table (1 cell)" in said
    assert "mine: idle is listed once, as idle of found (1 cell)" in said
    assert set(chosen[1].runs["cell"]) == {"full-control/table/alpha-0.5"}
    assert len(chosen[0].runs) == 12


def test_a_filter_asks_every_study_and_what_is_asked_for_by_name_is_listed(folder):
    chosen, _ = choose(folder, ["architecture=modular-table"])
    assert [(one.study, len(one.runs)) for one in chosen] == [("mine", 2)]
    with pytest.raises(BadInput, match="architecture=modular-tabel: no such run"):
        choose(folder, ["architecture=modular-tabel"])


def test_a_study_that_cannot_be_read_is_an_error_where_it_is_the_one_asked_for(folder):
    with pytest.raises(BadInput, match=r"study\.json"):
        choose(folder / "broken", [])


def test_one_catalog_has_a_dataset_for_each_task_of_each_study_and_says_how_far_it_is(
    folder, monkeypatch
):
    from rerun.catalog import CatalogClient

    monkeypatch.setattr(catalog_module, "AT_A_TIME", 4)
    chosen, _ = choose(folder, [])
    said = []
    with catalog_of(chosen, free_port(), said.append) as served:
        assert [*served.datasets] == [
            "found: balancing", "found: full-control", "mine: full-control",
        ]  # fmt: skip
        assert served.runs == 14
        client = CatalogClient(served.url)
        sizes = {name: len(client.get_dataset(name).segment_ids()) for name in served.datasets}
    assert [*sizes.values()] == [9, 3, 2]
    assert said[0] == "  4 of 14 recordings registered (found: balancing)"
    assert said[-1] == "  14 of 14 recordings registered (mine: full-control)"


def test_the_table_has_full_names_for_every_property_and_no_quotation_marks(results, tmp_path):
    import rerun as rr

    path = tmp_path / "table.rbl"
    table_layout(task_named("balancing", kind="balancing", steps=1)).save("upswing", path)
    reader = rr.chunk.RrdReader(path)
    (store,) = reader.blueprints()
    text = json.dumps(
        [
            str(batch[name].to_pylist())
            for chunk in reader.stream(store=store)
            for batch in [chunk.to_record_batch()]
            for name in batch.schema.names
        ],
        ensure_ascii=False,
    )
    for name in ("falls_last_fifth", "mean_reward", "first_stable_step", "arrival_speed"):
        assert LABELS[name] in text
    assert "rerun.components.EntityPath" in text


def test_what_is_listed_once_is_the_larger_of_two_or_the_first():
    def runs(*seeds):
        return frozenset((seed, f"digest-{seed}") for seed in seeds)

    found = once({"small": runs(1), "a": runs(1, 2), "b": runs(2, 1), "other": runs(2, 3)})
    assert found == {"a": ["b", "small"], "other": []}


def test_a_folder_without_a_study_says_how_to_make_one(tmp_path):
    with pytest.raises(BadInput, match="`make reproduce` makes"):
        choose(Path(tmp_path), [])
    assert isinstance(studies_in(tmp_path)[0], Results)
