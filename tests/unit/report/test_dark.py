"""Figures in either scheme, in a real browser: every text can be read, and none stands in a box of its own."""

import re

import numpy as np
import pytest
from PIL import Image


def linear(part):
    return part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4


def contrast(one, other):
    """WCAG 2.2, of two colours with parts from 0 to 1."""
    light = sorted(np.dot([0.2126, 0.7152, 0.0722], [linear(x) for x in c]) for c in (one, other))
    return (light[1] + 0.05) / (light[0] + 0.05)


TURN = np.array([[-0.574, 1.43, 0.144], [0.426, 0.43, 0.144], [0.426, 1.43, -0.856]])
"""hue-rotate(180deg), by the specification of filter effects."""


def in_the_dark(colour, paper):
    """invert(1) hue-rotate(180deg), and screened upon the paper."""
    turned = np.clip(TURN @ (1 - np.array(colour)), 0, 1)
    return turned + paper - turned * paper


TEXTS = """() => [...document.querySelectorAll(".picture svg text")].filter((one) => one.textContent.trim())
  .map((one) => {
    let opacity = 1;
    for (let at = one; at instanceof SVGElement; at = at.parentElement) opacity *= getComputedStyle(at).opacity;
    return [one.textContent, getComputedStyle(one).fill, opacity * getComputedStyle(one).fillOpacity];
  })"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_text_of_a_figure_can_be_read(watched, any_page, scheme):
    page = watched(any_page, color_scheme=scheme)
    if not page.evaluate("Object.keys(given.figures).length"):
        pytest.skip(
            "these figures were drawn by an older version; `make reproduce` draws them anew"
        )

    def colour(text):
        return np.array([int(part) for part in re.findall(r"\d+", text)[:3]]) / 255

    paper = colour(page.evaluate("getComputedStyle(document.body).backgroundColor"))
    select = page.get_by_label("Measure")
    texts = page.evaluate(TEXTS)
    select.select_option(index=1)
    texts += page.evaluate(TEXTS)
    assert len(texts) > 60
    dim = {}
    for text, fill, opacity in texts:
        on_white = 1 - opacity * (1 - colour(fill))
        seen, behind = (
            (on_white, np.ones(3)) if scheme == "light" else (in_the_dark(on_white, paper), paper)
        )
        if (found := contrast(seen, behind)) < 4.5:
            dim[text] = (fill, round(float(found), 2))
    assert dim == {}


def test_in_the_dark_a_figure_stands_on_the_paper_as_computed(watched, small_page, tmp_path):
    """The filter does what the contrasts above are computed with, and leaves no box around a figure."""
    page = watched(small_page, color_scheme="dark")
    svg = page.locator("#overview .picture svg")
    shades = ["#0072b2", "#d55e00", "#555555", "#009e73"]
    page.evaluate(
        """(shades) => {
          const svg = document.querySelector("#overview .picture svg");
          for (const [at, fill] of shades.entries())
            made(svg, "rect", { x: 20 * at, y: 0, width: 20, height: 20, fill });
        }""",
        shades,
    )
    svg.screenshot(path=tmp_path / "dark.png")
    with Image.open(tmp_path / "dark.png") as image:
        pixels = np.asarray(image.convert("RGB"), float) / 255
    scale = pixels.shape[1] / float(svg.get_attribute("viewBox").split()[2])
    paper = np.array([0x16, 0x18, 0x1B]) / 255
    assert np.abs(pixels[-2, 2] - paper).max() < 0.01
    for at, shade in enumerate(shades):
        seen = pixels[int(10 * scale), int((20 * at + 10) * scale)]
        colour = np.array(list(bytes.fromhex(shade[1:]))) / 255
        assert np.abs(seen - in_the_dark(colour, paper)).max() < 0.02, shade
