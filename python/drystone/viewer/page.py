"""One self-contained page: the viewer's bundle with a recording in it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from functools import cache
from html import escape
from importlib.resources import files
from os import PathLike, fspath
from pathlib import Path

from drystone import _core
from drystone.common import later
from drystone.common.files import PAGE, PICTURES, ending_of, write_whole
from drystone.common.text import counted
from drystone.recording import budget
from drystone.recording.recording import Recording

INLINE_HEIGHT = 640
"""Pixels of a page within a notebook."""


class Page:
    """A recording that can be looked at: saved as a page, or shown by a notebook.

    The page loads nothing: it opens from disk, without a network. What it holds is bounded, see
    `drystone.recording.budget`, and it says what was left out.
    """

    __slots__ = ("recording",)

    def __init__(self, recording: Recording) -> None:
        self.recording = recording
        """What the page plays, complete."""

    def html(self, limit: budget.Budget = budget.FILE) -> str:
        """The text of the page."""
        recording = budget.bounded(self.recording, limit)
        template = _template(recording.dimension)
        data = json.dumps(recording.to_json(), separators=(",", ":"), allow_nan=False)
        parts = {
            "title": escape(recording.title),
            # Within a script element only this character could end it.
            "recording": data.replace("<", "\\u003c"),
        }
        return re.sub(r"\{\{(title|recording)\}\}", lambda found: parts[found[1]], template)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the page; the name ends in .html. The file is replaced whole or not at all."""
        ending_of(path, (PAGE,))
        write_whole(Path(path), self.html().encode())

    def show(self) -> None:
        """Show the page: below the cell of a notebook, from a script in the browser."""
        later.show(self)

    def save_frames(
        self,
        folder: str | PathLike[str],
        frames: Iterable[int] | None = None,
        suffix: str = ".png",
    ) -> list[Path]:
        """Draw frames (all by default) as pictures frame-00000.png, ...; return their paths.

        `suffix` is ".png", ".svg" or ".pdf". The folder is made if it is not there. All have
        the same view.
        """
        from drystone import pictures

        ending_of(f"frame{suffix}", PICTURES)
        target = Path(fspath(folder))
        target.mkdir(parents=True, exist_ok=True)
        written = []
        box = pictures.frames_box(self.recording)
        for frame in range(len(self.recording.states)) if frames is None else frames:
            path = target / f"frame-{frame:05}{suffix}"
            pictures.save(pictures.frame_figure(self.recording, frame, box), path)
            written.append(path)
        return written

    def _repr_html_(self) -> str:
        """A frame of its own, so that page and notebook do not touch each other."""
        return (
            f'<iframe srcdoc="{escape(self.html(budget.INLINE))}" sandbox="allow-scripts" '
            f'title="{escape(self.recording.title)}" width="100%" height="{INLINE_HEIGHT}" '
            'style="border: 0"></iframe>'
        )

    def __repr__(self) -> str:
        frames, bodies = self.recording.states.shape
        of = f"{counted(frames, 'frame')} of {counted(bodies, 'body', 'bodies')}"
        return f"<Page: {self.recording.kind}, {of}>"


@cache
def _template(dimension: int) -> str:
    """The bundle, which `make build` and every wheel put beside this file."""
    name = "space.html" if dimension == 3 else "page.html"
    try:
        return files("drystone.viewer").joinpath(name).read_text(encoding="utf-8")
    except FileNotFoundError:
        raise _core.DrystoneError(
            "the viewer's page is not built: run `make build` in the source tree"
        ) from None
