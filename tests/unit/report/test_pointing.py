"""Figures in a real browser: pointing at a run, keys, a phone, and all of it without the script."""

import base64
import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from upswing.figures import drawable
from upswing.report.page import page_of
from upswing.study.paths import CELLS, RUNS
from upswing.study.paths import figure as path_of_figure

RUN = "balancing/table/alpha-0.1/seed-1"
CELL, SEED = RUN.rsplit("/seed-", 1)


def panels(results):
    """What every figure says of its panels."""
    found = {}
    for name in drawable(results.cells):
        words = json.loads((results.folder / path_of_figure(name, "json")).read_text("utf-8"))
        found[name] = words["panels"]
    return found


def places(results):
    """In how many panels of each figure ``RUN`` is."""
    counts = {}
    for name, of in panels(results).items():
        runs = [one for panel in of for one in panel["runs"] if one["cell"] == CELL]
        held = [one for one in runs if any(a <= int(SEED) <= b for a, b in one["seeds"])]
        if held:
            counts[name] = len(held)
    return counts


def spot(page, results, name, seed=int(SEED)):
    """Where the dot of a run of ``CELL`` is on the screen."""
    for panel in panels(results)[name]:
        for runs in panel["runs"]:
            if runs["kind"] == "dots" and runs["cell"] == CELL:
                left, top, width, height = panel["box"]
                at = seed - runs["seeds"][0][0]
                x, y = (
                    np.frombuffer(base64.b64decode(runs[key]), "<u2")[at] / 65_535 for key in "xy"
                )
                svg = page.locator(f"#{name} .picture svg")
                svg.scroll_into_view_if_needed()
                box = svg.bounding_box()
                units = float(svg.get_attribute("viewBox").split()[2])
                scale = box["width"] / units
                return (
                    box["x"] + scale * (left + width * x),
                    box["y"] + scale * (top + height * (1 - y)),
                )
    raise AssertionError(name)


def lit_in(page):
    """How many shapes are lit in each figure: two, a halo and a line, for each panel."""
    return page.evaluate(
        """Object.fromEntries([...document.querySelectorAll("svg .lit")].map((one) => [
             one.closest("figure").id, one.querySelectorAll(".ink:not(.dot)").length]))"""
    )


def card(page):
    return page.locator("#run-card")


def test_hover_lights_the_run_up_in_all_panels_with_its_numbers(watched, small_page, results):
    page = watched(small_page)
    assert card(page).is_hidden()
    page.mouse.move(*spot(page, results, "overview"))
    assert lit_in(page) == places(results)
    assert len(places(results)) >= 2
    row = pd.read_parquet(results.folder / RUNS).set_index("run").loc[RUN]
    text = card(page).inner_text()
    assert text.startswith(RUN)
    assert f"falls\n{row['falls']}\n" in text
    assert f"falls in the last fifth\n{row['falls_last_fifth']}\n" in text
    assert ("balances" if row["falls_last_fifth"] == 0 else "falls") in text
    assert f"{row['mean_reward']:.3f}".replace("-", "−") in text
    page.mouse.move(2, 2)
    assert card(page).is_hidden()
    assert lit_in(page) == {}


def test_a_click_keeps_it_with_links_to_recording_table_and_figures(watched, small_page, results):
    page = watched(small_page)
    page.mouse.click(*spot(page, results, "overview"))
    page.mouse.move(2, 2)
    assert lit_in(page) == places(results)
    recording = card(page).get_by_role("link", name="its recording").get_attribute("href")
    assert recording == page.locator(f"#runs-table a:text-is('{RUN}')").get_attribute("href")
    targets = (
        card(page).locator("a[href^='#']").evaluate_all("all => all.map((a) => a.hash.slice(1))")
    )
    assert set(targets) == {"runs", *places(results)}
    page.select_option("#runs-filters [name=task]", "full-control")  # so the row is not there …
    card(page).get_by_role("link", name="in the table").click()
    link = page.locator(f"#runs-table a:text-is('{RUN}')")
    assert link.evaluate("(a) => a === document.activeElement")  # … until it is asked for
    assert page.locator("tr[aria-current]").inner_text().startswith(RUN)
    card(page).get_by_role("button", name="Close").click()
    assert lit_in(page) == {}
    assert page.locator("tr[aria-current]").count() == 0


def test_a_tap_does_as_a_click_does(watched, small_page, results):
    page = watched(small_page, width=390, has_touch=True)
    page.touchscreen.tap(*spot(page, results, "overview"))
    assert card(page).inner_text().startswith(f"{CELL}/")
    assert card(page).get_by_role("link", name="in the table").is_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_on_a_phone_a_figure_is_enlarged_when_asked(watched, small_page):
    page = watched(small_page, width=390, has_touch=True)
    svg = page.locator("#overview .picture svg")
    assert svg.bounding_box()["width"] <= 390
    button = page.locator("#overview .enlarge")
    button.tap()
    assert button.get_attribute("aria-pressed") == "true"
    assert svg.bounding_box()["width"] > 800
    assert (
        page.evaluate("document.documentElement.scrollWidth") <= 390
    )  # the figure scrolls, not the page
    button.tap()
    assert svg.bounding_box()["width"] <= 390
    assert (
        watched(small_page).locator("#overview .enlarge").is_hidden()
    )  # on a wide screen there is none


def test_arrow_keys_go_from_run_to_run_and_to_the_next_panel(watched, small_page, results):
    page = watched(small_page)
    region = page.locator("#overview .picture")
    region.focus()
    assert page.locator("#overview-keys").is_visible()
    seen = []
    page.keyboard.press("End")
    for key in ["ArrowUp"] * 12:
        seen.append(page.evaluate("lit.run"))
        page.keyboard.press(key)
    dots = panels(results)["overview"][0]["runs"]
    assert set(seen) == {
        f"{one['cell']}/seed-{seed}"
        for one in dots for first, last in one["seeds"] for seed in range(first, last + 1)
    }  # fmt: skip
    page.keyboard.press("ArrowRight")
    assert page.evaluate("lit.run").startswith("full-control/")
    page.keyboard.press("Enter")
    assert card(page).evaluate("(card) => card === document.activeElement")
    page.keyboard.press("Escape")
    assert card(page).is_hidden()
    assert region.evaluate("(region) => region === document.activeElement")


def test_the_table_lights_runs_up_too(watched, small_page, results):
    page = watched(small_page)
    link = page.locator(f"#runs-table a:text-is('{RUN}')")
    link.focus()
    assert lit_in(page) == places(results)
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "show"
    page.keyboard.press("Enter")
    assert "shown in" in card(page).inner_text()
    assert card(page).evaluate("(card) => card === document.activeElement")
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.textContent") == "show"
    other = page.locator("#runs-table tbody tr").nth(1)
    other.hover()
    assert card(page).inner_text().startswith(other.locator("a").inner_text())


def test_where_a_run_has_no_recording_its_row_can_still_be_chosen(browser, whole, tmp_path):
    page_of(whole.folder, Path("report"), lent=False).write(tmp_path, "a.html", "a.csv", "b.csv")
    page = browser.new_page()
    page.goto((tmp_path / "a.html").as_uri())
    head = page.locator("#runs-table tbody th", has_not=page.locator("a")).first
    head.focus()
    assert card(page).inner_text().startswith(page.evaluate("lit.run"))
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    assert card(page).evaluate("(card) => card === document.activeElement")
    page.close()


@pytest.mark.parametrize(("motion", "moves"), [("reduce", False), ("no-preference", True)])
def test_nothing_moves_for_who_wants_no_motion(watched, small_page, results, motion, moves):
    page = watched(small_page, reduced_motion=motion)
    page.mouse.click(*spot(page, results, "overview"))
    shown = page.locator("#overview svg .lit")
    assert (shown.evaluate("(one) => getComputedStyle(one).animationName") != "none") == moves
    smooth = page.evaluate("getComputedStyle(document.documentElement).scrollBehavior") == "smooth"
    assert smooth <= moves


def test_without_the_script_the_figures_are_whole(watched, small_page, results):
    page = watched(small_page, java_script_enabled=False)
    text = page.content()
    for name in drawable(results.cells):
        svg = page.locator(f"#{name} .picture svg")
        box = svg.bounding_box()
        assert box["width"] > 500, name
        assert box["height"] > 100, name
        assert svg.get_attribute("role") == "img"
        assert len(svg.get_attribute("aria-label")) > 40
    assert page.locator("#overview text", has_text="falls in the last fifth").is_visible()
    assert "run-card" not in re.sub(r"<(style|script).*?</\1>", "", text, flags=re.DOTALL)
    assert page.locator(".measure").count() == 0


def test_step_sizes_are_drawn_in_any_measure_with_the_numbers_of_the_table(
    watched, small_page, results
):
    page = watched(small_page)
    cells = pd.read_parquet(results.folder / CELLS).set_index("cell")
    still, chosen = page.locator("#step-sizes svg:not(.chosen)"), page.locator("svg.chosen")
    select = page.get_by_label("Measure")
    assert still.is_visible()
    for label, columns, factor in (
        ("falls", ("falls_mean", "falls_mean_low", "falls_mean_high"), 1),
        ("upright steps in the last fifth", ("upright_share_mean", "upright_share_mean_low", "upright_share_mean_high"), 100),
        ("cost in the last fifth (mean of φ²)", ("mean_reward_mean", "mean_reward_mean_high", "mean_reward_mean_low"), -1),
    ):  # fmt: skip
        select.select_option(label=label)
        assert still.is_hidden()
        points = chosen.locator(".point").evaluate_all(
            "all => all.map((one) => ({...one.dataset}))"
        )
        assert len(points) == 2
        heights = {}
        for at, point in enumerate(points):
            told = json.loads(point["told"])
            own = cells.loc[f"balancing/{point['name']}/alpha-{point['alpha']}", list(columns)]
            assert np.allclose(told, factor * own.to_numpy(float), rtol=1e-5)
            heights[told[0]] = chosen.locator(".point circle").nth(at).bounding_box()["y"]
        low, high = sorted(heights)
        assert heights[low] >= heights[high]  # what is more stands higher
        assert chosen.get_attribute("aria-label")
    select.select_option(index=0)
    assert still.is_visible()
    assert chosen.count() == 0


def test_the_policy_stops_nothing_of_it(watched, small_page, results):
    page = watched(small_page)
    page.evaluate(
        "window.stopped = []; addEventListener('securitypolicyviolation', (e) => stopped.push(e.blockedURI))"
    )
    page.mouse.click(*spot(page, results, "overview"))
    page.get_by_label("Measure").select_option(index=2)
    page.keyboard.press("Escape")
    assert page.evaluate("window.stopped") == []
    assert page.locator("main [style]").count() == 0


def test_the_page_stays_small(any_page):
    text = Path(any_page.removeprefix("file://")).read_text("utf-8")
    assert len(text.encode()) < 6_000_000
    scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    assert sum(map(len, scripts)) < 30_000
