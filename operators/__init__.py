"""Keymark in Blender's user interface and on its command line: one folder for each step of the work.

A folder has its operators, its properties, and its panels in `panel.py`. Its `__init__` lists the modules to
register: `PROPERTIES` and `MODULES`. Of each its classes are registered in their order, unless it has a
`register` of its own. Modules that need SciPy or OpenCV are imported in functions, so that registering does
not wait for them and works without them.

Nothing is imported before `register()`: the command line of an ordinary Python shares this folder.
"""

from collections.abc import Iterator
from importlib import import_module
from types import ModuleType

STEPS = (
    "footage",
    "follow",
    "actor",
    "keyframes",
    "reconstruct",
    "review",
    "overlays",
    "character",
    "finish",
    "library",
)
"""The steps of the work, in the order in which the sidebar shows their panels."""


def modules() -> Iterator[str]:
    """Yield the modules to register in order: all properties, then the operators and panels that use them."""
    for folder in ("shell", *STEPS, "takes"):  # a take's properties contain those of the steps
        yield from (f"{folder}.{name}" for name in _listed(folder, "PROPERTIES"))
    for folder in (
        "shell",
        "takes",
        *STEPS,
        "animate",
        "cli",
    ):  # the main panel comes before the panels inside it
        yield from (f"{folder}.{name}" for name in _listed(folder, "MODULES"))


def register() -> None:
    """Register every module in order; if one fails, unregister those before it and raise."""
    done: list[ModuleType] = []
    try:
        for name in modules():
            module = import_module(f".{name}", __package__)
            _do("register", module)
            done.append(module)
    except Exception:
        for module in reversed(done):
            _do("unregister", module)
        raise


def unregister() -> None:
    """Unregister every module, in the reverse order."""
    for name in reversed(list(modules())):
        _do("unregister", import_module(f".{name}", __package__))


def _do(way: str, module: ModuleType) -> None:
    """Register or unregister a module: by its own function, or else Blender's classes in it.

    What needs these classes is in `ATTACHED`, properties of Blender's own types by path; `HANDLERS` are
    functions by Blender's lists of handlers, `MENUS` those that draw into menus, and `detach` ends what runs.
    """
    from bpy import app, types
    from bpy.utils import register_classes_factory

    classes = [
        each
        for each in vars(module).values()
        if isinstance(each, type)
        and each.__name__.startswith("KEYMARK_")
        and each.__module__ == module.__name__
    ]
    by_classes = dict(zip(("register", "unregister"), register_classes_factory(classes), strict=True))
    attached = [path.split(".") for path in getattr(module, "ATTACHED", ())]
    added = [(getattr(app.handlers, name), each) for name, each in getattr(module, "HANDLERS", {}).items()]
    added += [(getattr(types, name), each) for name, each in getattr(module, "MENUS", {}).items()]
    if way == "unregister":
        getattr(module, "detach", tuple)()
        for owner, name in attached:
            delattr(getattr(types, owner), name)
        for place, each in added:
            place.remove(each)
    getattr(module, way, by_classes[way])()
    if way == "register":
        for owner, name in attached:
            setattr(getattr(types, owner), name, module.ATTACHED[f"{owner}.{name}"])
        for place, each in added:
            place.append(each)


def _listed(folder: str, names: str) -> tuple[str, ...]:
    return getattr(import_module(f".{folder}", __package__), names, ())
