"""The ends of the track: what happens to a cart that gets there; in the thesis it has none (§4.2).

A track is chosen by its type, so that compiled code for an endless one has nothing to ask.
"""

from math import inf
from typing import Any, NamedTuple

from upswing.physics.jit import ByType
from upswing.study.physical import TrackOptions


class Endless(NamedTuple):
    """The track of the thesis."""

    limit: float = inf  # [m]


class Track(NamedTuple):
    """A track with two ends."""

    limit: float  # the cart goes no further than |x| = this [m]
    falls: bool  # whether a run is reset there; else the cart stops


def _at_end(_track: Any, _position: float) -> bool:
    """Whether a cart at x [m] is at an end, or beyond."""
    return False


def _ends_run(_track: Any, _position: float) -> bool:
    """Whether a cart at x [m] is at an end where runs are reset."""
    return False


_at_end_by_type = ByType(_at_end)
_ends_run_by_type = ByType(_ends_run)

at_end = _at_end_by_type.call
ends_run = _ends_run_by_type.call


@_at_end_by_type.register(Track)
def _is_at_end(track: Track, position: float) -> bool:
    return abs(position) >= track.limit


@_ends_run_by_type.register(Track)
def _is_where_runs_end(track: Track, position: float) -> bool:
    return track.falls and abs(position) >= track.limit


def track_of(options: TrackOptions) -> Endless | Track:
    """The track of a configuration."""
    if options.limit is None:
        return Endless()
    return Track(float(options.limit), options.at_end == "falls")
