"""``make bench-growth``: how time and size grow with seeds and with steps. Takes a quarter of an hour."""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pandas as pd

from tests.benchmarks.rivals import ours, specification
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.runs.train import train
from upswing.study.paths import GROWTH

SEEDS = (10, 30, 100)
STEPS = (100_000, 1_000_000, 10_000_000)


def of_seeds() -> list[dict[str, object]]:
    """The whole study from nothing with more and more seeds: wall and processor time, size."""
    rows: list[dict[str, object]] = []
    for seeds in SEEDS:
        with tempfile.TemporaryDirectory() as folder:
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            begin = time.perf_counter()
            subprocess.run(
                [
                    str(Path(sys.executable).with_name("snakemake")), "--cores", "all", "--profile",
                    "workflow/profiles/default", "--configfile", "config/config.yaml", "--config",
                    f"seeds={seeds}", f"results={folder}",
                ],
                env={**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"},
                check=True, capture_output=True,
            )  # fmt: skip
            wall = time.perf_counter() - begin
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            rows.append(
                {
                    "grows": "seeds",
                    "to": seeds,
                    "seconds": wall,
                    "cpu_seconds": cpu,
                    "megabytes": size_of(Path(folder)),
                }
            )
            print(rows[-1], flush=True)
    return rows


def of_steps() -> list[dict[str, object]]:
    """A run with more and more steps: time a step, size of what is stored."""
    rows: list[dict[str, object]] = []
    for learner in ("table", "networks-5"):
        for steps in STEPS:
            taken = min(ours(learner, steps, seed) for seed in range(3)) * steps / 1e9
            with tempfile.TemporaryDirectory() as folder:
                train(specification(learner, steps), Path(folder))
                rows.append(
                    {
                        "grows": f"steps of {learner}",
                        "to": steps,
                        "seconds": taken,
                        "cpu_seconds": taken,
                        "megabytes": size_of(Path(folder)),
                    }
                )
            print(rows[-1], flush=True)
    return rows


def size_of(folder: Path) -> float:
    """What a folder takes [MB]."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()) / 1e6


def main() -> int:
    """Measure, print and write the table; the folder of results may be given."""
    results = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("results")
    frame = pd.DataFrame(of_steps() + of_seeds())
    print(frame.to_string())
    (results / "tables").mkdir(parents=True, exist_ok=True)
    write_table(results / GROWTH, frame)
    seal(results, "growth", [results / GROWTH])
    return 0


if __name__ == "__main__":
    sys.exit(main())
