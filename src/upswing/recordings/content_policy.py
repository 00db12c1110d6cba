"""What a page may load and run: nothing but what it brings itself, named by its hash."""

import base64
import hashlib
import re

INLINE = re.compile(r"<(script|style)>(.*?)</\1>", re.DOTALL)


def source_of(text: str) -> str:
    """The name of a script or style that stands in a page, for the page's Content-Security-Policy."""
    digest = hashlib.sha256(text.encode("utf-8")).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"


def with_hashes(page: str) -> str:
    """A page of ours in whose policy ``THE-SCRIPT`` and ``THE-STYLE`` become the hashes of the two.

    The page must hold no data: a script that came in with them would be allowed.
    """
    for element, text in INLINE.findall(page):
        page = page.replace(f"THE-{element.upper()}", source_of(text), 1)
    return page
