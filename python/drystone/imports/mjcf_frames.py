"""Frames of MJCF: positions and the five ways to write an orientation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from drystone.imports.collected import FormatError
from drystone.imports.markup import values
from drystone.imports.pose import Pose, from_axis_angle, from_euler, from_quaternion

if TYPE_CHECKING:
    from numpy.typing import NDArray


ORIENTATIONS = ("quat", "euler", "axisangle", "xyaxes", "zaxis")
"""Attributes that turn a frame; the first that is given counts."""


@dataclass(frozen=True, slots=True)
class Frames:
    """How a model writes angles, as its <compiler> says."""

    degrees: bool
    sequence: str
    """Axes of Euler angles; those in lower case turn along."""

    @classmethod
    def of(cls, compiler: dict[str, str]) -> Frames:
        """The compiler's settings, or the defaults."""
        return cls(compiler.get("angle", "degree") == "degree", compiler.get("eulerseq", "xyz"))

    def pose(self, attributes: dict[str, str], position: str = "pos") -> Pose:
        """The frame that an element's attributes give; FormatError with its name, if it has one."""
        try:
            at = values(attributes.get(position, "0 0 0"), 3, position)
            return Pose(np.array(at), self.rotation(attributes))
        except FormatError as error:
            name = attributes.get("name")
            raise (FormatError(f"{name}: {error}") if name else error) from None

    def rotation(self, attributes: dict[str, str]) -> NDArray[np.float64]:
        """The rotation matrix (3, 3) of an element's attributes."""
        unit = math.pi / 180 if self.degrees else 1.0
        try:
            if "quat" in attributes:
                return from_quaternion(values(attributes["quat"], 4, "quat"))
            if "euler" in attributes:
                angles = [unit * x for x in values(attributes["euler"], 3, "euler")]
                # MuJoCo writes axes that turn along in lower case, SciPy in upper case.
                return from_euler(self.sequence.swapcase(), angles)
            if "axisangle" in attributes:
                *axis, angle = values(attributes["axisangle"], 4, "axisangle")
                return from_axis_angle(axis, unit * angle)
            if "xyaxes" in attributes:
                six = np.array(values(attributes["xyaxes"], 6, "xyaxes"))
                return _from_axes(six[:3], six[3:])
            if "zaxis" in attributes:
                return _shortest_turn(np.array(values(attributes["zaxis"], 3, "zaxis")))
        except FormatError:
            raise
        except (ValueError, FloatingPointError) as error:
            given = next(key for key in ORIENTATIONS if key in attributes)
            text = attributes[given]
            raise FormatError(f"{given}: {text!r} is no orientation ({error})") from None
        return np.eye(3)


def between(attributes: dict[str, str], what: str) -> tuple[Pose, float]:
    """The frame in the middle of `fromto`, its z axis along it, and half its length."""
    six = np.array(values(attributes["fromto"], 6, f"{what}: fromto"))
    along = six[3:] - six[:3]
    half = float(np.linalg.norm(along)) / 2
    if half == 0:
        raise FormatError(f"{what}: fromto has no length")
    return Pose((six[:3] + six[3:]) / 2, _shortest_turn(along)), half


def _from_axes(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    with np.errstate(invalid="ignore", divide="ignore"):
        x = x / np.linalg.norm(x)
        y = y - (y @ x) * x
        y = y / np.linalg.norm(y)
    rotation = np.stack([x, y, np.cross(x, y)], axis=1)
    if not np.isfinite(rotation).all():
        raise ValueError("its axes are parallel or zero")
    return rotation


def _shortest_turn(z: NDArray[np.float64]) -> NDArray[np.float64]:
    """The smallest rotation that takes the z axis there."""
    if not z.any():
        raise ValueError("its axis is zero")
    direction = z / np.linalg.norm(z)
    axis = np.cross([0.0, 0.0, 1.0], direction)
    angle = math.atan2(float(np.linalg.norm(axis)), float(direction[2]))
    return from_axis_angle(axis.tolist() if axis.any() else [1.0, 0.0, 0.0], angle)
