"""The best that was found on the thesis's tiles → rows of a table."""

from collections.abc import Iterator

import numpy as np

from upswing.optimal.follow import from_starts
from upswing.optimal.rows import Row, of_starts, with_exploring
from upswing.optimal.solved import Solved
from upswing.optimal.tile_policy import Actions, TilePolicy, score, thesis_tiles
from upswing.optimal.tile_search import Found, learned, projected, search
from upswing.study.task import kind_of_task

BUDGET = 600
"""Number of changes that a search tries of each of the policies it begins with …"""

FURTHER = 3_000
"""… and then of the best."""

SEEDS = range(1000, 1004)
"""The tables that were learned to begin with: seeds that no verdict uses."""

LEARNED = {"balancing": (0.001, 50_000), "full-control": (0.01, 1_000_000)}
"""Their α, and for how many steps they learned."""

PROJECTED = (0.7, 0.97, 0.99)
"""The γ of the optimal policies to begin with, besides the fastest."""

GRID = "tiles"


def of_tiles(solved: Solved) -> Iterator[Row]:
    """What the search began with and what it found, for both tasks."""
    body = solved.body
    for kind in LEARNED:
        starts = beginnings(solved, kind)
        for name, actions in starts.items():
            scored = score(kind, body, actions, np.zeros(len(actions), dtype=np.int64))
            yield Row("tile_score", scored[0], "", GRID, kind, name, note="begun with")
        found = best_of(solved, kind, starts)
        note = "found by search: a lower bound of what the tiles allow"
        yield Row("tile_score", found.score[0], "", GRID, kind, "tiles", note=note)
        if kind_of_task(kind).judged_by == "upright":
            policy = TilePolicy(thesis_tiles(kind), found.actions)
            yield from of_starts(GRID, "tiles", None, from_starts(policy, body))
            yield from with_exploring(body, policy, GRID, "tiles")
        else:
            yield Row("tile_worst", found.score[1], "", GRID, kind, "tiles", note=note)


def beginnings(solved: Solved, kind: str) -> dict[str, Actions]:
    """The policies on the tiles that a search begins with, by name."""
    starts = {
        f"optimal, γ = {discount}, on the tiles": projected(kind, solved.body, policy)
        for discount, policy in solved.optimal.items()
        if discount in PROJECTED
    }
    starts["fastest, on the tiles"] = projected(kind, solved.body, solved.fastest)
    alpha, steps = LEARNED[kind]
    for seed in SEEDS:
        starts[f"learned, α = {alpha}, seed {seed}"] = learned(kind, alpha, seed, steps)
    return starts


def best_of(solved: Solved, kind: str, starts: dict[str, Actions]) -> Found:
    """The best of the searches from ``starts``, searched on."""
    searches = (
        search(kind, solved.body, begun, seed, BUDGET) for seed, begun in enumerate(starts.values())
    )
    best = max(searches, key=lambda found: found.score)
    return search(kind, solved.body, best.actions, len(starts), FURTHER)
