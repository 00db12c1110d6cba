"""The ids of runs and what is derived from them."""


def recording_id(run: str) -> str:
    """The id of a run's recording; the viewer takes letters, digits, ``_`` and ``-`` only."""
    return run.replace("/", "_").replace(".", "-")
