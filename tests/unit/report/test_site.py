"""The folder for static hosts: whole, with links of its own only, and opened from a plain server."""

import shutil
import subprocess
import sys
from contextlib import contextmanager
from urllib.parse import urljoin, urlsplit

import pytest

from tests.paths import ROOT
from tests.unit.recordings.pages import LONG, shows_something
from upswing.cli.main import main
from upswing.recordings.ports import free_port, listens
from upswing.recordings.processes import running
from upswing.report import site as module
from upswing.report.site import write_site
from upswing.study.errors import BadInput
from upswing.study.paths import VIEWER


@pytest.fixture(scope="module")
def site(whole, tmp_path_factory):
    """The site of a small study."""
    folder = tmp_path_factory.mktemp("site") / "site"
    write_site(whole.folder, ROOT / "report", folder)
    return folder


@contextmanager
def served(folder):
    """The folder, handed out by a server that knows nothing of us."""
    port = free_port()
    command = [
        sys.executable,
        "-m",
        "http.server",
        str(port),
        "--bind",
        "127.0.0.1",
        "--directory",
        str(folder),
    ]
    with running(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        while not listens(port):
            assert process.poll() is None
        yield f"http://127.0.0.1:{port}/"


def files(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def test_it_has_the_page_its_tables_and_the_viewer(whole, site):
    found = files(site)
    assert {
        "index.html",
        "runs.csv",
        "evidence.csv",
        ".nojekyll",
        "LICENSE",
        "CITATION.cff",
    } <= found
    own = whole.folder / VIEWER
    assert {f"viewer/{name}" for name in files(own)} == {
        name for name in found if name.startswith("viewer/")
    }
    text = (site / "index.html").read_text("utf-8")
    for place in (str(ROOT), str(whole.folder), "localhost", "127.0.0.1"):
        assert place not in text


def test_every_link_is_answered_by_a_plain_server_and_a_recording_opens(browser, site, tmp_path):
    with served(site) as address:
        page = browser.new_page(viewport={"width": 1280, "height": 720})
        answers = {}
        page.on("response", lambda response: answers.update({response.url: response.status}))
        page.goto(address)
        links = page.evaluate("[...document.links].map((a) => a.getAttribute('href'))")
        assert len(links) > 40
        outside = [link for link in links if urlsplit(link).scheme or link.startswith("/")]
        assert outside == []
        for link in set(links):
            place, _, name = link.partition("#")
            if not place:
                assert page.locator(f"[id='{name}']").count() == 1, link
                continue
            assert page.request.get(urljoin(address, place)).ok, link
            if "viewer" in place:
                script = urljoin(address, f"{place.removesuffix('index.html')}recordings/{name}.js")
                assert page.request.get(script).ok, link
        page.locator("figcaption a.kept").first.click()
        page.wait_for_selector("body[data-state=open]", timeout=LONG)
        assert shows_something(page, tmp_path)
        assert set(answers.values()) <= {200, 304}
        page.get_by_text("← the report").click()
        page.wait_for_selector("h1")
        assert urlsplit(page.url).path == "/index.html"
        page.close()


def test_what_only_our_server_hands_out_is_no_link(browser, site, whole):
    page = browser.new_page()
    page.goto((site / "index.html").as_uri())
    assert page.locator("a.lent").count() == 0
    rows = page.locator("#runs-table tbody tr")
    assert rows.count() == len(whole.runs)
    assert rows.locator("th a.kept").count() < len(whole.runs)
    assert "make browse" in page.inner_text("main")
    page.close()


def test_an_earlier_site_is_replaced_as_a_whole(whole, site, tmp_path):
    folder = tmp_path / "site"
    shutil.copytree(site, folder)
    (folder / "viewer/recordings/old.js").touch()
    write_site(whole.folder, ROOT / "report", folder)
    assert files(folder) == files(site)
    assert [path.name for path in tmp_path.iterdir()] == ["site"]


def test_a_failure_leaves_what_was_there(whole, site, tmp_path, monkeypatch):
    folder = tmp_path / "site"
    shutil.copytree(site, folder)
    before = files(folder)

    def fails(*_, **__):
        raise OSError("no space left")

    monkeypatch.setattr(module.shutil, "copytree", fails)
    with pytest.raises(OSError, match="no space left"):
        write_site(whole.folder, ROOT / "report", folder)
    assert files(folder) == before
    assert [path.name for path in tmp_path.iterdir()] == ["site"]


@pytest.mark.parametrize("name", ["notes.txt", "index.html"])
def test_a_folder_with_anything_else_is_left_alone(whole, tmp_path, capsys, name):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / name).write_text("mine", "utf-8")
    assert main(["site", str(tmp_path / "mine"), "--results", str(whole.folder)]) == 2
    assert "holds something else" in capsys.readouterr().err
    assert files(tmp_path) == {f"mine/{name}"}


def test_results_without_a_viewer_are_named(whole, tmp_path):
    bare = tmp_path / "results"
    shutil.copytree(whole.folder / "tables", bare / "tables")
    shutil.copy(whole.folder / "study.json", bare)
    with pytest.raises(BadInput, match=r"viewer/index\.html: missing; `make reproduce` makes it"):
        write_site(bare, ROOT / "report", tmp_path / "site")
    assert not (tmp_path / "site").exists()
