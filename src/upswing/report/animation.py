"""The README's moving picture: stored stretches of runs, played side by side as an SVG.

It moves by style alone, so that it plays as an image in a page, without a script; whoever asks their
system for less motion sees its last moment instead. The same results give the same file.
"""

from collections.abc import Iterable, Sequence
from html import escape
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.analysis.colours import label
from upswing.runs.files.trajectory import WHOLE_AFTER_SUCCESS, WHOLE_BEFORE_SUCCESS
from upswing.runs.metrics import UPRIGHT
from upswing.runs.results import Results
from upswing.study.ids import cell_of

Real = NDArray[np.float64]

THESIS = "full-control/table/alpha-0.001"
"""The cell of the thesis's figure 8."""

LEARNED = "full-control/table/alpha-0.01"
"""The same table with another step size."""

STEPS = WHOLE_BEFORE_SUCCESS + WHOLE_AFTER_SUCCESS
"""Length of what is played [steps]: as is stored whole around a first success, in the thesis 10 s."""

A_FRAME = 0.04
"""25 frames a second [s]."""

WIDTH, HEIGHT, PANEL = 720, 330, 360
PIVOT_HEIGHT, ROD = 150, 84
"""Height of the pivot in the picture, and length of the rod [px]."""

STRIP_TOP, STRIP_HEIGHT, STRIP_LEFT, STRIP_WIDTH = 252, 60, 40, 300


class Stretch(NamedTuple):
    """What a panel plays."""

    title: str
    subtitle: str
    angle: Real  # φ from upright, without jumps between turns [rad]: (frames,)
    time_step: float  # between frames [s]

    @property
    def seconds(self) -> float:
        """For how long it plays."""
        return len(self.angle) * self.time_step


def stretches(results: Results) -> list[Stretch]:
    """The end of the thesis's median run, and the first success of the median one that has learned.

    An empty list where the study has not both cells.
    """
    if not {THESIS, LEARNED} <= results.cells.keys():
        return []
    ordered = results.in_order(LEARNED)
    learned = ordered[ordered["first_stable_step"].notna()]
    if learned.empty:
        second = _stretch(results, "another α", results.median_run(LEARNED).id, None)
    else:
        chosen = learned.iloc[(len(learned) - 1) // 2]
        second = _stretch(results, "another α", chosen["run"], chosen["first_stable_step"])
    return [_stretch(results, "as in figure 8", results.median_run(THESIS).id, None), second]


def _stretch(results: Results, says: str, run: str, success: float | None) -> Stretch:
    """The steps around a first success, or the last ones."""
    stored = results.trajectory(run)
    step = float(results.task(cell_of(run)).pendulum.time_step)
    apart = max(1, round(A_FRAME / step))
    last = int(stored["step"].iloc[-1]) + 1
    first = last - STEPS if success is None else int(success) - WHOLE_BEFORE_SUCCESS
    first = min(max(first, 0), max(last - STEPS, 0))
    shown = range(first, min(first + STEPS, last), apart)
    angle = np.unwrap(stored.loc[stored["step"].isin(shown), "angle"].to_numpy(float))
    if results.study.readings.zero_of_angle == "hanging":
        angle = angle + np.pi
    what = "the end of its run" if success is None else "from where it first stays up"
    title = f"{says}: {label(cell_of(run))}"
    return Stretch(title, f"{what}, step {first:,}", angle, apart * step)


def drawn(panels: Sequence[Stretch]) -> str:
    """The picture as SVG: a pendulum, seen from its cart, and its angle over time for each stretch."""
    styles, bodies = [], []
    for number, panel in enumerate(panels):
        styles.append(_moves(number, panel))
        bodies.append(f'<g transform="translate({PANEL * number})">{_body(number, panel)}</g>')
    said = escape(" Beside it: ".join(f"{panel.title}, {panel.subtitle}." for panel in panels))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" '
        f'height="{HEIGHT}" role="img" aria-label="{said}">\n'
        f"<style>\n{_LOOK}@media (prefers-reduced-motion: no-preference) {{\n"
        + "".join(styles)
        + f'}}\n</style>\n<rect class="card" width="{WIDTH}" height="{HEIGHT}" rx="12"/>\n'
        + "\n".join(bodies)
        + "\n</svg>\n"
    )


_LOOK = """\
text { font: 14px sans-serif; fill: #3b4252; text-anchor: middle }
.title { font-weight: bold; font-size: 17px; fill: #1f2430 }
.small { font-size: 12.5px }
.card { fill: #f6f7f9 }
.ground { stroke: #8a93a5; stroke-width: 1.5 }
.line { stroke: #8a93a5; fill: none }
.cart { fill: #3b4252 }
.rod { stroke: #c0392b; stroke-width: 8; stroke-linecap: round }
.upright { fill: #009e73; opacity: .22 }
.angle { stroke: #0072b2; stroke-width: 1.2; fill: none }
.now { stroke: #c0392b; stroke-width: 1.5 }
@media (prefers-color-scheme: dark) {
text, .cart { fill: #c9ced8 }
.title { fill: #ececec }
.card { fill: #22252a }
.rod, .now { stroke: #ff8a7a }
.upright { fill: #3ddba8; opacity: .3 }
.angle { stroke: #7cc4f5 }
}
"""


def _moves(number: int, panel: Stretch) -> str:
    """The movements of a panel: the rod and the mark of now."""
    seconds = panel.seconds
    parts = {
        "rod": _frames(f"transform:rotate({turn}deg)" for turn in _turns(panel.angle)),
        "now": f"0%{{transform:translate(-{STRIP_WIDTH}px)}}100%{{transform:translate(0)}}",
    }
    return "".join(
        f".{name}{number} {{ animation: {name}{number} {seconds:g}s linear infinite }}\n"
        f"@keyframes {name}{number} {{{frames}}}\n"
        for name, frames in parts.items()
    )


def _frames(values: Iterable[str]) -> str:
    """Keyframes at equal distances."""
    listed = list(values)
    last = max(len(listed) - 1, 1)
    return "".join(f"{100 * at / last:.5g}%{{{value}}}" for at, value in enumerate(listed))


def _turns(angle: Real) -> list[str]:
    """Rotations of a rod that is drawn upright [degrees, clockwise]: a positive φ leans to the left."""
    return [f"{-degrees:.1f}" for degrees in np.degrees(angle)]


def _body(number: int, panel: Stretch) -> str:
    """What a panel shows, as in its last frame."""
    middle, ground = PANEL // 2, PIVOT_HEIGHT + 12
    upper, lower = (_height(limit) for limit in (UPRIGHT, -UPRIGHT))
    wrapped = (panel.angle + np.pi) % (2 * np.pi) - np.pi
    across = STRIP_LEFT + STRIP_WIDTH * np.arange(len(wrapped)) / max(len(wrapped) - 1, 1)
    right = STRIP_LEFT + STRIP_WIDTH
    axis = "".join(
        f'<text class="small" x="{STRIP_LEFT - 20}" y="{_height(np.radians(degrees)) + 4:.1f}">'
        f"{f'{degrees}'.replace('-', '−')}°</text>"
        for degrees in (180, 0, -180)
    )
    return (
        f'<text class="title" x="{middle}" y="26">{escape(panel.title)}</text>'
        f'<text x="{middle}" y="45">{escape(panel.subtitle)}</text>'
        f'<path class="ground" d="M40 {ground}H{PANEL - 40}"/>'
        f'<rect class="cart" x="{middle - 22}" y="{PIVOT_HEIGHT - 8}" width="44" height="16" rx="3"/>'
        f'<g transform="translate({middle} {PIVOT_HEIGHT})"><path class="rod rod{number}" '
        f'transform="rotate({_turns(panel.angle)[-1]})" d="M0 0V-{ROD}"/></g>'
        f'<rect class="upright" x="{STRIP_LEFT}" y="{upper:.1f}" width="{STRIP_WIDTH}" '
        f'height="{lower - upper:.1f}"/>'
        f'<path class="line" d="M{STRIP_LEFT} {STRIP_TOP}v{STRIP_HEIGHT}h{STRIP_WIDTH}"/>'
        f'{axis}<path class="angle" d="{_curve(across, wrapped)}"/>'
        f'<path class="now now{number}" d="M{right} {STRIP_TOP}v{STRIP_HEIGHT}"/>'
        f'<text class="small" x="{middle + 10}" y="{STRIP_TOP + STRIP_HEIGHT + 14}">'
        f"angle φ over {panel.seconds:.3g} s; the band is upright, ±20°</text>"
    )


def _height(angle: float) -> float:
    """Where an angle [rad] stands in the strip [px]."""
    return STRIP_TOP + STRIP_HEIGHT * (0.5 - angle / (2 * np.pi))


def _curve(across: Real, angle: Real) -> str:
    """The angle within one turn [rad]; no line is drawn where it jumps by a turn."""
    jumps = np.abs(np.diff(angle, prepend=angle[0])) > np.pi
    return "".join(
        f"{'M' if jump or not at else 'L'}{x:.1f} {_height(phi):.1f}"
        for at, (x, phi, jump) in enumerate(zip(across, angle, jumps, strict=True))
    )
