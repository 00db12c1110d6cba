"""The documentation: it builds without a warning, fetches nothing, and says what there is."""

import importlib.util
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path

import pytest
import yaml

import upswing
from tests.paths import ROOT
from upswing.cli.main import main
from upswing.study.architecture import architecture_of
from upswing.study.config import validated
from upswing.study.readings import Readings, options_of

DOCS = ROOT / "docs"
PACKAGE = ROOT / "src/upswing"
PAGES = sorted(DOCS.rglob("*.md"))
TEXTS = [
    *PAGES,
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")),
    *(ROOT / folder / "README.md" for folder in ("config", "results", "workflow")),
]
NAMES = [str(path.relative_to(ROOT)) for path in TEXTS]
LINK = re.compile(r"\]\(([^()\s]+)\)")
CODE = re.compile(r"`([^`\n]+)`")
INCLUDED = re.compile(r'^--8<-- "(.+)"$', re.MULTILINE)
FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def text_of(path: Path) -> str:
    """A page with what it includes."""
    return INCLUDED.sub(lambda at: (ROOT / at[1]).read_text("utf-8"), path.read_text("utf-8"))


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The documentation, built where no network can be reached."""
    if importlib.util.find_spec("mkdocs") is None:
        pytest.skip("no mkdocs: install the extra `docs`")
    folder = tmp_path_factory.mktemp("site")
    nowhere = dict.fromkeys(("http_proxy", "https_proxy", "all_proxy"), "http://127.0.0.1:9")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT, env={**os.environ, **nowhere, "NO_MKDOCS_2_WARNING": "1"},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def test_every_page_is_built_and_has_text(site):
    for page in PAGES:
        built = site / page.relative_to(DOCS).with_suffix(".html")
        assert len(built.read_text("utf-8")) > 5_000, page
    assert "epsilon_greedy" in (site / "reference/agents.html").read_text("utf-8")
    assert "Columns of runs.parquet" in (site / "results.html").read_text("utf-8")


class Resources(HTMLParser):
    """What a page fetches by itself: links that a reader follows are none."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag, attrs):
        given = {name: value or "" for name, value in attrs}
        self.found += [given[name] for name in ("src", "srcset", "data", "poster") if name in given]
        if tag == "link" and given.get("rel") not in ("next", "prev", "canonical"):
            self.found.append(given.get("href", ""))


def is_foreign(address: str) -> bool:
    return bool(re.match(r"\s*(https?:)?//", address))


def test_no_page_fetches_anything_from_elsewhere(site):
    fetched = 0
    for page in site.rglob("*.html"):
        resources = Resources()
        resources.feed(page.read_text("utf-8"))
        fetched += len(resources.found)
        assert [one for one in resources.found if is_foreign(one)] == [], page
    assert fetched > 100
    for style in site.rglob("*.css"):
        addresses = re.findall(r"(?:url\(|@import)\s*[\"']?([^\"')\s]+)", style.read_text("utf-8"))
        assert [one for one in addresses if is_foreign(one)] == [], style
    assert is_foreign("https://a/b.js")
    assert is_foreign("//a/b.js")


def test_pages_open_as_files_and_are_searched_there(browser, site):
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    asked, said = [], []
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto((site / "algorithms/index.html").as_uri())
    page.keyboard.press("/")
    page.keyboard.type("viability")
    page.wait_for_selector(".md-search-result__link[href*=optimal]", state="attached")
    page.close()
    assert [url for url in asked if not url.startswith(("file:", "data:"))] == []
    assert said == []


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text("utf-8").splitlines()) <= 80


def anchors(path: Path) -> set[str]:
    """The anchors of a page's headings, as GitHub makes them."""
    bare = FENCED.sub("", text_of(path))
    headings = re.findall(r"^#+ (.+)$", bare, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("path", TEXTS, ids=NAMES)
def test_every_relative_link_leads_somewhere(path):
    for target in LINK.findall(path.read_text("utf-8")):
        if re.match(r"[a-z]+:", target):
            continue
        place, _, anchor = target.partition("#")
        there = path.parent / place if place else path
        assert there.exists(), target
        assert not anchor or anchor in anchors(there), target


def commands(path: Path) -> Iterator[str]:
    """What a page tells a reader to type: lines of its blocks of code, and code in its text."""
    text = text_of(path)
    blocks = [body for _, body in FENCED.findall(text)]
    bare = FENCED.sub("", text)
    lines = [line for block in blocks for line in block.splitlines()]
    lines += re.findall(r"^ {4}(\S.*)$", bare, re.MULTILINE)
    for line in [*lines, *CODE.findall(bare)]:
        yield line.partition("#")[0].strip()


def test_every_make_target_that_is_named_exists():
    makefile = (ROOT / "Makefile").read_text("utf-8")
    targets = set(re.findall(r"^([a-z-]+):.*## ", makefile, re.MULTILINE))
    named = {
        word
        for path in TEXTS
        for command in commands(path)
        if command.startswith("make ")
        for word in command.split()[1:]
        if re.fullmatch("[a-z-]+", word)
    }
    assert {"reproduce", "docs", "smoke", "beyond"} <= named
    assert named <= targets


def test_every_subcommand_that_is_named_exists():
    named = {
        found[1]
        for path in TEXTS
        for command in commands(path)
        if (found := re.match(r"(?:\.venv/bin/)?upswing ([a-z-]+)", command))
    }
    assert {"browse", "compare", "verdicts"} <= named
    for subcommand in sorted(named):
        assert main([subcommand, "--help"]) == 0, subcommand
    assert main(["nothing", "--help"]) != 0


def is_there(name: str) -> bool:
    above = (ROOT, ROOT / "config", PACKAGE, PACKAGE / "agents")
    found = any((folder / name).exists() for folder in above)
    return found or ("/" not in name and any(PACKAGE.rglob(name)))


@pytest.mark.parametrize("path", PAGES, ids=NAMES[: len(PAGES)])
def test_every_source_file_that_is_named_exists(path):
    for name in CODE.findall(FENCED.sub("", path.read_text("utf-8"))):
        if re.fullmatch(
            r"[\w/.-]+\.(py|yaml|toml|csv)|(src|config|tests|agents|physics)/[\w/.-]*", name
        ):
            assert is_there(name), name


@pytest.mark.parametrize(
    "path", sorted((DOCS / "algorithms").glob("*.md")), ids=lambda path: path.stem
)
def test_what_a_listing_names_stands_in_the_file_beside_it(path):
    text, checked = path.read_text("utf-8"), 0
    for row in re.findall(r"^\|(.+)\|$", text, re.MULTILINE):
        *cells, last = row.split(" | ")
        files = [name for name in CODE.findall(last) if name.endswith(".py")]
        if not files:
            continue
        found = [path for name in files for path in PACKAGE.rglob(Path(name).name)]
        source = "\n".join(one.read_text("utf-8") for one in found)
        for name in CODE.findall(" ".join(cells)):
            if word := re.fullmatch(r"(\w+)(\(.*\))?", name):
                checked += 1
                assert re.search(rf"\b{word[1]}\b", source), f"{name} is not in {files}"
    assert checked or path.stem in ("encoders", "bound")


def blocks_of_configuration() -> Iterator[tuple[str, dict]]:
    for path in PAGES:
        for language, body in FENCED.findall(path.read_text("utf-8")):
            if language == "yaml":
                yield f"{path.stem}: {body.splitlines()[0]}", yaml.safe_load(body)


@pytest.mark.parametrize(("where", "block"), list(blocks_of_configuration()))
def test_what_a_page_shows_of_a_configuration_is_valid(where, block):
    base = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))
    own = block.get("architectures", {})
    controls = [name for name, keys in own.items() if not architecture_of(**keys).learns]
    learners = [name for name in own if name not in controls]
    cells = [
        {"tasks": ["full-control"], "architectures": learners, "alphas": [0.1]},
        {"tasks": ["full-control"], "architectures": controls},
    ]
    experiments = block.get("experiments", [one for one in cells if one["architectures"]])
    shown = {**base, "architectures": {**base["architectures"], **own}, "experiments": experiments}
    assert validated({where: shown}).experiments


def layers() -> list[str]:
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["tool"]["importlinter"]
    return [name for layer in contracts["contracts"][0]["layers"] for name in layer.split(" | ")]


def test_the_packages_stand_in_the_order_of_the_contract():
    page = (DOCS / "architecture.md").read_text("utf-8")
    assert re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE) == layers()
    picture = (DOCS / "pictures/layers.svg").read_text("utf-8")
    assert re.findall(r'class="name"[^>]*>(\w+)<', picture) == layers()
    assert {path.stem for path in (DOCS / "reference").glob("*.md")} == {*layers(), "index"}


def test_the_readings_are_those_of_the_code():
    page = (DOCS / "thesis.md").read_text("utf-8")
    rows = re.findall(r"^\| (R\d+) `(\w+)` \| (.+?) \|", page, re.MULTILINE)
    assert len(rows) == len(Readings.model_fields) == 15
    for (number, key, options), (name, field) in zip(
        rows, Readings.model_fields.items(), strict=True
    ):
        assert (number, key) == (field.json_schema_extra["reading"], name)
        assert {f"{one:g}" if isinstance(one, float) else str(one) for one in options_of(name)} == set(CODE.findall(options))  # fmt: skip
        (default,) = re.findall(r"\*\*`(.+?)`\*\*", options)
        assert default == str(field.default)


def test_every_picture_is_shown():
    shown = {target for path in TEXTS for target in LINK.findall(path.read_text("utf-8"))}
    pictures = {f"pictures/{path.name}" for path in (DOCS / "pictures").iterdir()}
    assert pictures <= shown


def test_the_version_is_the_same_everywhere():
    (released, date), *_ = re.findall(
        r"^## (\d+\.\d+\.\d+) – (\d{4}-\d\d-\d\d)$",
        (ROOT / "CHANGELOG.md").read_text("utf-8"),
        re.MULTILINE,
    )
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert released == upswing.__version__ == citation["version"]
    assert str(citation["date-released"]) == date
