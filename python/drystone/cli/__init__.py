"""The command line: `drystone check | plan | simulate | scene | bench`.

Exit status: 0 for yes, 1 for no (it does not stand, there is no order, a step could not be made), 2
for bad input, which is one line on standard error.
"""

from __future__ import annotations

import sys

BAD_INPUT = 2
INTERRUPTED = 130


def main() -> None:
    """Run the command line given to the process."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: list[str]) -> int:
    """Run one command line and return its exit status."""
    from drystone.cli.app import app
    from drystone.cli.errors import InputError

    try:
        result = app(arguments, prog_name="drystone", standalone_mode=False)
    except InputError as error:
        return _complain(str(error))
    except KeyboardInterrupt:
        return INTERRUPTED
    except Exception as error:
        return _known(error)
    return result if isinstance(result, int) else 0


def _known(error: Exception) -> int:
    """The exit status for an error of the command line's own or of the compiled core."""
    # The parser's errors: one class in typer of today, another package's in older ones.
    format_message = getattr(error, "format_message", None)
    if format_message is not None:
        return _complain(format_message() or str(error))
    if type(error).__name__ == "Abort":
        return INTERRUPTED
    from drystone import DrystoneError

    if isinstance(error, DrystoneError):
        return _complain(str(error))
    raise error


def _complain(message: str) -> int:
    print("drystone: " + " ".join(message.split()), file=sys.stderr)
    return BAD_INPUT
