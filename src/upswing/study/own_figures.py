"""Figures of a study's own: declared from ready panels, or drawn by a file beside the configuration."""

from collections.abc import Collection, Iterator
from typing import Annotated, Any, Literal, Self

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    model_validator,
)
from pydantic.json_schema import SkipJsonSchema

from upswing.study.declared import part_name
from upswing.study.errors import near, problem
from upswing.study.loading import parts
from upswing.study.measured import MEASURES
from upswing.study.names import CellName, Name, Text
from upswing.study.values import Strict, listed, once

OF_SWEEPS = "readings-"
"""How the pictures of sweeps begin, which stand beside the figures."""

ONE_TASK = ("falls", "upright", "step-sizes")
"""Panels whose cells are drawn over one axis, and so are of one task."""


def _own(name: str) -> str:
    if name in parts("figures"):
        raise ValueError("the project has a figure of this name; choose another")
    if name.startswith(OF_SWEEPS):
        raise ValueError(f"{OF_SWEEPS}… are the pictures of sweeps; choose another name")
    return name


def _measured(name: str) -> str:
    if name not in MEASURES:
        raise ValueError(f"no measure of a run; {near(name, MEASURES)}")
    return name


FigureName = Annotated[Name, AfterValidator(_own)]


def _some(values: tuple[Any, ...]) -> tuple[Any, ...]:
    # Not `min_length`: of a list whose only item is wrong it would say that the list is empty as well.
    if not values:
        raise ValueError("must have at least 1")
    return values


some = AfterValidator(_some)


class DeclaredPanel(Strict):
    """A panel of a figure, which is ready to be drawn of any cells."""

    panel: Literal["angle", "falls", "upright", "measure", "step-sizes"] = Field(
        description="`angle`: φ of one run; `falls`, `upright`: all runs of the first cell over their "
        "steps, and the medians of the others; `measure`: every run as a dot, a row for each cell; "
        "`step-sizes`: the share of runs that succeed over α, a line for each architecture."
    )
    cells: Annotated[tuple[CellName, ...], BeforeValidator(listed), once, some] = Field(
        json_schema_extra={"minItems": 1},
        description="Ids of the cells that it shows, as `upswing check` lists them.",
    )
    title: Text = Field(default="", max_length=100, description="What stands over it.")
    measure: Annotated[str, AfterValidator(_measured)] | None = Field(
        default=None, description="Of `measure`: a column of the table of runs."
    )
    run: Literal["worst", "median", "best"] = Field(
        default="median", description="Of `angle`: which run of its cell."
    )

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if (self.measure is None) == (self.panel == "measure"):
            raise ValueError("`measure` goes with `panel: measure`, always")
        if self.panel == "angle" and len(self.cells) > 1:
            raise ValueError("`panel: angle` shows one cell; write a panel for each")
        if "run" in self.model_fields_set and self.panel != "angle" and self.run != "median":
            raise ValueError("`run` goes with `panel: angle`")
        tasks = {cell.partition("/")[0] for cell in self.cells}
        if self.panel in ONE_TASK and len(tasks) > 1:
            raise ValueError(f"`panel: {self.panel}` shows cells of one task, not of {len(tasks)}")
        if self.panel == "step-sizes" and any(cell.endswith("/alpha-none") for cell in self.cells):
            raise ValueError("`panel: step-sizes` shows cells that learn; a control has no α")
        return self


class DeclaredFigure(Strict):
    """A figure made of ready panels."""

    name: FigureName = Field(description="Its name, and that of its files.")
    title: Text = Field(min_length=1, max_length=100, description="Its heading.")
    panels: Annotated[tuple[DeclaredPanel, ...], BeforeValidator(listed), some] = Field(
        max_length=12,
        json_schema_extra={"minItems": 1},
        description="Its panels, two in a row.",
    )
    caption: Text = Field(
        default="",
        max_length=1_000,
        description="What to see; what each panel shows is said by itself.",
    )

    @property
    def cells(self) -> tuple[str, ...]:
        """The cells that it shows, each once."""
        return tuple(dict.fromkeys(cell for panel in self.panels for cell in panel.cells))


class FigureFile(Strict):
    """A figure that a file beside the configuration draws; only a loader makes one (``own_files``)."""

    name: FigureName
    file: Annotated[str, Field(min_length=1, pattern=r"\.py$")]  # from the folder of the workflow


OwnFigure = DeclaredFigure | FigureFile


def _chosen(value: Any, as_it_is: ValidatorFunctionWrapHandler) -> Any:
    """What a figure is, told by what is written of it, so that a problem is one line and not three."""
    if isinstance(value, dict):
        return (FigureFile if "file" in value else DeclaredFigure).model_validate(value)
    if isinstance(value, str):
        return _KNOWN(value)
    return as_it_is(value) if isinstance(value, DeclaredFigure | FigureFile) else _refused()


def _refused() -> Any:
    raise ValueError("must be the name of a figure, or a mapping of name, title and panels")


_KNOWN: Any = part_name("figures").func

AnyFigure = Annotated[str | DeclaredFigure | SkipJsonSchema[FigureFile], WrapValidator(_chosen)]


def figure_name(figure: "str | OwnFigure") -> str:
    """The name of a figure, however a study names it."""
    return figure if isinstance(figure, str) else figure.name


def _names_once(figures: "tuple[str | OwnFigure, ...]") -> "tuple[str | OwnFigure, ...]":
    names = [figure_name(one) for one in figures]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise ValueError(f"{twice!r} stands there twice")
    return figures


AnyFigures = Annotated[tuple[AnyFigure, ...], BeforeValidator(listed), AfterValidator(_names_once)]


def contradictions(
    figures: "tuple[str | OwnFigure, ...]", cells: Collection[str], source: str
) -> Iterator[str]:
    """What declared figures show that the study does not have."""
    for number, figure in enumerate(figures):
        if isinstance(figure, DeclaredFigure):
            for of, panel in enumerate(figure.panels):
                for at, cell in enumerate(panel.cells):
                    if cell not in cells:
                        place = f"figures[{number}].panels[{of}].cells[{at}]"
                        right = f"no cell of this study; {near(cell, cells)[:200]}"
                        yield problem(source, place, cell, right)
