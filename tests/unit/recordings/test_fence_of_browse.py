"""The page of the catalog: behind the same fence, it lists and shows runs, and asks nobody else."""

import signal
from urllib.parse import unquote, urlsplit

import pytest

from tests.unit.recordings.pages import LONG, opened, shows_something
from tests.unit.recordings.test_browsing import browsing


@pytest.mark.parametrize("words", [["balancing"], ["balancing/table/alpha-0.1/seed-1"]])
def test_the_page_shows_the_catalog_and_asks_this_machine_alone(browser, results, tmp_path, words):
    process, children = browsing(results, *words)
    try:
        said = ""
        while " runs at http" not in said:
            line = process.stdout.readline().decode()
            assert line, said
            said = line
        address = said.split()[-1]
        listening = {
            connection.laddr.ip
            for child in children
            for connection in child.net_connections()
            if connection.status == "LISTEN"
        }
        assert listening == {"127.0.0.1"}
        answers = []
        page, requests = opened(browser, "about:blank")
        page.on("response", lambda answer: answers.append((answer.url, answer.status)))
        answer = page.goto(address)
        assert "default-src 'none'" in answer.headers["content-security-policy"]
        page.wait_for_selector("canvas.visible", timeout=LONG)
        assert shows_something(page, tmp_path)
        # The catalog was asked, across to its port, and answered.
        port = urlsplit(unquote(address.partition("url=")[2])).port
        assert 200 in {code for place, code in answers if urlsplit(place).port == port}
        asked = {urlsplit(request).hostname for request in requests} - {None}  # data: and blob:
        assert asked == {"127.0.0.1"}
        page.close()
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 0
    finally:
        process.kill()
        process.wait(20)
