"""Draw the figure of paper.md: `python paper/figures.py` writes figures.png beside this file."""

from __future__ import annotations

import tempfile
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.image import imread

import drystone as ds

HERE = Path(__file__).parent


def main() -> None:
    wall = ds.scenes.wall(6, columns=8, friction=0.6)
    heap = ds.plan(ds.scenes.random_stack(84))
    collapse = ds.limit(wall, push={"43": (1.0, 0.0)})  # the first block of the top course
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "answer.png"
        for axes, answer in zip(figure.subplots(1, 2), (heap, collapse), strict=True):
            answer.draw(path)
            axes.imshow(imread(path))
            axes.set_axis_off()
    figure.savefig(HERE / "figures.png", dpi=150)


if __name__ == "__main__":
    main()
