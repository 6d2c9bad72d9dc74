"""The page as a reader meets it: opened from disk in Chromium, without a network."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import expect

import drystone as ds
from conftest import orderless
from drystone.viewer import FrameForces, Page, run_page
from tab import (
    LIGHT,
    Opener,
    count,
    find,
    hover,
    pixels,
    plays_within_a_notebook,
    press,
    says,
    settle,
)


@pytest.fixture(scope="module")
def plan() -> ds.Plan:
    return ds.plan(ds.scenes.five_blocks())


def a_run() -> Page:
    """Five blocks that rest and one that slides off, 240 steps of 1/240 s."""
    scene = ds.Scene()
    scene.add_box((0, -0.5), (8, 1), name="ground", fixed=True)
    for i in range(5):
        scene.add_box((0, 0.5 + i), (2, 1), name=f"rest{i}")
    scene.add_box((1.2, 5.5), (1, 1), name="slides")
    steps = 240
    times = np.arange(steps + 1) / 240
    poses = np.tile([[*b.centroid, b.angle] for b in scene.bodies], (steps + 1, 1, 1))
    late = np.clip(times - 0.25, 0, None)
    poses[:, 6] += np.stack([1.5 * late, -4.9 * late**2, -2 * late], axis=1)
    motionless = np.ones((steps + 1, 7), dtype=bool)
    motionless[61:, 6] = False
    pairs = np.array([[i, i + 1] for i in range(6)])
    points = np.array([[0.5, i] for i in range(6)])
    vectors = np.array([[0, 10.0 * (6 - i)] for i in range(6)])
    forces = FrameForces(
        6 * np.arange(steps + 2),
        *(np.tile(part, (steps + 1, 1)) for part in (pairs, points, vectors)),
    )
    pivots = np.where(np.arange(steps) == 60, 12, 0)
    return run_page(scene, times, poses, motionless, pivots, 1e-6 * (1 + pivots), forces)


def test_the_plan_opens_at_the_whole_structure(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    assert tab.title() == "Order found for 5 blocks"
    says(tab, "place", "Step 0 of 5")
    says(tab, "caption", "The whole structure: 5 blocks. Next: take away 5.")
    picture = pixels(tab)
    assert count(picture, LIGHT["stone"]) > 20_000
    assert count(picture, LIGHT["next"]) > 2000
    assert count(picture, LIGHT["force"]) > 200
    assert tab.locator("#legend").inner_text().split("\n") == [
        "stands",
        "next to be taken away",
        "taken away",
        "fixed",
    ]


def test_steps_take_blocks_away(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    tab.click("#forces")
    stone = [count(pixels(tab), LIGHT["stone"])]
    for _ in range(5):
        tab.click("#forward")
        stone.append(count(pixels(tab), LIGHT["stone"]))
    assert stone == sorted(stone, reverse=True)
    assert stone[0] > 20_000
    assert stone[-1] == 0
    says(tab, "caption", "1 is taken away; 0 blocks left.")
    assert count(pixels(tab), LIGHT["next"]) == 0
    expect(tab.locator("#forward")).to_be_disabled()
    tab.click("#back")
    says(tab, "place", "Step 4 of 5")
    tab.click("#first")
    says(tab, "place", "Step 0 of 5")
    expect(tab.locator("#back")).to_be_disabled()
    tab.click("#last")
    says(tab, "place", "Step 5 of 5")


def test_play_pause_and_speed(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    tab.select_option("#speed", "4")
    tab.click("#play")
    expect(tab.locator("#play")).to_have_attribute("aria-label", "Pause")
    expect(tab.locator("#scrub")).to_have_value("5", timeout=8000)
    expect(tab.locator("#play")).to_have_attribute("aria-label", "Play")
    tab.select_option("#speed", "0.1")
    tab.click("#play")
    tab.click("#play")
    tab.wait_for_timeout(300)
    expect(tab.locator("#scrub")).to_have_value("0"), "again from the start, and slowly"
    expect(tab.locator("#play")).to_have_attribute("aria-label", "Play")


def test_scrubbing(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    tab.locator("#scrub").fill("3")
    says(tab, "place", "Step 3 of 5")
    box = tab.locator("#scrub").bounding_box()
    assert box is not None
    tab.mouse.click(box["x"] + box["width"] - 3, box["y"] + box["height"] / 2)
    says(tab, "place", "Step 5 of 5")


def test_the_keyboard_alone_is_enough(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    press(tab, "ArrowRight", "ArrowRight")
    says(tab, "place", "Step 2 of 5")
    press(tab, "ArrowLeft")
    says(tab, "place", "Step 1 of 5")
    press(tab, "Shift+ArrowRight")
    says(tab, "place", "Step 5 of 5")
    press(tab, "Home")
    says(tab, "place", "Step 0 of 5")
    press(tab, "End")
    says(tab, "place", "Step 5 of 5")
    press(tab, "f")
    expect(tab.locator("#forces")).to_have_attribute("aria-pressed", "false")
    press(tab, "n")
    expect(tab.locator("#names")).to_have_attribute("aria-pressed", "false")
    press(tab, "Space")
    expect(tab.locator("#play")).to_have_attribute("aria-label", "Pause")
    press(tab, "Space", "Home", "]", "]")
    expect(tab.locator("#card strong")).to_have_text(plan.scene.names[1])
    press(tab, "Escape")
    expect(tab.locator("#card")).to_be_hidden()
    # Space on a focused button presses that button, and nothing else.
    tab.focus("#names")
    press(tab, "Space")
    expect(tab.locator("#names")).to_have_attribute("aria-pressed", "true")
    expect(tab.locator("#play")).to_have_attribute("aria-label", "Play")


def test_forces_and_names_can_be_switched_off(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    force = LIGHT["force"]
    shown = count(pixels(tab), force)
    tab.locator("#length").fill("2")
    assert count(pixels(tab), force) > 1.5 * shown, "four times as long"
    tab.click("#forces")
    without = pixels(tab)
    assert count(without, force) == 0
    expect(tab.locator("#length")).to_be_hidden()
    tab.click("#names")
    assert not np.array_equal(pixels(tab), without)


def test_frames_without_forces_show_those_before_and_say_so(opened: Opener, plan: ds.Plan) -> None:
    from dataclasses import replace

    recording = plan.view().recording
    assert recording.forces is not None
    kept = np.arange(6) % 2 == 0
    tab = opened(Page(replace(recording, forces=replace(recording.forces, kept=kept))))
    tab.click("#forward")
    says(
        tab,
        "caption",
        "5 is taken away; 4 blocks left. Next: take away 4. (Forces: those of step 0.)",
    )
    assert count(pixels(tab), LIGHT["force"]) > 200
    tab.click("#forward")
    says(tab, "caption", "4 is taken away; 3 blocks left. Next: take away 3.")


def test_held_blocks_are_hatched_and_named(opened: Opener) -> None:
    plan = ds.plan(ds.scenes.arch(7), hold=1)
    first = next(step for step, names in enumerate(plan.holds) if names)
    tab = opened(plan.view())
    expect(tab.locator("#legend")).to_contain_text("held")
    assert (first == 0) == (count(pixels(tab), LIGHT["held"]) > 0)
    tab.locator("#scrub").fill(str(first))
    expect(tab.locator("#caption")).to_contain_text(f"Held: {plan.holds[first][0]}.")
    expect(tab.locator("#caption")).to_contain_text(f"The hand on {plan.holds[first][0]} bears")
    press(tab, "n")
    picture = pixels(tab)
    assert count(picture, LIGHT["held"]) > 100
    assert count(picture, LIGHT["force"]) > 200
    card = hover(tab, *find(tab, LIGHT["held"]))
    expect(card.locator("strong")).to_have_text(plan.holds[first][0])
    expect(card).to_contain_text("by a hand or a scaffold")


def test_the_card_of_a_block(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    place = find(tab, LIGHT["next"])
    card = hover(tab, *place)
    expect(card).to_be_visible()
    lines = card.inner_text().split("\n")
    assert lines[0] == plan.order[0]
    assert "next to be taken away" in lines
    mass = plan.scene.body(plan.order[0]).mass
    assert any(line.startswith(f"{mass:g} kg") for line in lines)
    assert any("force" in line and line.endswith(" N") for line in lines)
    press(tab, "ArrowRight")
    expect(card).to_contain_text("taken away in step 1")
    hover(tab, 0.01, 0.01)
    expect(card).to_be_hidden()


def test_a_click_keeps_the_card(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    card = hover(tab, *find(tab, LIGHT["next"]))
    tab.mouse.down()
    tab.mouse.up()
    tab.mouse.move(1, 1)
    settle(tab)
    expect(card).to_be_visible()


def test_zoom_and_drag(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    whole = pixels(tab)
    press(tab, "+", "+", "+")
    near = pixels(tab)
    assert count(near, LIGHT["stone"]) > 1.3 * count(whole, LIGHT["stone"])
    hover(tab, 0.5, 0.5)
    tab.mouse.down()
    hover(tab, 0.4, 0.6)
    tab.mouse.up()
    tab.mouse.move(1, 1)
    assert not np.array_equal(pixels(tab), near)
    press(tab, "0")
    tab.evaluate("document.activeElement.blur()")  # the picture's focus ring
    assert np.array_equal(pixels(tab), whole)


def test_the_charts_show_values_and_lead_there(opened: Opener) -> None:
    run = a_run()
    tab = opened(run)
    figures = tab.locator("#charts figure")
    assert figures.count() == 2
    expect(figures.nth(0)).to_be_hidden()  # work and times are for those who ask
    tab.click("#work summary")
    assert "pivots per step" in figures.nth(0).inner_text()
    chart = figures.nth(0).locator("canvas")
    box = chart.bounding_box()
    assert box is not None
    # The step with 12 pivots is the 61st of 241 frames.
    tab.mouse.click(box["x"] + (61.5 / 241) * box["width"], box["y"] + 20)
    expect(tab.locator("#scrub")).to_have_value("61")
    expect(figures.nth(0).locator("strong")).to_have_text("12")
    expect(figures.nth(1).locator("strong")).to_have_text("13 µs")
    tab.mouse.down()
    tab.mouse.move(box["x"] + 0.999 * box["width"], box["y"] + 20)
    tab.mouse.up()
    expect(tab.locator("#scrub")).to_have_value("240")


def test_a_run_plays_in_its_own_time(opened: Opener) -> None:
    tab = opened(a_run())
    says(tab, "place", "0.000 s · step 0 of 240")
    says(tab, "caption", "6 of 6 blocks motionless")
    before = pixels(tab)
    assert count(before, LIGHT["still"]) > 20_000
    assert count(before, LIGHT["stone"]) == 0
    tab.click("#play")
    expect(tab.locator("#scrub")).to_have_value("240", timeout=10_000)
    says(tab, "place", "1.000 s · step 240 of 240")
    says(tab, "caption", "5 of 6 blocks motionless")
    after = pixels(tab)
    assert count(after, LIGHT["stone"]) > 2000, "what moves is light"
    assert count(after, LIGHT["still"]) > 20_000


def test_a_run_without_forces_has_no_use_for_the_button(opened: Opener) -> None:
    from dataclasses import replace

    tab = opened(Page(replace(a_run().recording, forces=None)))
    expect(tab.locator("#forces")).to_be_disabled()
    assert count(pixels(tab), LIGHT["force"]) == 0


@pytest.mark.parametrize("width", [600, 1600])
def test_it_fits_narrow_and_wide_windows(opened: Opener, plan: ds.Plan, width: int) -> None:
    tab = opened(plan.view(), width=width)
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    for control in ("play", "scrub", "speed", "forces", "names"):
        box = tab.locator(f"#{control}").bounding_box()
        assert box is not None
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= width
    scene = tab.locator("#scene").bounding_box()
    assert scene is not None
    assert scene["height"] >= 250


def test_dark_and_light(opened: Opener, plan: ds.Plan) -> None:
    light = pixels(opened(plan.view()))
    dark = pixels(opened(plan.view(), color_scheme="dark"))
    assert light[2, 2].min() > 240
    assert dark[2, 2].max() < 40


def test_reduced_motion_does_without_fades(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view(), reduced_motion="reduce")
    tab.click("#forward")
    says(tab, "place", "Step 1 of 5")
    at_once = tab.locator("#scene").screenshot()
    tab.wait_for_timeout(500)
    assert tab.locator("#scene").screenshot() == at_once


def test_everything_has_a_name_for_those_who_do_not_see_it(opened: Opener, plan: ds.Plan) -> None:
    tab = opened(plan.view())
    for button in tab.locator("button, input, select").all():
        label = button.get_attribute("aria-label")
        assert label or button.inner_text() or button.evaluate("e => e.labels[0].textContent")
    expect(tab.locator("#scrub")).to_have_attribute(
        "aria-valuetext", "Step 0 of 5. The whole structure: 5 blocks. Next: take away 5."
    )


def test_without_an_order_what_was_never_there_is_not_taken_away(opened: Opener) -> None:
    tab = opened(ds.plan(orderless(1)).view())
    expect(tab.locator("#legend")).to_contain_text("not there")
    expect(tab.locator("#legend li").last).to_have_text("fixed")
    assert "taken away" not in tab.locator("#legend li").all_inner_texts()


def test_what_does_not_stand_is_shown_falling(opened: Opener) -> None:
    tab = opened(ds.plan(ds.scenes.diamond(5)).view())
    assert count(pixels(tab), "#f2a48c") > 20_000
    expect(tab.locator("#play")).to_be_disabled()
    expect(tab.locator("#caption")).to_contain_text("Falls: 24 of 25 blocks")


def test_within_a_notebook(opened: Opener, plan: ds.Plan) -> None:
    plays_within_a_notebook(opened, plan.view())


def test_damage_is_said_in_one_line(opened: Opener, plan: ds.Plan) -> None:
    broken = plan.view().html().replace('"version":2', '"version":9')
    tab = opened(broken)
    alert = tab.locator("[role=alert]").inner_text()
    assert alert == "The recording has version 9; this page reads version 2."


def test_names_are_text_and_never_markup(opened: Opener) -> None:
    scene = ds.Scene()
    scene.add_box((0, -0.5), (4, 1), fixed=True)
    scene.add_box((0, 0.5), (1, 1), name="<img src=x onerror=alert(1)></script>")
    tab = opened(ds.plan(scene).view())
    press(tab, "]", "]")
    expect(tab.locator("#card strong")).to_have_text("<img src=x onerror=alert(1)></script>")
    assert tab.locator("#card img").count() == 0
