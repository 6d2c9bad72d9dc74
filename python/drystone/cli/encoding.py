"""Text for terminals that do not know every character."""

from __future__ import annotations

import codecs
import sys

PLAIN = str.maketrans("µ²³", "u23")
"""Characters of units, with what is written where they are not known: as wide, so that tables stay
in line."""

NAME = "drystone"


def write_what_is_not_known() -> None:
    """A character that a stream's encoding does not know is no reason to fail: those of units are
    written plainly, others, of names, as escapes."""
    codecs.register_error(NAME, _plain)
    for stream in (sys.stdout, sys.stderr):
        if stream is not None and hasattr(stream, "reconfigure"):
            stream.reconfigure(errors=NAME)


def _plain(error: UnicodeError) -> tuple[str | bytes, int]:
    if isinstance(error, UnicodeEncodeError):
        plain = error.object[error.start].translate(PLAIN)
        if plain.isascii():
            return plain, error.start + 1
    return codecs.backslashreplace_errors(error)
