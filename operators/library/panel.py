"""The popover of keyframe libraries."""

import bpy
from bpy.types import Context, PropertyGroup, UILayout

from ...core.errors import pluralize
from ..shell.panel import Popover, RowList, draw_sentence, right_end
from ..shell.takes import active_take
from .registry import chosen_entry, own_folder

MOST_LINES = 4  # Lines of a library's description, or of its problem


class KEYMARK_UL_shelf(RowList, bpy.types.UIList):
    """Registered libraries, with an icon for shipped, own and unusable ones."""

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        row = layout.row(align=True)
        icon = "ERROR" if item.problem else "USER" if item.is_own else "PACKAGE"
        row.label(text=item.title, translate=False, icon=icon)
        if not item.problem:
            facts = right_end(row)
            facts.active = False
            facts.label(text=str(item.postures), translate=False)


class KEYMARK_PT_libraries(Popover, bpy.types.Panel):
    """The library that poses are sought in; libraries loaded, saved, learned, and edited as pose assets."""

    bl_label = "Libraries"

    def draw(self, context: Context) -> None:
        registry, layout = context.window_manager.keymark_shelf, self.layout
        take = active_take(context.scene)
        self.column().prop(take.matching, "library", text="Pose From")
        layout.use_property_split = False  # a list's rows would be split too
        row = layout.row()
        row.template_list(
            "KEYMARK_UL_shelf", "", registry, "libraries", registry, "active", rows=4, maxrows=6
        )
        buttons = row.column(align=True)
        buttons.operator("keymark.import_library", text="", icon="IMPORT")
        buttons.operator("keymark.export_library", text="", icon="EXPORT")
        buttons.operator("keymark.refresh_shelf", text="", icon="FILE_REFRESH")
        buttons.operator("wm.path_open", text="", icon="FILE_FOLDER").filepath = str(own_folder())
        item, column = chosen_entry(context), layout.column()
        if item is not None and item.problem:
            draw_sentence(column, context, item.problem, "ERROR", MOST_LINES)
        elif item is not None:
            facts = column.column(align=True)
            facts.scale_y = 0.85
            size = f"{pluralize(item.postures, 'posture')}, {pluralize(item.motions, 'motion')}"
            by = f"Version {item.version} by {item.author}"
            for text, icon in ((size, "INFO"), (by, "BLANK1"), (item.license, "BLANK1")):
                facts.label(text=text, icon=icon, translate=False)
            if item.description:
                draw_sentence(column, context, item.description, "TEXT", MOST_LINES)
            column.operator("keymark.edit_library", icon="ASSET_MANAGER").library = item.name
        saving = column.column(align=True)
        posed = saving.row()
        posed.enabled = take.keyframe_action is not None
        posed.operator("keymark.export_library", text="Save Keyframes", icon="KEYINGSET").source = "KEYFRAMES"
        saving.operator("keymark.learn_library", icon="ACTION")
