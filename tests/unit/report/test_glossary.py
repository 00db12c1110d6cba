"""Every word is explained in one place, which each use leads to."""

import re

import pytest

from tests.paths import ROOT
from upswing.report.glossary import FILE, as_sections, glossary, in_a_paragraph
from upswing.study.errors import BadInput

WORDS = glossary(ROOT / "report")


def test_every_word_is_used_and_every_link_to_a_word_leads_to_one(browser, any_page):
    page = browser.new_page()
    page.goto(any_page)
    linked = page.evaluate(
        "[...document.querySelectorAll('a[href^=\"#word-\"]')].filter((a) => !a.closest('#words ~ dl.words'))"
        ".map((a) => a.getAttribute('href').slice(1))"
    )
    shown = page.evaluate("[...document.querySelectorAll('dl.words > div')].map((one) => one.id)")
    page.close()
    assert shown == [f"word-{key}" for key, word in WORDS.items() if not word.aside]
    assert set(linked) == set(shown)


def test_a_section_links_a_word_once(browser, any_page):
    page = browser.new_page()
    page.goto(any_page)
    twice = page.evaluate(
        """() => {
          const found = [];
          let section = "", seen = new Set();
          for (const one of document.querySelectorAll("main h2, main a.term")) {
            if (one.matches("h2")) { section = one.id; seen = new Set(); continue; }
            const to = one.getAttribute("href");
            if (seen.has(to)) found.push(section + to);
            seen.add(to);
          }
          return found;
        }"""
    )
    page.close()
    assert twice == []


def test_words_come_before_what_they_are_used_in(browser, any_page):
    page = browser.new_page()
    page.goto(any_page)
    heads = page.evaluate("[...document.querySelectorAll('main h2')].map((one) => one.id)")
    page.close()
    assert heads.index("words") < min(
        heads.index(name) for name in ("came-out", "verdicts", "matrix")
    )


def test_readme_and_documentation_have_the_same_words():
    readme, docs = in_a_paragraph(WORDS), as_sections(WORDS)
    for word in WORDS.values():
        assert f"\n{word.meaning}" in docs
        assert (f"**{word.term}.** {word.meaning}" in readme) == word.short
    assert readme in (ROOT / "README.md").read_text("utf-8")
    assert docs in (ROOT / "docs/report.md").read_text("utf-8")


def test_a_meaning_is_a_sentence_and_words_are_not_said_twice():
    for word in WORDS.values():
        assert word.meaning[0].isupper() or word.meaning[0].isdigit()
        assert word.meaning.endswith(".")
    terms = [word.term for word in WORDS.values()]
    assert len(set(terms)) == len(terms)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("cell: {term: cell}", r"cell.meaning: missing"),
        ("cell: {term: cell, meaning: A row., mening: x}", "mening"),
        ("cell: 3", "cell"),
    ],
)
def test_a_word_without_a_meaning_is_named(tmp_path, text, expected):
    (tmp_path / FILE).write_text(text, "utf-8")
    with pytest.raises(BadInput) as error:
        glossary(tmp_path)
    assert re.search(expected, str(error.value))
    assert FILE in str(error.value)
