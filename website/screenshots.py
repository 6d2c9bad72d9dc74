"""Pictures of the viewer's pages, as the guide shows them: needs Chromium.

    .venv/bin/python website/screenshots.py [folder]

`make pictures` leaves them as they are, since not every machine has a browser.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

import drystone as ds

FOLDER = Path(__file__).parent.parent / "docs" / "pictures"
SIZE = {"width": 980, "height": 720}
"""Pixels."""
SHADER = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""WebGL without a graphics card."""


def plane(page: Page) -> None:
    """A heap after 20 blocks of it have gone."""
    for _ in range(2):
        page.keyboard.press("Shift+ArrowRight")


def space(page: Page) -> None:
    """A pyramid of cubes, cut open across x."""
    page.keyboard.press("ArrowRight")
    page.keyboard.press("x")


PICTURES = {
    "viewer": (lambda: ds.plan(ds.scenes.random_stack(84)), plane),
    "viewer-space": (lambda: ds.plan(ds.scenes.square_pyramid(4)), space),
}
"""Name of the picture, whose page it is of, and what is done on the page."""

if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", *SHADER]
        )
        for name, (answer, act) in PICTURES.items():
            path = Path(folder, f"{name}.html")
            answer().draw(path)
            page = browser.new_page(viewport=SIZE)
            page.goto(path.as_uri())
            page.wait_for_timeout(2000)
            act(page)
            page.wait_for_timeout(1500)
            page.screenshot(path=target / f"{name}.png", full_page=True)
        browser.close()
