"""Base of the operators that install keyframe libraries where the asset browser finds them."""

from abc import abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..shell.error_reports import reported
from ..shell.job_operator import JobOperator
from ..shell.messages import label, say
from ..shell.redraw import refresh_asset_browsers
from ..shell.requirements import idle
from .conflict_dialog import WIDTH, Conflict, draw_question

if TYPE_CHECKING:
    from ...core.library.library import Library
    from ...core.progress import Job
    from .installation import DrawnLibrary, Installation

Item = tuple[str, str, str]
_items: list[Item] = []
"""Items of the menu: Blender keeps no copy of the strings."""


def asset_libraries(context: bpy.types.Context) -> dict[str, Path]:
    """Folders of the asset libraries in the preferences, by name."""
    listed = context.preferences.filepaths.asset_libraries
    return {item.name: Path(bpy.path.abspath(item.path)) for item in listed if item.path}


def an_asset_library(context: bpy.types.Context) -> str | None:
    """The preferences name an asset library."""
    there = asset_libraries(context)
    return (
        None
        if there
        else label("Add an asset library in the preferences first (File Paths > Asset Libraries)")
    )


def asset_library_items(_properties: object, context: bpy.types.Context | None) -> list[Item]:
    """Items of a menu of the asset libraries."""
    found = asset_libraries(context or bpy.context)
    items = [(name, name, str(folder)) for name, folder in found.items()]
    _items[:] = items or [("NONE", label("None"), label("The preferences name no asset library"))]
    return _items


class InstallOperator(JobOperator):
    """Mixin of the installers: draws the pictures first, then writes a .blend for each library."""

    bl_options = {"REGISTER"}
    requirements = (an_asset_library, idle)
    layout: bpy.types.UILayout
    options: bpy.types.OperatorOptions
    existing: str
    asset_library: str
    _found: list[Conflict] = []

    @abstractmethod
    def libraries(self, context: bpy.types.Context) -> "list[Library]":
        """The libraries to install."""

    @abstractmethod
    def again(self) -> set[str]:
        """Call the operator anew, with the choices of the dialog."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the asset library where there are several, and what to do where identifiers are taken."""
        with reported(self):
            installation = self._installation(context)
            if self.existing != "ASK":
                return super().invoke(context, event)
            self._found = installation.conflicts(self.libraries(context))
            if not self._found and len(asset_libraries(context)) == 1:
                return super().invoke(context, event)
            self.existing = "KEEP"
            word = label("Continue") if self._found else label("Install")
            return context.window_manager.invoke_props_dialog(self, width=WIDTH, confirm_text=word)
        return {"CANCELLED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the asset library, and the question."""
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "asset_library")
        if self._found:
            draw_question(self.layout, self, self._found)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do the whole job at once; after the dialog, with a progress bar."""
        if self.options.is_invoke and not bpy.app.background and self.existing != "ASK":
            return self.again()
        return super().execute(context)

    def start(self, scene: bpy.types.Scene) -> "Job[list[DrawnLibrary]]":
        """Draw the pictures of what is to be installed."""
        installation = self._installation(bpy.context)
        return (yield from installation.draw(self.libraries(bpy.context), self.existing))

    def finish(self, scene: bpy.types.Scene, result: "list[DrawnLibrary]") -> None:
        """Write the files."""
        self._installation(bpy.context).write(result)
        refresh_asset_browsers(bpy.context)
        name = self.asset_library
        if not result:
            say(self, "INFO", "Nothing to install: all of it is in '{name}'", name=name)
            return
        count = sum(len(drawn.library.postures) for drawn in result)
        titles = ", ".join(drawn.library.title for drawn in result)
        say(
            self,
            "INFO",
            "Installed {titles} in '{name}': {count} pose assets",
            titles=titles,
            name=name,
            count=count,
        )

    def _installation(self, context: bpy.types.Context) -> "Installation":
        """The libraries installed in the chosen asset library.

        Raises:
            InputError: None is chosen.
        """
        from .installation import Installation

        found = asset_libraries(context)
        if self.asset_library not in found:
            raise InputError(
                "no asset library is chosen; the preferences name them under File Paths > Asset Libraries"
            )
        return Installation(found[self.asset_library])
