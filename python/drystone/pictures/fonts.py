"""Names in any script: fonts that have what matplotlib's own has not, where there are any."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache

from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties, findfont, fontManager, get_font
from matplotlib.text import Text

OTHERS = (
    *(f"Noto Sans CJK {region}" for region in ("SC", "JP", "KR", "TC", "HK")),
    *(f"Noto Sans {script}" for script in ("SC", "JP", "KR", "TC")),
    "Source Han Sans SC",
    "WenQuanYi Zen Hei",
    "WenQuanYi Micro Hei",
    "Droid Sans Fallback",
    "IPAexGothic",
    "Microsoft YaHei",
    "SimHei",
    "Yu Gothic",
    "Meiryo",
    "Malgun Gothic",
    "PingFang SC",
    "Hiragino Sans",
    "Apple SD Gothic Neo",
    "Nanum Gothic",
    "NanumGothic",
    "Arial Unicode MS",
    "Noto Sans",
    "Noto Sans Arabic",
    "Noto Sans Hebrew",
    "Noto Sans Devanagari",
    "Noto Sans Thai",
)
"""Of Linux, Windows and macOS, those for Chinese, Japanese and Korean first."""

MOST_SAID = 10
"""Characters that are listed in a warning."""


_said: set[str] = set()
"""Warnings that were given: a film has many pictures."""


@contextmanager
def fonts_for_names(figure: Figure, *, text: bool) -> Iterator[None]:
    """Each text that its fonts cannot write whole has the other fonts that are installed too.

    A UserWarning says once which characters no font has, in place of matplotlib's for each. `text`
    says that the file's text is text: then the fonts are those of whoever looks at it.
    """
    incomplete = _incomplete(figure)
    if not incomplete:
        yield
        return
    if not text:
        _say(_take_fonts(incomplete))
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from", UserWarning)
        yield


def _say(missing: Sequence[str]) -> None:
    if not missing:
        return
    some = " ".join(missing[:MOST_SAID])
    more = f" and {len(missing) - MOST_SAID} more" if len(missing) > MOST_SAID else ""
    text = (
        f"no font here has {some}{more}: they are boxes in the picture; install one that has (Noto "
        "Sans CJK for Chinese, Japanese and Korean), or draw an .svg"
    )
    if text not in _said:
        _said.add(text)
        warnings.warn(text, stacklevel=5)


def _incomplete(figure: Figure) -> list[Text]:
    """The texts with characters that their fonts have not."""
    texts = [text for text in figure.findobj(Text) if isinstance(text, Text)]
    return [
        text
        for text in texts
        if not text.get_text().isascii() and _missing(text.get_text(), _families(text))
    ]


def _take_fonts(texts: Sequence[Text]) -> list[str]:
    """The characters that remain without one."""
    there = set(fontManager.get_font_names())
    missing: dict[str, None] = {}
    for text in texts:
        text.set_fontfamily([*_families(text), *(name for name in OTHERS if name in there)])
        missing |= dict.fromkeys(_missing(text.get_text(), _families(text)))
    return list(missing)


def _families(text: Text) -> list[str]:
    given = text.get_fontfamily()
    return [given] if isinstance(given, str) else list(given)


def _missing(text: str, families: Iterable[str]) -> list[str]:
    """The characters of a text that none of the fonts has."""
    known = [_characters(family) for family in families]
    return [c for c in text if c.isprintable() and not any(ord(c) in one for one in known)]


@cache
def _characters(family: str) -> frozenset[int]:
    return frozenset(get_font(findfont(FontProperties(family=[family]))).get_charmap())
