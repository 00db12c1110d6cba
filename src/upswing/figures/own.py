"""Figures of a study's own: declared from panels, or code beside the configuration, which is run.

Planning a study and drawing a figure run its code; nothing else does. The page shows what drawing left
behind, so that reading somebody's results runs nothing of theirs.
"""

from collections.abc import Iterator, Mapping
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

from upswing.figures.declaration import Declaration
from upswing.study.config import Study
from upswing.study.errors import BadInput
from upswing.study.own_figures import DeclaredFigure, FigureFile, OwnFigure

MODULE = "upswing_own_figures"
"""What the modules of such files are called, with a figure's name behind."""


def own_of(study: Study) -> dict[str, OwnFigure]:
    """The figures that a study declares, or that files beside its configuration draw, by name."""
    return {one.name: one for one in study.figures if not isinstance(one, str)}


class WithOwn(Mapping[str, Declaration]):
    """What each figure shows, those of a study's own included; each is read when it is asked for."""

    def __init__(self, project: Mapping[str, Declaration], study: Study) -> None:
        self._project, self._own = project, own_of(study)
        self._known: dict[str, Declaration] = {}

    def __getitem__(self, name: str) -> Declaration:
        if name not in self._own:
            return self._project[name]
        if name not in self._known:  # for it is read by running its file
            self._known[name] = declaration_of(self._own[name])
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        yield from self._project
        yield from self._own

    def __len__(self) -> int:
        return len(self._project) + len(self._own)


def declaration_of(figure: OwnFigure) -> Declaration:
    """What a figure shows.

    Raises:
        BadInput: its file cannot be run, or does not say it.
    """
    if isinstance(figure, DeclaredFigure):
        return Declaration(figure.title, "", (), figure.cells)
    declared = getattr(load_file(figure), "FIGURE", None)
    if not isinstance(declared, Declaration):
        raise BadInput([f"{figure.file}: FIGURE: must be a Declaration(…)"])
    if declared.number is not None:
        raise BadInput([f"{figure.file}: FIGURE: number: only a figure of the thesis has one"])
    return declared


def load_file(figure: FigureFile) -> ModuleType:
    """The module in a figure's file, run anew.

    Raises:
        BadInput: there is no such file, or running it failed.
    """
    path = Path(figure.file)
    found = spec_from_file_location(f"{MODULE}.{path.stem}", path)
    if found is None or found.loader is None or not path.is_file():
        raise BadInput([f"{path}: missing; it draws the figure {figure.name}"])
    module = module_from_spec(found)
    try:
        found.loader.exec_module(module)
    except Exception as error:  # noqa: BLE001  whatever it is, it is not ours
        said = (str(error).splitlines() or [""])[0]
        at = f" line {line}:" if (line := _line(error, path)) else ""
        raise BadInput([f"{path}:{at} {type(error).__name__}: {said}"]) from None
    return module


def _line(error: Exception, path: Path) -> int | None:
    """The last line of a file that an error went through."""
    if isinstance(error, SyntaxError):
        return error.lineno
    lines = []
    traceback = error.__traceback__
    while traceback is not None:
        if Path(traceback.tb_frame.f_code.co_filename).resolve() == path.resolve():
            lines.append(traceback.tb_lineno)
        traceback = traceback.tb_next
    return lines[-1] if lines else None
