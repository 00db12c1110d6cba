"""What the rules ask of Snakemake where another workflow has them as a module."""

from collections.abc import Iterable
from typing import Any

from upswing.study.errors import BadInput


def is_module(workflow: Any) -> bool:
    """Whether the rules that are being read are a module of another workflow."""
    return not workflow.modifier.is_main_snakefile()


def own_names(workflow: Any, names: Iterable[str]) -> dict[str, str]:
    """The names of rules, by what they are called in the workflow that has them as a module."""
    return {workflow.modifier.modify_rulename(name): name for name in names}


def check_paths(workflow: Any) -> None:
    """Refuse a module's ``prefix``: a study names its own folder, and each job is told of it.

    Raises:
        BadInput: the module has one, or replaces some.
    """
    modifier = workflow.modifier.path_modifier
    if modifier.prefix is not None or modifier._prefix_replacements is not None:
        right = "cannot be used; say `results: FOLDER` in the module's config"
        raise BadInput([f"module: prefix: {right}"])
