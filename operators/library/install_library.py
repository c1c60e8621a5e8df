"""Install keyframe libraries where the asset browser finds them."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ...core.arrays import Image
from ...core.errors import InputError
from ...core.library.texts import checked_identifier
from ...core.progress import Progress
from ..shell.error_reports import reported
from ..shell.job_operator import JobOperator
from ..shell.messages import say
from ..shell.redraw import refresh_asset_browsers
from ..shell.requirements import all_met, idle
from .conflict_dialog import WIDTH, draw_question
from .conflicts import CHOICES, Conflict, asset_libraries, conflicts, settled
from .library_choice import chosen_library

if TYPE_CHECKING:
    from ...core.library.library import Library
    from ...core.progress import Job

FOLDER = "keymark"
"""In the asset library."""
Item = tuple[str, str, str]
_items: list[Item] = []
"""Blender keeps no copy of a menu's words."""


def _asset_library_items(_properties: object, context: bpy.types.Context | None) -> list[Item]:
    found = asset_libraries(context or bpy.context)
    items = [(name, name, str(folder)) for name, folder in found.items()]
    _items[:] = items or [("NONE", "None", "The preferences name no asset library")]
    return _items


class InstallOperator(JobOperator):
    """What both installers share: pictures are drawn first, then each library gets a .blend of its own."""

    bl_options = {"REGISTER"}
    layout: bpy.types.UILayout
    options: bpy.types.OperatorOptions
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

    def again(self) -> set[str]:
        """Call the operator anew, with what was chosen."""
        raise NotImplementedError

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask where to, where there is a choice, and what to do where a library is there already."""
        with reported(self):
            root = self._root(context)
            if self.existing != "ASK":
                return super().invoke(context, event)
            self._found = conflicts(self.libraries(context), _Installed(root))
            if not self._found and len(asset_libraries(context)) == 1:
                return super().invoke(context, event)
            self.existing = "KEEP"
            word = "Continue" if self._found else "Install"
            return context.window_manager.invoke_props_dialog(self, width=WIDTH, confirm_text=word)
        return {"CANCELLED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw where to, and the question."""
        column = self.layout.column()
        column.use_property_split = True
        column.prop(self, "asset_library")
        if self._found:
            draw_question(self.layout, self, self._found)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do all of it at once; after the dialog, with a progress bar."""
        if self.options.is_invoke and not bpy.app.background and self.existing != "ASK":
            return self.again()
        return super().execute(context)

    def start(self, scene: bpy.types.Scene) -> "Job[list[tuple[Library, list[Image]]]]":
        """Read what is there, and draw the pictures of what is to be installed."""
        from ..bridge.library.pose_assets import draw_pictures

        there = _Installed(self._root(bpy.context))
        wanted = settled(self.libraries(bpy.context), there, self.existing)
        count = sum(len(library.postures) for library in wanted)
        drawn: list[tuple[Library, list[Image]]] = []
        done = 0
        for library in wanted:
            pictures: list[Image] = []
            for picture in draw_pictures(library):
                pictures.append(picture)
                done += 1
                yield Progress("Drawing the postures", done / count)
            drawn.append((library, pictures))
        return drawn

    def finish(self, scene: bpy.types.Scene, result: "list[tuple[Library, list[Image]]]") -> None:
        """Write the files."""
        from ..bridge.library.library_blend import write_library_blend

        root = self._root(bpy.context)
        for library, pictures in result:
            write_library_blend(_file(root, library.identifier), library, root, pictures)
        refresh_asset_browsers(bpy.context)
        name = self.asset_library
        if not result:
            say(self, "INFO", "Nothing to install: all of it is in '{name}'", name=name)
            return
        count = sum(len(library.postures) for library, _ in result)
        titles = ", ".join(library.title for library, _ in result)
        say(
            self,
            "INFO",
            "Installed {titles} in '{name}': {count} pose assets",
            titles=titles,
            name=name,
            count=count,
        )

    def _root(self, context: bpy.types.Context) -> Path:
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

    def again(self) -> set[str]:
        """Call the operator anew, with what was chosen."""
        return set(
            bpy.ops.keymark.install_library(
                "INVOKE_DEFAULT",
                library=self.library,
                asset_library=self.asset_library,
                existing=self.existing,
            )
        )


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
        from ...core.library.registry import SHIPPED, registered_libraries

        return [entry.library for entry in registered_libraries([SHIPPED]) if entry.library is not None]

    def again(self) -> set[str]:
        """Call the operator anew, with what was chosen."""
        return set(
            bpy.ops.keymark.install_shipped_libraries(
                "INVOKE_DEFAULT", asset_library=self.asset_library, existing=self.existing
            )
        )


def _an_asset_library(context: bpy.types.Context) -> str | None:
    there = asset_libraries(context)
    return None if there else "Add an asset library in the preferences first (File Paths > Asset Libraries)"


def _file(root: Path, identifier: str) -> Path:
    return root / FOLDER / f"{checked_identifier(identifier, 'the identifier')}.blend"


class _Installed:
    """The libraries installed below a folder, each read once."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._read: dict[str, Library | None] = {}

    def __call__(self, identifier: str) -> "Library | None":
        """The library of an identifier; None where it is not installed."""
        from ..bridge.library.library_blend import read_library_blend

        if identifier not in self._read:
            path = _file(self._root, identifier)
            self._read[identifier] = read_library_blend(path)[0] if path.exists() else None
        return self._read[identifier]


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_OT_install_library, KEYMARK_OT_install_shipped_libraries)
)
