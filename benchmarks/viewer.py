"""How large are the pages of plans, and how long does a frame take to draw?

    .venv/bin/python benchmarks/viewer.py

Opens each page in Chromium without a GPU (1600 x 1000 pixels), plays it at twice its speed for some
seconds, and times the page's own work: its script in each animation frame, and the time from one
frame to the next, which has the browser's painting in it too. 60 frames a second are 16.7 ms.
"""

from __future__ import annotations

import shutil
import tempfile
import time
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, sync_playwright

import drystone as ds

SCENES = {
    "random, 84 blocks": lambda: ds.scenes.random_stack(84),
    "column of 1000": lambda: ds.scenes.column(1000),
    "pyramid of 990": lambda: ds.scenes.pyramid(44),
    "wall of 1035, friction": lambda: ds.scenes.wall(30, 34),
}
SECONDS = 4
TIMED = """
const request = window.requestAnimationFrame.bind(window);
window.frames_ = [];
window.requestAnimationFrame = (draw) => request((now) => {
    const begun = performance.now();
    draw(now);
    window.frames_.push([begun, performance.now() - begun]);
});
"""


def main() -> None:
    print(
        f"{'scene':24}{'forces s':>9}{'MB':>7}{'inline':>8}{'load ms':>9}"
        f"{'script ms: median':>19}{'95 %':>6}{'max':>6}{'between: median':>17}{'95 %':>6}"
    )
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
        )
        for name, scene in SCENES.items():
            plan = ds.plan(scene())
            begun = time.perf_counter()
            page = plan.view()
            forces = time.perf_counter() - begun
            path = Path(folder) / "plan.html"
            page.save(path)
            inline = len(page._repr_html_()) / 1e6
            size = path.stat().st_size / 1e6
            load, script, between = played(browser, path)
            print(
                f"{name:24}{forces:9.1f}{size:7.2f}{inline:8.2f}{load:9.0f}"
                f"{np.median(script):19.1f}{np.quantile(script, 0.95):6.1f}{script.max():6.1f}"
                f"{np.median(between):17.1f}{np.quantile(between, 0.95):6.1f}",
                flush=True,
            )


def played(browser: Browser, path: Path) -> tuple[float, np.ndarray, np.ndarray]:
    """Milliseconds: until the page is ready, of script in each frame, between frames."""
    tab = browser.new_page(viewport={"width": 1600, "height": 1000})
    tab.add_init_script(TIMED)
    begun = time.perf_counter()
    tab.goto(path.as_uri())
    tab.wait_for_selector("#viewer[aria-busy=false]")
    load = 1e3 * (time.perf_counter() - begun)
    tab.select_option("#speed", "2")
    tab.click("#play")
    tab.evaluate("window.frames_ = []")
    tab.wait_for_timeout(1000 * SECONDS)
    frames = np.array(tab.evaluate("window.frames_"))
    tab.close()
    return load, frames[:, 1], np.diff(frames[:, 0])


if __name__ == "__main__":
    main()
