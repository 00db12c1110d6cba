"""How a policy is tried out on a task: from which starts, for how long, and what of it is judged."""

import numpy as np

STARTS = {
    "balancing": np.radians(np.linspace(-20, 20, 9)),
    "full-control": np.linspace(-np.pi, np.pi, 16, endpoint=False),
}
"""The angles it starts from, at rest [rad]; another kind of task has those of full control."""

STEPS = {"balancing": 2_000, "full-control": 4_000}
"""How long each start is followed: 10 s and 20 s [steps]."""

JUDGED = 1_000
"""Length of the end that is judged in full control: 5 s [steps]."""
