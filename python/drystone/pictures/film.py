"""A recording as a film, for slides and pages that play no HTML: an animated GIF, or MP4."""

from __future__ import annotations

import io
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from functools import singledispatch
from os import PathLike, fspath
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from drystone import _core
from drystone.common.drawn import DPI
from drystone.common.files import write_whole
from drystone.motion.run import Run
from drystone.pictures.canvas import rendered
from drystone.pictures.recording import frame_figure, frames_box
from drystone.planning.answer import Plan
from drystone.recording.of_plan import plan_recording
from drystone.recording.of_run import recording_of_run
from drystone.recording.recording import Recording

PER_SECOND = 25
"""Pictures a second of what moves."""

STEPS_PER_SECOND = 2
"""Steps of a plan a second."""


@singledispatch
def _recorded(thing: object) -> Recording:
    """The frames of a plan or a run; TypeError for what does not move."""
    raise TypeError(f"there is no film of a {type(thing).__name__}")


_recorded.register(Plan, plan_recording)
_recorded.register(Run, recording_of_run)


def save_film(
    thing: object,
    path: str | PathLike[str],
    dpi: float = DPI,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """The frames of a plan or a run, at the speed of the run; the name ends in .gif or .mp4.

    `progress` is called with (frames drawn, frames in all). DrystoneError for .mp4 without ffmpeg,
    TypeError for what does not move.
    """
    film_of(_recorded(thing), path, dpi, progress)


def film_of(
    recording: Recording,
    path: str | PathLike[str],
    dpi: float = DPI,
    progress: Callable[[int, int], None] | None = None,
) -> None:
    """The frames of a recording, those that `PER_SECOND` leaves of one that has times."""
    target = Path(fspath(path))
    ffmpeg = _ffmpeg() if target.suffix.lower() == ".mp4" else None
    frames, per_second = _chosen(recording)
    box = frames_box(recording)
    drawn: list[Image.Image] = []
    for frame in frames:
        figure = frame_figure(recording, frame, box)
        drawn.append(Image.open(io.BytesIO(rendered(figure, "png", dpi))))
        if progress is not None:
            progress(len(drawn), len(frames))
    pictures = _of_one_size(drawn)
    if ffmpeg is None:
        write_whole(target, _gif(pictures, per_second))
    else:
        write_whole(target, _mp4(pictures, per_second, ffmpeg))


def _chosen(recording: Recording) -> tuple[NDArray[np.int64], int]:
    """Which frames, and how many a second."""
    times = recording.times
    if times is None:
        return np.arange(len(recording.states)), STEPS_PER_SECOND
    at = np.arange(times[0], times[-1] + 0.5 / PER_SECOND, 1 / PER_SECOND)
    return np.minimum(np.searchsorted(times, at - 1e-9), len(times) - 1), PER_SECOND


def _of_one_size(pictures: list[Image.Image]) -> list[Image.Image]:
    """A note below of more lines makes a figure higher: all get the room of the highest. Even
    numbers of pixels, which MP4 asks for."""
    width = max(picture.width for picture in pictures) // 2 * 2
    height = (max(picture.height for picture in pictures) + 1) // 2 * 2
    made = []
    for picture in pictures:
        page = Image.new("RGB", (width, height), "white")
        page.paste(picture.convert("RGB"), (0, 0))
        made.append(page)
    return made


def _gif(pictures: list[Image.Image], per_second: int) -> bytes:
    out = io.BytesIO()
    first, *others = [picture.quantize(64) for picture in pictures]
    first.save(
        out,
        "GIF",
        save_all=True,
        append_images=others,
        duration=round(1000 / per_second),
        loop=0,
    )
    return out.getvalue()


def _mp4(pictures: list[Image.Image], per_second: int, ffmpeg: str) -> bytes:
    width, height = pictures[0].size
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "film.mp4"
        given = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
        coded = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
        command = [ffmpeg, "-loglevel", "error", "-r", str(per_second), *given, "-i", "-", *coded]
        ended = subprocess.run(
            [*command, str(made)],
            input=b"".join(picture.tobytes() for picture in pictures),
            capture_output=True,
            check=False,
        )
        if ended.returncode != 0:
            said = " ".join(ended.stderr.decode(errors="replace").split())[:200]
            raise _core.DrystoneError(f"ffmpeg could not make the film: {said}")
        return made.read_bytes()


def _ffmpeg() -> str:
    found = shutil.which("ffmpeg")
    if found is not None:
        return found
    try:
        from imageio_ffmpeg import get_ffmpeg_exe
    except ImportError:
        raise _core.DrystoneError(
            "an .mp4 needs ffmpeg: install it (pip install imageio-ffmpeg), or save a .gif"
        ) from None
    return str(get_ffmpeg_exe())
