"""What the user wrote: the study as a typed value; unknown keys are refused."""

from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path, PurePosixPath
from typing import Annotated, Any, Literal, NamedTuple, Self, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    WithJsonSchema,
    model_validator,
)

from upswing.study.errors import BadInput, explained, near, problem, shown
from upswing.study.loading import parts
from upswing.study.names import Alpha, Name, Text, alpha_text
from upswing.study.readings import Readings
from upswing.study.yaml_file import read_yaml

T = TypeVar("T")

LARGEST_SEED = 2**32 - 1
LONGEST_RUN = 100_000_000
MOST_RUNS = 10_000
"""Largest number of runs of a study: Snakemake plans them in half a minute, even in one cell."""


def _no_value_twice(values: tuple[T, ...]) -> tuple[T, ...]:
    seen = set[T]()
    for value in values:
        if value in seen:
            raise ValueError(f"{shown(value)} stands there twice")
        seen.add(value)
    return values


def listed(value: Any) -> Any:
    """Lists become tuples before strict validation, which takes no list for a tuple."""
    return tuple(value) if isinstance(value, list) else value


def _counted(value: Any) -> Any:
    if isinstance(value, int) and not isinstance(value, bool):
        if value < 1:
            raise ValueError("write how many seeds there are, 1 or more, or list them")
        if value > MOST_RUNS:
            raise ValueError(f"a study has at most {MOST_RUNS:,} runs")
        return tuple(range(value))
    return listed(value)


def _part(kind: str) -> AfterValidator:
    """A part by the name of its file, which is found without importing it."""

    def known(name: str) -> str:
        if name not in (there := parts(kind)):
            *others, last = [repr(one) for one in there]
            hint = get_close_matches(name, there, n=1)
            suggestion = f"; did you mean {hint[0]!r}?" if hint else ""
            raise ValueError(f"must be {', '.join(others)} or {last}{suggestion}")
        return name

    return AfterValidator(known)


def _choice(kind: str) -> WithJsonSchema:
    return WithJsonSchema({"type": "string", "enum": parts(kind)})


Kind = Annotated[str, _part("tasks"), _choice("tasks")]
LearnerName = Annotated[str, _part("learners"), _choice("learners")]
CodingName = Annotated[str, _part("codings"), _choice("codings")]
MethodName = Annotated[str, _part("methods"), _choice("methods")]


def _folder(text: str) -> str:
    if not text.isprintable() or set(text) & set("{}*?"):
        raise ValueError("a folder has no control characters, braces or wildcards")
    if text and (text[0] in "-~" or "://" in text):
        raise ValueError("would be an option, a home or an address to others; write ./ before it")
    if text and text != (plain := str(PurePosixPath(text))) and text != f"./{plain}":
        raise ValueError(f"write {plain}")
    return text


once = AfterValidator(_no_value_twice)
"""A list in which nothing stands twice."""

Steps = Annotated[int, Field(ge=1, le=LONGEST_RUN)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
Seed = Annotated[int, Field(ge=0, le=LARGEST_SEED)]
Seeds = Annotated[
    tuple[Seed, ...],
    Field(min_length=1),
    BeforeValidator(_counted),
    once,
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "integer", "minimum": 1},
                {
                    "type": "array",
                    "items": {"type": "integer", "minimum": 0, "maximum": LARGEST_SEED},
                    "minItems": 1,
                    "uniqueItems": True,
                },
            ]
        }
    ),
]


class Strict(BaseModel):
    """A frozen value without unknown keys and without conversions."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class GoesWith(NamedTuple):
    """Which learners, codings or methods an option of an architecture is for."""

    part: str
    always: tuple[str, ...]  # those that need it
    sometimes: tuple[str, ...]  # those that may have it
    meaning: str


GOES_WITH = {
    "hidden": GoesWith(
        "learner", ("networks", "action-input", "dqn"), ("gated",), "one or two sizes"
    ),
    "behaviour": GoesWith("learner", ("control",), (), "idle or random"),
    "halved_after": GoesWith("learner", ("decaying",), (), "a number of updates"),
    "cuts": GoesWith("coding", ("fine", "hashed"), (), "a number of cuts"),
    "entries": GoesWith("coding", ("hashed",), (), "a number of entries"),
    "trace": GoesWith("method", ("q-lambda",), (), "a share λ"),
}
"""The options of architectures; an option of a new learner has its line here."""


OURS = ("action-input", "control", "decaying", "dqn", "gated", "networks", "table")
SUITED = {"continuous": ("control", "dqn", "networks"), "tilings": ("control", "decaying", "table")}
"""What ours can learn from codings that are more, or less, than one tile."""


class Task(Strict):
    """A task of §4.3 and how long a run of it is."""

    kind: Kind = Field(
        description="balancing: reset beyond 90°; full-control: any start, never reset."
    )
    steps: Steps = Field(description="Steps of 5 ms in one run.")
    velocity_weight: NotNegative = Field(
        default=0.0, description="Beyond the thesis: −w·φ̇² is added to what is learned from [s²]."
    )
    shaping: NotNegative = Field(
        default=0.0,
        description="Beyond the thesis: the height of a potential of energy [rad²].",
    )


class Architecture(Strict):
    """What learns, and whether one learner or two modules share the state space (§4.4–4.6)."""

    learner: LearnerName = Field(description="What holds Q; a file in src/upswing/agents/learners.")
    coding: CodingName = Field(
        default="grid",
        description="What it is told of a state; a file in src/upswing/agents/features.",
    )
    method: MethodName = Field(
        default="q-learning",
        description="How it learns from a step; a file in src/upswing/agents/algorithms.",
    )
    hidden: Annotated[
        tuple[Annotated[int, Field(ge=1, le=1000)], ...],
        BeforeValidator(listed),
        Field(max_length=2),
    ] = Field(default=(), description="Sizes of a network's hidden layers, input side first.")
    behaviour: Literal["idle", "random"] | None = Field(
        default=None, description="What a control does: always 0, or any action."
    )
    modular: bool = Field(
        default=False, description="One learner above the horizontal and one below (§4.6.3)."
    )

    cuts: Annotated[int, Field(ge=2, le=32)] | None = Field(
        default=None,
        description="Codings fine and hashed: each tile of the thesis is cut cuts × cuts.",
    )
    entries: Annotated[int, Field(ge=1, le=1_000_000)] | None = Field(
        default=None,
        description="Coding hashed: number of entries that the tiles are scattered over.",
    )
    trace: Share | None = Field(
        default=None, description="Method q-lambda: the λ by which a trace decays, beside γ."
    )
    halved_after: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = Field(
        default=None,
        description="Learner decaying: number of updates of an entry that halve its α.",
    )
    epsilon: Share | None = Field(default=None, description="Its own ε in place of the study's.")
    discount: Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)] | None = Field(
        default=None, description="Its own γ in place of the study's."
    )

    @model_validator(mode="after")
    def _fits(self) -> Self:
        for option, goes in GOES_WITH.items():
            chosen, given = getattr(self, goes.part), getattr(self, option) not in (None, ())
            if (chosen in goes.always and not given) or (
                given and chosen not in (*goes.always, *goes.sometimes)
            ):
                names = " or ".join(f"`{goes.part}: {name}`" for name in goes.always)
                raise ValueError(f"`{option}` ({goes.meaning}) goes with {names}, always")
        if self.learner == "control" and self.modular:
            raise ValueError("a control has nothing to divide into modules")
        if self.learner in OURS and self.learner not in SUITED.get(self.coding, OURS):
            suited = " or ".join(SUITED[self.coding])
            raise ValueError(f"`coding: {self.coding}` suits {suited}, not {self.learner}")
        if self.learner == "dqn" and (self.coding, self.method) != ("continuous", "q-learning"):
            raise ValueError(
                "a dqn needs `coding: continuous` and has its own method; leave it out"
            )
        if len(self.hidden) > 1 and (
            self.learner == "action-input"
            or (self.learner, self.coding) == ("networks", "continuous")
        ):
            raise ValueError("`hidden` has one size here: there is one hidden layer")
        if self.modular and self.coding != "grid":
            raise ValueError("`modular` divides the grid of the thesis; leave `coding` out")
        return self


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
    title: Text = Field(
        default="",
        max_length=100,
        description="What is changed; its cells then stand in the table of what each change buys.",
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

    results: Annotated[str, AfterValidator(_folder)] = Field(
        default="results", min_length=1, max_length=1_000, description="Folder of the results."
    )
    seeds: Seeds = Field(description="How many seeds a cell has (0, 1, …), or a list of them.")
    seeds_per_job: Annotated[int, Field(ge=1, le=1000)] = Field(
        default=15, description="Runs that share one job; more seeds then only add jobs."
    )
    epsilon: Share = Field(default=0.01, description="Share ε of random actions (§4.4).")
    discount: Annotated[float, Field(ge=0, lt=1, allow_inf_nan=False)] = Field(
        default=0.7, description="Discount γ (§4.5.1)."
    )
    tasks: dict[Name, Task] = Field(min_length=1, description="Tasks by name.")
    architectures: dict[Name, Architecture] = Field(
        min_length=1, description="Architectures by name."
    )
    experiments: Annotated[tuple[Experiment, ...], BeforeValidator(listed)] = Field(
        min_length=1, description="The cells of the matrix."
    )
    search: Search | None = Field(
        default=None, description="A search for what succeeds every time, and how soon."
    )
    readings: Readings = Field(
        default_factory=Readings, description="What the thesis leaves open (R1–R15)."
    )


def load(path: Path) -> Study:
    """The study written in a YAML file; ``BadInput`` with all its problems otherwise."""
    return validated({str(path): read_yaml(path)})


def from_snakemake(files: Sequence[str | Path], merged: Mapping[str, Any]) -> Study:
    """The study of a Snakemake run: its configuration files, and what ``--config`` laid over them."""
    contents = {str(path): read_yaml(Path(path)) for path in files}
    overlaid = {
        key: value
        for key, value in merged.items()
        if not any(content.get(key) == value for content in contents.values())
    }
    return validated({**contents, "--config": overlaid} if overlaid else contents)


def validated(contents: Mapping[str, Mapping[str, Any]]) -> Study:
    """The study written in several sources, each replacing whole keys of those before it."""
    data = {key: value for content in contents.values() for key, value in content.items()}
    origin = {key: source for source, content in contents.items() for key in content}

    def source_of(key: str) -> str:
        return origin.get(key, " + ".join(contents))

    try:
        study = Study.model_validate(data)
    except ValidationError as error:
        raise BadInput(explained(Study, error, source_of)) from None
    problems = list(_contradictions(study, source_of("experiments")))
    problems += _contradictions_of_search(study, source_of("search"))
    if problems:
        raise BadInput(problems)
    return study


def _contradictions(study: Study, source: str) -> Iterator[str]:
    """What each experiment says that the rest of the study does not bear out."""
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
            if architecture.learner == "control" and experiment.alphas:
                right = f"{name} does not learn and has no α; leave `alphas` out"
                yield problem(source, f"{place}.alphas", experiment.alphas, right)
            if architecture.learner != "control" and not experiment.alphas:
                yield f"{source}: {place}.alphas: missing: {name} learns with an α in (0, 1]"
        for task in experiment.tasks:
            for name in experiment.architectures:
                for alpha in experiment.alphas or (None,):
                    earlier = cells.setdefault((task, name, alpha), number)
                    if earlier != number:
                        right = f"duplicate cell: experiments[{earlier}] has it already"
                        yield problem(
                            source, place, f"{task}/{name}/alpha-{alpha_text(alpha)}", right
                        )
    if (runs := len(cells) * len(study.seeds)) > MOST_RUNS:
        right = f"{len(cells)} cells come to {runs:,} runs; a study has at most {MOST_RUNS:,}"
        yield problem(source, "seeds", len(study.seeds), right)


def _contradictions_of_search(study: Study, source: str) -> Iterator[str]:
    """What the search says that the rest of the study does not bear out."""
    search = study.search
    if search is None:
        return
    task = study.tasks.get(search.task)
    if task is None or task.kind == "balancing":
        known = [name for name, one in study.tasks.items() if one.kind != "balancing"]
        right = f"must be a task of full control; {near(search.task, known or ['none'])}"
        yield problem(source, "search.task", search.task, right)
    if both := sorted(set(search.seeds) & set(study.seeds)):
        right = "cells are reported on these seeds; what is chosen must be chosen on others"
        yield problem(source, "search.seeds", both[:5], right)
    for number, candidates in enumerate(search.candidates):
        place = f"search.candidates[{number}].architectures"
        for name in candidates.architectures:
            architecture = study.architectures.get(name)
            if architecture is None:
                yield problem(source, place, name, f"unknown; {near(name, study.architectures)}")
            elif architecture.learner == "control":
                yield problem(source, place, name, "a control learns nothing")


def schema() -> dict[str, Any]:
    """The JSON schema of a study, for editors; ``config/schema.json`` is this."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **Study.model_json_schema()}
