"""Names and numbers in text for people."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable
from difflib import get_close_matches

MOST_ROWS = 40
"""Longer tables are cut, with a line that says so."""

_TURNING = frozenset("\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Marks that change the direction of what follows: text around a name would turn with it."""

_UNSHOWN = frozenset({"Cc", "Cs", "Zl", "Zp"})
"""Control characters, halves of pairs, and ends of lines and paragraphs."""


def shown(text: str) -> str:
    r"""The text in one line, as it is but for what steers a terminal or a page: that as escapes.

    >>> shown("the [bold] $x^2$ block"), shown("two\nlines")
    ('the [bold] $x^2$ block', 'two\\nlines')
    """
    if text.isprintable():
        return text
    return "".join(_escaped(c) for c in text)


def _escaped(c: str) -> str:
    if c in _TURNING or unicodedata.category(c) in _UNSHOWN:
        return c.encode("unicode_escape").decode("ascii")
    return c


def like(word: str, known: Iterable[str]) -> str:
    """The nearest of the `known` words, as a question; empty if none is near.

    >>> like("Boden", ["wall", "boden"]), like("x", ["boden"])
    (" (did you mean 'boden'?)", '')
    """
    small = {name.casefold(): name for name in sorted(known)}
    near = get_close_matches(word.casefold(), small, n=1)
    return f" (did you mean {small[near[0]]!r}?)" if near else ""


def counted(number: int, thing: str, things: str | None = None) -> str:
    """1 block, 2 blocks; 1 body, 2 bodies where the plural is given."""
    return f"{number} {thing if number == 1 else things or thing + 's'}"


def ordinal(number: int) -> str:
    """1st, 12th, 22nd."""
    ending = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10)
    return f"{number}{ending or 'th'}"


NOTHING = 1e-9
"""A number smaller than this share of the largest of its kind is printed as 0: forces balance every
block to 1e-9, and places are rounded too, so that it says nothing."""


def digits(value: float, largest: float, count: int = 4) -> str:
    """So many digits of a number; 0 for what rounding left beside the largest of its kind.

    >>> digits(0.27182818, 1.0), digits(-1.4e-17, 1.0)
    ('0.2718', '0')
    """
    return f"{value:.{count}g}" if abs(value) > NOTHING * largest else "0"


def place(numbers: Iterable[float], count: int = 4) -> str:
    """(0.5, 1): a point or a direction, in four digits or so many.

    >>> place((0.5, 1.0)), place((-6.1e-17, -1.0), 3)
    ('(0.5, 1)', '(0, -1)')
    """
    given = [float(x) for x in numbers]
    largest = max(map(abs, given), default=0.0)
    return f"({', '.join(digits(x, largest, count) for x in given)})"


def shorten(names: Iterable[str], limit: int = 8) -> str:
    """The first few names, and how many more there are."""
    every = [shown(name) for name in names]
    if len(every) <= limit:
        return ", ".join(every)
    return ", ".join(every[:limit]) + f" and {len(every) - limit} more"
