"""The house is as CONTRIBUTING says: every room is in its list, and imports only from rooms above it."""

import re
from pathlib import Path

from upswing.fingerprint import _imports

ROOT = Path(__file__).parents[1]
ROW = re.compile(r"\| ((?:`[\w/]+`(?:, )?)+) \|")


def rooms():
    """The rooms in the order of the list; those of a line stand in their own order."""
    lines = (ROOT / "CONTRIBUTING.md").read_text("utf-8").splitlines()
    found = [
        name
        for line in lines
        if (row := ROW.match(line))
        for name in re.findall(r"`(\w+)/?`", row[1])
    ]
    assert len(found) == len(set(found)) > 30
    return {name: number for number, name in enumerate(found)}


def modules():
    for path in sorted((ROOT / "src/upswing").rglob("*.py")):
        parts = path.relative_to(ROOT / "src").with_suffix("").parts
        name = ".".join(part for part in parts if part != "__init__")
        if "." in name:
            yield name


def test_every_room_is_in_the_list_and_none_else():
    assert {name.split(".")[1] for name in modules()} == set(rooms())


def test_nothing_imports_upwards():
    place = rooms()
    upwards = [
        f"{name} imports {imported}"
        for name in modules()
        for imported in _imports(name)
        if "." in imported and place[imported.split(".")[1]] > place[name.split(".")[1]]
    ]
    assert upwards == []
