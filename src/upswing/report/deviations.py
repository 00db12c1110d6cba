"""Where a study does something that the thesis does not say: ``deviations.yaml``."""

from pathlib import Path

from upswing.study.yaml_file import read_yaml

FILE = "deviations.yaml"

OF_THE_STUDY = "of_the_study"
"""The key of a deviation that is one of the thesis's own study alone."""


def deviations(templates: Path, own: bool = False) -> list[str]:
    """All deviations, each a sentence or a few.

    Args:
        templates: the folder of the file.
        own: whether they are shown of a study of one's own, which has not those of the thesis's.
    """
    every = read_yaml(templates / FILE)["deviations"]
    return [
        one if isinstance(one, str) else one[OF_THE_STUDY]
        for one in every
        if isinstance(one, str) or not own
    ]
