"""The shipped libraries by name: every module of kinds/ composes one."""

from importlib import import_module
from pathlib import Path

from keymark.core.prior.library import Library

NAMES = tuple(sorted(file.stem for file in (Path(__file__).parent / "kinds").glob("[a-z]*.py")))


def composed(name: str) -> Library:
    """The library called `name`, composed anew."""
    library: Library = import_module(f"libraries.kinds.{name}").library()
    return library
