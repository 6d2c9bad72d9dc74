"""Recordings as SVG pictures that move: small files, sharp at any size, no script.

A picture holds every body once. What changes (where it is, its colour, the forces) is written as
CSS keyframes, so a browser plays it in a loop, also inside an `<img>` of a README. Who asks the
browser for less motion sees the first frame, at rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape

import numpy as np
from numpy.typing import NDArray

from drystone.pictures import style

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif"
MARGIN = 14.0
"""Pixels around the drawing."""
TEXT_HEIGHT = 34.0
"""Pixels under the drawing for one line of text, where there is one."""


@dataclass(frozen=True, slots=True)
class View:
    """Metres to pixels: y points up in a scene and down in a picture."""

    box: tuple[float, float, float, float]
    """(left, bottom, right, top) of what is shown, metres."""
    width: float = 640.0
    """Pixels of the whole picture."""

    @property
    def scale(self) -> float:
        """Pixels a metre."""
        return (self.width - 2 * MARGIN) / (self.box[2] - self.box[0])

    @property
    def height(self) -> float:
        """Pixels of the drawing, its margins included, without the text."""
        return self.scale * (self.box[3] - self.box[1]) + 2 * MARGIN

    def at(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """(n, 2) pixels of (n, 2) metres."""
        left, _, _, top = self.box
        pixels: NDArray[np.float64] = MARGIN + self.scale * (points - (left, top)) * (1, -1)
        return pixels


@dataclass(slots=True)
class Film:
    """A picture of `frames` states, shown one after another in `seconds`, again and again."""

    view: View
    frames: int
    seconds: float
    title: str
    """What a reader who sees no picture is told."""
    body: list[str] = field(default_factory=list)
    css: list[str] = field(default_factory=list)

    def polygon(self, corners: NDArray[np.float64], fill: str, **more: str) -> str:
        """The element of one polygon, corners in metres."""
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in self.view.at(corners))
        return _element("polygon", points=points, fill=fill, **more)

    def add(self, *elements: str) -> None:
        """Draw over what is there."""
        self.body.extend(elements)

    def steps(self, property_: str, values: Sequence[str], element: str) -> str:
        """The element with a CSS property that jumps from frame to frame."""
        return self._animated(property_, values, element, "step-end")

    def moving(self, values: Sequence[str], element: str, property_: str = "transform") -> str:
        """The element with a CSS property that goes evenly from frame to frame."""
        return self._animated(property_, values, element, "linear")

    def shown(self, when: Sequence[bool], element: str) -> str:
        """The element, there in some frames and not in others."""
        return self.steps("visibility", ["visible" if one else "hidden" for one in when], element)

    def say(self, lines: Sequence[str]) -> None:
        """One line of text under the drawing for each frame."""
        y = self.view.height + TEXT_HEIGHT / 2
        for line in dict.fromkeys(lines):
            text = _element("text", escape(line), x=f"{self.view.width / 2:g}", y=f"{y:g}")
            self.add(self.shown([one == line for one in lines], text))

    def svg(self) -> str:
        """The text of the file."""
        width, height = self.view.width, self.view.height + TEXT_HEIGHT
        still = "@media(prefers-reduced-motion:reduce){*{animation:none!important}}"
        text = f"text{{font:14px {FONT};fill:{style.INK};text-anchor:middle}}"
        return "\n".join(
            [
                f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" '
                f'width="{width:g}" height="{height:g}" role="img">',
                f"<title>{escape(self.title)}</title>",
                "<style>",
                f"polygon{{stroke:{style.INK};stroke-width:1;stroke-linejoin:round}}",
                text,
                *self.css,
                still,
                "</style>",
                f'<rect width="{width:g}" height="{height:g}" rx="8" fill="#fff"/>',
                *self.body,
                "</svg>\n",
            ]
        )

    def _animated(self, name: str, values: Sequence[str], element: str, timing: str) -> str:
        """Keyframes where the value changes; none if it never does."""
        if len(values) != self.frames:
            raise ValueError(f"{len(values)} values for {self.frames} frames")
        tag, rest = _split(element)
        if len(set(values)) == 1:
            return f'{tag} style="{name}:{values[0]}"{rest}'
        key = f"a{len(self.css)}"
        stops = [
            f"{100 * k / self.frames:.5g}%{{{name}:{value}}}"
            for k, value in enumerate(values)
            if _needed(values, k, timing == "linear")
        ]
        # Evenly moving pictures rest on their last frame, then begin again.
        stops.append(f"100%{{{name}:{values[-1]}}}")
        self.css.append(f"@keyframes {key}{{{''.join(stops)}}}")
        self.css.append(
            f".{key}{{{name}:{values[0]};animation:{key} {self.seconds:g}s {timing} infinite}}"
        )
        return f'{tag} class="{key}"{rest}'


def arrow(view: View, tail: NDArray[np.float64], vector: NDArray[np.float64], width: float) -> str:
    """A path: a shaft and a head, from `tail` along `vector`, both in metres; `width` in pixels."""
    (x, y), (u, v) = view.at(tail[None])[0], view.at((tail + vector)[None])[0]
    length = float(np.hypot(u - x, v - y))
    if length < 1.0:
        return ""
    along = np.array([u - x, v - y]) / length
    across = np.array([-along[1], along[0]])
    head = min(4.0 * width, 0.6 * length)
    neck = np.array([u, v]) - head * along
    left, right = neck + 0.5 * head * across, neck - 0.5 * head * across
    return (
        f"M{x:.1f} {y:.1f}L{neck[0]:.1f} {neck[1]:.1f}"
        f"M{left[0]:.1f} {left[1]:.1f}L{u:.1f} {v:.1f}L{right[0]:.1f} {right[1]:.1f}z"
    )


def _split(element: str) -> tuple[str, str]:
    """An element's beginning, such as `<g`, and what follows."""
    end = next(k for k, character in enumerate(element) if character in " >")
    return element[:end], element[end:]


def _needed(values: Sequence[str], k: int, evenly: bool) -> bool:
    """Whether a keyframe says something that its neighbours do not."""
    if k == 0 or values[k] != values[k - 1]:
        return True
    return evenly and k + 1 < len(values) and values[k] != values[k + 1]


def _element(tag: str, content: str = "", **attributes: str) -> str:
    inside = "".join(f' {name.replace("_", "-")}="{value}"' for name, value in attributes.items())
    return f"<{tag} {inside.strip()}>{content}</{tag}>" if content else f"<{tag} {inside.strip()}/>"
