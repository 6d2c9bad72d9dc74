"""Errors that Python alone raises, of what may not be installed."""

from drystone._core import DrystoneError


class StaticsError(DrystoneError):
    """None of HiGHS's methods decided a linear program."""
