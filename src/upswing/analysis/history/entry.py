"""What the head of an entry says: which study, when, by which code, what changed, and what came out."""

from datetime import UTC, datetime

from pydantic import BaseModel, ConfigDict

from upswing.study.errors import BadInput

SHORT = 7
"""Of a commit, as it is shown [hexadecimal digits]."""


class Head(BaseModel):
    """Part of what an entry says. What a later version adds is passed over."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class Changed(Head):
    """Something that differs from the entry before."""

    what: str  # a dotted key of the configuration, or a claim
    before: str
    after: str


class Runs(Head):
    """Runs, and how they differ from those of the entry before."""

    all: int
    new: int
    changed: int  # their steps are others
    gone: int


class Taken(Head):
    """What it took, by the jobs' own account; times are of all these jobs, one after the other."""

    trained_runs: int  # since the entry before
    training_seconds: float  # of the jobs that trained them
    training_cpu_seconds: float
    jobs: int  # all of the study, but for sweeps over readings: as they ran last
    seconds: float
    cpu_seconds: float


class Patch(Head):
    """The difference of the tracked files from the commit."""

    bytes: int  # as kept
    whole: bool  # False where it was longer than what is kept


class Note(Head):
    """A note that was added later."""

    when: datetime
    text: str


class Entry(Head):
    """The head of an entry."""

    id: str
    number: int  # from 1; the oldest has the smallest
    when: datetime
    before: str | None  # the id of the entry that it is compared with; None for a first one
    digest: str  # equal for what came out alike
    note: str
    commit: str  # "unknown" outside a checkout
    dirty: bool
    patch: Patch | None
    python: str
    packages: dict[str, str]
    machine: str
    processors: int
    cells: int
    runs: Runs
    configuration: tuple[Changed, ...]  # against the entry before
    verdicts: dict[str, str]  # by claim
    changed_verdicts: tuple[Changed, ...]
    changed_cells: int  # cells whose estimates are others, or that only one of both has
    taken: Taken

    @property
    def commit_shown(self) -> str:
        """The commit, short, with a ``+`` where files differed from it."""
        return f"{self.commit[:SHORT]}{'+' if self.dirty else ''}"

    @property
    def when_shown(self) -> str:
        """When it was written, in UTC to the minute."""
        return f"{self.when.astimezone(UTC):%Y-%m-%d %H:%M}"

    @property
    def name(self) -> str:
        """How it is called in a sentence: ``@3 (20261126-062427-3fa2c1)``."""
        return f"@{self.number} ({self.id})"


class Listed(Entry):
    """The head of an entry with what was noted later."""

    notes: tuple[Note, ...] = ()

    @property
    def every_note(self) -> list[str]:
        """What was noted when it was written, and later."""
        return [text for text in (self.note, *(note.text for note in self.notes)) if text]


class Entries(Head):
    """All heads, the oldest first."""

    entries: tuple[Listed, ...]


def parsed(model: type[Head], text: bytes, source: str) -> Head:
    """What a file of the history says.

    Raises:
        BadInput: it is not what was written.
    """
    try:
        return model.model_validate_json(text)
    except ValueError as error:
        said = str(error).splitlines()[0]
        raise BadInput([f"{source}: is no such file of a history: {said}"]) from None
