"""The command line: `drystone check | plan | simulate | scene | import | bench`.

Exit status: 0 for yes, 1 for no (it does not stand, there is no order, a step could not be made), 2
for everything else that went wrong, which is one line on standard error, 130 after Ctrl-C. Whoever
reads standard output may stop: then the status is that of SIGPIPE, 141, and nothing is said.
"""

from __future__ import annotations

import contextlib
import os
import sys
import warnings
from typing import TextIO

from drystone.cli.encoding import write_what_is_not_known
from drystone.cli.errors import BAD_INPUT, INTERRUPTED, NOT_READ, InputError

VALIDATOR = "Value error, "
"""What newer parsers put before a reason; it tells the user nothing."""


def main() -> None:
    """Run the command line given to the process."""
    write_what_is_not_known()
    warnings.showwarning = _warn
    try:
        status = run(sys.argv[1:])
    except KeyboardInterrupt:
        status = INTERRUPTED
    _abandon(sys.stdout)
    _abandon(sys.stderr)
    sys.exit(status)


def run(arguments: list[str]) -> int:
    """Run one command line and return its exit status."""
    try:
        from drystone.cli.app import app

        result = app(arguments, prog_name="drystone", standalone_mode=False)
        if sys.stdout is not None:
            sys.stdout.flush()
        return result if isinstance(result, int) else 0
    except BrokenPipeError:
        return NOT_READ
    except KeyboardInterrupt:
        return INTERRUPTED
    except SystemExit as error:  # the parser's answer to a closed pipe, with status 1
        return NOT_READ if isinstance(error.__context__, BrokenPipeError) else BAD_INPUT
    except BaseException as error:  # a panic of the compiled core is no Exception
        return _failed(error)


def _warn(message: Warning | str, *_: object, **__: object) -> None:
    """A warning is a line too, not a place in a program that the user did not write."""
    _complain(str(message))


def _failed(error: BaseException) -> int:
    """The exit status for whatever a command ended with, after one line about it."""
    if type(error).__name__ == "Abort":  # the parser's word for Ctrl-C
        return INTERRUPTED
    return _complain(_said(error))


def _said(error: BaseException) -> str:
    """What to tell of it; the type too if it is none of those that speak to users."""
    # The parser's errors: one class in typer of today, another package's in older ones.
    format_message = getattr(error, "format_message", None)
    if format_message is not None:
        return str(format_message() or error).replace(VALIDATOR, "")
    if isinstance(error, MemoryError):
        return "there is not enough memory for this"
    if isinstance(error, OSError):
        where = f"{error.filename}: " if error.filename else ""
        return f"{where}{error.strerror or error}"
    if _speaks(error):
        return str(error)
    return f"{type(error).__name__}: {error} (this is a fault of drystone: please report it)"


def _speaks(error: BaseException) -> bool:
    if isinstance(error, InputError):
        return True
    try:
        from drystone._core import DrystoneError
    except ImportError:
        return False
    return isinstance(error, DrystoneError)


def _complain(message: str) -> int:
    from drystone.common.text import shown

    # Where the help was shown instead there is nothing to say.
    if message and sys.stderr is not None:
        with contextlib.suppress(OSError, ValueError):  # nobody is there to be told
            print("drystone: " + shown(" ".join(message.split())), file=sys.stderr, flush=True)
    return BAD_INPUT


def _abandon(stream: TextIO | None) -> None:
    """What a full disk or a closed pipe did not take must not raise again at the end."""
    if stream is None:
        return
    try:
        stream.flush()
    except (OSError, ValueError):
        with contextlib.suppress(OSError, ValueError):
            null = os.open(os.devnull, os.O_WRONLY)
            os.dup2(null, stream.fileno())
            os.close(null)
