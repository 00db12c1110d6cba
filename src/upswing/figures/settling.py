"""How V and the policy settle, sweep by sweep: generalized policy iteration of §2.4.1 at work."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration
from upswing.optimal.tables import OF_SETTLING, SETTLING_REMEDY
from upswing.study.paths import SETTLING

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration("How value and policy settle", "§2.4.1", (), tables=(SETTLING,))
NEARLY = 0.01
"""The share of states that may have a worse action where the policy is called nearly right."""

COLOURS = ("#0072B2", "#D55E00", "#009E73")


def draw(results: "Results") -> "Drawing":
    """Above, how far V is from V*; below, in how many states the policy is not yet one of the best."""
    from upswing.analysis.colours import of_text
    from upswing.figures import panels
    from upswing.figures.style import WIDTH, subplots
    from upswing.runs.files.typed_table import read_table

    table = read_table(results.folder / SETTLING, OF_SETTLING, SETTLING_REMEDY)
    methods = list(dict.fromkeys(table["method"]))
    discounts = sorted(table["discount"].unique())
    shades = dict(zip(methods, COLOURS, strict=False))
    figure, rows = subplots(
        2, len(discounts), figsize=(WIDTH, 3.6), sharex="col", sharey="row", squeeze=False
    )
    needed: dict[tuple[float, str], int] = {}
    for column, discount in enumerate(discounts):
        error, worse = rows[0][column], rows[1][column]
        for method in methods:
            one = table[(table["discount"] == discount) & (table["method"] == method)]
            needed[discount, method] = int(one["backups"].iloc[-1])
            style = {"color": shades[method], "linewidth": 1.2}
            error.loglog(one["backups"], one["error"].clip(lower=1e-7), **style)
            worse.semilogx(one["backups"], 100 * one["worse"], label=method, **style)
        error.set_title(f"γ = {discount:g}")
        worse.set_xlabel("values of (s, a) computed, in sweeps over all states")
    rows[0][0].set_ylabel("largest |V − V*|\n[rad²]")
    rows[1][0].set_ylabel("states with a\nworse action [%]")
    handles, labels = rows[1][0].get_legend_handles_labels()
    legend = figure.legend(
        handles, labels, loc="outside upper center", ncols=len(methods), frameon=False
    )
    for text, method in zip(legend.get_texts(), methods, strict=True):
        text.set_color(of_text(shades[method]))
    far = discounts[-1]
    costs = sorted((needed[far, method], method) for method in methods)
    (least, quickest), (most, slowest) = costs[0], costs[-1]
    of_values = table[(table["discount"] == far) & (table["method"] == methods[0])]
    soon = of_values[of_values["worse"] <= NEARLY].iloc[0]
    counted = "; ".join(f"{method}, {cost:,}" for cost, method in costs)
    caption = (
        "Policy evaluation makes V that of the policy; policy improvement makes the policy greedy for "
        "V. Value iteration improves after every sweep, policy iteration when V stands still, and "
        "anything between them is generalized policy iteration. All end at the same V and the same "
        f"policy. Sweeps that it takes with γ = {far:g}: {counted}. What to see: after "
        f"{int(soon['backups']):,} of the sweeps of value iteration, "
        f"{100 * (1 - soon['worse']):.1f} % of the states have one of the best actions, while V is "
        f"still wrong by up to {soon['error']:.2g} rad²."
    )
    alt = (
        f"With γ = {far:g}, {quickest} needs {least:,} sweeps to the best policy's values, and "
        f"{slowest} {most:,}."
    )
    return panels.Drawing(figure, caption, [], alt)
