"""Install keyframe libraries where the asset browser finds them."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from .running.failures import reported
from .running.redraw import refresh_asset_browsers
from .running.requirements import all_met, idle
from .running.say import say
from .scene.library_choice import chosen_library
from .scene.library_exchange import CHOICES, Conflict, asset_libraries, conflicts, settled
from .ui.choose_existing import WIDTH, draw_question

if TYPE_CHECKING:
    from ..core.library.library import Library

FOLDER = "keymark"
"""In the asset library."""
_items: list[tuple[str, str, str]] = []
"""Blender keeps no copy of a menu's words."""


def _asset_library_items(
    _properties: object, context: bpy.types.Context | None
) -> list[tuple[str, str, str]]:
    found = asset_libraries(context or bpy.context)
    items = [(name, name, str(folder)) for name, folder in found.items()]
    _items[:] = items or [("", "None", "The preferences name no asset library")]
    return _items


class InstallOperator:
    """What both installers share."""

    bl_options = {"REGISTER"}
    existing: str
    asset_library: str
    _found: list[Conflict] = []

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Blender must know a folder for assets."""
        return all_met(cls, context, _an_asset_library, idle)

    def libraries(self, context: bpy.types.Context) -> "list[Library]":
        """What to install."""
        raise NotImplementedError

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask where to, where there is a choice, and what to do where a library is there already."""
        with reported(self):
            root = self._root(context)
            self._found = conflicts(self.libraries(context), lambda name: _installed(root, name))
            if not self._found and len(asset_libraries(context)) == 1:
                return self.execute(context)
            self.existing = "KEEP"
            return context.window_manager.invoke_props_dialog(self, width=WIDTH)
        return {"CANCELLED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw where to, and the question."""
        self.layout.prop(self, "asset_library")
        if self._found:
            draw_question(self.layout, self, self._found)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write each into a .blend of its own."""
        with reported(self):
            from .bridge.library_blend import write_library_blend

            root = self._root(context)
            wanted = settled(self.libraries(context), lambda name: _installed(root, name), self.existing)
            for library in wanted:
                write_library_blend(_file(root, library.identifier), library, root)
            refresh_asset_browsers(context)
            if wanted:
                say(
                    self,
                    "INFO",
                    "Installed {count} libraries with {postures} pose assets in '{name}'",
                    count=len(wanted),
                    postures=sum(len(library.postures) for library in wanted),
                    name=self.asset_library,
                )
            else:
                say(self, "INFO", "Nothing to install: all of it is in '{name}'", name=self.asset_library)
            return {"FINISHED"}
        return {"CANCELLED"}

    def _root(self, context: bpy.types.Context) -> Path:
        from ..core.errors import InputError

        found = asset_libraries(context)
        if self.asset_library not in found:
            raise InputError(
                "no asset library is chosen; the preferences name them under File Paths > Asset Libraries"
            )
        return found[self.asset_library]


class KEYMARK_OT_install_library(InstallOperator, bpy.types.Operator):
    """Install the library as pose assets, so that the asset browser shows it in every file"""

    bl_idname = "keymark.install_library"
    bl_label = "Install as Pose Assets"

    library: bpy.props.StringProperty(
        name="Library",
        description="Identifier of a library at hand; empty: the one that is made in this file",
        options={"SKIP_SAVE"},
    )
    asset_library: bpy.props.EnumProperty(
        name="Asset Library", description="Where to install", items=_asset_library_items
    )
    existing: bpy.props.EnumProperty(
        name="Existing",
        description="What to do where another library of the same identifier is installed",
        items=CHOICES,
        options={"SKIP_SAVE"},
    )

    def libraries(self, context: bpy.types.Context) -> "list[Library]":
        """The chosen one."""
        return [chosen_library(context, self.library)]


class KEYMARK_OT_install_shipped_libraries(InstallOperator, bpy.types.Operator):
    """Install the libraries that come with Keymark as pose assets, so that the asset browser shows them"""

    bl_idname = "keymark.install_shipped_libraries"
    bl_label = "Install Shipped Libraries"

    asset_library: bpy.props.EnumProperty(
        name="Asset Library", description="Where to install", items=_asset_library_items
    )
    existing: bpy.props.EnumProperty(
        name="Existing",
        description="What to do where another library of the same identifier is installed",
        items=CHOICES,
        options={"SKIP_SAVE"},
    )

    def libraries(self, context: bpy.types.Context) -> "list[Library]":
        """All that come with Keymark."""
        from ..core.library.shelf import SHIPPED, shelved

        return [entry.library for entry in shelved([SHIPPED]) if entry.library is not None]


def _an_asset_library(context: bpy.types.Context) -> str | None:
    there = asset_libraries(context)
    return None if there else "Add an asset library in the preferences first (File Paths > Asset Libraries)"


def _file(root: Path, identifier: str) -> Path:
    from ..core.library.texts import checked_identifier

    return root / FOLDER / f"{checked_identifier(identifier, 'the identifier')}.blend"


def _installed(root: Path, identifier: str) -> "Library | None":
    """The library of an identifier that is installed below a folder."""
    from .bridge.library_blend import read_library_blend

    path = _file(root, identifier)
    return read_library_blend(path)[0] if path.exists() else None


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_OT_install_library, KEYMARK_OT_install_shipped_libraries)
)
