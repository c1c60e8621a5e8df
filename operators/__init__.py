"""Keymark in Blender's user interface and on its command line: one operator a file."""

from types import ModuleType

MODULES: tuple[ModuleType, ...] = ()


def register() -> None:
    """Register every module in order; if one fails, take back those before it and raise."""
    done: list[ModuleType] = []
    try:
        for module in MODULES:
            module.register()
            done.append(module)
    except Exception:
        for module in reversed(done):
            module.unregister()
        raise


def unregister() -> None:
    """Unregister every module, in the reverse order."""
    for module in reversed(MODULES):
        module.unregister()
