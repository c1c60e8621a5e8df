"""What can go wrong: the input is unusable, the conversion failed, or another works there."""


class KeymarkError(Exception):
    """Base of every error Keymark raises on purpose; its text is one sentence for a person."""


class InputError(KeymarkError):
    """The input cannot be used: the sentence names file, field, value and what would be valid."""


class ConversionError(KeymarkError):
    """The input was usable, yet no motion could be computed or written from it."""


class BusyError(KeymarkError):
    """Another process is writing there just now; later it would work."""
