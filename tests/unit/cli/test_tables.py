"""What is printed: 80 columns in a terminal, a line a row in a pipe."""

import shutil
from pathlib import Path

import pandas as pd
import pytest

from tests.unit.cli.terminal import ANSI, BOXES, columns_of, in_pipe, in_terminal
from upswing.analysis.compare import Comparison, Interval, OfACell, OfAPart
from upswing.analysis.doctor import Diagnosis, Finding
from upswing.analysis.history.configuration import Difference
from upswing.cli.shown.beyond import print_changes, print_chosen
from upswing.cli.shown.compare import print_comparison
from upswing.cli.shown.folders import print_diagnosis
from upswing.cli.shown.readings import print_robustness
from upswing.cli.terminal import print_table, say
from upswing.study.claims import load_claims

CLAIMS = load_claims(Path("config/claims.yaml"))
LONG = "full-control-25k/tilings-gamma-97/alpha-0.01"


@pytest.fixture
def folder(results, tmp_path):
    return shutil.copytree(results.folder, tmp_path / "results")


@pytest.fixture(params=[None, 80, 200], ids=["pipe", "80", "200"])
def room(request, monkeypatch):
    monkeypatch.setattr("upswing.cli.terminal.terminal_width", lambda: request.param)
    return request.param


def fits(text, room):
    return max(map(columns_of, text.splitlines())) <= (room or 10_000)


def test_verdicts_take_two_lines_or_so_in_80_columns(folder):
    shown = in_terminal(80, "verdicts", folder)
    _, header, *lines = shown.splitlines()  # the first says how to repeat it
    assert all(columns_of(line) <= 80 for line in (header, *lines))
    assert len(lines) <= 3 * len(CLAIMS) + 2
    assert sum(line.startswith("C") for line in lines) == len(CLAIMS)
    assert not BOXES.search(shown)
    assert ANSI.search(shown)
    plain = in_terminal(80, "verdicts", folder, NO_COLOR="1")
    # Where colorama is installed, numba has it reset the terminal when the program ends.
    assert not ANSI.search(plain.removesuffix("\x1b[0m"))
    words = " ".join(ANSI.sub("", shown).split())
    for claim in CLAIMS.values():
        assert claim.statement in words


def test_verdicts_in_a_pipe_are_a_line_a_claim(folder):
    done = in_pipe("verdicts", "--results", folder, COLUMNS="20")
    assert done.returncode == 0, done.stderr
    written = pd.read_parquet(folder / "tables/verdicts.parquet").set_index("claim")
    lines = done.stdout.splitlines()
    for name, claim in CLAIMS.items():
        (line,) = [line for line in lines if line.startswith(f"{name} ")]
        row = written.loc[name]
        assert line.endswith(claim.statement)
        for text in (row["verdict"], row["threshold"], f" {row['n']} "):
            assert text in line
        assert (f"{row['estimate']:.3g} [{row['low']:.3g}, {row['high']:.3g}]" in line) == bool(
            row["n"]
        )
    assert (
        len(lines) == len(CLAIMS) + 3
    )  # how to repeat it, the header, how many have which verdict
    assert lines[-1].startswith(f"{len(CLAIMS)} claims: ")
    assert not BOXES.search(done.stdout)
    assert not ANSI.search(done.stdout)


def test_details_say_what_was_measured_and_how(folder):
    shown = in_pipe("verdicts", folder, "--details").stdout
    for row in pd.read_parquet(folder / "tables/verdicts.parquet").to_dict("records"):
        own = shown.partition(f"\n{row['claim']} ")[2].partition("\nC")[0]
        for text in (row["measure"], row["cells"], row["method"], row["section"], row["note"]):
            assert text in own


def test_cells_stand_below_each_other_and_their_words_where_there_is_room(room, capsys):
    words = ["short", "so many words that they do not fit beside the others in eighty columns " * 2]
    print_table(
        ("cell", "n", "what it is"), [("a", "1"), ("φ̇ is long", "100")], right=("n",), words=words
    )
    lines = capsys.readouterr().out.splitlines()
    if room == 80:
        assert [line.rstrip() for line in lines[:3]] == [
            "cell         n",
            "a            1",
            "           short",
        ]
        assert lines[3].endswith("  100")
        assert all(line.startswith(" " * 11) for line in lines[4:])
    else:
        assert len(lines) == 3
        assert lines[0].endswith("n  what it is")
        assert lines[1].endswith("1  short")
    of_n = [
        columns_of(line[: line.index(n) + len(n)])
        for line, n in zip(lines, (" n", " 1"), strict=False)
    ]
    assert len(set(of_n)) == 1
    assert " ".join(words[1].split()) in " ".join(" ".join(lines).split())


def test_a_long_name_is_not_torn_apart(room, capsys):
    say(f"{'x' * 60}: {LONG}/seed-0 is another", 4)
    said = capsys.readouterr().out
    assert f"{LONG}/seed-0" in said
    assert fits(said, room)
    assert (said.count("\n") == 1) == (room != 80)


def change(**differing):
    row = {
        "cell": LONG, "change": "A control structure that learns", "sure": 29, "runs": 30,
        "upright": 0.98765, "stable_step": 1_234_567.0,
    }  # fmt: skip
    return {**row, **differing}


def test_changes_say_what_each_buys(room, capsys):
    print_changes(
        pd.DataFrame([change(), change(cell="b/c/alpha-1", sure=0, stable_step=float("inf"))])
    )
    said = capsys.readouterr().out
    assert fits(said, room)
    _, first, *others = said.splitlines()
    assert first.split()[:2] == [LONG, "29"]
    assert "0.988       1,234,567" in first
    assert any("0 of 30" in line and "never" in line for line in others)
    assert said.count("A control structure that learns") == 2


def test_the_chosen_say_after_how_long_they_are_reliable(room, capsys):
    row = {
        "title": "The shortest training", "architecture": "tilings-gamma-97", "alpha": 0.3,
        "discount": 0.97, "seeds": 40, "steps": 25_000.0, "sure": 40,
    }  # fmt: skip
    print_chosen(pd.DataFrame([row, {**row, "steps": float("inf"), "sure": 3}]))
    said = capsys.readouterr().out
    assert fits(said, room)
    assert "0.3  0.97  40 of 40       25,000" in said
    assert "3 of 40" in said
    assert "never" in said


def test_readings_say_under_how_many_a_claim_holds(room, capsys):
    row = {
        "claim": "C12", "sweep": "networks", "readings": 192, "holds": 7, "estimate_holds": 31,
        "default": "not reproduced", "reproduced": 3, "partly": 4, "inconclusive": 0, "not reproduced": 185,
    }  # fmt: skip
    print_robustness(pd.DataFrame([row]))
    said = capsys.readouterr().out
    assert fits(said, room)
    assert said.splitlines()[1].split()[:6] == ["C12", "not", "reproduced", "192", "7", "31"]
    assert "3 reproduced, 4 partly, 185 not reproduced (sweep networks)" in " ".join(said.split())


def test_a_comparison_and_a_diagnosis_are_wrapped_in_a_terminal_only(room, capsys):
    runs = [f"{LONG}/seed-{seed}" for seed in range(12)]
    values = (Interval(0.456, 0.4, 0.5), Interval(0.789, 0.7, 0.8))
    comparison = Comparison(
        configuration=[Difference("epsilon", ("0.01", "0.02"))],
        cells=[OfACell(LONG, "upright share", values)],
        same_cells=3,
        partial_cells=[(LONG, (False, True))],
        cells_known=True,
        verdicts=[("C1", ("partly", "reproduced"))],
        estimates=[OfAPart("C4", f"part 1, {LONG} : balancing/random/alpha-none", values)],
        changed_runs=runs,
        common_runs=30,
        partial_runs={(False, True): runs[:1]},
    )
    print_comparison(comparison, ["@1", "results"], ["@1 (20261126-062427-3fa2c1)", "the results"])
    command = f"rm 'results/{LONG}/seed-0.trajectory.parquet'  # and run the study again"
    finding = Finding(
        Path(f"results/{LONG}/seed-0.trajectory.parquet"), "is not what was written", command
    )
    print_diagnosis(Diagnosis(12, 99, [finding], [Path("orphan")], ["a note"]), Path("results"))
    said = capsys.readouterr().out
    assert command in said  # to be copied, however wide the terminal
    assert fits(said.replace(command, ""), room)
    for text in (
        "epsilon: 0.01 → 0.02",
        "0.456 [0.4, 0.5]",
        "apart",
        "C1: partly → reproduced",
        "0.456 → 0.789",
        "12 of 30 runs",
        "… and 2 more",
    ):
        assert text in " ".join(said.split())
    if room is None:
        of_cells = 2 + 1 + 2 + 1
        assert len(said.splitlines()) == 2 + 1 + of_cells + 1 + 1 + 1 + 11 + 2 + 2 + 2 + 1 + 1
