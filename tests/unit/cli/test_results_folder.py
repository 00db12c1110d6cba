"""The folder of results: ``--results`` means the same everywhere, and the old places still count."""

import inspect

import pandas as pd
import pytest

from tests.helpers import make_spec
from upswing.cli.main import PANELS, main
from upswing.cli.options import Named, Positional
from upswing.study.ids import file_of

WITHOUT = {"check", "init", "schema", "keys"}
"""What neither reads nor writes a folder of results."""

OPTION_ONLY = {"train", "study", "shortest", "browse", "watch", "play", "site", "adopt"}
"""What took the folder only as an option before, because its arguments are others."""

READERS = [
    ["verdicts"], ["figure", "5"], ["doctor"], ["clean-orphans"], ["readme"], ["exploratory"], ["screenshots"],
    ["tables"], ["comparison", "task-balancing"], ["comparisons"], ["viewer"], ["report"], ["changes"], ["readings"],
    ["sweep", "networks", "group"], ["finalists", "networks", "2"],
]  # fmt: skip
"""What takes it in both ways, with the arguments that come first."""

MAKERS = ["bound", "settling", "prediction", "tiles"]
"""What takes it in both ways, too, and needs nothing in it."""


def annotations():
    return {
        command.name: [
            parameter.annotation
            for parameter in inspect.signature(command.callback).parameters.values()
        ]
        for panel in PANELS
        for command in panel.registered_commands
    }


def test_every_subcommand_with_results_has_the_option():
    assert {name for name, own in annotations().items() if Named not in own} == WITHOUT


def test_the_folder_is_an_argument_where_it_was_one():
    asked = {name for name, own in annotations().items() if Positional in own}
    assert asked == {*(words[0] for words in READERS), *MAKERS}
    assert asked == annotations().keys() - WITHOUT - OPTION_ONLY - {"compare"}


@pytest.mark.parametrize("words", READERS, ids=lambda words: words[0])
def test_both_ways_name_the_same_folder(words, tmp_path, capsys):
    said = []
    for given in (
        [str(tmp_path)],
        ["--results", str(tmp_path)],
        [str(tmp_path), "--results", str(tmp_path)],
    ):
        assert main([*words, *given]) == 2
        said.append(capsys.readouterr().err)
    assert f"{tmp_path}/" in said[0]
    assert said == said[:1] * 3


@pytest.mark.parametrize(
    "words", [*READERS, *([name] for name in MAKERS), ["compare", "a"]], ids=lambda words: words[0]
)
def test_two_folders_are_a_mistake_in_one_line(words, tmp_path, capsys):
    one, other = tmp_path / "one", tmp_path / "other"
    assert main([*words, str(one), "--results", str(other)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert f"'--results': {other}, while the argument says {one}" in said
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("name", "writes"),
    [("bound", "bound.write_bound"), ("tiles", "represented.write_represented")],
)
def test_what_needs_nothing_is_written_where_it_was_asked_for(tmp_path, monkeypatch, name, writes):
    written = []

    def write(folder, *_):
        written.append(folder)
        return pd.DataFrame({"success": [True, False]})

    monkeypatch.setattr(f"upswing.optimal.{writes}", write)
    assert main([name, str(tmp_path)]) == 0
    assert main([name, "--results", str(tmp_path)]) == 0
    assert written == [tmp_path] * 2


def test_without_a_folder_it_is_results(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["tables"]) == 2
    assert "  results/study.json: missing" in capsys.readouterr().err


def test_training_writes_where_it_was_asked_to(tmp_path):
    spec = make_spec(steps=100)
    assert main(["train", spec.canonical(), "--results", str(tmp_path)]) == 0
    assert (tmp_path / file_of(spec.run(0), "windows.parquet")).is_file()


def test_one_folder_is_compared_with_that_of_the_option(results, tmp_path, capsys):
    folder = str(results.folder)
    assert main(["compare", folder, "--results", folder]) == main(["compare", folder, folder]) == 0
    said = capsys.readouterr().out
    assert said[: len(said) // 2] == said[len(said) // 2 :]
