"""A page open in Chromium, without a network: how it is opened, what is done and looked for there.

Without Chromium the tests that need it are skipped, except where CI is set: there it has to be.
"""

from __future__ import annotations

import io
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Browser, Locator, Playwright, expect, sync_playwright
from playwright.sync_api import Page as Tab

from drystone.viewer import Page

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
FLAGS = [
    "--no-sandbox",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]
READY = "#viewer[aria-busy=false]"
COUNT_FRAMES = """
const ask = window.requestAnimationFrame.bind(window);
window.nextFrame = ask;
window.framesAsked = 0;
window.requestAnimationFrame = (draw) => {
    window.framesAsked++;
    return ask((now) => {
        window.framesAsked--;
        draw(now);
    });
};
"""
"""The page asks for frames as long as something moves."""
FRAMES = """(rest) => new Promise((done) => {
    let calm = 0;
    const look = () => {
        calm = rest && window.framesAsked ? 0 : calm + 1;
        if (calm > 2) done();
        else window.nextFrame(look);
    };
    look();
})"""
Opener = Callable[..., Tab]


@pytest.fixture(scope="session")
def playwright() -> Iterator[Playwright]:
    """One for all browsers: a thread has no second one."""
    if CHROMIUM is None and not os.environ.get("CI"):
        pytest.skip("no chromium on this machine")
    assert CHROMIUM is not None, "CI needs chromium: see .ci/run"
    with sync_playwright() as started:
        yield started


def launched(playwright: Playwright, *flags: str) -> Browser:
    return playwright.chromium.launch(executable_path=CHROMIUM, args=[*FLAGS, *flags])


@pytest.fixture(scope="module")
def browser(playwright: Playwright) -> Iterator[Browser]:
    """Without a graphics card; tests that need WebGL have their own."""
    browser = launched(playwright, "--disable-gpu")
    yield browser
    browser.close()


@pytest.fixture
def opened(browser: Browser, tmp_path: Path) -> Iterator[Opener]:
    """Open a page from disk; at the end nothing was asked of a network and nothing complained."""
    complaints: list[str] = []
    asked: list[str] = []
    contexts = []

    def open_page(page: Page | str, width: int = 1000, height: int = 800, **options: str) -> Tab:
        path = tmp_path / f"{len(contexts)}.html"
        path.write_text(page if isinstance(page, str) else page.html())
        context = browser.new_context(
            viewport={"width": width, "height": height},
            offline=True,
            **options,  # type: ignore[arg-type]
        )
        context.add_init_script(COUNT_FRAMES)
        contexts.append(context)
        tab = context.new_page()
        tab.on("console", lambda message: complaints.append(message.text))
        tab.on("pageerror", lambda error: complaints.append(str(error)))
        tab.on("request", lambda request: asked.append(request.url))
        tab.goto(path.as_uri())
        tab.wait_for_selector(READY)
        return tab

    yield open_page
    for context in contexts:
        context.close()
    assert complaints == []
    assert all(url.startswith(("file://", "data:", "about:", "blob:")) for url in asked), asked


LIGHT = {
    "stone": "#e4dccb",
    "still": "#6b7178",
    "next": "#e69f00",
    "force": "#005fa3",
    "held": "#c2185b",
}
"""Colours of the page where it is light."""


def says(tab: Tab, identifier: str, text: str) -> None:
    """Wait until an element says this: the page answers in its next animation frame."""
    expect(tab.locator(f"#{identifier}")).to_have_text(text)


def settle(tab: Tab) -> None:
    """Wait until the page shows what was just asked for, and fades are over."""
    tab.evaluate(FRAMES, True)


def pixels(tab: Tab) -> np.ndarray:
    """(height, width, 3) of the picture, drawn after what was just asked for."""
    from matplotlib.image import imread

    settle(tab)
    shot = io.BytesIO(tab.locator("#scene").screenshot())
    picture: np.ndarray = (255 * imread(shot, format="png")[:, :, :3]).round().astype(int)
    return picture


def count(picture: np.ndarray, colour: str) -> int:
    """Pixels of a colour of the page."""
    wanted = [int(colour[i : i + 2], 16) for i in (1, 3, 5)]
    return int(np.sum(np.all(np.abs(picture - wanted) <= 2, axis=2)))


def press(tab: Tab, *keys: str) -> None:
    for key in keys:
        tab.keyboard.press(key)
    tab.evaluate(FRAMES, False)  # it may play from now on


def hover(tab: Tab, x: float, y: float) -> Locator:
    """Move the pointer to a place of the picture, as shares of its width and height."""
    box = tab.locator("#scene").bounding_box()
    assert box is not None
    tab.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"])
    settle(tab)
    return tab.locator("#card")


def find(tab: Tab, colour: str) -> tuple[float, float]:
    """The middle of what has a colour, as shares of the picture."""
    picture = pixels(tab)
    wanted = [int(colour[i : i + 2], 16) for i in (1, 3, 5)]
    ys, xs = np.nonzero(np.all(np.abs(picture - wanted) <= 2, axis=2))
    return float(np.mean(xs) / picture.shape[1]), float(np.mean(ys) / picture.shape[0])


def plays_within_a_notebook(opened: Opener, page: Page) -> None:
    """The notebook's frame, in a page of another, runs without touching what is around it."""
    frame = page._repr_html_()
    tab = opened(f'<!doctype html><main id="viewer" aria-busy="false">{frame}</main>')
    inner = tab.frame_locator("iframe")
    inner.locator(READY).wait_for()
    inner.locator("#forward").click()
    expect(inner.locator("#place")).to_have_text("Step 1 of 5")
