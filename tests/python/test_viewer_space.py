"""The page of a structure in space, in Chromium with WebGL made by the processor."""

from __future__ import annotations

import base64
import hashlib
import re
import zlib
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from playwright.sync_api import Browser, Playwright, expect

from by_hand import plan_by_hand, run_by_hand
from drystone.viewer import Page
from tab import Opener, Tab, hover, launched, pixels, plays_within_a_notebook, press, says


@pytest.fixture(scope="module")
def browser(playwright: Playwright) -> Iterator[Browser]:
    browser = launched(
        playwright, "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"
    )
    yield browser
    browser.close()


def hues(picture: np.ndarray) -> dict[str, int]:
    """Pixels of stone (light and warm), of what is next (orange), of forces (blue), of still grey.

    Faces are lit, so colours are told by their proportions.
    """
    red, green, blue = (picture[:, :, i] for i in range(3))
    warm = (red - blue > 12) & (red - blue < 60) & (red - green < 30)
    return {
        "stone": int(np.sum(warm)),
        "next": int(np.sum(red - blue > 90)),
        "force": int(np.sum(blue - red > 90)),
        "still": int(np.sum((np.ptp(picture, axis=2) < 25) & (red > 30) & (red < 150))),
    }


def spread(picture: np.ndarray) -> int:
    """Pixels across what is neither page nor ground nor shadow: the orange cube excepted."""
    red, blue = picture[:, :, 0], picture[:, :, 2]
    columns = np.flatnonzero(np.any((red - blue > 12) & (red - blue < 60), axis=0))
    return int(np.ptp(columns))


def bare(tab: Tab) -> None:
    """Neither names nor forces, so that blocks alone are seen."""
    press(tab, "f", "n")


def test_the_plan_opens_at_the_whole_structure(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    assert tab.title() == "Order found for 5 blocks"
    says(tab, "place", "Step 0 of 5")
    seen = hues(pixels(tab))
    assert seen["stone"] > 20_000
    assert seen["next"] > 3000
    assert seen["force"] > 300


def test_dragging_turns_and_the_keyboard_does_too(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    first = pixels(tab)
    hover(tab, 0.5, 0.5)
    tab.mouse.down()
    hover(tab, 0.3, 0.4)
    tab.mouse.up()
    tab.mouse.move(1, 1)
    turned = pixels(tab)
    assert np.mean(np.any(turned != first, axis=2)) > 0.05
    press(tab, "0")
    back = pixels(tab)
    assert np.mean(np.any(back != first, axis=2)) < 1e-3
    for key in "adws":
        press(tab, key)
        assert np.mean(np.any(pixels(tab) != back, axis=2)) > 0.01, key
        press(tab, "0")


def test_zoom_and_pan(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    first = hues(pixels(tab))["stone"]
    press(tab, "+", "+")
    near = pixels(tab)
    assert hues(near)["stone"] > 1.4 * first
    hover(tab, 0.5, 0.5)
    tab.mouse.down(button="right")
    hover(tab, 0.7, 0.5)
    tab.mouse.up(button="right")
    tab.mouse.move(1, 1)
    warm = [
        np.flatnonzero(np.any(p[:, :, 0] - p[:, :, 2] > 90, axis=0)) for p in (near, pixels(tab))
    ]
    moved = warm[1].mean() - warm[0].mean()
    assert moved == pytest.approx(0.2 * near.shape[1], rel=0.15), "it follows the pointer"


def test_the_wheel_zooms_once_the_picture_was_clicked(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    first = hues(pixels(tab))["stone"]
    hover(tab, 0.05, 0.9)
    tab.mouse.wheel(0, -300)
    assert hues(pixels(tab))["stone"] == pytest.approx(first, rel=1e-3), "it scrolls the page"
    tab.mouse.down()
    tab.mouse.up()
    tab.mouse.wheel(0, -300)
    assert hues(pixels(tab))["stone"] > 1.4 * first


def test_fingers_turn_and_zoom(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()), has_touch=True)
    bare(tab)
    first = pixels(tab)
    box = tab.locator("#scene").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    touch = tab.context.new_cdp_session(tab)

    def fingers(kind: str, *places: tuple[float, float]) -> None:
        points = [{"x": px, "y": py, "id": i} for i, (px, py) in enumerate(places)]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    fingers("touchStart", (x, y))
    for step in range(1, 6):
        fingers("touchMove", (x + 20 * step, y))
    fingers("touchEnd")
    assert np.mean(np.any(pixels(tab) != first, axis=2)) > 0.05
    press(tab, "0")
    fingers("touchStart", (x - 50, y), (x + 50, y))
    for step in range(1, 6):
        fingers("touchMove", (x - 50 - 10 * step, y), (x + 50 + 10 * step, y))
    fingers("touchEnd")
    assert hues(pixels(tab))["stone"] > 1.5 * hues(first)["stone"]


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_a_section_hides_what_is_before_it(opened: Opener, axis: str) -> None:
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    whole = hues(pixels(tab))
    tab.select_option("#section", axis)
    expect(tab.locator("#depth")).to_be_visible()
    tab.locator("#depth").fill("1" if axis == "z" else "0.5")
    cut = pixels(tab)
    tab.locator("#depth").fill("0")
    low = hues(pixels(tab))
    tab.locator("#depth").fill("1")
    high = hues(pixels(tab))
    total = [sum(seen[kind] for kind in ("stone", "next")) for seen in (low, high)]
    assert min(total) < 0.2 * (whole["stone"] + whole["next"]), "at one end nothing is left"
    assert max(total) > 0.9 * (whole["stone"] + whole["next"]), "at the other everything"
    tab.click("#turn")
    assert not np.array_equal(pixels(tab), cut)
    tab.select_option("#section", "off")
    expect(tab.locator("#turn")).to_be_hidden()
    assert hues(pixels(tab)) == whole


def test_what_a_section_lays_bare_is_filled(opened: Opener) -> None:
    """Seen along the normal of a cut through the cubes there is stone, not their hollow inside."""
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    press(tab, "x", "x", "x")
    expect(tab.locator("#section")).to_have_value("z")
    tab.locator("#depth").fill("0.35")
    press(tab, *["w"] * 12)
    seen = hues(pixels(tab))
    assert seen["next"] == 0, "the one on top is cut away"
    assert seen["stone"] > 20_000


def test_the_slider_draws_blocks_apart(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    press(tab, "+")  # from here on the view stays as it is
    widths = []
    for value in ("0", "0.3", "0.6"):
        tab.locator("#explode").fill(value)
        widths.append(spread(pixels(tab)))
    assert widths[0] * 1.1 < widths[1] < widths[2]


def test_forces_can_be_switched_off_and_made_longer(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    press(tab, "n")
    shown = hues(pixels(tab))["force"]
    tab.locator("#length").fill("1.5")
    assert hues(pixels(tab))["force"] > 1.5 * shown
    tab.click("#forces")
    assert hues(pixels(tab))["force"] == 0


def test_colours_by_order(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    expect(tab.locator("#scale")).to_be_hidden()
    stone = hues(pixels(tab))["stone"]
    tab.click("#order")
    expect(tab.locator("#scale")).to_contain_text("last (5)")
    picture = pixels(tab)
    assert hues(picture)["stone"] < 0.1 * stone
    red, green, blue = (picture[:, :, i] for i in range(3))
    assert np.sum((green > 1.2 * red) & (green > 1.2 * blue)) > 3000, "green in the middle"
    assert np.sum((blue > 1.3 * green) & (red > green)) > 1000, "violet at last"
    press(tab, "o")
    assert hues(pixels(tab))["stone"] == stone


def test_hover_names_a_block_and_its_state(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    picture = pixels(tab)
    ys, xs = np.nonzero(picture[:, :, 0] - picture[:, :, 2] > 90)
    card = hover(tab, xs.mean() / picture.shape[1], ys.mean() / picture.shape[0])
    expect(card.locator("strong")).to_have_text("top")
    expect(card).to_contain_text("next to be taken away")
    expect(card).to_contain_text("1 kg (1 kg/m³)")
    press(tab, "ArrowRight")
    expect(card.locator("strong")).to_have_text("top")
    expect(card).to_contain_text("taken away in step 1")
    tab.mouse.move(1, 1)
    press(tab, "]", "]")
    expect(card.locator("strong")).to_have_text("low00")


def test_held_blocks_have_a_colour_of_their_own(opened: Opener) -> None:
    recording = plan_by_hand()
    held = np.zeros(recording.states.shape, dtype=bool)
    held[0, [body.name for body in recording.bodies].index("low00")] = True

    def reddish(tab: Tab) -> int:
        bare(tab)
        red, green, blue = (pixels(tab)[:, :, i] for i in range(3))
        return int(np.sum((red - green > 40) & (blue - green > 5)))

    assert reddish(opened(Page(recording))) == 0
    tab = opened(Page(replace(recording, held=held)))
    assert reddish(tab) > 500
    expect(tab.locator("#legend")).to_contain_text("held")
    press(tab, "ArrowRight")
    red, green, blue = (pixels(tab)[:, :, i] for i in range(3))
    assert int(np.sum((red - green > 40) & (blue - green > 5))) == 0


def test_play_takes_blocks_away(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    bare(tab)
    before = hues(pixels(tab))
    tab.select_option("#speed", "4")
    tab.click("#play")
    expect(tab.locator("#scrub")).to_have_value("5", timeout=20_000)
    says(tab, "caption", "0 left.")
    after = hues(pixels(tab))
    assert before["stone"] > 20_000
    assert after["stone"] + after["next"] == 0


def test_charts_and_scrubbing_are_those_of_the_plane(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    tab.locator("#scrub").fill("3")
    says(tab, "place", "Step 3 of 5")
    tab.click("#work summary")
    expect(tab.locator("#charts figure strong")).to_have_text("2")


def test_a_run_moves_and_what_is_motionless_is_dark(opened: Opener) -> None:
    tab = opened(Page(run_by_hand()))
    press(tab, "n")
    first = pixels(tab)
    assert hues(first)["still"] > 20_000
    tab.click("#play")
    expect(tab.locator("#scrub")).to_have_value("120", timeout=20_000)
    says(tab, "place", "0.500 s · step 120 of 120")
    says(tab, "caption", "4 of 5 blocks motionless")
    last = hues(pixels(tab))
    assert last["stone"] > hues(first)["stone"] + 2000, "what moves is light"
    expect(tab.locator("#order")).to_be_disabled()


def test_dark_and_light(opened: Opener) -> None:
    dark = pixels(opened(Page(plan_by_hand()), color_scheme="dark"))
    assert dark[2, 2].max() < 40


def test_everything_has_a_name_for_those_who_do_not_see_it(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()))
    for button in tab.locator("button, input, select").all():
        label = button.get_attribute("aria-label")
        assert label or button.inner_text() or button.evaluate("e => e.labels[0].textContent")


def test_narrow_windows(opened: Opener) -> None:
    tab = opened(Page(plan_by_hand()), width=420)
    assert tab.evaluate("document.documentElement.scrollWidth") <= 420


def test_within_a_notebook(opened: Opener) -> None:
    plays_within_a_notebook(opened, Page(plan_by_hand()))


def test_the_page_loads_nothing_and_runs_no_other_script() -> None:
    """The packed script is the one whose fingerprint the policy names."""
    text = Page(plan_by_hand()).html()
    assert "default-src 'none'" in text
    assert not re.search(r"""(src|href)\s*=\s*["']|@import|url\(""", text)
    data = re.search(r'<script id="script" type="application/octet-stream">(.*?)</script>', text)
    assert data is not None
    script = zlib.decompress(base64.b64decode(data[1]))
    assert base64.b64encode(hashlib.sha256(script).digest()).decode() in text
    assert b"Three.js Authors" in script, "whose work it is stays with it"


def test_nothing_to_show_is_a_page(opened: Opener) -> None:
    nothing = np.zeros((1, 0), dtype=np.uint8)
    tab = opened(Page(replace(plan_by_hand(), bodies=[], states=nothing, forces=None, series=[])))
    expect(tab.locator("#play")).to_be_disabled()


class TestWithoutWebGL:
    @pytest.fixture
    def browser(self, playwright: Playwright) -> Iterator[Browser]:
        browser = launched(playwright, "--disable-3d-apis")
        yield browser
        browser.close()

    def test_the_page_says_so_in_words(self, opened: Opener) -> None:
        tab = opened(Page(plan_by_hand()))
        expect(tab.locator("[role=alert]")).to_contain_text("needs WebGL 2")
