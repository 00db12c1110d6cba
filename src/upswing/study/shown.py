"""How an architecture is shown: keys that change nothing but pictures and words.

They are apart from what a run is specified by (``architecture``): whoever gives an architecture another
colour trains nothing anew.
"""

from typing import Annotated

from pydantic import AfterValidator, Field, SerializeAsAny

from upswing.study.architecture import ARCHITECTURES, Architecture
from upswing.study.contrast import OF_LINES, channels, contrast, darkened
from upswing.study.names import Text


def _visible(shade: str) -> str:
    try:
        known = len(channels(shade)) == len(shade.removeprefix("#")) // 2 and len(shade) == 7
    except ValueError:
        known = False
    if not known or shade[0] != "#":
        raise ValueError('write a colour as "#0072B2", in quotes')
    if contrast(shade) < OF_LINES:
        right = f'too pale to be seen on white; "{darkened(shade, OF_LINES)}" is dark enough'
        raise ValueError(f"{right} (contrast {OF_LINES:g}:1)")
    return shade.upper()


Colour = Annotated[str, AfterValidator(_visible)]


class ShownArchitecture(Architecture):
    """An architecture of a study, and how it is shown."""

    colour: Colour | None = Field(
        default=None,
        description='Its colour in figures and recordings, as `"#0072B2"`, with a contrast of 3:1 to '
        "white or more; without it, one of its own. Text has a darker shade where it needs one.",
    )
    label: Text | None = Field(
        default=None,
        min_length=1,
        max_length=40,
        description="What it is called in figures and recordings, in place of its name.",
    )


HOW_SHOWN = tuple(
    key for key in ShownArchitecture.model_fields if key not in Architecture.model_fields
)
"""The keys that no run depends on."""

AnyShownArchitecture = Annotated[
    SerializeAsAny[ShownArchitecture], ARCHITECTURES.chooser(ShownArchitecture)
]
