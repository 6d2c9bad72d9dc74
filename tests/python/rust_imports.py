"""Which file of a Rust crate uses what another file defines, and where files do so in a circle.

A re-export (`pub use`) hands on what is defined elsewhere: it is looked through, and is no use of
its own.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

Module = tuple[str, ...]

_TEST_ITEM = re.compile(r"#\[cfg\(test\)\]\s*(?:#\[[^\]]*\]\s*)*")
_USE = re.compile(r"\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);")
_PATH = re.compile(r"\b(?:crate|super|self)(?:::\w+)+")
_OF_CHILD = re.compile(r"(?<![\w:])(?!crate\b|super\b|self\b)\w+(?:::\w+)+")
"""What a file says of a module below it, without a `use`."""
_DEFINES = r"\b(?:struct|enum|trait|fn|const|static|type|union|macro_rules!)\s+{}\b"


def circles(crate: Path) -> list[list[str]]:
    """Groups of files that use one another, directly or through others; tests do not count."""
    sources = Crate(crate / "src")
    modules = sorted(sources.texts)
    number = {module: k for k, module in enumerate(modules)}
    ends = np.array([[number[end] for end in arrow] for arrow in sources.arrows()], dtype=int)
    graph = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(len(modules),) * 2)
    _, labels = connected_components(graph, directed=True, connection="strong")
    groups = [np.flatnonzero(labels == label) for label in np.unique(labels)]
    return [["::".join(modules[k]) or "lib" for k in group] for group in groups if len(group) > 1]


class Crate:
    """The modules of a crate: each is a file."""

    def __init__(self, src: Path) -> None:
        self.texts = {
            _module(path.relative_to(src)): _code(path.read_text()) for path in src.rglob("*.rs")
        }
        self.uses = {module: self._used(module) for module in self.texts}
        self.reexports = {module: self._reexported(module) for module in self.texts}

    def arrows(self) -> list[tuple[Module, Module]]:
        """From each file to those that define what it uses."""
        found = [
            (module, self._definer(*path)) for module, paths in self.uses.items() for path in paths
        ]
        return [(user, used) for user, used in found if user != used]

    def _used(self, module: Module) -> list[tuple[Module, Module]]:
        """What a file uses of its crate: a module to begin at, and the way from there."""
        text = self.texts[module]
        names = [
            path for public, tree in _USE.findall(text) if not public for path in _expand(tree)
        ]
        rest = _USE.sub("", text)
        names += [match.split("::") for match in _PATH.findall(rest)]
        names += [match.split("::") for match in _OF_CHILD.findall(rest)]
        return self._begun(module, names)

    def _reexported(self, module: Module) -> list[tuple[Module, Module]]:
        uses = _USE.findall(self.texts[module])
        return self._begun(module, [path for _, tree in uses for path in _expand(tree)])

    def _begun(self, module: Module, names: list[list[str]]) -> list[tuple[Module, Module]]:
        return [path for name in names if (path := self._begin(module, name))]

    def _begin(self, module: Module, path: list[str]) -> tuple[Module, Module] | None:
        if path[0] == "crate":
            return (), tuple(path[1:])
        if path[0] == "self":
            return module, tuple(path[1:])
        if path[0] == "super":
            up = next((k for k, name in enumerate(path) if name != "super"), len(path))
            return module[: len(module) - up], tuple(path[up:])
        return (module, tuple(path)) if (*module, path[0]) in self.texts else None

    def _definer(self, module: Module, path: Module, depth: int = 0) -> Module:
        """The file in which the item at the end of a path is defined, through re-exports."""
        while path and (*module, path[0]) in self.texts:
            module, path = (*module, path[0]), path[1:]
        if (
            not path
            or depth > 8
            or re.search(_DEFINES.format(re.escape(path[0])), self.texts[module])
        ):
            return module
        for start, way in self.reexports[module]:
            if way and way[-1] == path[0]:
                return self._definer(start, way, depth + 1)
        return module


def _module(path: Path) -> Module:
    parts = path.with_suffix("").parts
    return parts[:-1] if parts[-1] in ("mod", "lib") else parts


def _code(text: str) -> str:
    """Without comments, strings and tests."""
    text = re.sub(r"//[^\n]*", "", text)
    text = re.sub(r'"(?:[^"\\]|\\.)*"', '""', text)
    kept, at = "", 0
    while test := _TEST_ITEM.search(text, at):
        kept += text[at : test.start()]
        at = _end_of_item(text, test.end())
    return kept + text[at:]


def _end_of_item(text: str, at: int) -> int:
    depth = 0
    for k in range(at, len(text)):
        depth += {"{": 1, "}": -1}.get(text[k], 0)
        if depth == 0 and text[k] in "};":
            return k + 1
    return len(text)


def _expand(tree: str) -> list[list[str]]:
    """The paths of a `use` with braces."""
    tree = re.sub(r"\s+as\s+\w+$", "", tree.strip())
    match = re.match(r"((?:\w+::)*)\{(.*)\}$", tree, re.DOTALL)
    if not match:
        return [[part.strip() for part in tree.split("::") if part.strip()]]
    prefix = [part for part in match[1].split("::") if part]
    items, depth = [""], 0
    for character in match[2]:
        depth += {"{": 1, "}": -1}.get(character, 0)
        if character == "," and depth == 0:
            items.append("")
        else:
            items[-1] += character
    return [prefix + path for item in items if item.strip() for path in _expand(item)]
