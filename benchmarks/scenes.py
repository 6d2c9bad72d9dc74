"""The assemblies measured, by their names in the results."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from dataclasses import dataclass

import drystone as ds

FRICTIONS = (0.0, 0.5)


@dataclass(frozen=True, slots=True)
class Row:
    """One assembly with one coefficient of friction."""

    scene: str
    friction: float

    def build(self) -> ds.Scene:
        """The scene itself."""
        return SCENES[self.scene](self.friction)

    def build_within(self, seconds: float) -> ds.Scene | None:
        """The scene, made in a process of its own that is stopped after `seconds`."""
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            try:
                return pool.apply_async(self.build).get(seconds)
            except multiprocessing.TimeoutError:
                return None

    def __str__(self) -> str:
        return f"{self.scene}, friction {self.friction:g}"


SCENES: dict[str, Callable[[float], ds.Scene]] = {
    "col80": lambda mu: ds.scenes.column(80, friction=mu),
    "col400": lambda mu: ds.scenes.column(400, friction=mu),
    "col2000": lambda mu: ds.scenes.column(2000, friction=mu),
    "pyr13": lambda mu: ds.scenes.pyramid(13, friction=mu),
    "pyr31": lambda mu: ds.scenes.pyramid(31, friction=mu),
    "pyr70": lambda mu: ds.scenes.pyramid(70, friction=mu),
    "random84": lambda mu: ds.scenes.random_stack(84, friction=mu),
    "random1000": lambda mu: ds.scenes.random_stack(1000, friction=mu),
    "arch200": lambda mu: ds.scenes.arch(voussoirs=200, thickness=0.2, friction=mu),
}

FAMILIES = {
    "column": ("col80", "col400", "col2000"),
    "pyramid": ("pyr13", "pyr31", "pyr70"),
    "random": ("random84", "random1000"),
}
"""Scenes that differ in size only: an exponent is fitted to each family."""

QUICK = ("col80", "pyr13")


def rows(names: tuple[str, ...]) -> list[Row]:
    """Each scene without and with friction."""
    return [Row(name, friction) for name in names for friction in FRICTIONS]
