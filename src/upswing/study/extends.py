"""A configuration that extends another, key ``extends``: it says only what differs.

A mapping (tasks, architectures, readings, a pendulum) is joined key by key; anything else, a list too,
stands in place of what was there. What a page says of a study, its title for one, is said of none that
extends it.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from upswing.study.errors import BadInput, problem
from upswing.study.yaml_file import read_yaml

KEY = "extends"
OF_ONE_ALONE = ("title", "about")
"""Keys that are about the study of their own file and no other."""

Content = dict[str, Any]


def sources_of(path: Path) -> dict[str, Content]:
    """What a configuration and those that it extends say, by file: the farthest first, itself last.

    Raises:
        BadInput: a file cannot be read, extends itself, or would write into the results of the other.
    """
    found: dict[str, Content] = {}
    at: Path | None = path
    while at is not None:
        if str(at) in found:
            raise BadInput(
                [problem(str(path), KEY, str(at), "extends itself; leave one of them out")]
            )
        content = read_yaml(at)
        found[str(at)] = content
        at = _extended(at, content)
    return dict(reversed(found.items()))


def _extended(path: Path, content: Content) -> Path | None:
    """The file that a configuration extends, beside it; none where it extends nothing."""
    if KEY not in content:
        return None
    name = content[KEY]
    if not isinstance(name, str) or not (other := path.parent / name).is_file():
        right = f"must be the name of a configuration in {path.parent}"
        raise BadInput([problem(str(path), KEY, name, right)])
    if "results" not in content:
        raise BadInput(
            [f"{path}: results: missing: a study that extends another has its own folder"]
        )
    return other


def joined(contents: Mapping[str, Content]) -> Content:
    """What several files say together, each over those before it."""
    whole: Content = {}
    for content in contents.values():
        inherited = {key: value for key, value in whole.items() if key not in OF_ONE_ALONE}
        whole = _over(inherited, content)
    whole.pop(KEY, None)
    return whole


def _over(below: Content, above: Content) -> Content:
    both = {
        key: _over(below[key], value)
        if isinstance(value, dict) and isinstance(below.get(key), dict)
        else value
        for key, value in above.items()
    }
    return {**below, **both}
