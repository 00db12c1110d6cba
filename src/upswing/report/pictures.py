"""Pictures within the page."""

import base64
from pathlib import Path


def picture(path: Path) -> str:
    """A picture as an address that holds all of it."""
    return f"data:image/svg+xml;base64,{base64.b64encode(path.read_bytes()).decode()}"
