"""Every claim under every reading of a sweep: a column a reading, the verdict as a colour."""

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from upswing.analysis.robustness.tables import OF_A_READING, REMEDY
from upswing.figures.style import GRID, WIDTH, save, subplots
from upswing.runs.files.ledger import seal
from upswing.runs.files.typed_table import read_table
from upswing.study.errors import BadInput
from upswing.study.paths import READINGS, figure_of_sweep
from upswing.study.readings import options_of
from upswing.study.sweeps import Sweep, number_of

SHADES = {
    "reproduced": "#0B6B3A",
    "partly": "#8CC9A1",
    "inconclusive": "#D9D9D9",
    "not reproduced": "#D98880",
}
ROW = 0.17
"""Height of a row [inch]."""


def draw_readings(results: Path, sweeps: Mapping[str, Sweep]) -> list[Path]:
    """Draw ``figures/readings-NAME`` for each sweep that was judged; returns the pictures' paths."""
    judged = read_table(results / READINGS, OF_A_READING, REMEDY)
    paths = []
    for name, of in judged.groupby("sweep", sort=False):
        if name not in sweeps:
            raise BadInput([f"{results / READINGS}: {name}: is no sweep of this study; {REMEDY}"])
        picture = results / figure_of_sweep(str(name), "svg")
        save(draw_sweep(of, sweeps[str(name)]), picture.with_suffix(""))
        paths.append(picture)
    seal(results, "figures/readings", [p.with_suffix(e) for p in paths for e in (".svg", ".png")])
    return paths


def draw_sweep(judged: pd.DataFrame, sweep: Sweep) -> Figure:
    """The verdicts of a sweep above, the options of each reading below.

    Columns stand in the order of how many claims hold under them; the default is framed.

    Args:
        judged: the sweep's rows of the table of readings.
        sweep: what was varied.
    """
    claims = sorted(judged["claim"].unique(), key=lambda claim: int(claim[1:]))
    table = judged.pivot(index="claim", columns="readings", values="verdict").loc[claims]
    holds = judged.pivot(index="claim", columns="readings", values="holds").sum()
    columns = sorted(table.columns, key=lambda text: (-holds[text], text))
    table = table[columns]
    codes = {verdict: code for code, verdict in enumerate(SHADES)}
    options = [(name, option) for name in sweep.vary for option in options_of(name)]
    options = options if sweep.how == "grid" else [o for o in options if _is_varied(columns, *o)]
    figure, (above, below) = subplots(
        2, 1, figsize=(WIDTH, ROW * (len(claims) + len(options)) + 1.3),
        height_ratios=(len(claims), len(options)), sharex=True,
    )  # fmt: skip
    picture = np.array(
        [[codes.get(str(verdict), np.nan) for verdict in table.loc[claim]] for claim in claims]
    )
    above.pcolormesh(
        picture, cmap=ListedColormap(list(SHADES.values())), vmin=0, vmax=len(SHADES) - 1,
        edgecolors="white", linewidth=0.3, rasterized=True,
    )  # fmt: skip
    above.set_yticks(np.arange(len(claims)) + 0.5, claims)
    above.invert_yaxis()
    above.legend(
        handles=[Patch(color=shade, label=verdict) for verdict, shade in SHADES.items()],
        ncols=4, loc="lower left", bbox_to_anchor=(0, 1.0), frameon=False, borderaxespad=0.2,
    )  # fmt: skip
    chosen = [json.loads(text) for text in columns]
    for row, (name, option) in enumerate(options):
        at = [column for column, readings in enumerate(chosen) if readings.get(name) == option]
        below.plot(
            np.array(at) + 0.5, np.full(len(at), row + 0.5), "s", color="#333333", markersize=1.8
        )
        if name != options[row - 1][0] and row:
            below.axhline(row, color=GRID, linewidth=0.8)
    below.set_yticks(
        np.arange(len(options)) + 0.5, [f"{number_of(name)} {option}" for name, option in options]
    )
    below.set_ylim(len(options), 0)
    below.set_xlabel(f"{len(columns)} readings, those first under which most claims hold")
    default = judged.loc[judged["is_default"], "readings"].unique()
    for text in default:
        place = columns.index(text)
        for axes, rows in ((above, len(claims)), (below, len(options))):
            axes.plot(
                [place, place, place + 1, place + 1, place], [0, rows, rows, 0, 0], color="black",
                linewidth=1.2, clip_on=False,
            )  # fmt: skip
    for axes in (above, below):
        axes.grid(visible=False)
        axes.tick_params(length=0)
        axes.set_xticks([])
    return figure


def _is_varied(columns: list[str], name: str, option: object) -> bool:
    return any(json.loads(text).get(name) == option for text in columns)
