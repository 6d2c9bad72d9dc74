"""Files of other tools where a scene is wanted: what they are, and what to do."""

from __future__ import annotations

import json
from pathlib import Path

from drystone.imports.compas_kind import is_assembly
from drystone.meshes.reading import ENDINGS

UNREAD = (".dxf", ".dwg", ".skp", ".3dm", ".ifc", ".blend", ".fbx", ".dae", ".usd")
"""Drawings and models that drystone does not read."""

OUT_OF_CAD = (
    "export the blocks as closed meshes, one object each (.obj, .3mf, .step), or give their "
    "corners to Scene.add_polygon"
)
"""What to do with them."""

MARKUP = (".xml", ".mjcf", ".urdf")

OTHERS = (".svg", ".png", ".pdf", ".html", ".npz", ".csv", ".jpg", ".gif", ".mp4", ".bmp")
"""Names that say of a file that it is no scene."""

MOST_BYTES = 1 << 28
"""Larger files are not looked into."""


def kind_of(path: Path) -> str | None:
    """What a file of another tool is, as in "a mesh"; None for what is not known."""
    if path.is_dir():
        return "a folder"
    if not path.exists():
        return None
    if path.suffix.lower() in ENDINGS:
        return "a mesh"
    try:
        if path.stat().st_size > MOST_BYTES:
            return None
        text = path.read_bytes().lstrip()
    except OSError:
        return None
    if text.startswith(b"<"):
        kinds = {b"<mujoco": "an MJCF model", b"<robot": "a URDF model"}
        return next((kind for tag, kind in kinds.items() if tag in text), None)
    return _kind_of_json(text)


def _kind_of_json(text: bytes) -> str | None:
    try:
        data = json.loads(text)
        if is_assembly(data):
            return "a file of COMPAS"
    except (ValueError, RecursionError):
        return None
    return "a manifest of parts" if isinstance(data, dict) and "parts" in data else None


def advice(path: Path) -> str | None:
    """One line for a file of another tool that was given as a scene."""
    if path.suffix.lower() in UNREAD and path.exists():
        return f"{path}: {unread(path)}"
    if path.suffix.lower() in OTHERS and path.is_file():
        return f"{path}: no scene, by its name: a scene is a .json file"
    kind = kind_of(path)
    if kind is None:
        return None
    return (
        f"{path}: this is {kind}, not a scene: make one of it first with "
        f"drystone import {path} -o scene.json, or drystone.imports.load"
    )


def unread(path: Path) -> str:
    """What to say of a drawing."""
    return f"{path.suffix.lower()} is not read: {OUT_OF_CAD}"


def lies(path: Path) -> bool:
    """Whether a name says that the file is something else than JSON."""
    return path.suffix.lower() in (*ENDINGS, *MARKUP, *OTHERS, *UNREAD)
