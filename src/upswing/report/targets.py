"""Which files a study comes to, and which of them its figures and its page are made from.

Nothing here looks at the disk, but for adopted cells, and for the files that a page shows only where
they are there.
"""

from collections.abc import Collection, Iterable, Mapping
from functools import cached_property
from pathlib import Path

from upswing.analysis.colours import Shown, shown_of
from upswing.figures import NAMES, claims_of, drawable, figures_of
from upswing.figures.declaration import Declaration
from upswing.figures.own import own_of
from upswing.recordings.comparison_names import comparison_names
from upswing.report.citation import FILE as CITATION
from upswing.report.targets_of_sweeps import SWEPT, TargetsOfSweeps
from upswing.runs.adopted import files_of
from upswing.study import jobs
from upswing.study.claims import Claim, canonical_claims, cells_of_claims
from upswing.study.history_paths import ENTRIES
from upswing.study.ids import KNOWN_FILE, file_of
from upswing.study.own_figures import DeclaredFigure
from upswing.study.paths import (
    BEYOND,
    BOUND,
    CELLS,
    CHANGES,
    CHOSEN,
    EVIDENCE,
    EVIDENCE_CSV,
    MAPS,
    PAGE,
    PREDICTION,
    PREDICTION_LIMITS,
    RUNS,
    RUNS_CSV,
    SETTLING,
    SHORTEST,
    STUDY,
    TILES,
    VERDICTS,
    VIEWER_PAGE,
    comparison,
    figure,
    finalists_of_sweep,
)
from upswing.study.registration import checksum_of

PICTURE = ("svg", "png", "json")
"""The endings of a figure's files: the picture twice, and its words."""

OF_THE_PAGE = (PAGE, RUNS_CSV, EVIDENCE_CSV)

CHAPTER = (
    STUDY, CHANGES, BOUND, CHOSEN, VERDICTS, EVIDENCE,
    *(figure(name, "svg") for name in ("bound", "settling", "prediction", "changes")),
)  # fmt: skip
"""What the page shows of the chapter beyond the thesis, once that has been run."""

OF_THE_CHAPTER = (BOUND, MAPS, SETTLING, PREDICTION, PREDICTION_LIMITS, CHANGES)
"""The tables of a study of changes."""

TEMPLATES = (
    "*.j2", "*.css", "*.js", "*.yaml", "*.json", "exploratory.csv", "expected.csv", "changes.csv",
    "parts/*", "drawings/*",
)  # fmt: skip


def templates(folder: Path) -> list[str]:
    """The project's own files that the page is made from: templates, style, script, texts, drawings.

    So is what says how to cite it, which stands beside their folder.
    """
    own = [path for pattern in TEMPLATES for path in folder.glob(pattern)]
    return sorted(str(path) for path in (*own, *folder.parent.glob(CITATION)))


class Targets(TargetsOfSweeps):
    """The files of a study, each as its path from the folder that the workflow runs in."""

    @cached_property
    def changes(self) -> bool:
        """Whether experiments have a title: changes to the thesis, held against what is possible."""
        return any(experiment.title for experiment in self.study.experiments)

    @cached_property
    def figures(self) -> list[str]:
        """The names of the figures that can be drawn, the study having all cells that they show.

        Raises:
            BadInput: a figure that the study names itself shows a cell that it does not have.
        """
        return drawable(self.matrix.cells, self.changes, self.study.figure_names, self.declared)

    @cached_property
    def declared(self) -> Mapping[str, Declaration]:
        """What each figure shows."""
        return figures_of(self.study)

    @cached_property
    def project_figures(self) -> list[str]:
        """The names of the project's figures that the page shows or says are missing."""
        named = (name for name in self.study.figures if isinstance(name, str))
        return list(dict.fromkeys((*NAMES, *named)))

    @cached_property
    def tables(self) -> list[str]:
        """The tables of every study."""
        return self._below(RUNS, CELLS, VERDICTS, EVIDENCE)

    @cached_property
    def comparisons(self) -> list[str]:
        """The recordings that compare runs."""
        names = comparison_names(self.claims, self.matrix.cells)
        return self._below(*map(comparison, names))

    @cached_property
    def beyond(self) -> list[str]:
        """The tables of a study of changes; none of another."""
        search = (SHORTEST, CHOSEN) if self.study.search else ()
        return self._below(*OF_THE_CHAPTER, *search) if self.changes else []

    @cached_property
    def page(self) -> list[str]:
        """The page, and the tables beside it."""
        return self._below(*OF_THE_PAGE)

    @cached_property
    def everything(self) -> list[str]:
        """What a study is run for, besides the files of its runs (``Matrix.wanted``)."""
        return [
            self.page[0],
            *self._below(VIEWER_PAGE),
            *self.tables,
            *self.pictures(*PICTURE),
            *self.comparisons,
            *self.beyond,
        ]

    @cached_property
    def quick(self) -> list[str]:
        """What follows training and takes seconds: made again where nobody knows how it was made."""
        changes = self._below(CHANGES) if self.changes else []
        return [
            *self._below(STUDY, ENTRIES, VIEWER_PAGE),
            *self.tiles,
            *self.tables,
            *self.comparisons,
            *self.pictures(*PICTURE),
            *self.page,
            *changes,
        ]

    @cached_property
    def slow(self) -> list[str]:
        """What takes long besides training: left as it is where nobody knows how it was made."""
        readings = self.readings if self.groups else []
        rounds = [
            file
            for name, sweep in self.sweeps.items()
            for number in range(2, len(sweep.rounds) + 2)
            for file in self._below(finalists_of_sweep(name, number))
        ]
        return [
            *self.swept,
            *rounds,
            *readings,
            *(table for table in self.beyond if CHANGES not in table),
        ]

    def pictures(self, *kinds: str) -> list[str]:
        """The files of all figures that have one of these endings."""
        return self._below(*(figure(name, kind) for name in self.figures for kind in kinds))

    def of_figure(self, name: str) -> list[str]:
        """What a figure is drawn from: its own cells and those of its claims, or whatever there is."""
        runs = self.of_cells(self.cells_of_figure(name))
        adopted = [] if self.declared[name].cells else self.adopted()
        tiles = self.tiles if _asks_for_tiles(self._decided_by(name)) else []
        return [*runs, *adopted, *tiles, *self._below(*self.declared[name].tables)]

    def cells_of_figure(self, name: str) -> list[str]:
        """Its own cells with those of its claims that the study has, or all in the study's order."""
        declared = self.declared[name]
        if not declared.cells:
            return list(self.matrix.cells)
        of_claims = (cell for _, cell in cells_of_claims(self._decided_by(name)))
        shown = dict.fromkeys((*declared.cells, *declared.beside, *of_claims))
        return [cell for cell in shown if cell in self.matrix.cells]

    def words_of_figure(self, name: str) -> str:
        """By what a figure judges, its claims and readings that they ask for; and what it declares."""
        own = own_of(self.study).get(name)
        declared = own.model_dump_json() if isinstance(own, DeclaredFigure) else ""
        return declared + self._words(self._decided_by(name))

    def code_of_figure(self, name: str) -> str:
        """The fingerprint of the code that draws a figure."""
        return jobs.figure(own_of(self.study).get(name, name)).fingerprint

    def shown(self, cells: Iterable[str]) -> dict[str, Shown]:
        """How the architectures of cells are shown, by name."""
        named = dict.fromkeys(self.matrix.cells[cell].architecture.name for cell in cells)
        return {name: self._shown[name] for name in named}

    @cached_property
    def _shown(self) -> dict[str, Shown]:
        return shown_of(self.study)

    def _decided_by(self, name: str) -> dict[str, Claim]:
        """The claims that a figure decides: of a study that judges nothing, none."""
        return claims_of(name, self.claims if self.study.judges else {})

    @cached_property
    def judged_cells(self) -> list[str]:
        """The cells of the study that the claims name."""
        named = {cell for _, cell in cells_of_claims(self.claims)}
        return [cell for cell in self.matrix.cells if cell in named]

    def of_comparison(self, name: str) -> list[str]:
        """What a recording that compares runs is made from."""
        claim = self._claim_of(name)
        asks = claim is not None and _asks_for_tiles({name: claim})
        adopted = self.adopted(name.partition("-")[2]) if claim is None else []
        return [
            *self.of_cells(self.cells_of_comparison(name)),
            *adopted,
            *(self.tiles if asks else []),
        ]

    def adopted(self, task: str = "") -> list[str]:
        """The files that say which agents from elsewhere were adopted, into all tasks or one."""
        files = files_of(Path(self.study.results))
        return [str(path) for path in files if task in ("", path.parent.name)]

    def cells_of_comparison(self, name: str) -> list[str]:
        """The cells of a task, or those that a claim names, by the name of their recording."""
        of = name.partition("-")[2]
        if (claim := self._claim_of(name)) is not None:
            named = dict.fromkeys(cell for _, cell in cells_of_claims({of: claim}))
            return [cell for cell in named if cell in self.matrix.cells]
        return [cell for cell, spec in self.matrix.cells.items() if spec.task.name == of]

    def words_of_comparison(self, name: str) -> str:
        """By what a recording of a claim judges: the claim itself, and readings that it asks for."""
        claim = self._claim_of(name)
        return self._words({} if claim is None else {name.partition("-")[2]: claim})

    def _words(self, claims: Mapping[str, Claim]) -> str:
        """Claims, and the readings under which their parts are asked; nothing without any claim."""
        if not claims:
            return ""
        asked = {key for claim in claims.values() for part in claim.parts for key in part.only_if}
        return f"{canonical_claims(claims)} {self.study.readings.model_dump_json(include=asked)}"

    def _claim_of(self, name: str) -> Claim | None:
        """The claim of a recording that compares runs; None for one of a task."""
        what, _, of = name.partition("-")
        return self.claims[of] if what == "claim" else None

    def of_cells(self, cells: Iterable[str]) -> list[str]:
        """A file of each job of these cells: it stands for all of the job's, written together."""
        return self._below(
            *(
                file_of(self.matrix.cells[cell].run(block.seeds[0]), KNOWN_FILE)
                for cell in cells
                for block in self.matrix.blocks_of(self.matrix.cells[cell])
            )
        )

    def seeds_of(self, cells: Iterable[str]) -> str:
        """A checksum of the seeds of these cells: what is made from them reads each of their runs.

        Of a job one file is named, which stays the same where its block has fewer seeds than before.
        """
        return checksum_of(str({cell: self.matrix.cells[cell].seeds for cell in sorted(cells)}))

    def of_page(self, asked: Collection[str]) -> list[str]:
        """What the page is made from, besides its templates.

        Sweeps and chapter are shown where they have been run, for which this looks at the disk; and the
        sweeps also where they are about to be run.

        Args:
            asked: the targets of this run of the workflow, rules or files.
        """
        coming = self.are_coming(asked)
        swept = [
            p for p in self._below(*SWEPT) if (coming and p in self.readings) or Path(p).exists()
        ]
        made_from = [
            *self._below(STUDY, ENTRIES),
            *self.tables,
            *self.pictures("svg", "json"),
            *swept,
            *(self.beyond or [path for path in self._chapter() if Path(path).exists()]),
        ]
        return list(dict.fromkeys(made_from))

    @cached_property
    def tiles(self) -> list[str]:
        """What says whether a table can represent the task, where a claim of this study asks."""
        asks = any(
            claim.cell in self.matrix.cells and part.kind == "share_represented"
            for claim in self.claims.values()
            for part in claim.parts
        )
        return self._below(TILES) if asks else []

    def _chapter(self) -> list[str]:
        """The chapter in the study's own folder, or in the folder for it below."""
        return self._below(
            *sorted(f"{base}{file}" for base in ("", f"{BEYOND}/") for file in CHAPTER)
        )


def _asks_for_tiles(claims: Mapping[str, Claim]) -> bool:
    """Whether one of the claims is about what a table can represent."""
    return any(
        part.kind == "share_represented" for claim in claims.values() for part in claim.parts
    )
