"""Keymark's panels drawn on a layout that notes what stands on it: their controls, and whether any fails.

Every property, operator, icon and entry of a menu that is drawn must exist, and each operator is asked for
its tooltip. What is folded counts nothing; of a list, its rows count as one control.
"""

import inspect
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any

import bpy

WIDTH = 280  # of a sidebar as it opens [px]
CONTAINERS = {"row", "column", "split", "box", "column_flow", "grid_flow"}
SHOWN = {"label", "separator", "progress", "context_pointer_set"}
ICONS = set(bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys())


class Settings:
    """The settings of a drawn operator: those that were written, else their defaults."""

    def __init__(self, kind: Any) -> None:
        self.__dict__.update(bl_rna=kind, written={})

    def __getattr__(self, name: str) -> Any:
        if name in self.written:
            return self.written[name]
        return self.bl_rna.properties[name].default

    def __setattr__(self, name: str, value: Any) -> None:
        assert name in self.bl_rna.properties, f"{self.bl_rna.identifier} has no setting {name}"
        self.written[name] = value

    def is_property_set(self, name: str) -> bool:
        return name in self.written


class Layout:
    """A layout as panels know it; `drawn` gets what is drawn, as (kind, name, words or settings)."""

    def __init__(self, context: Any, drawn: list[tuple[str, str, str]]) -> None:
        self._context, self._drawn = context, drawn

    def __getattr__(self, name: str) -> Any:
        if name in CONTAINERS:
            return lambda *_, **__: Layout(self._context, self._drawn)
        assert name in SHOWN, f"panels draw {name}, which is not counted"
        return lambda *_, **words: self._show(name, "", **words)

    def _show(self, kind: str, name: str, *, icon: str = "NONE", text: str | None = None, **_: Any) -> None:
        assert icon in ICONS, f"there is no icon {icon}"
        self._drawn.append((kind, name, text or ""))

    def panel(self, idname: str, default_closed: bool = False) -> tuple["Layout", "Layout | None"]:
        self._show("fold", idname)
        return self.row(), None if default_closed else self.row()

    def panel_prop(self, data: Any, name: str) -> tuple["Layout", "Layout | None"]:
        self._show("fold", name)
        return self.row(), self.row() if getattr(data, name) else None

    def prop(self, data: Any, name: str, **words: Any) -> None:
        assert name in data.bl_rna.properties, f"{data.bl_rna.identifier} has no property {name}"
        self._show("prop", name, **words)

    def prop_search(self, data: Any, name: str, source: Any, among: str, **words: Any) -> None:
        assert among in source.bl_rna.properties
        self.prop(data, name, **words)

    def operator(self, idname: str, **words: Any) -> Settings:
        group, _, name = idname.partition(".")
        operator = getattr(getattr(bpy.ops, group), name)
        settings = Settings(operator.get_rna_type())
        self._show("operator", idname, **words)
        operator.poll()
        self._drawn.append(("call", idname, settings))
        return settings

    def operator_menu_enum(self, idname: str, name: str, **words: Any) -> Settings:
        settings = Layout(self._context, []).operator(idname)
        for item in settings.bl_rna.properties[name].enum_items:
            each = Settings(settings.bl_rna)
            setattr(each, name, item.identifier)
            self._drawn.append(("call", idname, each))
        self._show("operator", idname, **words)
        return settings

    def menu(self, idname: str, **words: Any) -> None:
        self._show("menu", idname, **words)
        self._drawn += _calls(_draw(getattr(bpy.types, idname), self._context))

    def popover(self, panel: str, **words: Any) -> None:
        self._show("popover", panel, **words)
        shown = getattr(bpy.types, panel)
        if not hasattr(shown, "poll") or shown.poll(self._context):
            self._drawn += _calls(_draw(shown, self._context))

    def template_list(
        self, kind: str, _: str, data: Any, name: str, chosen: Any, index: str, **__: Any
    ) -> None:
        self._show("list", name)
        rows: list[tuple[str, str, str]] = []
        listed, inside = getattr(bpy.types, kind), Layout(self._context, rows)
        assert index in chosen.bl_rna.properties
        for item in getattr(data, name):
            listed.draw_item(_own(listed, inside), self._context, inside, data, item, 0, chosen, index)
        self._drawn += [("listed", name, words) for of, name, words in rows if of == "operator"]
        self._drawn += _calls(rows)


def _own(kind: Any, layout: Layout) -> Any:
    """Something with the methods of a panel, a menu or a list, and this layout."""

    class Own:
        def __getattr__(self, name: str) -> Any:
            value, declared = getattr(kind, name), inspect.getattr_static(kind, name)
            return value.__get__(self) if type(declared).__name__ == "function" else value

        column = property(lambda self: lambda: kind.column(self))

    own = Own()
    own.layout = layout
    for each in kind.__mro__:
        for name, value in vars(each).items():
            if isinstance(value, property) and not name.startswith("__") and each.__module__ != "bpy_types":
                setattr(Own, name, value)
    return own


def _draw(kind: Any, context: Any, *parts: str) -> list[tuple[str, str, str]]:
    drawn: list[Any] = []
    for part in parts or ("draw",):
        if hasattr(kind, part):
            getattr(kind, part)(_own(kind, Layout(context, drawn)), context)
    for _, name, settings in _calls(drawn):  # only now are its settings known
        described = getattr(getattr(bpy.types, settings.bl_rna.identifier, None), "description", None)
        said = described(context, settings) if described else settings.bl_rna.description
        assert said, f"{name} says nothing of itself"
    return drawn


def _calls(drawn: list[Any]) -> list[Any]:
    return [each for each in drawn if each[0] == "call"]


class _Context:
    """Blender's context, with a view where there is no window."""

    def __init__(self) -> None:
        self.space_data = bpy.context.space_data or SimpleNamespace(
            region_3d=SimpleNamespace(view_perspective="CAMERA"), clip=None
        )
        self.region = bpy.context.region or SimpleNamespace(width=WIDTH)
        self.area = bpy.context.area or SimpleNamespace(
            spaces=SimpleNamespace(active=SimpleNamespace(region_3d=None))
        )

    def __getattr__(self, name: str) -> Any:
        return getattr(bpy.context, name)


def drawn_panels(editor: str = "VIEW_3D") -> list[tuple[str, str, str]]:
    """What Keymark's tab shows of an editor now: kind, name and words of each, in order."""
    context, drawn = _Context(), []
    for kind in _panels(editor):
        if _is_shown(kind, context):
            drawn += _draw(kind, context, *HEADER)
            if _is_open(kind):
                drawn += _draw(kind, context)
    return drawn


HEADER = ("draw_header", "draw_header_preset")


def controls(editor: str = "VIEW_3D") -> list[str]:
    """Names of what can be clicked on or typed into, but for what folds and unfolds."""
    kinds = ("operator", "prop", "list", "menu", "popover")
    return [name for kind, name, _ in drawn_panels(editor) if kind in kinds]


def offered(editor: str = "VIEW_3D") -> list[str]:
    """Names of the controls, with the buttons in the rows of lists."""
    return controls(editor) + [name for kind, name, _ in drawn_panels(editor) if kind == "listed"]


def calls(editor: str = "VIEW_3D") -> list[tuple[str, dict[str, Any]]]:
    """What a click on each button would call, those of popovers and menus among them: name and settings."""
    return [(name, settings.written) for _, name, settings in _calls(drawn_panels(editor))]


def _panels(editor: str) -> Iterator[Any]:
    for name in dir(bpy.types):
        kind = getattr(bpy.types, name)
        if name.startswith("KEYMARK_PT_") and kind.bl_space_type == editor:
            if not {"INSTANCED"} & set(getattr(kind, "bl_options", ())):
                yield kind


def _is_open(kind: Any) -> bool:
    options = set(getattr(kind, "bl_options", ()))
    return "HIDE_HEADER" in options or "DEFAULT_CLOSED" not in options


def _is_shown(kind: Any, context: Any) -> bool:
    parent = getattr(bpy.types, getattr(kind, "bl_parent_id", ""), None)
    if parent is not None and not (_is_open(parent) and _is_shown(parent, context)):
        return False
    poll: Callable[[Any], bool] | None = getattr(kind, "poll", None)
    return poll is None or bool(poll(context))
