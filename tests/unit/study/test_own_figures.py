"""Figures made of ready panels, as they are written."""

import pytest

from upswing.study.config import validated
from upswing.study.errors import BadInput

ONE, OTHER = "balancing/table/alpha-1", "balancing/table/alpha-0.5"
IDLE, FULL = "balancing/idle/alpha-none", "full-control/table/alpha-1"
STUDY = {
    "seeds": 2,
    "tasks": {name: {"kind": name, "steps": 500} for name in ("balancing", "full-control")},
    "architectures": {"table": {"learner": "table"}, "idle": {"learner": "control", "behaviour": "idle"}},
    "experiments": [
        {"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.5]},
        {"tasks": ["balancing"], "architectures": ["idle"]},
        {"tasks": ["full-control"], "architectures": ["table"], "alphas": [1]},
    ],
}  # fmt: skip


def study(*panels, **more):
    figure = {"name": "mine", "title": "Mine", "panels": list(panels), **more}
    return validated({"mine.yaml": {**STUDY, "figures": [figure]}})


def test_a_figure_shows_the_cells_of_its_panels():
    found = study({"panel": "falls", "cells": [ONE, OTHER]}, {"panel": "angle", "cells": [ONE]})
    assert found.figure_names == ("mine",)
    assert found.figures[0].cells == (ONE, OTHER)


@pytest.mark.parametrize(
    ("panel", "expected"),
    [
        ({"panel": "fall", "cells": [ONE]}, "panels[0].panel: \"fall\": must be 'angle', "),
        ({"panel": "falls", "cells": []}, "panels[0].cells: []: must have at least 1"),
        ({"panel": "falls", "cells": ["balancing/tabel/alpha-1"]}, f"no cell of this study; did you mean '{ONE}'?"),
        ({"panel": "falls", "cells": [ONE, FULL]}, "shows cells of one task, not of 2"),
        ({"panel": "angle", "cells": [ONE, OTHER]}, "`panel: angle` shows one cell"),
        ({"panel": "falls", "cells": [ONE], "run": "best"}, "`run` goes with `panel: angle`"),
        ({"panel": "falls", "cells": [ONE], "measure": "falls"}, "`measure` goes with `panel: measure`"),
        ({"panel": "measure", "cells": [ONE]}, "`measure` goes with `panel: measure`"),
        ({"panel": "measure", "cells": [ONE], "measure": "fals"}, "no measure of a run; did you mean 'falls'?"),
        ({"panel": "step-sizes", "cells": [ONE, IDLE]}, "a control has no α"),
        ({"panel": "falls", "cells": [ONE], "titel": "x"}, "panels[0].titel: unknown key: "),
    ],
)  # fmt: skip
def test_a_panel_that_cannot_be_drawn_is_refused_in_one_line(panel, expected):
    with pytest.raises(BadInput) as refused:
        study(panel)
    (line,) = refused.value.problems
    assert line.startswith("mine.yaml: figures[0].panels[0]")
    assert expected in line


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("overview", "the project has a figure of this name"),
        ("readings-mine", "are the pictures of sweeps"),
        ("Mine", "a name has small letters"),
    ],
)
def test_a_figure_needs_a_name_of_its_own(name, expected):
    with pytest.raises(BadInput) as refused:
        study({"panel": "falls", "cells": [ONE]}, name=name)
    (line,) = refused.value.problems
    assert line.startswith("mine.yaml: figures[0].name: ")
    assert expected in line
