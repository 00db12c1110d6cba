"""Adopting an agent from elsewhere: its runs over a task of the study (``upswing adopt``)."""

import re
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout
from io import TextIOBase
from pathlib import Path
from typing import NamedTuple, TextIO

from pydantic import ValidationError

from upswing.agents.elsewhere import Acting, Agent, AgentFailed, find
from upswing.agents.learners.adopted import acting
from upswing.runs.adopted import (
    declare,
    declared,
    file_of_cell,
    joined,
    specified,
)
from upswing.runs.files.checksums import checksum
from upswing.runs.study_file import read_study
from upswing.runs.train import train
from upswing.study.architecture import NamedArchitecture, architecture_named
from upswing.study.config import ADOPTED, Study
from upswing.study.errors import BadInput, explained, near
from upswing.study.spec import Spec
from upswing.study.values import LARGEST_SEED


class Asked(NamedTuple):
    """What is adopted, as it was asked for."""

    agent: str  # file.py:function or module:function
    task: str  # its name in the study
    name: str  # of the architecture that it will be called
    seeds: tuple[int, ...]
    reads: Sequence[Path] = ()  # files whose checksums belong to its origin: its weights


class _Shown(TextIOBase):
    """What a training says of its runs, but for the command that would repeat one: it takes no agent."""

    def __init__(self, shown: TextIO) -> None:
        self._shown = shown

    def write(self, text: str) -> int:
        """Pass on a text that was printed."""
        return self._shown.write(re.sub(r"\n +to repeat it: .*", "", text))


def adopt(results: Path, asked: Asked) -> Spec:
    """Run an agent over a task of the study in ``results``, once for each seed, and keep the runs.

    Each run is as long as those of the task, from the starts that other runs of its seed have, and has
    the greedy evaluation of the task. Returns the specification of the cell with all its seeds.

    Raises:
        BadInput: what was asked for is not possible; nothing was written.
        RunsFailed: the agent failed in a run. The cell is declared as it was before; runs that finished
            are used again by the next call.
    """
    study = read_study(results)
    _check(results, study, asked)
    agent = find(asked.agent)
    architecture = _architecture(agent, asked)
    spec = specified(study, asked.task, architecture, asked.seeds)
    _try(agent, spec)
    before = _before(results, study, spec)
    with acting(agent), redirect_stdout(_Shown(sys.stdout)):
        train(spec, results)
    seeds = tuple(sorted({*asked.seeds, *before}))
    whole = spec.model_copy(update={"seeds": seeds})
    declare(results, whole)
    return whole


def _check(results: Path, study: Study, asked: Asked) -> None:
    problems = []
    if asked.task not in study.tasks:
        problems.append(
            f"task: {asked.task}: no task of {results}; {near(asked.task, study.tasks)}"
        )
    if asked.name in study.architectures:
        problems.append(
            f"name: {asked.name}: is an architecture of {results}; give another with --name"
        )
    problems += [
        f"file: {path}: there is no such file" for path in asked.reads if not path.is_file()
    ]
    if len(set(asked.seeds)) < len(asked.seeds):
        problems.append(f"seed: {asked.seeds}: one stands there twice")
    problems += [
        f"seed: {seed}: must be a whole number from 0 to {LARGEST_SEED}"
        for seed in asked.seeds
        if not 0 <= seed <= LARGEST_SEED
    ]
    if problems:
        raise BadInput(problems)


def _architecture(agent: Agent, asked: Asked) -> NamedArchitecture:
    """The agent as an architecture that says where it comes from."""
    name = asked.agent.rpartition(":")[0]
    files = {name: agent.source, **{str(path): path for path in asked.reads}}
    try:
        return architecture_named(
            asked.name,
            learner=ADOPTED,
            coding="continuous",
            agent=asked.agent,
            checksums={said: checksum(path) for said, path in files.items() if path.is_file()},
            made_with=agent.made_with,
        )
    except ValidationError as error:
        raise BadInput(explained(NamedArchitecture, error, lambda *_: "adopt")) from None


def _try(agent: Agent, spec: Spec) -> None:
    """Ask the agent once, before anything is written."""
    try:
        acting = Acting(agent, spec.seeds[0], spec.task.pendulum.accelerations)
        acting.begin()
        acting.action(0.0, 0.0)
    except AgentFailed as error:
        raise BadInput([f"agent: {error}"]) from None


def _before(results: Path, study: Study, spec: Spec) -> tuple[int, ...]:
    """The seeds with which the same agent was adopted before.

    Raises:
        BadInput: another agent was adopted under this name.
    """
    if spec.cell not in joined(results, study).cells:
        return ()  # or it is of another study than this has become, and is replaced
    there = next(one for one in declared(results) if one.cell == spec.cell)
    if there.model_copy(update={"seeds": spec.seeds}).canonical() != spec.canonical():
        path = file_of_cell(results, spec)
        raise BadInput(
            [
                f"name: {spec.architecture.name}: is in {results} already, another agent or another "
                f"state of it; give another --name, or delete {path} first"
            ]
        )
    return there.seeds
