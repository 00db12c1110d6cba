"""``make bench-edits``: what an edit costs, from saving it until the page is right again.

In a copy of the project with its results, so that nothing here is touched. Each edit is made, the study
run as ``make reproduce`` runs it, undone, and run again; the least of three.
"""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import pandas as pd
from rich.console import Console
from rich.table import Table

from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.study.paths import EDITS

BIN = Path(sys.executable).parent
REPETITIONS = 3
COPIED = ("Snakefile", "workflow", "report", "config", "src")
ALPHAS = "alphas: [1, 0.75, 0.5, 0.1, 0.01, 0.001]"
"""The first step sizes in ``config/config.yaml``: those of tables that balance."""


class Edit(NamedTuple):
    """Something that one changes, and how long it may take."""

    name: str
    goal: float  # [s]; of the way back the same, where nothing else is said
    file: str = ""
    old: str = ""
    new: str = ""
    goal_of_undoing: float | None = None


EDITS_MADE = (
    Edit("nothing", 2.0),
    Edit(
        "one new α (a cell of balancing)", 13.0, "config/config.yaml", ALPHAS,
        ALPHAS.replace("[1,", "[1, 0.{number},"), 6.0,
    ),
    Edit("a threshold", 6.0, "config/claims.yaml", "at_least: 0.98", "at_least: 0.97"),
    Edit("a line's width in a shared panel", 15.0, "src/upswing/figures/panels.py", "linewidth=1.8", "linewidth=1.7"),
    Edit("one figure's own code", 7.0, "src/upswing/figures/fig05.py", "5_000", "4_000"),
    Edit("a word in the page's template", 5.0, "report/parts/head.html.j2", "</h1>", " again</h1>"),
)  # fmt: skip
FROM_NOTHING = Edit("everything from nothing", 380.0)
"""The goal was 110 s for 1,020 runs, so it is 380 s for 3,500."""


def study(folder: Path) -> float:
    """Run the study in ``folder``; how long it took [s]."""
    environment = {
        **{key: text for key, text in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"},
        "PATH": f"{BIN}:{os.environ['PATH']}",
        "PYTHONPATH": str(folder / "src"),
    }
    begin = time.perf_counter()
    for command in (
        [BIN / "upswing", "check", "config/config.yaml"],
        [
            BIN / "snakemake", "--cores", "all", "--profile", "workflow/profiles/default",
            "--logger", "rich", "--configfile", "config/config.yaml",
        ],
    ):  # fmt: skip
        subprocess.run(
            command, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )  # fmt: skip
    return time.perf_counter() - begin


def measure(results: Path) -> pd.DataFrame:
    """One row for each edit and one for each way back: seconds, and the goal."""
    rows = []
    with TemporaryDirectory(dir=results.resolve().parent) as temporary:
        folder = Path(temporary)
        for name in COPIED:
            copy = shutil.copytree if Path(name).is_dir() else shutil.copy
            copy(name, folder / name)
        # Files of runs are replaced whole, so the copies may share their content with the originals.
        shutil.copytree(
            results, folder / "results", ignore=shutil.ignore_patterns("runs", "beyond")
        )
        shutil.copytree(results / "runs", folder / "results/runs", copy_function=os.link)
        study(folder)  # whatever the copy is not yet
        for edit in EDITS_MADE:
            there, back = [], []
            for number in range(REPETITIONS):
                if not edit.file:
                    there.append(study(folder))
                    continue
                path = folder / edit.file
                kept = path.read_text("utf-8")
                # An α that was there before has its runs still.
                new = edit.new.replace("{number}", str(61 + number))
                path.write_text(kept.replace(edit.old, new, 1), "utf-8")
                assert path.read_text("utf-8") != kept, f"{edit.old!r} is no longer in {edit.file}"
                there.append(study(folder))
                path.write_text(kept, "utf-8")
                back.append(study(folder))
            rows.append(_row(edit.name, min(there), edit.goal))
            if back:
                goal = edit.goal_of_undoing or edit.goal
                rows.append(_row(f"… undone: {edit.name}", min(back), goal))
            print(rows[-2:], flush=True)
        shutil.rmtree(folder / "results")
        shutil.rmtree(folder / ".snakemake")
        rows.append(_row(FROM_NOTHING.name, study(folder), FROM_NOTHING.goal))
    return pd.DataFrame(rows)


def _row(name: str, seconds: float, goal: float) -> dict[str, object]:
    return {"edit": name, "seconds": seconds, "goal": goal, "met": seconds <= goal}


def main() -> int:
    """Measure, print and write the table; the folder of results may be given."""
    results = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("results")
    frame = measure(results)
    table = Table("what one does", "seconds", "goal", title="From an edit to the page")
    for row in frame.to_dict("records"):
        sign = "✓" if row["met"] else "✗"
        table.add_row(row["edit"], f"{row['seconds']:.1f}", f"≤ {row['goal']:g} {sign}")
    Console().print(table)
    write_table(results / EDITS, frame)
    seal(results, "edits", [results / EDITS])
    return 0


if __name__ == "__main__":
    sys.exit(main())
