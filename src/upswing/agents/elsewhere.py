"""An agent from elsewhere: a function of somebody else's, found by name and asked for actions.

What it is asked is what the Gymnasium environments say: cos φ, sin φ, φ̇. To find it is to run its file,
so only a name that a person has given is looked up, never one that stands in a folder of results.
"""

import ast
import importlib
import inspect
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.metadata import packages_distributions, version
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from traceback import extract_tb
from types import ModuleType
from typing import Any

import numpy as np

from upswing.physics.actions import indices, pushes
from upswing.physics.observation import Observation, observed
from upswing.study.errors import BadInput, near

FORMS = "file.py:function or module:function"
SEED = "seed"
"""The name of the parameter by which a function says that it makes agents."""


class AgentFailed(RuntimeError):
    """An agent raised an error, or answered with what is no action."""


@dataclass(frozen=True)
class Agent:
    """An agent that was found.

    ``make`` gives, for the seed of a run, what acts in it: a function of an observation, whose
    attribute ``reset``, if it has one, is called where an episode begins.
    """

    name: str  # as it was given
    source: Path
    make: Callable[[int], Callable[[Observation], Any]]

    @property
    def made_with(self) -> str:
        """The packages that its file imports, with their versions, in one line."""
        there = packages_distributions()
        names = {name for module in _imports(self.source) for name in there.get(module, ())}
        return ", ".join(f"{name} {version(name)}" for name in sorted(names - {"upswing"}))


class Acting:
    """An agent in a run, whose actions are these accelerations of the cart [m/s²]."""

    def __init__(self, agent: Agent, seed: int, accelerations: Sequence[float]) -> None:
        self.agent, self.accelerations = agent, accelerations
        self._policy = _guarded(agent, "made for a seed", lambda: agent.make(seed))
        if not callable(self._policy):
            raise AgentFailed(f"{agent.name}: made for a seed: {self._policy!r} is no function")

    def begin(self) -> None:
        """Tell it that an episode begins, if it asks to be told."""
        if callable(reset := getattr(self._policy, "reset", None)):
            _guarded(self.agent, "reset", reset)

    def action(self, angle: float, angular_velocity: float) -> int:
        """The index of its action at φ [rad], φ̇ [rad/s].

        Raises:
            AgentFailed: it raised an error, or its answer is no action.
        """
        observation = observed(angle, angular_velocity)
        at = f"asked at [{', '.join(f'{number:.4g}' for number in observation)}]"
        answer = _guarded(self.agent, at, lambda: self._policy(observation))
        if type(answer) is not int and isinstance(answer, np.ndarray | np.integer):
            answer = answer.item() if answer.size == 1 else answer
        count = len(self.accelerations)
        if type(answer) is not int or not 0 <= answer < count:
            said = " ".join(repr(answer).split())[:60]
            raise AgentFailed(
                f"{self.agent.name}: {at}: answers {said}: must be {indices(count)}, "
                f"an index into {pushes(self.accelerations)} m/s²"
            )
        return answer


def find(text: str) -> Agent:
    """The agent that is called ``file.py:function`` or ``module:function``; this runs its file.

    Raises:
        BadInput: there is none, or it cannot be imported.
    """
    place, colon, name = text.rpartition(":")
    if not (colon and place and name.isidentifier()):
        raise BadInput([f"agent: {text}: must be {FORMS}"])
    module = _imported(text, place)
    found = getattr(module, name, None)
    if found is None:
        known = [one for one, value in vars(module).items() if callable(value) and one[0] != "_"]
        raise BadInput([f"agent: {text}: {place} has no {name}; {near(name, known)[:200]}"])
    if not callable(found):
        raise BadInput([f"agent: {text}: is no function but {type(found).__name__}"])
    return Agent(text, Path(str(module.__file__)), _maker(text, found))


def _imported(text: str, place: str) -> ModuleType:
    path = Path(place)
    if is_file := place.endswith(".py") or "/" in place:
        if not path.is_file():
            raise BadInput([f"agent: {text}: there is no file {place}"])
        if path.suffix != ".py":
            raise BadInput([f"agent: {text}: must be {FORMS}; {place} is no .py"])
    # As `python file.py` has it: what lies beside a file can be imported by it, now and later.
    sys.path.append(str(path.resolve().parent) if is_file else str(Path.cwd()))
    try:
        module = _from_file(path) if is_file else import_module(place)
    except (Exception, SystemExit) as error:  # noqa: BLE001  whatever it may raise
        raise BadInput([f"agent: {text}: cannot be imported: {_said(error)}"]) from None
    if not getattr(module, "__file__", None):
        raise BadInput([f"agent: {text}: {place} is a folder; name a module in it"])
    return module


def _from_file(path: Path) -> ModuleType:
    name = f"upswing_agent_{path.stem}"
    described = spec_from_file_location(name, path)
    if described is None or described.loader is None:
        raise ImportError(f"{path} is no Python")
    module = sys.modules[name] = module_from_spec(described)
    described.loader.exec_module(module)
    return module


def _maker(text: str, found: Callable[..., Any]) -> Callable[[int], Callable[[Observation], Any]]:
    """What makes the agent of a run: the function itself, if it is one of an observation."""
    try:
        parameters = inspect.signature(found).parameters
    except (TypeError, ValueError):  # one that is compiled does not say
        return lambda _: found
    if SEED in parameters:
        return lambda seed: found(**{SEED: seed})
    needed = [
        parameter
        for parameter in parameters.values()
        if parameter.default is parameter.empty
        and parameter.kind not in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
    ]
    if not parameters:
        return lambda _: found()
    if len(needed) > 1:
        names = ", ".join(parameter.name for parameter in needed)
        raise BadInput(
            [
                f"agent: {text}: takes {names}: must take an observation, or `{SEED}` and make an agent"
            ]
        )
    return lambda _: found


def _guarded(agent: Agent, doing: str, call: Callable[[], Any]) -> Any:
    try:
        return call()
    except (Exception, SystemExit) as error:  # whatever it may raise
        raise AgentFailed(f"{agent.name}: {doing}: {_said(error)}") from error


def _said(error: BaseException) -> str:
    """An error in one line, with the place in the agent's own code."""
    words = " ".join(str(error).split())[:200]
    frames = [
        frame
        for frame in extract_tb(error.__traceback__)
        if frame.filename not in (__file__, importlib.__file__)
    ]
    outside = [frame for frame in frames if not frame.filename.startswith("<")]
    where = f" ({Path(outside[0].filename).name}, line {outside[0].lineno})" if outside else ""
    return f"{type(error).__name__}: {words}{where}"


def _imports(source: Path) -> Iterator[str]:
    """The outermost packages that a file imports."""
    try:
        tree = ast.parse(source.read_bytes())
    except (OSError, SyntaxError, ValueError):  # of a compiled module
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield node.module.partition(".")[0]
