"""Where everything of a study stands, from its folder of results: the one place that names these files.

A run's own files are named in ``ids``. Light, so that the workflow can read it.
"""

STUDY = "study.json"

RUNS = "tables/runs.parquet"
CELLS = "tables/cells.parquet"
VERDICTS = "tables/verdicts.parquet"
EVIDENCE = "tables/evidence.parquet"

TILES = "tables/tiles.parquet"
"""What a policy on the thesis's tiles can do, start by start (C9)."""

SELECTION = "tables/selection.parquet"
READINGS = "tables/readings.parquet"
DECISIVE = "tables/decisive.parquet"
ROBUST = "tables/robust.parquet"
"""What the sweeps over readings come to."""

BOUND = "tables/bound.parquet"
MAPS = "tables/bound_maps.parquet"
SETTLING = "tables/settling.parquet"
PREDICTION = "tables/prediction.parquet"
PREDICTION_LIMITS = "tables/prediction_limits.parquet"
CHANGES = "tables/changes.parquet"
SHORTEST = "tables/shortest.parquet"
CHOSEN = "tables/chosen.parquet"
"""What goes beyond the thesis."""

BENCHMARK = "tables/benchmark.parquet"
GROWTH = "tables/growth.parquet"
EDITS = "tables/edits.parquet"

FIGURES = "figures"
RECORDINGS = "recordings"
CHECKSUMS = "checksums"
LEDGER_OF_VERDICTS = "verdicts"
"""The ledger of verdicts and evidence; it has the claims by which they were judged."""
JOB_COSTS = "benchmarks"

PAGE = "report/index.html"
RUNS_CSV = "report/runs.csv"
EVIDENCE_CSV = "report/evidence.csv"
VIEWER = "report/viewer"
VIEWER_PAGE = f"{VIEWER}/index.html"
"""The page of the viewer, written last: with it the viewer is complete."""

BEYOND = "beyond"
"""The folder, in that of the thesis's study, of the study beyond it."""


def figure(name: str, ending: str) -> str:
    """A figure's picture (``svg``, ``png``) or its words (``json``)."""
    return f"{FIGURES}/{name}.{ending}"


def figure_of_sweep(sweep: str, ending: str) -> str:
    """The picture of a sweep over readings."""
    return figure(f"readings-{sweep}", ending)


def comparison(name: str) -> str:
    """A recording that compares runs: ``task-…`` or ``claim-…``."""
    return f"{RECORDINGS}/{name}.rrd"


def group_of_sweep(sweep: str, group: str) -> str:
    """The table of a job of a sweep."""
    return f"readings/{sweep}/{group}.parquet"


def finalists_of_sweep(sweep: str, number: int) -> str:
    """Which readings go on to a round of a sweep."""
    return f"readings/{sweep}/round-{number}.json"
