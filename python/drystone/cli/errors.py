"""What the user typed cannot be used."""


class InputError(Exception):
    """Its text is the one line the user sees."""
