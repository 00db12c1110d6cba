"""The study that a results folder is of: its validated configuration, kept beside its results.

So every later step asks the folder alone what should be in it.
"""

import json
from pathlib import Path

from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import seal
from upswing.study.config import Study, validated
from upswing.study.errors import BadInput
from upswing.study.paths import STUDY


def canonical(study: Study) -> str:
    """The study as one line of JSON: the same text for the same meaning."""
    return json.dumps(study.model_dump(mode="json"), sort_keys=True, separators=(",", ":"))


def write_study(text: str, results: Path) -> None:
    """Keep the study written in ``text`` (JSON) as that of the folder ``results``."""
    study = parse_study(text, "study")
    with written(results / STUDY) as beside:
        beside.write_text(json.dumps(study.model_dump(mode="json"), indent=1) + "\n", "utf-8")
    seal(results, "study", [results / STUDY])


def read_study(results: Path) -> Study:
    """The study that the folder ``results`` is of."""
    path = results / STUDY
    try:
        text = path.read_text("utf-8")
    except OSError:
        raise BadInput([f"{path}: missing; `make reproduce` makes a folder of results"]) from None
    except UnicodeDecodeError:
        raise BadInput(
            [f"{path}: is not text in UTF-8; delete it and run the study again"]
        ) from None
    return parse_study(text, str(path))


def parse_study(text: str, source: str) -> Study:
    """The study written in JSON; ``BadInput`` with all its problems otherwise, naming ``source``."""
    try:
        content = json.loads(text)
    except (json.JSONDecodeError, RecursionError) as error:
        raise BadInput([f"{source}: is not JSON: {error}"]) from None
    if not isinstance(content, dict):
        raise BadInput([f"{source}: must be a JSON object"])
    return validated({source: content})
