"""What the user wrote: the study as a typed value; unknown keys are refused."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path, PurePosixPath
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, ValidationError

from upswing.study.errors import BadInput, explained, near, problem
from upswing.study.extends import Content, joined, sources_of
from upswing.study.ids import cell_id
from upswing.study.names import Alpha, Name, Text, alpha_text
from upswing.study.own_figures import AnyFigures, contradictions, figure_name
from upswing.study.own_files import placed
from upswing.study.physical import PendulumOptions
from upswing.study.readings import Readings
from upswing.study.shown import AnyShownArchitecture
from upswing.study.task import AnyTask
from upswing.study.values import MOST_RUNS, Discount, Seeds, Share, Steps, Strict, listed, once

COMMAND_LINE = "--config"
"""Where a run of Snakemake has said something that stands in no file."""

ADOPTED = "adopted"
"""The learner that no configuration names: an agent from elsewhere, which somebody has to vouch for."""


def _folder(text: str) -> str:
    if not text.isprintable() or set(text) & set("{}*?"):
        raise ValueError("a folder has no control characters, braces or wildcards")
    if text and (text[0] in "-~" or "://" in text):
        raise ValueError("would be an option, a home or an address to others; write ./ before it")
    if text and text != (plain := str(PurePosixPath(text))) and text != f"./{plain}":
        raise ValueError(f"write {plain}")
    return text


class Experiment(Strict):
    """Cells of the matrix: every combination of the named tasks, architectures and step sizes."""

    tasks: Annotated[tuple[str, ...], BeforeValidator(listed), once] = Field(
        min_length=1, description="Names of tasks."
    )
    architectures: Annotated[tuple[str, ...], BeforeValidator(listed), once] = Field(
        min_length=1, description="Names of architectures."
    )
    alphas: Annotated[tuple[Alpha, ...], BeforeValidator(listed), once] = Field(
        default=(), description="Step sizes α in (0, 1]; none for controls."
    )
    seeds: Seeds | None = Field(
        default=None, description="The seeds of these cells, where they are not the study's."
    )
    title: Text = Field(
        default="",
        max_length=100,
        description="What is changed; its cells then stand in the table of what each change buys.",
    )
    source: Text = Field(
        default="",
        max_length=600,
        description="Where that change comes from and what the thesis says of it; stands there, too.",
    )


class Candidates(Strict):
    """Some of what is tried in a search: every combination of architectures and step sizes."""

    title: Text = Field(
        min_length=1, max_length=100, description="How far they go beyond the thesis."
    )
    architectures: Annotated[tuple[str, ...], BeforeValidator(listed), once] = Field(
        min_length=1, description="Names of architectures."
    )
    alphas: Annotated[tuple[Alpha, ...], BeforeValidator(listed), once] = Field(
        min_length=1, description="Step sizes α in (0, 1]."
    )


class Search(Strict):
    """The search for the shortest training after which every run succeeds."""

    task: str = Field(description="Name of a task of full control.")
    seeds: Seeds = Field(description="Its own seeds: none that a cell is reported on.")
    lengths: Annotated[tuple[Steps, ...], BeforeValidator(listed), once] = Field(
        min_length=1, description="Steps of training after which a run is judged."
    )
    candidates: Annotated[tuple[Candidates, ...], BeforeValidator(listed)] = Field(
        min_length=1, description="What is tried, in groups."
    )


class Study(Strict):
    """A study: everything `make reproduce` computes."""

    title: Text = Field(
        default="",
        max_length=150,
        description="The title of its page: what the study asks. Without one, what learns at what.",
    )
    about: Text = Field(
        default="",
        max_length=1_500,
        description="What its page says first: what differs, and what to look at.",
    )
    judges: bool = Field(
        default=True,
        description="Whether its page judges claims; few seeds and short runs say too little for that.",
    )
    results: Annotated[str, AfterValidator(_folder)] = Field(
        default="results", min_length=1, max_length=1_000, description="Folder of the results."
    )
    seeds: Seeds = Field(
        description="How many seeds a cell has (0, 1, …), a list of them, or `first` and `count`."
    )
    seeds_per_job: Annotated[int, Field(ge=1, le=1000)] = Field(
        default=30, description="Number of runs that share one job; more seeds then only add jobs."
    )
    epsilon: Share = Field(default=0.01, description="Share ε of random actions (§4.4).")
    discount: Discount = Field(default=0.7, description="Discount γ (§4.5.1).")
    tasks: dict[Name, AnyTask] = Field(min_length=1, description="Tasks by name.")
    architectures: dict[Name, AnyShownArchitecture] = Field(
        min_length=1, description="Architectures by name."
    )
    experiments: Annotated[tuple[Experiment, ...], BeforeValidator(listed)] = Field(
        min_length=1, description="The cells of the matrix."
    )
    figures: AnyFigures = Field(
        default=(),
        description="Own figures, each a name (of `figures/NAME.py` beside this file, or in "
        "src/upswing/figures) or made of ready panels; those of the thesis are drawn wherever their "
        "cells are.",
    )
    claims: Text = Field(
        default="",
        max_length=1_000,
        description="The file of its own claims, beside this file or below; without it, the claims of "
        "the thesis are judged.",
    )
    search: Search | None = Field(
        default=None, description="A search for what succeeds every time, and how soon."
    )
    readings: Readings = Field(
        default_factory=Readings, description="What the thesis leaves open (R1–R15)."
    )

    @property
    def figure_names(self) -> tuple[str, ...]:
        """The names of its own figures."""
        return tuple(map(figure_name, self.figures))


def narrowed(study: Study) -> Study:
    """A study with no more tasks and architectures than its experiments name; tasks in their order.

    One that extends another has all of its tasks, and need not run any of them.
    """
    tasks = dict.fromkeys(name for one in study.experiments for name in one.tasks)
    names = {name for one in study.experiments for name in one.architectures}
    return study.model_copy(
        update={
            "tasks": {name: study.tasks[name] for name in tasks},
            "architectures": {
                name: one for name, one in study.architectures.items() if name in names
            },
        }
    )


def pendulum_of_bound(study: Study) -> PendulumOptions:
    """The pendulum that the bound of a study is about: that of its first task of full control."""
    upright = (task for task in narrowed(study).tasks.values() if task.judged_by == "upright")
    return next((task.pendulum for task in upright), PendulumOptions())


def load(path: Path) -> Study:
    """The study written in a YAML file; ``BadInput`` with all its problems otherwise."""
    sources = sources_of(path)
    problems: list[str] = []
    return validated({str(path): joined(_placed(sources, problems))}, sources, problems)


def _placed(sources: Mapping[str, Content], problems: list[str]) -> dict[str, Content]:
    """Configurations by their files, with the files that they name as paths from here."""
    return {
        file: placed(file, content, Path(file).parent, problems)
        for file, content in sources.items()
    }


def from_snakemake(files: Sequence[str | Path], merged: Mapping[str, Any]) -> Study:
    """The study of a Snakemake run: its configuration files, and what ``--config`` laid over them."""
    written = {file: sources_of(Path(file)) for file in map(str, files)}
    problems: list[str] = []
    contents = {file: joined(_placed(sources, problems)) for file, sources in written.items()}
    said = [content for sources in written.values() for content in sources.values()]
    overlaid = {
        key: value
        for key, value in merged.items()
        if not any(content.get(key) == value for content in said)
    }
    first = _number_of_seeds(overlaid)
    beside = Path(files[-1]).parent if files else Path()
    overlay = {COMMAND_LINE: placed(COMMAND_LINE, overlaid, beside, problems)} if overlaid else {}
    sources = {name: content for of in written.values() for name, content in of.items()}
    study = validated({**contents, **overlay}, {**sources, **overlay}, problems)
    return study if first is None else with_first_seeds(study, first)


def _number_of_seeds(overlaid: dict[str, Any]) -> int | None:
    """The number in ``--config seeds=3``, taken out: how many of the study's seeds, not which."""
    number = overlaid.get("seeds")
    if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= MOST_RUNS:
        return None
    return int(overlaid.pop("seeds"))


def with_first_seeds(study: Study, number: int) -> Study:
    """The study with the first seeds of each cell, so that runs that are there are used again.

    Of a larger number the study's seeds are counted on; those of an experiment stay as they are.
    """
    more = range(study.seeds[-1] + 1, study.seeds[-1] + 1 + max(0, number - len(study.seeds)))
    experiments = tuple(
        one if one.seeds is None else one.model_copy(update={"seeds": one.seeds[:number]})
        for one in study.experiments
    )
    seeds = (*study.seeds[:number], *more)
    data = {**dict(study), "seeds": list(seeds), "experiments": experiments}
    return validated({COMMAND_LINE: data})


def validated(
    contents: Mapping[str, Mapping[str, Any]],
    written: Mapping[str, Mapping[str, Any]] | None = None,
    problems: Sequence[str] = (),
) -> Study:
    """The study in several sources, each replacing whole keys of those before it.

    Args:
        contents: what they say by name.
        written: what stands in the files themselves, where one extends another: whom a problem names.
        problems: what is known to be wrong already.
    """
    data = {key: value for content in contents.values() for key, value in content.items()}
    files = contents if written is None else written
    origin = {place: source for source, content in files.items() for place in _places(content)}

    def source_of(*place: str) -> str:
        known = (origin[place[:end]] for end in (2, 1) if place[:end] in origin)
        return next(known, " + ".join(files))

    try:
        study = Study.model_validate(data)
    except ValidationError as error:
        raise BadInput([*problems, *explained(Study, error, source_of)]) from None
    found = [*problems, *_contradictions(study, source_of("experiments"))]
    found += _contradictions_of_search(study, source_of("search"))
    found += contradictions(study.figures, _cells(study), source_of("figures"))
    if found:
        raise BadInput(found)
    return study


def _places(content: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    """The keys of a file and those one below."""
    for key, value in content.items():
        yield (key,)
        yield from ((key, str(below)) for below in value) if isinstance(value, dict) else ()


def _contradictions(study: Study, source: str) -> Iterator[str]:
    """What each experiment says that the rest of the study does not bear out."""
    for name, one in study.architectures.items():
        if one.learner == ADOPTED:
            right = "an agent from elsewhere joins a study by `upswing adopt`"
            yield problem(source, f"architectures.{name}.learner", one.learner, right)
    cells: dict[tuple[str, str, float | None], int] = {}
    for number, experiment in enumerate(study.experiments):
        place = f"experiments[{number}]"
        for key, known in (("tasks", study.tasks), ("architectures", study.architectures)):
            for name in getattr(experiment, key):
                if name not in known:
                    yield problem(source, f"{place}.{key}", name, f"unknown; {near(name, known)}")
        for name in experiment.architectures:
            architecture = study.architectures.get(name)
            if architecture is None:
                continue
            if experiment.alphas and not architecture.learns:
                right = f"{name} does not learn and has no α; leave `alphas` out"
                yield problem(source, f"{place}.alphas", experiment.alphas, right)
            if architecture.learns and not experiment.alphas:
                yield f"{source}: {place}.alphas: missing: {name} learns with an α in (0, 1]"
        for task in experiment.tasks:
            for name in experiment.architectures:
                if task in study.tasks and name in study.architectures:
                    for right in study.architectures[name].misfits(study.tasks[task]):
                        yield problem(source, place, f"{task} with {name}", right)
                for alpha in experiment.alphas or (None,):
                    earlier = cells.setdefault((task, name, alpha), number)
                    if earlier != number:
                        right = f"duplicate cell: experiments[{earlier}] has it already"
                        yield problem(
                            source, place, f"{task}/{name}/alpha-{alpha_text(alpha)}", right
                        )
    own = [study.experiments[number].seeds or study.seeds for number in cells.values()]
    if (runs := sum(map(len, own))) > MOST_RUNS:
        right = f"{len(cells)} cells come to {runs:,} runs; a study has at most {MOST_RUNS:,}"
        yield problem(source, "seeds", len(study.seeds), right)


def _cells(study: Study) -> set[str]:
    """The ids of all cells."""
    return {
        cell_id(*of)
        for one in study.experiments
        for of in product(one.tasks, one.architectures, one.alphas or (None,))
    }


def _contradictions_of_search(study: Study, source: str) -> Iterator[str]:
    """What the search says that the rest of the study does not bear out."""
    search = study.search
    if search is None:
        return
    task = study.tasks.get(search.task)
    if task is None or task.judged_by != "upright":
        known = [name for name, one in study.tasks.items() if one.judged_by == "upright"]
        right = f"must be a task of full control; {near(search.task, known or ['none'])}"
        yield problem(source, "search.task", search.task, right)
    reported = {*study.seeds, *(seed for one in study.experiments for seed in one.seeds or ())}
    if both := sorted(set(search.seeds) & reported):
        right = "cells are reported on these seeds; what is chosen must be chosen on others"
        yield problem(source, "search.seeds", both[:5], right)
    for number, candidates in enumerate(search.candidates):
        place = f"search.candidates[{number}].architectures"
        for name in candidates.architectures:
            architecture = study.architectures.get(name)
            if architecture is None:
                yield problem(source, place, name, f"unknown; {near(name, study.architectures)}")
            elif not architecture.learns:
                yield problem(source, place, name, "a control learns nothing")
