"""Pages opened in a browser, and scripts unpacked as a page does it."""

import base64
import gzip
import re

from PIL import Image

LONG = 90_000
"""A browser that draws in software has so long to show a recording [ms]."""


def unpacked(script):
    name, packed, layout = re.fullmatch(
        r'arrived\("([\w-]+)","([\w+/=]+)","([\w-]*)"\)\n', script
    ).groups()
    return name, gzip.decompress(base64.b64decode(packed)), layout


def opened(browser, address):
    page = browser.new_page(viewport={"width": 1280, "height": 720})
    requests = []
    page.on("request", lambda request: requests.append(request.url))
    page.goto(address)
    return page, requests


def shades(page, tmp_path):
    """How many colours the page shows; a blank page shows few."""
    picture = tmp_path / "page.png"
    page.screenshot(path=picture, timeout=LONG)
    with Image.open(picture) as image:
        return len(image.convert("RGB").getcolors(1 << 20))


def shows_something(page, tmp_path):
    for _ in range(30):
        page.wait_for_timeout(500)
        if (count := shades(page, tmp_path)) > 200:
            return count
    return 0
