"""The page on paper: evidence open, nothing cut off, no heading alone, no page emptier than a third."""

from io import BytesIO

import numpy as np
import pytest

pdfium = pytest.importorskip("pypdfium2", reason="no pypdfium2 to look at printed pages with")

MARGIN = 15 / 25.4
"""Of a page, as the page's own style has it [inches]."""

A4 = 210 / 25.4
INK = 200
"""Darker than this is printed [of 255]."""

FULL = 1 / 3
"""Share of a page that is used at least."""


@pytest.fixture(scope="module", params=["small", "thesis"])
def printed(browser, request):
    """The page as PDF, of either study."""
    page = browser.new_page()
    page.goto(request.getfixturevalue(f"{request.param}_page"))
    document = pdfium.PdfDocument(BytesIO(page.pdf(format="A4", prefer_css_page_size=True)))
    page.close()
    yield document
    document.close()


def used(page):
    """How far down a page is printed, as a share of what is between its margins."""
    ink = np.asarray(page.render(scale=1).to_pil().convert("L")) < INK
    top, bottom = MARGIN * 72, page.get_height() - MARGIN * 72
    rows = np.flatnonzero(ink.any(axis=1))
    return (rows.max() - top) / (bottom - top) if len(rows) else 0.0


def text_of(page):
    return page.get_textpage().get_text_range()


def test_no_page_but_the_last_is_emptier_than_a_third(printed):
    shares = [used(page) for page in printed]
    assert len(shares) > 5
    assert min(shares[:-1]) > FULL, [round(share, 2) for share in shares]


def test_nothing_is_printed_in_the_margins(printed):
    for page in printed:
        ink = np.asarray(page.render(scale=1).to_pil().convert("L")) < INK
        columns = np.flatnonzero(ink.any(axis=0))
        assert columns.min() > MARGIN * 72 - 4
        assert columns.max() < page.get_width() - MARGIN * 72 + 4


def test_no_heading_stands_alone_at_the_foot_of_a_page(browser, printed, any_page):
    page = browser.new_page()
    page.goto(any_page)
    heads = set(
        page.evaluate("[...document.querySelectorAll('h2, h3')].map((h) => h.innerText.trim())")
    )
    page.close()
    for one in list(printed)[:-1]:
        assert text_of(one).strip().splitlines()[-1].strip() not in heads


def test_the_evidence_is_open_and_the_runs_are_left_out(printed):
    said = " ".join(" ".join(text_of(page) for page in printed).split())
    assert said.count("How sure") >= 16
    assert said.count("Reason:") >= 16
    assert "is not printed" in said
    assert "What was written down" in said
    assert "Seed-free" not in said
    assert said.count("seed-") < 200  # figures name a few runs; the table would name all, twice


def test_no_table_is_wider_than_paper(browser, any_page):
    width = round((A4 - 2 * MARGIN) * 96)
    page = browser.new_page(viewport={"width": width, "height": 1_000})
    page.emulate_media(media="print")
    page.goto(any_page)
    cut = page.evaluate(
        "(width) => [...document.querySelectorAll('table, figure, .picture, svg')].filter((one) =>"
        " one.getBoundingClientRect().right > width + 1).map((one) => one.outerHTML.slice(0, 90))",
        width,
    )
    page.close()
    assert cut == []
