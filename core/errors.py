"""What can go wrong, in two kinds: the input is unusable, or the conversion failed."""


class KeymarkError(Exception):
    """Base of every error Keymark raises on purpose; its text is one sentence for a person."""


class InputError(KeymarkError):
    """The input cannot be used: the sentence names file, field, value and what would be valid."""


class ConversionError(KeymarkError):
    """The input was usable, yet no motion could be computed or written from it."""


class BusyError(KeymarkError):
    """Another process is at work on the same results; what it leaves may be what was wanted."""


def describe_unexpected(error: BaseException) -> str:
    """An error that nobody has thought of, in one line for a sentence."""
    said = " ".join(str(error).split())
    return f"{type(error).__name__}: {said}" if said else type(error).__name__
