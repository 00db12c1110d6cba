"""What every key of a configuration means, as Markdown; ``config/README.md`` is this."""

from collections.abc import Iterator
from typing import Any

from upswing.study.claims import Claims
from upswing.study.json_schema import schema, sections_of_options
from upswing.study.registration import Entry, Registered
from upswing.study.sweeps import Report, Round, Sweep

HEAD = """\
# Configuration

`config.yaml` is the study of the thesis, `smoke.yaml` the same in a minute. Write your own beside
them and run it with

    .venv/bin/upswing check config/mine.yaml
    make study CONFIG=config/mine.yaml

and give it a `results` folder of its own, or it replaces what is in `results/`. Unknown keys,
duplicate keys and numbers written as text (`1e-3` is text in YAML) are refused, all problems in one
message.

`schema.json` is the same as a JSON schema, for editors. Both are generated from the types
(`make schema`), and a test compares them.
"""


OPTIONS_HEAD = """\
The learner, the feature encoder (`coding`), the algorithm (`method`) and the kind of task may have
options of their own, which stand beside the keys above. They are declared in the file of the part, in a
class `Options`.
"""

CLAIMS_HEAD = """\
`claims.yaml` says what each claim of the thesis measures and from where on it holds; its head explains
the words. A file of your own, which `claims` names, has the same keys; `docs/extend/claim.md` is a
worked example.

"""

SWEEPS_HEAD = """\
`readings.yaml` says what `make readings` runs under other readings. Each sweep judges the claims whose
cells it has; the sweep named `networks` also chooses the networks' default.

"""

REGISTRATION_HEAD = """\
`registration.yaml` says of every version of claims, sweeps, seeds and readings why it is what it is, and
which seeds no run had used when it was written. A test fails where the last entry is about another
version; it says the checksums.

"""


def reference() -> str:
    """The page."""
    described = schema()
    definitions = described["$defs"]
    sections = [HEAD, _section("Top level", described)]
    titles = {
        "Task": "A task, below `tasks.<name>`",
        "PendulumOptions": "The pendulum, below `pendulum` of a task",
        "TrackOptions": "The track of the cart, below `track` of a task",
        "StartOptions": "The starts, below `start` of a task",
        "TileOptions": "The tiles, below `tiles` of a task",
        "ShownArchitecture": "An architecture, below `architectures.<name>`",
        "Experiment": "An experiment, an item of `experiments`",
        "DeclaredFigure": "A figure of ready panels, an item of `figures`",
        "DeclaredPanel": "A panel, an item of `panels` of a figure",
        "Readings": "Readings, below `readings`",
    }
    sections += [_section(title, definitions[name]) for name, title in titles.items()]
    sections.append(OPTIONS_HEAD)
    sections += [_section(title, options) for title, options in sections_of_options()]
    claim = Claims.model_json_schema()["$defs"]
    sections.append(
        CLAIMS_HEAD + _section("A claim, below `<name>` in a file of claims", claim["Claim"])
    )
    sections.append(_section("A part of a claim, an item of `parts`", claim["Part"]))
    sweep = Sweep.model_json_schema()
    sections.append(SWEEPS_HEAD + _section("A sweep, below `<name>` in `readings.yaml`", sweep))
    report, one = Report.model_json_schema(), Round.model_json_schema()
    sections.append(_section("A report, below `reports.<name>` of a sweep", report))
    sections.append(_section("A round, an item of `rounds` of a sweep", one))
    entry, registered = Entry.model_json_schema(), Registered.model_json_schema()
    sections.append(
        REGISTRATION_HEAD + _section("An entry, an item of `entries` in `registration.yaml`", entry)
    )
    sections.append(_section("What is registered, below `registered` of an entry", registered))
    return "\n".join(sections)


def _section(title: str, described: dict[str, Any]) -> str:
    rows = "\n".join(_rows(described))
    return (
        f"## {title}\n\n| key | values | default | meaning |\n| --- | --- | --- | --- |\n{rows}\n"
    )


def _rows(described: dict[str, Any]) -> Iterator[str]:
    required = described.get("required", [])
    for name, field in described["properties"].items():
        default = "required" if name in required else _shown(field.get("default"))
        meaning = field.get("description", "").replace("|", "\\|")
        yield f"| `{name}` | {_values(field)} | {default} | {meaning} |"


def _values(field: dict[str, Any]) -> str:
    """The values a key may have, in words."""
    if "enum" in field:
        return ", ".join(f"`{value}`" for value in field["enum"])
    if "const" in field:
        return f"`{field['const']}`"
    if "anyOf" in field:
        return " or ".join(_values(option) for option in field["anyOf"])
    if "$ref" in field:
        return "see below"
    match field.get("type"):
        case "array":
            return f"list of {_values(field['items'])}"
        case "object":
            if "required" in field:
                keys = ", ".join(f"`{name}`" for name in field["required"])
                return f"mapping of {keys}"
            return "mapping, see below"
        case "integer" | "number" as number:
            return str(number) + _limits(field)
        case "boolean":
            return "`true`, `false`"
        case "null":
            return "nothing"
    return "text"


def _limits(field: dict[str, Any]) -> str:
    words = {
        "minimum": "from {}", "exclusiveMinimum": "above {}",
        "maximum": "to {}", "exclusiveMaximum": "below {}",
    }  # fmt: skip
    limits = [text.format(field[key]) for key, text in words.items() if key in field]
    return f" {' '.join(limits)}" if limits else ""


def _shown(default: Any) -> str:
    if default in (None, [], ()):
        return "none"
    if isinstance(default, dict):
        return "the thesis’s"
    return f"`{str(default).lower() if isinstance(default, bool) else default}`"
