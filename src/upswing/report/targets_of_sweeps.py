"""Which files the sweeps over readings come to; nothing here looks at the disk, but ``weighed``."""

import hashlib
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from upswing.analysis.robustness.tables import SHIPPED
from upswing.study import jobs
from upswing.study.claims import Claim
from upswing.study.config import Study
from upswing.study.matrix import Matrix
from upswing.study.paths import (
    DECISIVE,
    READINGS,
    ROBUST,
    SELECTION,
    figure_of_sweep,
    finalists_of_sweep,
    group_of_sweep,
)
from upswing.study.places import TEMPLATES
from upswing.study.sweeps import CHOOSING, Group, Sweep, content_of, groups

ASKING_FOR_READINGS = ("readings", "with_readings")
"""The targets, rules of the workflow, by which the claims are judged under other readings."""

ONLY_IF_ASKED = "readings/only-made-by-make-readings"
"""A file that is never there, for what must not be made unless it is asked for."""

SWEPT = (SELECTION, READINGS, DECISIVE, ROBUST)
"""The tables of the sweeps over readings, which the page shows once they have been run."""


@dataclass(frozen=True)
class TargetsOfSweeps:
    """The files of a study's sweeps, each as its path from the folder that the workflow runs in."""

    study: Study
    claims: Mapping[str, Claim]
    sweeps: Mapping[str, Sweep]
    templates: Path = TEMPLATES

    @cached_property
    def matrix(self) -> Matrix:
        """The study's cells and runs."""
        return Matrix(self.study)

    @cached_property
    def groups(self) -> dict[str, tuple[Sweep, Group]]:
        """Every job of the sweeps by ``sweep/group``."""
        return {
            f"{name}/{group.name}": (sweep, group)
            for name, sweep in self.sweeps.items()
            for group in groups(sweep, self.study)
        }

    @cached_property
    def swept(self) -> list[str]:
        """The table of every job of the sweeps."""
        return self._below(
            *(
                group_of_sweep(name, group.name)
                for name, sweep in self.sweeps.items()
                for group in groups(sweep, self.study)
            )
        )

    @cached_property
    def readings(self) -> list[str]:
        """What the sweeps come to: tables, and a figure of each sweep that judges claims."""
        pictures = [figure_of_sweep(name, kind) for name in self.sweeps for kind in ("svg", "png")]
        tables = [table for table in SWEPT if table != SELECTION or CHOOSING in self.sweeps]
        return self._below(*tables, *pictures)

    def before_sweep(self, job: str) -> list[str]:
        """What a job of the sweeps reads: which readings go on to its round, after the first."""
        name, number = job.partition("/")[0], self.groups[job][1].round
        return self._below(finalists_of_sweep(name, number)) if number > 1 else []

    def before_round(self, name: str, number: int) -> list[str]:
        """The tables of all jobs of a sweep before a round."""
        jobs = groups(self.sweeps[name], self.study)
        return self._below(*(group_of_sweep(name, one.name) for one in jobs if one.round < number))

    def reports_of_sweep(self, name: str) -> str:
        """What says which readings go on, as one line."""
        return self.sweeps[name].model_dump_json(include={"reports", "rounds"})

    def are_coming(self, asked: Collection[str]) -> bool:
        """Whether this run of the workflow is asked for the sweeps; only then are they run and judged.

        Where it is not, they are shown as they are, whatever code they are of.
        """
        return not {*ASKING_FOR_READINGS, *self.readings}.isdisjoint(asked)

    def judged_from(self, asked: Collection[str]) -> list[str]:
        """What the sweeps are judged from, where this run of the workflow is asked for that.

        Where it is not, it is a file that nobody makes: Snakemake then takes the tables as they are.
        """
        return self.swept if self.are_coming(asked) else self._below(ONLY_IF_ASKED)

    def weighed(self, asked: Collection[str]) -> list[str]:
        """What says how the claims do over readings: the study's own sweeps, or what is shipped."""
        coming = self.are_coming(asked)
        (own,) = self._below(ROBUST)
        if (coming and own in self.readings) or Path(own).exists():
            return [own]
        shipped = self.templates / SHIPPED
        return [str(shipped)] if shipped.exists() else []

    def content_of_sweep(self, job: str) -> str:
        """What the result of a job of the sweeps depends on besides the code, as a checksum."""
        sweep, group = self.groups[job]
        return content_of(sweep, self.study, group, self.matrix.cells)

    def shown_as_of(self, asked: Collection[str]) -> str:
        """A checksum of what the sweeps would be made from now, by which a page says whether they are.

        It is empty where there are none to be shown.
        """
        if not (self.are_coming(asked) or Path(*self._below(ROBUST)).exists()):
            return ""
        codes = [jobs.sweep(one, self.study).fingerprint for one in self.sweeps.values()]
        texts = [*codes, jobs.JUDGED_OVER_READINGS.fingerprint, self.content_of_readings]
        return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]

    @cached_property
    def content_of_readings(self) -> str:
        """What judging the sweeps depends on besides runs, claims and code, as a checksum."""
        beside = {cell for sweep in self.sweeps.values() for cell in sweep.beside}
        texts = [
            self.study.readings.model_dump_json(),
            *(f"{name} {sweep.model_dump_json()}" for name, sweep in self.sweeps.items()),
            *(self.content_of_sweep(job) for job in self.groups),
            *(self._without_seeds(cell) for cell in sorted(beside)),
        ]
        return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]

    def _without_seeds(self, cell: str) -> str:
        return self.matrix.cells[cell].model_copy(update={"seeds": ()}).canonical()

    def _below(self, *files: str) -> list[str]:
        return [f"{self.study.results}/{file}" for file in files]
