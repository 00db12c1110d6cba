"""The specification of a job: everything that its results depend on, besides the code."""

import json
import shlex
from collections import Counter
from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, ValidationError

from upswing.study.architecture import AnyNamedArchitecture
from upswing.study.errors import BadInput, explained, shown
from upswing.study.ids import cell_id, run_id
from upswing.study.names import Alpha
from upswing.study.readings import Readings
from upswing.study.task import AnyNamedTask
from upswing.study.values import Discount, Seed, Share, Strict, listed, once


class Spec(Strict):
    """One cell of the matrix, and the seeds to run it with."""

    task: AnyNamedTask
    architecture: AnyNamedArchitecture
    alpha: Alpha | None
    seeds: Annotated[tuple[Seed, ...], BeforeValidator(listed), Field(min_length=1), once]
    epsilon: Share
    discount: Discount
    readings: Readings

    @property
    def cell(self) -> str:
        """The id of the cell, and its path below ``runs``: ``balancing/table/alpha-0.75``."""
        return cell_id(self.task.name, self.architecture.name, self.alpha)

    def run(self, seed: int) -> str:
        """The id of a run, and its path below ``runs`` without an ending."""
        return run_id(self.cell, seed)

    def columns(self, seed: int) -> dict[str, Any]:
        """What a table says of which run it is."""
        return {
            "run": self.run(seed),
            "task": self.task.name,
            "architecture": self.architecture.name,
            "alpha": self.alpha,
            "seed": seed,
        }

    def of_seed(self, seed: int) -> "Spec":
        """The specification of a single run."""
        return self.model_copy(update={"seeds": (seed,)})

    def canonical(self) -> str:
        """As one line of JSON: the same text for the same meaning.

        Only the readings that touch the run are in it, and no key that has its default.
        """
        content = self.model_dump(exclude={"readings", "task", "architecture"})
        content["task"] = self.task.model_dump(exclude_defaults=True)
        content["architecture"] = self.architecture.model_dump(exclude_defaults=True)
        content["readings"] = self.readings.touching(
            self.architecture.learner, self.task.kind, self.architecture.is_modular
        )
        return json.dumps(_shortest(content), sort_keys=True, separators=(",", ":"))

    def canonical_runs(self) -> Iterator[tuple[int, str]]:
        """Each seed, and the canonical text of its run alone."""
        text = self.of_seed(0).canonical()
        for seed in self.seeds:
            yield seed, text.replace('"seeds":[0]', f'"seeds":[{seed}]')

    def command(self, results: str) -> str:
        """The command that repeats the job by hand."""
        return shlex.join(["upswing", "train", self.canonical(), "--results", results])


def parse(text: str) -> Spec:
    """The specification in a line of JSON; ``BadInput`` with all its problems otherwise."""
    try:
        content = json.loads(text, object_pairs_hook=_no_key_twice)
    except (json.JSONDecodeError, RecursionError) as error:
        raise BadInput([f"spec: {shown(text)}: is not JSON: {error}"]) from None
    if not isinstance(content, dict):
        raise BadInput([f"spec: {shown(text)}: must be a JSON object"])
    try:
        spec = Spec.model_validate(content)
    except ValidationError as error:
        raise BadInput(explained(Spec, error, lambda *_: "spec")) from None
    if (spec.alpha is None) != (not spec.architecture.learns):
        raise BadInput(
            [f"spec: alpha: {shown(spec.alpha)}: a control has null, a learner a number"]
        )
    return spec


def _no_key_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) < len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key, count in Counter(keys).items() if count > 1)
        raise BadInput([f"spec: {twice}: duplicate key; keep one"])
    return content


def _shortest(value: Any) -> Any:
    """Whole floats as integers, so that 1 and 1.0 are the same text."""
    if isinstance(value, dict):
        return {key: _shortest(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_shortest(part) for part in value]
    if isinstance(value, float) and value.is_integer():
        return int(value)
    return value
