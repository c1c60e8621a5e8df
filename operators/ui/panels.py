"""The sidebar panel in the 3D viewport."""

import bpy

from ..job_operator import job_is_running


class SidebarPanel:
    """Where all of Keymark's panels are."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Keymark"


class SubPanel(SidebarPanel):
    """A panel inside the main one, with properties in Blender's two columns."""

    bl_parent_id = "KEYMARK_PT_main"
    layout: bpy.types.UILayout

    def column(self) -> bpy.types.UILayout:
        """The panel's column of properties."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class KEYMARK_UL_markers(bpy.types.UIList):
    """Markers with their colors."""

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.AnyType,
        item: bpy.types.PropertyGroup,
        icon: int,
        active_data: bpy.types.AnyType,
        active_property: str,
    ) -> None:
        """Draw one marker: color and name."""
        row = layout.row(align=True)
        swatch = row.row()
        swatch.ui_units_x = 2.0
        swatch.prop(item, "color", text="")
        row.prop(item, "name", text="", emboss=False)


class KEYMARK_PT_main(SidebarPanel, bpy.types.Panel):
    """What is done most often: posing and reconstructing."""

    bl_label = "Keymark"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the main actions, or the running job."""
        layout = self.layout
        scene = context.scene
        settings = scene.keymark
        if job_is_running(context):
            progress = context.window_manager.keymark_progress
            layout.progress(
                factor=progress.fraction, text=f"{progress.stage} ({100.0 * progress.fraction:.0f}%)"
            )
            layout.label(text="Esc cancels")
            return
        if scene.active_clip is None and settings.armature is None:
            layout.operator("keymark.open_take", icon="FILE_FOLDER")
            layout.operator("keymark.load_footage", icon="FILE_MOVIE")
            return
        row = layout.row(align=True)
        row.operator("keymark.jump_to_proposal", text="", icon="PREV_KEYFRAME").direction = "PREVIOUS"
        row.operator("keymark.store_keyframe", icon="KEY_HLT")
        row.operator("keymark.jump_to_proposal", text="", icon="NEXT_KEYFRAME").direction = "NEXT"
        row = layout.row()
        row.scale_y = 1.4
        row.operator("keymark.reconstruct", icon="ARMATURE_DATA")
        layout.prop(settings, "method", text="")
        _draw_show(layout, settings)


def _draw_show(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """The switch between keyframes and motion, where there is a motion to switch to."""
    if settings.armature is None or settings.motion_action is None:
        return
    data = settings.armature.animation_data
    shown = data.action if data else None
    row = layout.row(align=True)
    for which, action, text in (
        ("KEYFRAMES", settings.keyframe_action, "Keyframes"),
        ("MOTION", settings.motion_action, "Motion"),
    ):
        depress = action is not None and action == shown
        row.operator("keymark.show_action", text=text, depress=depress).which = which


class KEYMARK_PT_keyframes(SubPanel, bpy.types.Panel):
    """Where to pose."""

    bl_label = "Keyframes"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw proposals and method."""
        settings = context.scene.keymark
        column = self.column()
        column.prop(settings, "keyframe_count")
        column.operator("keymark.propose_keyframes", icon="MARKER_HLT")
        column.separator()
        column.prop(settings, "keyframe_action", text="Action")


class KEYMARK_PT_markers(SubPanel, bpy.types.Panel):
    """What the performer wears."""

    bl_label = "Markers"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the list and the active marker."""
        settings = context.scene.keymark
        row = self.layout.row()
        row.template_list("KEYMARK_UL_markers", "", settings, "markers", settings, "active_marker", rows=5)
        buttons = row.column(align=True)
        buttons.operator("keymark.add_marker", text="", icon="ADD")
        buttons.operator("keymark.remove_marker", text="", icon="REMOVE")
        if settings.active_marker < len(settings.markers):
            marker = settings.markers[settings.active_marker]
            column = self.column()
            column.prop(marker, "segment")
            column.prop(marker, "color")
            column.operator("keymark.pick_marker_color", text="Pick from Footage", icon="EYEDROPPER")


class KEYMARK_PT_actor(SubPanel, bpy.types.Panel):
    """Who performs."""

    bl_label = "Actor"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the armature and how to build one."""
        settings = context.scene.keymark
        column = self.column()
        column.prop(settings, "armature")
        column.prop(settings, "stature")
        column.operator("keymark.build_actor", icon="OUTLINER_OB_ARMATURE")


class KEYMARK_PT_footage(SubPanel, bpy.types.Panel):
    """What was filmed."""

    bl_label = "Footage"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw clip, camera and the take's files."""
        scene = context.scene
        column = self.column()
        column.prop(scene, "active_clip", text="Clip")
        column.prop(scene, "camera")
        if scene.camera is not None and scene.camera.type == "CAMERA":
            column.prop(scene.camera.data, "lens")
            column.prop(scene.camera.data, "sensor_width")
        column.operator("keymark.load_footage", icon="FILE_MOVIE")
        row = column.row(align=True)
        row.operator("keymark.open_take", icon="FILE_FOLDER")
        row.operator("keymark.save_take", icon="FILE_TICK")


register, unregister = bpy.utils.register_classes_factory(
    (
        KEYMARK_UL_markers,
        KEYMARK_PT_main,
        KEYMARK_PT_keyframes,
        KEYMARK_PT_markers,
        KEYMARK_PT_actor,
        KEYMARK_PT_footage,
    )
)
