"""How a command ends when it does not end well."""

BAD_INPUT = 2
INTERRUPTED = 130
NOT_READ = 141
"""Exit statuses; the last one is that of SIGPIPE."""


class InputError(Exception):
    """What the user typed cannot be used. Its text is the one line the user sees."""
