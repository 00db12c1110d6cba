"""What is possible at all: the fastest swing-up, what can be caught, what the reward asks for."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration
from upswing.optimal.tables import OF_THE_BOUND, OF_THE_MAPS, REMEDY
from upswing.study.paths import BOUND, MAPS

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration("What is possible at all", "§2.4.2", ("C9", "C15"), tables=(BOUND, MAPS))
THESIS, FAR_SIGHTED = "0.7", "0.97"
SHOWN = 20.0
"""How far φ̇ is shown for the thesis's pendulum [rad/s]; for another, as far beside what it can reach."""

HANGING = "success_from_hanging"
NEEDED = "lowest_discount_from_hanging"


def draw(results: "Results") -> "Drawing":
    """Maps over φ and φ̇: time to upright with what can be caught, and two optimal policies."""
    import numpy as np
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    from upswing.figures import panels
    from upswing.figures.style import WIDTH, subplots
    from upswing.optimal.body import natural_speed
    from upswing.physics.actions import signed
    from upswing.physics.pendulum import Pendulum, body_of
    from upswing.runs.files.typed_table import read_table
    from upswing.runs.recording.actions import action_colours
    from upswing.study.config import pendulum_of_bound
    from upswing.study.errors import BadInput

    policies = {f"action_{discount}": "whole" for discount in (THESIS, FAR_SIGHTED)}
    maps = read_table(results.folder / MAPS, {**OF_THE_MAPS, **policies}, REMEDY)
    path = results.folder / BOUND
    table = read_table(path, OF_THE_BOUND, REMEDY)
    bound = table.set_index("quantity")["value"]
    swings = table[(table["quantity"] == HANGING) & (table["discount"] == float(THESIS))]["value"]
    angles = np.degrees(np.unique(maps["angle"]))
    speeds = np.unique(maps["angular_velocity"])
    if len(maps) != len(angles) * len(speeds):
        raise BadInput([f"{results.folder / MAPS}: is no map: it has gaps; {REMEDY}"])
    if NEEDED not in bound.index:
        raise BadInput([f"{path}: {NEEDED}: is not in it; {REMEDY}"])

    def over(column: str) -> np.ndarray:
        return maps[column].to_numpy().reshape(len(angles), len(speeds)).T.astype(float)

    figure, (fastest, thesis, far_sighted) = subplots(
        1, 3, figsize=(WIDTH, 2.7), width_ratios=(1.25, 1, 1), sharey=True
    )
    image = fastest.pcolormesh(
        angles, speeds, over("time_to_upright"), cmap="viridis", rasterized=True
    )
    figure.colorbar(image, ax=fastest, label="fastest way to ±20° [s]")
    fastest.contour(angles, speeds, over("keepable"), levels=[0.5], colors="white", linewidths=1.2)
    fastest.set_title("Time to upright")
    fastest.set_ylabel("φ̇ [rad/s]")
    body = body_of(pendulum_of_bound(results.study))
    colours = ["#{:02X}{:02X}{:02X}".format(*one) for one in action_colours(body.accelerations)]
    shades = ListedColormap(colours)
    fastest_shown = SHOWN * natural_speed(body) / natural_speed(Pendulum())
    for panel, discount in ((thesis, THESIS), (far_sighted, FAR_SIGHTED)):
        actions = over(f"action_{discount}")
        panel.pcolormesh(
            angles, speeds, actions, cmap=shades, vmin=0, vmax=len(colours) - 1, rasterized=True
        )
        panel.set_title(f"Optimal policy, γ = {discount}")
    for panel in (fastest, thesis, far_sighted):
        panel.set(xlabel="φ [°]", xticks=(-180, -90, 0, 90), ylim=(-fastest_shown, fastest_shown))
        panel.grid(visible=False)
    names = [f"{signed(one)} m/s²" if one else "0" for one in body.accelerations]
    figure.legend(
        handles=[
            Patch(color=shade, label=name) for shade, name in zip(colours, names, strict=True)
        ],
        loc="outside lower right", ncols=min(len(names), 5), frameon=False,
    )  # fmt: skip
    needed = bound.loc[[NEEDED]].iloc[-1]  # of the finest grid
    low = (
        "it pushes towards upright whatever the velocity, and what hangs stays below; from "
        f"γ = {needed:.3f} on it swings up from there"
    )
    since = f"{needed:.3f}"
    if len(swings) and swings.iloc[-1]:  # another pendulum may be lighter to move
        low, since = "what hangs is swung up already", THESIS
    caption = (
        "Left: the least time to upright from every state; the white line is the border of the states "
        "from which the pendulum can be kept above the horizontal. Middle and right: the policy that is "
        f"best for the discounted reward, by value iteration. With the thesis's γ = {THESIS} {low}."
    )
    alt = f"The best policy for the discounted reward swings up from hanging from γ = {since} on."
    return panels.Drawing(figure, caption, [], alt)
