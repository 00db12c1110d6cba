"""Figures put into the page: what a plot needs passes, whatever else a file may hold does not."""

import re
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from upswing.report.inline_svg import inline
from upswing.study.errors import BadInput

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 9 9">'


def read(svg):
    return ET.fromstring(svg)  # noqa: S314  our own


def put(tmp_path, text, name="fig05"):
    path = tmp_path / "a.svg"
    path.write_text(text, "utf-8")
    return inline(path, name, 'what "it" shows <&>')


@pytest.fixture
def plot(tmp_path):
    """What matplotlib draws: lines and dots that are cut off, markers, text, pixels."""
    figure = Figure(figsize=(4, 3))
    axes = figure.subplots()
    axes.plot([1, 2, 3], [1, 4, 2], "o--", label="one & <two>", clip_on=True)
    axes.plot([1, 2], [5, 6], rasterized=True)
    axes.set_xscale("log")
    axes.set_title("φ̇ of a run")
    axes.legend()
    path = tmp_path / "plot.svg"
    import matplotlib as mpl

    with mpl.rc_context({"svg.fonttype": "none"}):
        figure.savefig(path)
    return path


def test_a_plot_passes_with_all_that_is_drawn(plot):
    before = read(plot.read_text("utf-8"))
    after = read(inline(plot, "fig05", "words"))
    for element in ("path", "use", "image", "text", "clipPath", "rect"):
        drawn = [one for one in before.iter() if one.tag.endswith("}" + element)]
        assert len(list(after.iter(element))) == len(drawn) > 0, element
    texts = [one for one in before.iter() if one.tag.endswith(("}text", "}tspan"))]
    said = "".join("".join(one.itertext()) for one in texts if one.tag.endswith("}text"))
    assert "".join("".join(one.itertext()) for one in after.iter("text")).split() == said.split()
    assert "one & <two>" in said


def test_it_has_nothing_that_the_policy_blocks(plot):
    text = inline(plot, "fig05", 'a "word" <')
    assert not re.search(r"<style|<script|<!|<\?|\sstyle=|\son\w+=|xmlns|http", text)
    root = read(text)
    assert (root.get("role"), root.get("aria-label")) == ("img", 'a "word" <')
    line = next(one for one in root.iter("path") if one.get("stroke-dasharray"))
    assert line.get("stroke").startswith("#")


def test_no_two_figures_share_an_id_and_each_finds_its_own(plot):
    one, other = (read(inline(plot, name, "")) for name in ("fig05", "fig06"))
    ids = [{part.get("id") for part in root.iter() if part.get("id")} for root in (one, other)]
    assert ids[0]
    assert not ids[0] & ids[1]
    text = inline(plot, "fig05", "")
    used = set(re.findall(r'(?:href="|url\()#([^")]+)', text))
    assert used == ids[0]


EVIL = {
    "script": "<script>alert(1)</script>",
    "foreignObject": "<foreignObject><body xmlns='http://www.w3.org/1999/xhtml'/></foreignObject>",
    "animate": "<animate attributeName='href' to='javascript:alert(1)'/>",
    "<a>": "<a href='javascript:alert(1)'><text>x</text></a>",
    "onload": "<g onload='alert(1)'/>",
    "<html>": "<html xmlns='http://www.w3.org/1999/xhtml'/>",
    "href": "<use href='https://example.org/a.svg#b'/>",
    "outside": "<image xlink:href='https://example.org/a.png' width='1' height='1'/>",
    "drawing": "<image href='data:image/svg+xml;base64,PHN2Zy8+' width='1' height='1'/>",
    "text/html": "<use href='data:text/html,x'/>",
    "fill": "<path d='M0 0' fill='url(https://example.org/a#b)'/>",
    "style": "<path d='M0 0' style='fill: url(https://example.org/a)'/>",
    "property": "<path d='M0 0' style='background: red'/>",
    "cut": "<path d='M0 0' clip-path='url(https://example.org/a#b)'/>",
    "rules": "<style>@import 'https://example.org/a.css';</style>",
    "svg in svg": "<svg/>",
    "class": "<path d='M0 0&quot; onload=&quot;alert(1)'/>",
}


@pytest.mark.parametrize("evil", EVIL.values(), ids=EVIL)
def test_what_is_no_part_of_a_figure_is_refused(tmp_path, evil):
    with pytest.raises(BadInput, match=r"a\.svg.*upswing figure fig05"):
        put(tmp_path, f"{HEAD}{evil}</svg>")


@pytest.mark.parametrize(
    "text",
    [
        '<!DOCTYPE svg [<!ENTITY a "b">]>' + HEAD + "<text>&a;</text></svg>",
        '<!DOCTYPE svg [<!ENTITY a SYSTEM "file:///etc/passwd">]>'
        + HEAD
        + "<text>&a;</text></svg>",
        '<?xml-stylesheet href="https://example.org/a.css"?>' + HEAD + "</svg>",
        HEAD,
        "",
        "no picture",
        "<html/>",
        '<svg xmlns="http://www.w3.org/2000/svg"/>',
    ],
)
def test_what_is_no_picture_is_refused(tmp_path, text):
    with pytest.raises(BadInput, match=r"a\.svg"):
        put(tmp_path, text)


def test_bytes_are_refused(tmp_path):
    (tmp_path / "a.svg").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(BadInput, match="no text"):
        inline(tmp_path / "a.svg", "fig05", "")


def test_text_stays_text(tmp_path):
    text = put(tmp_path, f"{HEAD}<text>&lt;script&gt;alert(1)&lt;/script&gt;</text></svg>")
    assert "<script" not in text
    assert read(text).find("text").text == "<script>alert(1)</script>"


@given(
    st.sampled_from(["fill", "d", "style", "transform", "href", "clip-path", "id", "x", "onclick"]),
    st.text(max_size=40),
)
def test_whatever_a_value_is_it_stays_in_its_attribute(tmp_path_factory, key, value):
    from xml.sax.saxutils import quoteattr

    path = tmp_path_factory.getbasetemp() / "fuzzed.svg"
    path.write_text(f"{HEAD}<path {key}={quoteattr(value)}/></svg>", "utf-8")
    try:
        text = inline(path, "fig05", "")
    except BadInput:
        return
    (one,) = read(text)
    assert one.tag == "path"
    assert not [name for name in one.attrib if name.startswith(("on", "style"))]
    assert "//" not in "".join(one.attrib.values())
