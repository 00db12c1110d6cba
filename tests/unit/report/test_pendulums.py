"""The pendulums of a study as the page shows them."""

import re
from pathlib import Path

import pytest
from jinja2 import Environment, FileSystemLoader

from tests.paths import ROOT
from upswing.physics.braking import highest_stoppable_speed
from upswing.physics.pendulum import Pendulum
from upswing.report import words
from upswing.report.cards import cards
from upswing.report.glossary import glossary
from upswing.report.pendulums import (
    choices,
    drawn_for,
    held_by_push,
    length_of_a_step,
    lengths,
    own_starts,
    own_tiles,
    pendulums,
    system,
)
from upswing.study.config import load, validated

TEMPLATES = ROOT / "report"
STRONG = {"length": 0.4, "accelerations": [-20, -10, 0, 10, 20], "time_step": 0.01}


def study_of(**tasks):
    kinds = {
        name: {"kind": "full-control", "steps": 1_000_000, **keys} for name, keys in tasks.items()
    }
    return validated({"study": {
        "seeds": 1, "tasks": kinds, "architectures": {"table": {"learner": "table"}},
        "experiments": [{"tasks": list(tasks), "architectures": ["table"], "alphas": [0.1]}],
    }})  # fmt: skip


def rendered(part, study):
    """A part of the page, without its marks."""
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters.update(words.FILTERS, cards=cards)
    given = {
        **system(study, TEMPLATES), "study": study, "adopted": [], "beyond": {"kept": set()},
        "kept": set(), "lent": False, "cell": {}, "glossary": glossary(TEMPLATES), "solving": [],
    }  # fmt: skip
    text = '{% import "parts/macros.html.j2" as show with context %}{% include "parts/'
    return environment.from_string(f'{text}{part}.html.j2" %}}').render(given)


def text_of(html):
    return " ".join(re.sub(r"<(svg|math).*?</\1>|<[^>]*>", " ", html, flags=re.DOTALL).split())


THESIS = load(Path(ROOT / "config/config.yaml"))
OWN = study_of(strong={"pendulum": STRONG, "track": {"limit": 2}, "tiles": {"velocity_limit": 18}})
BOTH = study_of(
    plain={},
    strong={"pendulum": STRONG, "track": {"limit": 2}},
    hard={"pendulum": STRONG, "track": {"limit": 2}, "start": {"middle": 180, "within": 10}},
    falls={"track": {"limit": 1.5, "at_end": "falls"}},
    uneven={"pendulum": {"accelerations": [-3, 15]}},
)


def test_the_thesis_s_study_has_one_and_says_what_it_said():
    (one,) = pendulums(THESIS)
    assert (one.is_thesis, one.body, one.tasks) == (True, Pendulum(), list(THESIS.tasks))
    assert (one.track, one.held, held_by_push(THESIS)) == ("no end", "±134°", "±134°")
    assert (own_tiles(THESIS), own_starts(THESIS)) == ([], [])
    said = text_of(rendered("system", THESIS))
    for words_ in (
        "In each step of 5 ms the agent", "accelerates by −10, 0 or +10 m/s² (§4.1)",
        "The pendulum is the thesis’s (§4.2.2): a rod of mass m = 0.1 kg and length l = 0.2 m, with viscous friction f c = 0.001 N·m·s and "
        "g = 9.81 m/s². With φ from upright (reading R1)",
        "and a step of dt = 0.005 s is", "and likewise for the cart (24, 25). The reward is −φ².",
        "and is never reset. A state", "into 20. Learning",
    ):  # fmt: skip
        assert words_ in said, words_
    assert "Pendulums" not in rendered("system", THESIS)
    for name, drawing in system(THESIS, TEMPLATES)["drawings"].items():
        assert drawing == (TEMPLATES / f"drawings/{name}.svg").read_text("utf-8")
    assert "Every 5 ms the learner" in text_of(rendered("task", THESIS))
    assert "one of three actions : it accelerates the cart to the left, to the right, or not at all." in text_of(
        rendered("task", THESIS)
    )  # fmt: skip
    solving = text_of(rendered("solving", THESIS))
    assert "90 % of 5,000 steps (25 s)" in solving
    assert "90 % of its last 100,000 steps" in solving
    assert "holds the rod at ±134°." in solving


def test_another_pendulum_for_all_tasks_stands_in_the_text():
    (one,) = pendulums(OWN)
    assert (one.is_thesis, one.accelerations) == (False, "−20, −10, 0, +10 or +20")
    said = text_of(rendered("system", OWN))
    for words_ in (
        "In each step of 10 ms", "accelerates by −20, −10, 0, +10 or +20 m/s²", "length l = 0.4 m",
        "The pendulum is not the thesis’s: a rod of mass m = 0.1 kg", "The cart can go to ±2 m, where it stops dead.",
        "dt = 0.01 s", "in strong the angle, up to ±180°, is cut into 8 parts, and the velocity, up to ±18 rad/s, into 20.",
    ):  # fmt: skip
        assert words_ in said, (words_, said)
    drawing = str(system(OWN, TEMPLATES)["drawings"]["task"])
    assert "its strongest actions, −20 m/s² and +20 m/s²" in drawing
    assert (">+20 m/s²<" in drawing, ">−20 m/s²<" in drawing, "10 m/s²" in drawing) == (
        True,
        True,
        False,
    )
    assert "one of five actions : it accelerates the cart to the left or to the right, more or less strongly, or not at all." in (
        text_of(rendered("task", OWN))
    )  # fmt: skip
    assert "holds the rod at ±116°." in text_of(rendered("solving", OWN))
    assert lengths(OWN) == {"stable": "2,500 steps", "end": "50,000 steps"}


def test_several_stand_in_a_table_a_row_for_each():
    found = pendulums(BOTH)
    assert [one.tasks for one in found] == [["plain"], ["strong", "hard"], ["falls"], ["uneven"]]
    assert [one.is_thesis for one in found] == [True, False, False, False]
    assert [one.held for one in found] == ["±134°", "±116°", "±134°", "123° or −163°"]
    assert [one.track for one in found] == [
        "no end", "±2 m, where it stops dead", "±1.5 m, where a run is reset", "no end",
    ]  # fmt: skip
    assert [one.stoppable for one in found] == [highest_stoppable_speed(one.body) for one in found]
    html = rendered("system", BOTH)
    (table,) = re.findall(r'aria-label="Pendulums".*?</table>', html, re.DOTALL)
    rows = [text_of(row) for row in re.findall(r"<tr>.*?</tr>", table, re.DOTALL)[1:]]
    assert len(rows) == 4
    assert rows[0].startswith("plain (the thesis’s) 0.1 0.2 9.81 0.001 0.005 −10, 0 or +10 no end")
    assert rows[0].endswith("±134° 20.24")
    assert rows[1].startswith("strong , hard 0.1 0.4 9.81 0.001 0.01 −20, −10, 0, +10 or +20 ±2 m")
    said = text_of(html)
    assert "The tasks of this study have 4 different pendulums" in said
    assert "accelerates to either side" in said
    assert "; hard starts within ±10° of 180°. A state" in said
    assert length_of_a_step(BOTH) == "5 or 10 ms"
    assert lengths(BOTH) == {"stable": "25 s", "end": "500 s"}
    assert choices(BOTH).how_many == "two, three or five"
    assert ">+<" in drawn_for("<text>+10 m/s²</text>", found)


@pytest.mark.parametrize("study", [THESIS, OWN, BOTH])
def test_nothing_is_left_of_the_template(study):
    for part in ("system", "task", "solving"):
        html = rendered(part, study)
        assert not re.search(r"\{[{%]|[%}]\}", html)
        assert html.count("<p>") == html.count("</p>"), part
        assert html.count("<table>") == html.count("</table>")
