"""Panels of keyframe libraries: the registry, and the library that is made in this file."""

import bpy

from ..shell.messages import count_label, label
from ..shell.panel import RowList, SubPanel, draw_progress, draw_sentence, property_column
from ..shell.takes import find_take
from .editing.scene_libraries import active_motion, active_posture, find_library_here, library_here
from .registry import chosen_entry

MOST_LINES = 4
"""Lines of a library's description, or of its problem."""


class KEYMARK_UL_shelf(RowList, bpy.types.UIList):
    """Registered libraries, with an icon for shipped, own and unusable ones."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        """Draw one library: title and number of postures."""
        row = layout.row(align=True)
        row.label(
            text=item.title,
            translate=False,
            icon="ERROR" if item.problem else "USER" if item.is_own else "PACKAGE",
        )
        if not item.problem:
            facts = row.row()
            facts.alignment = "RIGHT"
            facts.active = False
            facts.label(text=str(len(item.postures)), translate=False)


class KEYMARK_UL_library_postures(RowList, bpy.types.UIList):
    """The postures of the library that is made here, in their order."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        """Draw one posture: its mark and its name."""
        row = layout.row(align=True)
        row.prop(item, "selected", text="")
        row.prop(
            item, "name", text="", emboss=False, icon="ERROR" if item.action is None else "ARMATURE_DATA"
        )


class KEYMARK_UL_library_motions(RowList, bpy.types.UIList):
    """The motions of the library that is made here."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        """Draw one motion: name and duration."""
        row = layout.row(align=True)
        row.prop(item, "name", text="", emboss=False, icon="FILE_REFRESH" if item.cyclic else "FORWARD")
        facts = row.row()
        facts.alignment = "RIGHT"
        facts.label(text=label("{duration:.2f} s", duration=item.duration_s), translate=False)


class KEYMARK_UL_library_steps(RowList, bpy.types.UIList):
    """The steps of the chosen motion."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        """Draw one step: time and posture."""
        row = layout.row(align=True)
        when = row.row()
        when.ui_units_x = 3.5
        when.prop(item, "time_s", text="", emboss=False)
        row.label(text=item.posture, translate=False)


class KEYMARK_MT_shelf(bpy.types.Menu):
    """Further operators on the registered libraries."""

    bl_label = "Library Specials"

    def draw(self, context: bpy.types.Context) -> None:
        """Installing, exporting, refreshing."""
        layout = self.layout
        item = chosen_entry(context)
        if item is not None and not item.problem:
            layout.operator("keymark.export_library", icon="EXPORT").library = item.name
        layout.operator("keymark.install_shipped_libraries", icon="PACKAGE")
        layout.separator()
        layout.operator("keymark.refresh_shelf", icon="FILE_REFRESH")


class KEYMARK_MT_library(bpy.types.Menu):
    """Further operators on the library that is made here."""

    bl_label = "Library Specials"

    def draw(self, context: bpy.types.Context) -> None:
        """Mirroring, replacing, removing."""
        layout = self.layout
        layout.operator(
            "keymark.add_posture", text="Replace by Current Pose", icon="FILE_REFRESH"
        ).replace = True
        layout.separator()
        for what, text in (
            ("POSTURE", label("Add Chosen Mirrored")),
            ("POSTURES", label("Add All Mirrored")),
            ("LIBRARY", label("New Mirrored Library")),
        ):
            layout.operator("keymark.mirror_library", text=text, icon="MOD_MIRROR").what = what
        layout.separator()
        layout.operator("keymark.gather_library", icon="ASSET_MANAGER")
        layout.operator("keymark.remove_library", icon="TRASH")


class KEYMARK_PT_libraries(SubPanel, bpy.types.Panel):
    """The libraries at hand."""

    bl_label = "Libraries"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list, the facts of the chosen library, and its operators."""
        registry, layout = context.window_manager.keymark_shelf, self.layout
        row = layout.row()
        row.template_list(
            "KEYMARK_UL_shelf", "", registry, "libraries", registry, "active", rows=4, maxrows=6
        )
        buttons = row.column(align=True)
        buttons.operator("keymark.import_library", text="", icon="IMPORT")
        buttons.operator("keymark.discard_library", text="", icon="REMOVE")
        buttons.menu("KEYMARK_MT_shelf", text="", icon="DOWNARROW_HLT")
        item = chosen_entry(context)
        if item is None:
            return
        if item.problem:
            draw_sentence(layout, context, item.problem, "ERROR", MOST_LINES)
            return
        _facts(layout, context, item)
        column = property_column(layout.column())
        column.prop_search(registry, "posture", item, "postures", icon="ARMATURE_DATA")
        column.prop(registry, "mirrored")
        apply = column.operator("keymark.apply_posture", icon="POSE_HLT")
        apply.library, apply.posture, apply.mirrored = item.name, registry.posture, registry.mirrored
        if not draw_progress(column, context, "keymark.install_"):
            column.operator("keymark.install_library", icon="ASSET_MANAGER").library = item.name
        column.operator("keymark.edit_library", icon="GREASEPENCIL").library = item.name


class KEYMARK_PT_library_here(SubPanel, bpy.types.Panel):
    """The library that is made in this file."""

    bl_label = "Made in This File"
    bl_parent_id = "KEYMARK_PT_libraries"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the library, its postures, and their operators."""
        layout, group = self.layout, find_library_here(context.scene)
        if group is None:
            layout.operator("keymark.new_library", icon="ADD")
            layout.operator("keymark.gather_library", icon="ASSET_MANAGER")
            return
        settings = context.scene.keymark
        row = layout.row(align=True)
        if len(settings.libraries) > 1:
            row.prop(settings, "active_library", text="")
        row.prop(group, "name", text="", icon="ASSET_MANAGER")
        row.operator("keymark.new_library", text="", icon="ADD")
        row.menu("KEYMARK_MT_library", text="", icon="DOWNARROW_HLT")
        row = layout.row()
        row.template_list(
            "KEYMARK_UL_library_postures", "", group, "postures", group, "active_posture", rows=5, maxrows=8
        )
        buttons = row.column(align=True)
        buttons.operator("keymark.add_posture", text="", icon="ADD").replace = False
        buttons.operator("keymark.remove_posture", text="", icon="REMOVE")
        buttons.separator()
        buttons.operator("keymark.move_posture", text="", icon="TRIA_UP").direction = "UP"
        buttons.operator("keymark.move_posture", text="", icon="TRIA_DOWN").direction = "DOWN"
        entry, column = active_posture(group), self.column()
        if entry is not None:
            column.prop(entry, "tags")
            row = column.row(align=True)
            row.operator("keymark.apply_posture", icon="POSE_HLT").mirrored = False
            row.operator("keymark.apply_posture", text="", icon="MOD_MIRROR").mirrored = True
        if entry is None:
            _draw_begin(column, context)
            return
        column.operator("keymark.keep_library", icon="USER")
        row = column.row(align=True)
        row.operator("keymark.export_library", text="Export", icon="EXPORT").library = ""
        row.operator("keymark.install_library", text="Install", icon="ASSET_MANAGER").library = ""


class LibraryPart(SubPanel):
    """A part of the library that is made here, folded until it is wanted."""

    bl_parent_id = "KEYMARK_PT_library_here"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There is a library."""
        return find_library_here(context.scene) is not None


class KEYMARK_PT_library_motions(LibraryPart, bpy.types.Panel):
    """Motions of the library."""

    bl_label = "Motions"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the motions, and the steps of the chosen one."""
        layout, group = self.layout, library_here(context.scene)
        row = layout.row()
        row.template_list(
            "KEYMARK_UL_library_motions", "", group, "motions", group, "active_motion", rows=2, maxrows=6
        )
        buttons = row.column(align=True)
        buttons.operator("keymark.add_motion", text="", icon="ADD")
        buttons.operator("keymark.remove_motion", text="", icon="REMOVE")
        motion = active_motion(group)
        if motion is None:
            return
        column = self.column()
        column.prop(motion, "duration_s")
        column.prop(motion, "cyclic")
        if motion.cyclic:
            travel = column.column(align=True)
            for name in ("travel_x", "travel_y", "travel_turn"):
                travel.prop(motion, name)
        row = layout.row()
        row.template_list(
            "KEYMARK_UL_library_steps", "", motion, "steps", motion, "active_step", rows=4, maxrows=10
        )
        buttons = row.column(align=True)
        buttons.operator("keymark.add_step", text="", icon="ADD")
        buttons.operator("keymark.remove_step", text="", icon="REMOVE")
        if motion.active_step < len(motion.steps):
            step, column = motion.steps[motion.active_step], self.column()
            column.prop_search(step, "posture", group, "postures", icon="ARMATURE_DATA")
            column.prop(step, "time_s")


class KEYMARK_PT_library_details(LibraryPart, bpy.types.Panel):
    """Details of the library."""

    bl_label = "Details"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw author, license, description and sources."""
        group, column = library_here(context.scene), self.column()
        for name in ("author", "license", "version", "description", "tags", "identifier"):
            column.prop(group, name)
        lines = self.layout.column(align=True)
        lines.use_property_split = False
        for number, line in enumerate(group.sources):
            row = lines.row(align=True)
            row.prop(line, "text", text="", icon="HELP" if not line.text else "BOOKMARKS")
            row.operator("keymark.remove_source", text="", icon="REMOVE").line = number
        lines.operator("keymark.add_source", icon="ADD")


def _draw_begin(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the next step of an empty library; without a take there is no other button to build an actor."""
    take = find_take(context.scene)
    if take is None or take.armature is None:
        draw_sentence(layout, context, label("Build an actor to pose; no footage is needed"), "FORWARD")
        layout.operator("keymark.build_actor", icon="OUTLINER_OB_ARMATURE")
    else:
        draw_sentence(layout, context, label("Pose the actor, and add its pose with the plus"), "FORWARD")


def _facts(layout: bpy.types.UILayout, context: bpy.types.Context, item: bpy.types.PropertyGroup) -> None:
    """Draw the facts of a registered library."""
    column = layout.column(align=True)
    column.scale_y = 0.85
    postures = count_label(len(item.postures), "1 posture", "{count} postures")
    motions = count_label(item.motions, "1 motion", "{count} motions")
    column.label(text=f"{postures}, {motions}", icon="INFO", translate=False)
    by = label("Version {version} by {author}", version=item.version, author=item.author)
    column.label(text=by, icon="BLANK1", translate=False)
    column.label(text=item.license, icon="BLANK1", translate=False)
    if item.description:
        draw_sentence(layout, context, item.description, "TEXT", MOST_LINES)


register, unregister = bpy.utils.register_classes_factory(
    (
        KEYMARK_UL_shelf,
        KEYMARK_UL_library_postures,
        KEYMARK_UL_library_motions,
        KEYMARK_UL_library_steps,
        KEYMARK_MT_shelf,
        KEYMARK_MT_library,
        KEYMARK_PT_libraries,
        KEYMARK_PT_library_here,
        KEYMARK_PT_library_motions,
        KEYMARK_PT_library_details,
    )
)
