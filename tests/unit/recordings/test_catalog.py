"""The catalog of recordings in a browser."""

import re

import pytest

from tests.unit.recordings.pages import LONG, opened, shows_something
from tests.unit.recordings.test_browsing import browsing

RUN = "full-control/modular-networks-5/alpha-1/seed-0"


@pytest.mark.parametrize("what", ["run", "table"])
def test_the_web_viewer_shows_a_run_and_the_catalogs_table(browser, results, tmp_path, what):
    words = [RUN] if what == "run" else ["task=balancing"]
    process, _ = browsing(results, *words)
    try:
        lines = iter(process.stdout.readline, b"")  # a line before may say that a port is in use
        address = next(
            found.group(1)
            for line in lines
            if (found := re.search(r"runs? at (http://\S+)", line.decode()))
        )
        page, requests = opened(browser, address)
        page.wait_for_selector("canvas.visible", timeout=LONG)
        assert shows_something(page, tmp_path)
        # The rows come from the catalog, not from the server of the page.
        assert any("SegmentTable" in request or "rerun.cloud" in request for request in requests)
        page.close()
    finally:
        process.terminate()
        process.wait(20)
