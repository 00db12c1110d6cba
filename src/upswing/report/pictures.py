"""Pictures within the page."""

import base64


def data_of(svg: bytes) -> str:
    """An SVG as an address that holds all of it."""
    return f"data:image/svg+xml;base64,{base64.b64encode(svg).decode()}"
