"""The report in a real browser: from a plain file, on a phone, printed, with a keyboard and a reader."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pandas as pd
import pytest

from upswing.recordings.content_policy import source_of
from upswing.report import words
from upswing.report.cost import costs
from upswing.report.page import write_report
from upswing.report.scale import strip
from upswing.study.paths import CELLS, PAGE, RUNS, VERDICTS


@pytest.fixture(scope="module")
def address(small_page):
    """The page of a small study, with everything beside it that it links."""
    return small_page


@pytest.fixture
def opened(browser, address):
    """The page on a laptop's screen, and what it asked for or complained of."""
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.requests, page.said = [], []
    page.on("request", lambda request: page.requests.append(request.url))
    page.on("console", lambda message: page.said.append(message.text))
    page.on("pageerror", lambda error: page.said.append(str(error)))
    page.goto(address)
    yield page
    page.close()


def test_it_needs_nothing_else_and_complains_of_nothing(opened, address):
    opened.wait_for_load_state("networkidle")
    assert [request for request in opened.requests if not request.startswith("data:")] == [address]
    assert opened.said == []


def test_its_policy_names_its_own_script_and_style_by_hash(opened, results):
    text = (results.folder / PAGE).read_text("utf-8")
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', text)[1]
    allowed = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    for element in ("script", "style"):
        (own,) = re.findall(rf"<{element}>(.*?)</{element}>", text, re.DOTALL)
        assert allowed[f"{element}-src"] == source_of(own)
    assert "unsafe" not in policy
    # Nothing that the hashes do not cover: it would be without effect.
    assert not re.search(r'<[^>]*\s(style|on\w+)="', text)
    # What came in with data would not run, escaped or not.
    opened.evaluate(
        """() => {
          const script = document.createElement("script");
          script.textContent = "document.title = 'foreign'";
          document.body.append(script);
          document.body.insertAdjacentHTML("beforeend", "<img src=x onerror='document.title = 1'>");
        }"""
    )
    opened.wait_for_timeout(300)
    assert opened.title().startswith("upswing")
    assert len(opened.said) >= 2


def test_the_filters_send_nothing_anywhere(opened, address):
    opened.fill("#runs-words", "seed-1")
    opened.press("#runs-words", "Enter")
    opened.wait_for_timeout(300)
    assert opened.url == address
    assert opened.said == []


def test_no_link_is_broken_and_no_picture_missing(opened, results):
    broken = opened.evaluate(
        "[...document.images].filter((i) => !(i.complete && i.naturalWidth)).map((i) => i.alt)"
    )
    assert broken == []
    targets = opened.evaluate("[...document.links].map((a) => a.getAttribute('href'))")
    assert len(targets) > 40
    kept = {path.stem for path in (results.folder / "report/viewer/recordings").iterdir()}
    runs = set(map(words.recording, results.runs["run"]))
    for target in targets:
        if target.startswith("#"):
            assert opened.locator(f"[id='{target[1:]}']").count() == 1, target
        else:
            place, _, name = target.partition("#")
            assert (results.folder / "report" / place).is_file(), target
            assert place.endswith(".csv") or name in kept | runs, target
    shown = opened.evaluate(
        "[...document.querySelectorAll('main a, header a')].filter((a) => !a.closest('#runs-table'))"
        ".map((a) => a.getAttribute('href')).filter((h) => h.startsWith('viewer'))"
    )
    assert {target.partition("#")[2] for target in shown} <= kept


def shown_runs(page):
    return page.locator("#runs-table tbody tr:not([hidden])")


def test_runs_are_sorted_and_filtered_without_a_server(opened, results):
    assert shown_runs(opened).count() == len(results.runs)
    head = opened.get_by_role("button", name="falls", exact=True)
    for order, ascending in (("ascending", True), ("descending", False)):
        head.click()
        assert opened.locator(f"th[aria-sort={order}]").count() == 1
        texts = shown_runs(opened).locator("td:nth-child(5)").all_inner_texts()
        falls = [int(text.replace(",", "")) for text in texts]
        assert falls == sorted(falls, reverse=not ascending)
        assert len(set(falls)) > 3
    opened.select_option("#runs-filters [name=task]", "balancing")
    opened.select_option("#runs-filters [name=alpha]", "0.1")
    assert shown_runs(opened).count() == 3
    assert opened.inner_text("#runs-said") == f"3 of {len(results.runs)} runs"
    opened.fill("#runs-words", "SEED-1")
    assert shown_runs(opened).count() == 1
    opened.fill("#runs-words", "no such run")
    assert shown_runs(opened).count() == 0


def test_a_verdict_opens_by_keyboard_and_shows_all_its_parts(opened, results):
    claim = opened.locator("#C3")
    assert claim.locator("tbody tr").first.is_hidden()
    claim.locator("summary").focus()
    opened.keyboard.press("Enter")
    assert claim.locator("tbody tr").first.is_visible()
    verdicts = pd.read_parquet(results.folder / VERDICTS).set_index("claim")
    assert claim.locator("tbody tr").count() == verdicts.at["C3", "parts"]


def test_every_claim_states_verdict_interval_and_number_of_runs(opened, results):
    for row in pd.read_parquet(results.folder / VERDICTS).to_dict("records"):
        text = opened.locator(f"#{row['claim']} summary").inner_text()
        assert row["statement"] in text
        assert words.verdict({**row, "own": False}) in text
        assert words.interval(row) in text
        assert re.search(rf"\b{row['n']} (runs|problems)", text)


@pytest.mark.parametrize("width", [320, 390])
def test_a_phone_has_no_sideways_scroll(browser, address, width):
    page = browser.new_page(viewport={"width": width, "height": 800})
    page.goto(address)
    page.evaluate("for (const one of document.querySelectorAll('details')) one.open = true")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.close()


@pytest.fixture(scope="session")
def axe(tmp_path_factory):
    """The source of axe-core, from npm."""
    if not shutil.which("npm"):
        pytest.skip("no npm to fetch axe-core with")
    folder = tmp_path_factory.mktemp("npm")
    command = [
        "npm",
        "install",
        "--silent",
        "--no-audit",
        "--no-fund",
        "--prefix",
        str(folder),
        "axe-core@4",
    ]
    if subprocess.run(command, check=False, capture_output=True, timeout=120).returncode:
        pytest.skip("npm could not fetch axe-core")
    return (folder / "node_modules/axe-core/axe.min.js").read_text("utf-8")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_is_accessible(browser, address, axe, scheme):
    # The page forbids scripts that are not its own; axe is one.
    context = browser.new_context(color_scheme=scheme, bypass_csp=True)
    page = context.new_page()
    page.goto(address)
    page.evaluate("document.getElementById('C3').open = true")
    page.locator("#overview .picture").focus()
    page.keyboard.press("ArrowUp")  # the card of a run is there too
    page.locator(".measure select").select_option(index=1)
    page.evaluate(axe)
    found = page.evaluate("axe.run()")
    problems = [
        f"{one['id']}: {one['help']}: {[node['html'][:120] for node in one['nodes'][:3]]}"
        for one in found["violations"]
    ]
    assert problems == []
    assert len(found["passes"]) > 20
    context.close()


def test_print_shows_figures_whole(opened):
    opened.emulate_media(media="print")
    tallest = opened.evaluate(
        "Math.max(...[...document.querySelectorAll('figure img, .picture svg')]"
        ".map((i) => i.getBoundingClientRect().height))"
    )
    assert 0 < tallest < 25 / 2.54 * 96  # a sheet's height, in CSS pixels
    for style in opened.evaluate(
        "[...document.querySelectorAll('.picture, .task, .moving')].map((f) => getComputedStyle(f).breakInside)"
    ):
        assert style == "avoid"
    assert opened.locator("#runs-table").is_hidden()
    assert opened.pdf()[:5] == b"%PDF-"


EVIL = "<script>alert(1)</script>&\"'"


def test_strings_of_the_tables_are_escaped(browser, results, tmp_path):
    folder = tmp_path / "results"
    shutil.copytree(results.folder / "tables", folder / "tables")
    shutil.copy(results.folder / "study.json", folder)
    for table, column in ((RUNS, "spec"), (CELLS, "architecture"), (VERDICTS, "statement")):
        frame = pd.read_parquet(folder / table)
        frame[column] = EVIL
        frame.to_parquet(folder / table)
    write_report(folder, Path("report"))
    text = (folder / PAGE).read_text("utf-8")
    assert EVIL not in text
    page = browser.new_page()
    opened_boxes = []
    page.on("dialog", lambda box: opened_boxes.append(box))
    page.goto((folder / PAGE).as_uri())
    assert EVIL in page.inner_text("#C3 summary")
    assert opened_boxes == []
    page.close()


def test_what_each_rule_took_is_summed_up(tmp_path):
    for name, seconds, memory in (
        ("train/a", 2.0, 100.0),
        ("train/b", 3.0, 300.0),
        ("report", 1.0, 50.0),
    ):
        path = tmp_path / "benchmarks" / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"s\tmax_rss\tcpu_time\n{seconds}\t{memory}\t-\n", "utf-8")
    (tmp_path / "benchmarks/empty.tsv").write_text("", "utf-8")
    rows = {row["rule"]: row for row in costs(tmp_path)}
    assert set(rows) == {"train", "report"}
    assert rows["train"]["jobs"] == 2
    assert rows["train"]["seconds"] == 5
    assert rows["train"]["memory"] == 300
    assert costs(tmp_path / "nothing") == []


@pytest.mark.parametrize("lower", [True, False])
def test_a_strip_keeps_the_order_of_its_numbers(lower):
    row = {"method": "ratio", "estimate": 1.2, "low": 0.5, "high": 3.0, "holds_from": 2.0, "partly_from": 1.0, "at_least": lower}  # fmt: skip
    placed = strip(row)
    assert 0 < placed.low < placed.partly < placed.estimate < placed.threshold < placed.high < 100
    assert (placed.holds_from, placed.holds_to) == (
        (placed.threshold, 100) if lower else (0, placed.threshold)
    )
    assert strip({**row, "low": float("nan")}) is None


def test_the_page_has_no_number_of_a_run_typed_by_hand():
    # Whatever stands in the templates as a number must be no measured one: percentages and shares.
    for path in sorted(Path("report/parts").glob("*.j2")):
        text = re.sub(r"{[%{#].*?[%}#]}|<[^>]*>|&#?\w+;", " ", path.read_text("utf-8"), flags=re.S)
        found = set(re.findall(r"\d[\d,.]*\d|\d", text))
        allowed = {"95", "90", "20", "5", "10", "1", "2", "3", "4", "11", "13", "17", "21", "22", "23",
                   "24", "25", "5,000", "8", "12", "16", "7", "9", "0", "4.1", "4.2.1", "4.6.3", "2.4.1", "2.4.2", "2.4.3", "2.4.4", "15",
                   "30", "100,000", "0.95", "0.05", "40", "324"}  # fmt: skip
        assert found <= allowed, (path, found - allowed)


def test_words_for_what_is_unknown():
    assert words.number(None) == words.number(float("nan")) == words.percent(None) == "–"
    assert words.number(-1234.5, 1) == "−1,234.5"
    assert words.alpha(0.001) == "0.001"
    assert json.dumps(words.recording("runs/a/b/alpha-0.5/seed-1.rrd")) == '"a_b_alpha-0-5_seed-1"'
