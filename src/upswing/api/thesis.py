"""The names of the thesis's study, for training without a folder of results.

They are those of ``config/config.yaml``, which an installed package does not have; a test holds the two
against each other.
"""

from typing import Any

TASKS: dict[str, dict[str, Any]] = {
    "balancing": {"kind": "balancing", "steps": 50_000},
    "full-control": {"kind": "full-control", "steps": 1_000_000},
    "full-control-long": {"kind": "full-control", "steps": 5_000_000},
}

ARCHITECTURES: dict[str, dict[str, Any]] = {
    "table": {"learner": "table"},
    "networks-5": {"learner": "networks", "hidden": [5]},
    "networks-20-5": {"learner": "networks", "hidden": [20, 5]},
    "networks-30": {"learner": "networks", "hidden": [30]},
    "modular-table": {"learner": "table", "modular": True},
    "modular-networks-5": {"learner": "networks", "hidden": [5], "modular": True},
    "idle": {"learner": "control", "behaviour": "idle"},
    "random": {"learner": "control", "behaviour": "random"},
    "push": {"learner": "control", "behaviour": "push"},
}

THESIS: dict[str, Any] = {"tasks": TASKS, "architectures": ARCHITECTURES}
"""What a run is made of where nothing else is said; ε, γ and readings are the defaults of a study."""
