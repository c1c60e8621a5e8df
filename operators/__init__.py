"""Keymark in Blender's user interface and on its command line: a folder a step of the work.

Nothing is imported before `register()`: the command line of an ordinary Python shares this folder.
"""

from collections.abc import Iterator
from importlib import import_module
from types import ModuleType

STEPS = (
    "footage",
    "markers",
    "actor",
    "keyframes",
    "matching",
    "reconstruct",
    "review",
    "overlays",
    "turntable",
    "finish",
    "library",
)
"""The steps of the work, in the order in which the sidebar shows their panels."""


def modules() -> Iterator[str]:
    """The modules to register, in this order: all properties, then the operators and panels that use them.

    A topic names its own in its `__init__`: `PROPERTIES` and `MODULES`.
    """
    for topic in ("shell", *STEPS, "takes"):  # a take's properties hold those of the steps
        yield from (f"{topic}.{name}" for name in _listed(topic, "PROPERTIES"))
    for topic in ("shell", "takes", *STEPS, "cli"):  # the main panel comes before the panels inside it
        yield from (f"{topic}.{name}" for name in _listed(topic, "MODULES"))


def register() -> None:
    """Register every module in order; if one fails, take back those before it and raise."""
    done: list[ModuleType] = []
    try:
        for name in modules():
            module = import_module(f".{name}", __package__)
            module.register()
            done.append(module)
    except Exception:
        for module in reversed(done):
            module.unregister()
        raise


def unregister() -> None:
    """Unregister every module, in the reverse order."""
    for name in reversed(list(modules())):
        import_module(f".{name}", __package__).unregister()


def _listed(topic: str, names: str) -> tuple[str, ...]:
    return getattr(import_module(f".{topic}", __package__), names, ())
