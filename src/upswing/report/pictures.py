"""Pictures within the page."""

import base64
from pathlib import Path


def picture(path: Path) -> str:
    """A picture as an address that holds all of it."""
    return data_of(path.read_bytes())


def data_of(svg: bytes) -> str:
    """An SVG as an address that holds all of it."""
    return f"data:image/svg+xml;base64,{base64.b64encode(svg).decode()}"
