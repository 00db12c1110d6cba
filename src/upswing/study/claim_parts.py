"""The parts of a claim: what is compared, from where on it holds, and what an interval says of it."""

from math import inf
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from upswing.study.errors import near, shown
from upswing.study.measured import MEASURES
from upswing.study.names import CellName, Text
from upswing.study.readings import Readings, options_of
from upswing.study.values import Strict, listed, once

if TYPE_CHECKING:  # the workflow reads claims, and need not wait for scipy
    from upswing.analysis.statistics import Estimate

Verdict = Literal["reproduced", "partly", "inconclusive", "not reproduced", "not in this study"]
NOT_HERE: Verdict = "not in this study"
"""What is said of a claim whose cells a study lacks."""

WEAKEST_FIRST: tuple[Verdict, ...] = (
    "not in this study",
    "not reproduced",
    "inconclusive",
    "partly",
    "reproduced",
)

Kind = Literal[
    "share",
    "share_by",
    "share_identical",
    "share_contracting",
    "share_represented",
    "location",
    "ratio_of_means",
    "ratio_of_sums",
    "difference_of_means",
    "difference_of_shares",
    "probability_greater",
    "range_of_means",
    "range_of_shares",
]
Cells = Annotated[tuple[CellName, ...], BeforeValidator(listed), once]
Number = Annotated[float, Field(allow_inf_nan=False)]

CELLS_OF: dict[str, tuple[int, int]] = {
    "share": (1, 1),
    "share_by": (1, 1),
    "share_identical": (2, 2),
    "share_contracting": (0, 0),
    "share_represented": (0, 0),
    "location": (1, 1),
    "ratio_of_means": (2, 2),
    "ratio_of_sums": (1, 1),
    "difference_of_means": (2, 2),
    "difference_of_shares": (2, 2),
    "probability_greater": (2, 2),
    "range_of_means": (2, 9),
    "range_of_shares": (2, 9),
}
"""How many cells each kind compares, at least and at most."""

COUNTED = {"share_contracting": "problems", "share_represented": "starts"}
"""What an estimate is of, where it is not of runs, by its kind."""

OF_SHARES = ("share", "difference_of_shares", "range_of_shares")
WITHIN: dict[str, tuple[float, float]] = {
    "share": (0, 1),
    "share_by": (0, 1),
    "share_identical": (0, 1),
    "share_contracting": (0, 1),
    "share_represented": (0, 1),
    "probability_greater": (0, 1),
    "range_of_shares": (0, 1),
    "difference_of_shares": (-1, 1),
}
"""Between which values an estimate of each kind lies, where it is not any number."""

SHARES = (*OF_SHARES, "share_by", "share_identical", "share_contracting", "share_represented")
"""Kinds that count how many of how many."""

WITH_LIMIT = ("share_by",)
WITH_PER = ("ratio_of_sums",)
WITHOUT_MEASURE = (*OF_SHARES, "share_identical", "share_contracting", "share_represented")


def _measured(name: str) -> str:
    if name not in MEASURES:
        raise ValueError(f"no measure of a run; {near(name, MEASURES)}")
    return name


Measure = Annotated[str, AfterValidator(_measured)]
"""A column of the table of runs."""


class Bound(Strict):
    """A condition on a measure of a run; a measure that is not there fulfils none."""

    at_least: Number | None = None
    at_most: Number | None = None
    below: Number | None = None

    @model_validator(mode="after")
    def _says_something(self) -> Self:
        if self.at_least is None and self.at_most is None and self.below is None:
            raise ValueError("write `at_least`, `at_most` or `below`")
        return self

    def __call__(self, value: float) -> bool:
        """Whether ``value`` fulfils the condition."""
        return (
            value == value  # not NaN
            and (self.at_least is None or value >= self.at_least)
            and (self.at_most is None or value <= self.at_most)
            and (self.below is None or value < self.below)
        )


class Part(Strict):
    """One thing that a claim says, as a comparison with a threshold."""

    says: Text = Field(description="What is compared, in words.")
    kind: Kind = Field(description="What is estimated; docs/extend/claim.md explains each.")
    because: Text = Field(description="The reason for the thresholds.")
    measure: Measure | None = Field(
        default=None, description="What is measured of each run: a column of the table of runs."
    )
    per: Measure | None = Field(default=None, description="Of `ratio_of_sums`: what is divided by.")
    cells: Cells = Field(default=(), description="Ids of the cells that are compared.")
    each: Cells = Field(default=(), description="The part once for each of these cells, instead.")
    each_pair: Annotated[tuple[Cells, ...], BeforeValidator(listed)] = Field(
        default=(), description="The part once for each of these pairs of cells, instead."
    )
    where: dict[Measure, Bound] = Field(
        default_factory=dict,
        description="Of shares: what a run must fulfil to be counted, each measure with `at_least`, "
        "`at_most` or `below`.",
    )
    among: dict[Measure, Bound] = Field(
        default_factory=dict,
        description="Which runs are looked at, in the same way; without it, all.",
    )
    statistic: Literal["mean", "median", "interquartile_mean"] = Field(
        default="mean", description="Of `location`."
    )
    limit: Annotated[int, Field(ge=1)] | None = Field(
        default=None, description="Of `share_by`: by which step."
    )
    at_least: Number | None = Field(
        default=None, description="From where on the part holds; this, or `at_most`."
    )
    at_most: Number | None = Field(default=None, description="Up to where the part holds.")
    partly: Number = Field(description="From where on, or up to where, it holds partly.")
    paired: bool = Field(
        default=False,
        description="Of `difference_of_means`: runs of the same seed are the same but for one thing.",
    )
    fewest: Annotated[int, Field(ge=1)] = Field(
        default=1, description="Number of runs without which nothing is said."
    )
    only_if: dict[str, str] = Field(
        default_factory=dict, description="Readings under which the part is asked at all."
    )

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if (self.at_least is None) == (self.at_most is None):
            raise ValueError("write either `at_least` or `at_most`")
        if (self.cells != ()) + (self.each != ()) + (self.each_pair != ()) > 1:
            raise ValueError("write one of `cells`, `each` and `each_pair`")
        low, high = WITHIN.get(self.kind, (-inf, inf))
        if not (low <= self.threshold <= high and low <= self.partly <= high):
            raise ValueError(f"the thresholds of {self.kind} lie between {low:g} and {high:g}")
        for name, option in self.only_if.items():
            if name not in Readings.model_fields:
                hint = near(name, Readings.model_fields)
                raise ValueError(f"only_if: {shown(name)}: no such reading; {hint}")
            if option not in options_of(name):
                options = ", ".join(map(str, options_of(name)))
                raise ValueError(
                    f"only_if: {name}: {shown(option)}: no such option; there are {options}"
                )
        for name, bound in (*self.where.items(), *self.among.items()):
            is_share = name.endswith("_share") or name.startswith("upright_")
            if is_share and not all(0 <= x <= 1 for _, x in bound if x is not None):
                raise ValueError(f"{name} lies between 0 and 1, and so does what bounds it")
        weaker = self.partly <= self.threshold if self.is_lower else self.partly >= self.threshold
        if not weaker:
            raise ValueError("`partly` must be the weaker of the two thresholds")
        fewest, most = CELLS_OF[self.kind]
        for cells in self.comparisons:
            if not fewest <= len(cells) <= most:
                raise ValueError(f"{self.kind} compares {fewest} to {most} cells, not {len(cells)}")
        if (self.measure is None) != (self.kind in WITHOUT_MEASURE):
            raise ValueError(f"`measure` does not go with {self.kind}, or is missing")
        if bool(self.where) != (self.kind in OF_SHARES):
            raise ValueError(f"`where` goes with {', '.join(OF_SHARES)}, always")
        if (self.limit is not None) != (self.kind in WITH_LIMIT):
            raise ValueError("`limit` goes with share_by, always")
        if (self.per is not None) != (self.kind in WITH_PER):
            raise ValueError("`per` goes with ratio_of_sums, always")
        if self.paired and self.kind != "difference_of_means":
            raise ValueError("`paired` goes with difference_of_means")
        return self

    @property
    def is_lower(self) -> bool:
        """Whether the threshold is a lower one."""
        return self.at_least is not None

    @property
    def threshold(self) -> float:
        """From where on the part holds."""
        return float(self.at_least if self.at_least is not None else self.at_most or 0.0)

    @property
    def comparisons(self) -> list[tuple[str, ...]]:
        """The cells of each comparison that the part stands for."""
        if self.each_pair:
            return list(self.each_pair)
        return [(cell,) for cell in self.each] or [self.cells]

    @property
    def threshold_text(self) -> str:
        """The thresholds as a reader would write them."""
        sign = "≥" if self.is_lower else "≤"
        return f"{sign} {self.threshold:g} (partly {sign} {self.partly:g})"

    def could_be_better(self, estimate: "Estimate") -> bool:
        """Whether the interval of an estimate reaches the threshold without lying beyond it.

        "Partly" then means at least partly: more runs might yet show that the claim holds.
        """
        sign = 1 if self.is_lower else -1
        worst, best = sorted((sign * estimate.low, sign * estimate.high))
        return worst < sign * self.threshold <= best

    def verdict(self, estimate: "Estimate") -> Verdict:
        """What the interval of an estimate says of this part; nothing else is asked."""
        sign = 1 if self.is_lower else -1
        worst, best = sorted((sign * estimate.low, sign * estimate.high))
        if estimate.n < self.fewest:
            return "inconclusive"
        if worst >= sign * self.threshold:
            return "reproduced"
        if worst >= sign * self.partly:
            return "partly"
        if best < sign * self.partly:
            return "not reproduced"
        return "inconclusive"

    def at_threshold(self, estimate: "Estimate") -> bool:
        """Whether a line, ours, lies within the interval: on which side the truth is, is not decided."""
        return any(estimate.low < line < estimate.high for line in (self.threshold, self.partly))


def weakest(verdicts: list[Verdict]) -> Verdict:
    """The verdict of a claim with such parts."""
    return min(verdicts, key=WEAKEST_FIRST.index)


OF_ONES_OWN = {"reproduced": "holds", "not reproduced": "does not hold"}
"""How verdicts are shown on claims of one's own, of which there is nothing to reproduce."""


def words_of(verdict: str, could_be_better: bool, own: bool) -> str:
    """A verdict as it is shown.

    Args:
        verdict: the verdict.
        could_be_better: whether more runs might make it better, which "partly" says.
        own: whether the claim is of a study's own file and not the thesis's.
    """
    if verdict == "partly" and could_be_better:
        return f"at least {verdict}"
    return OF_ONES_OWN.get(verdict, verdict) if own else verdict
