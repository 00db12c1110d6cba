"""How the page lies on screens: nothing is cut off, the contents stay, the first screen says what was found."""

from itertools import pairwise

import pytest

from upswing.study.claims import load_claims
from upswing.study.places import CLAIMS

WIDTHS = (320, 390, 1280, 1440)

TOO_WIDE = """(width) => [...document.querySelectorAll("body :not(#runs-table *, #runs-table, svg *)")].filter((one) => {
  const place = one.getBoundingClientRect();
  if (place.width === 0 || (place.right <= width + 1 && place.left >= -1)) return false;
  return getComputedStyle(one).clipPath === "none" && !one.closest(".skip, thead");
}).map((one) => one.outerHTML.slice(0, 100))"""
"""All but the table of runs, which has a frame of its own to scroll in, and what is hidden from sight."""

CONTRAST = """() => {
  const canvas = Object.assign(document.createElement("canvas"), { width: 1, height: 1 });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  const channels = (colour) => {
    context.clearRect(0, 0, 1, 1);
    context.fillStyle = colour;
    context.fillRect(0, 0, 1, 1);
    return [...context.getImageData(0, 0, 1, 1).data];
  };
  const light = (colour) => channels(colour).slice(0, 3).map((value) => value / 255)
    .map((value) => value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4)
    .reduce((sum, value, at) => sum + value * [0.2126, 0.7152, 0.0722][at], 0);
  const paper = (one) => {
    for (let at = one; at; at = at.parentElement) {
      const colour = getComputedStyle(at).backgroundColor;
      if (channels(colour)[3] === 255) return colour;
    }
    return "white";
  };
  const poor = [];
  for (const one of document.querySelectorAll("body :not(svg *, math *, #runs-table tr:nth-child(n + 9) *)")) {
    const own = [...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim());
    if (!own || one.matches("script") || !one.checkVisibility()) continue;
    const [a, b] = [light(getComputedStyle(one).color), light(paper(one))].sort((x, y) => y - x);
    if ((a + 0.05) / (b + 0.05) < 4.5) poor.push(one.outerHTML.slice(0, 100));
  }
  return poor;
}"""


@pytest.fixture
def opening(browser):
    """Opens a page in a window of a size."""
    contexts = []

    def opened(address, width, height=900, **options):
        contexts.append(browser.new_context(viewport={"width": width, "height": height}, **options))
        page = contexts[-1].new_page()
        page.goto(address)
        return page

    yield opened
    for context in contexts:
        context.close()


def open_all(page):
    page.evaluate("for (const one of document.querySelectorAll('main details')) one.open = true")


@pytest.mark.parametrize("width", WIDTHS)
def test_no_element_is_wider_than_the_screen(opening, any_page, width):
    page = opening(any_page, width)
    open_all(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.evaluate(TOO_WIDE, width) == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_all_text_can_be_read_in_either_scheme(opening, any_page, scheme):
    page = opening(any_page, 1280, color_scheme=scheme, reduced_motion="reduce")
    open_all(page)
    assert page.evaluate(CONTRAST) == []
    # The measure itself can fail.
    page.evaluate("document.querySelector('h1').style.color = 'var(--line)'")
    assert len(page.evaluate(CONTRAST)) == 1


def test_headings_leave_no_level_out(opening, any_page):
    page = opening(any_page, 1280)
    levels = page.evaluate(
        "[...document.querySelectorAll('h1, h2, h3, h4')].map((h) => +h.tagName[1])"
    )
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_beside_a_wide_page_the_contents_stay_and_mark_the_section(opening, small_page):
    page = opening(small_page, 1440)
    contents = page.locator("nav.contents")
    for section in ("verdicts", "matrix"):
        page.evaluate(
            "(id) => document.getElementById(id).scrollIntoView({ behavior: 'instant' })", section
        )
        page.wait_for_timeout(200)
        box = contents.bounding_box()
        assert 0 <= box["y"] < 50
        assert box["x"] + box["width"] < page.locator(f"#{section}").bounding_box()["x"]
        current = page.evaluate("document.querySelector('nav.contents a:target-current')?.hash")
        assert current == f"#{section}"
    linked = page.evaluate(
        "[...document.querySelectorAll('nav.contents a')].map((a) => a.hash.slice(1))"
    )
    heads = page.evaluate("[...document.querySelectorAll('h2')].map((one) => one.id)")
    assert set(heads) - {"history"} <= set(linked)


def test_on_a_phone_the_contents_are_a_bar_that_a_choice_closes(opening, small_page):
    page = opening(small_page, 390, 844, reduced_motion="reduce")
    page.evaluate("document.getElementById('system').scrollIntoView({ behavior: 'instant' })")
    bar = page.locator("nav.contents summary")
    assert bar.bounding_box()["y"] < 20
    link = page.get_by_role("link", name="The cells", exact=True)
    assert not link.is_visible()
    bar.click()
    assert link.is_visible()
    link.click()
    page.wait_for_timeout(200)
    assert not link.is_visible()
    below = page.locator("#matrix").bounding_box()["y"]
    assert bar.bounding_box()["height"] - 1 <= below < 150
    bar.click()
    page.keyboard.press("Escape")
    assert not link.is_visible()


@pytest.mark.parametrize(("width", "height", "screens"), [(1440, 900, 1), (390, 844, 2)])
def test_the_first_screen_says_what_was_found(opening, thesis_page, width, height, screens):
    page = opening(thesis_page, width, height)
    for selector in ("h1", ".moving img", "ol.findings", ".strip-of-verdicts"):
        box = page.locator(selector).bounding_box()
        assert box["y"] + box["height"] <= screens * height, selector
    picture = page.locator(".moving img").bounding_box()
    assert picture["y"] + picture["height"] <= height
    assert page.locator("ol.findings li").count() == 3
    for one in page.locator("ol.findings li").all():
        assert one.locator("a[href^='#C']").count() == 1
        assert one.locator(".certainty").inner_text()
    assert page.locator(".strip-of-verdicts a").count() == len(load_claims(CLAIMS))


def test_the_title_promises_what_the_tables_have(opening, thesis_page, small_page):
    title = opening(thesis_page, 1280).locator("h1").inner_text()
    assert "?" in title
    assert "Yes" in title
    assert "?" not in opening(small_page, 1280).locator("h1").inner_text()


def test_what_others_are_shown_of_a_link(opening, thesis_page):
    page = opening(thesis_page, 1280)
    content = page.evaluate(
        "Object.fromEntries([...document.querySelectorAll('meta[property], meta[name]')]"
        ".map((one) => [one.getAttribute('property') ?? one.name, one.content]))"
    )
    assert content["og:title"] == page.locator("h1").inner_text().replace("\n", " ")
    assert content["og:description"] == content["description"]
    assert page.locator("ol.findings .large").first.inner_text() in content["description"]
    assert not any("://" in value or "/home" in value for value in content.values())
    foot = page.locator("footer").inner_text()
    for said in ("MIT", "@software", content["date"]):
        assert said in foot


def test_recordings_that_need_a_server_look_different_and_a_legend_says_so(
    opening, whole, small_page
):
    page = opening(small_page, 1280)
    beside = {path.stem for path in (whole.folder / "report/viewer/recordings").iterdir()}

    def linked(kind):
        found = page.evaluate(
            f"[...document.querySelectorAll('a.{kind}')].map((a) => a.hash.slice(1))"
        )
        return {name for name in found if name}

    assert linked("kept") == beside
    assert linked("lent")
    assert not linked("lent") & beside
    everything = page.evaluate(
        "[...document.querySelectorAll('a[href*=\"viewer/\"]')].every((a) => a.matches('.kept, .lent'))"
    )
    assert everything
    looks = "(one) => [getComputedStyle(one).textDecorationStyle, getComputedStyle(one, '::before').content]"
    kept, lent = (page.locator(f"a.{kind}").first.evaluate(looks) for kind in ("kept", "lent"))
    assert kept[0] != lent[0]
    assert kept[1] != lent[1]
    assert page.locator("em.kept").count() == page.locator("em.lent").count() == 1
