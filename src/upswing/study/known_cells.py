"""Cells that claims and sweeps name: is each one that some study has?

A study with fewer cells than the thesis judges fewer claims, and says so. A cell that no study beside
the file has is a slip of the pen, and would be judged without a word.
"""

from collections.abc import Mapping
from pathlib import Path

from upswing.study.config import Study, load
from upswing.study.errors import BadInput, near, problem
from upswing.study.matrix import Matrix


def check_cells(named: Mapping[str, str], study: Study, path: Path) -> None:
    """Refuse cells that neither ``study`` nor another configuration in the folder of ``path`` has.

    Args:
        named: the cells by the place in the file where they stand.
        study: the study that is run.
        path: the file that names them.
    """
    known = set(Matrix(study).cells)
    if set(named.values()) <= known:
        return  # as nearly always: the other files need not be read
    for other in sorted(path.parent.glob("*.yaml")):
        try:
            known |= set(Matrix(load(other)).cells)
        except BadInput:
            continue  # no study, or one that is not finished
    if problems := [
        problem(str(path), place, cell, f"no study here has this cell; {near(cell, known)[:200]}")
        for place, cell in named.items()
        if cell not in known
    ]:
        raise BadInput(problems)
