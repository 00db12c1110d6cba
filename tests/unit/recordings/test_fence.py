"""The page of what is watched: a browser that shows it asks this machine and nobody else."""

import http.client
import signal
from contextlib import closing
from urllib.parse import urlsplit

from tests.unit.recordings.pages import LONG, opened, shows_something
from tests.unit.recordings.test_watch import RUNS, watching
from upswing.recordings.looking import page
from upswing.recordings.ports import free_port


def test_the_page_shows_the_run_and_listens_on_loopback_alone(browser, results, tmp_path):
    with watching(results, RUNS[0], "--speed", "fast") as (process, children, address):
        listening = [
            connection.laddr.ip
            for child in children
            for connection in child.net_connections()
            if connection.status == "LISTEN"
        ]
        assert set(listening) == {"127.0.0.1"}
        shown, requests = opened(browser, address)
        shown.wait_for_selector("canvas.visible", timeout=LONG)
        assert shows_something(shown, tmp_path)
        asked = {urlsplit(request).hostname for request in requests} - {None}  # data: and blob:
        assert asked == {"127.0.0.1"}
        shown.close()
        process.send_signal(signal.SIGINT)
        assert process.wait(60) == 0


def test_the_page_is_handed_out_under_a_policy_and_by_a_name_of_this_machine_only():
    web = free_port()

    def answered(host):
        connection = http.client.HTTPConnection("127.0.0.1", web, timeout=20)
        with closing(connection):
            connection.request("GET", "/", headers={"Host": host})
            answer = connection.getresponse()
            return answer.status, answer.getheader("Content-Security-Policy"), answer.read()

    with page(free_port(), web):
        assert answered("elsewhere.example")[0] == 403
        status, policy, content = answered(f"localhost:{web}")
    assert status == 200
    assert "default-src 'none'" in policy
    assert b"the_canvas_id" in content
    assert b"googleapis" not in content


def test_who_looks_is_asked_for_where_it_is_seen():
    with page(free_port(), free_port()) as looking:
        assert looking.looks
    assert not looking.looks
