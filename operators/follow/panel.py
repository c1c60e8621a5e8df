"""What is followed in the clip: a switch for each kind of evidence, what it sees in this frame, its settings.

The viewport's sidebar shows them in the step Performer, and the Movie Clip editor in a panel of their own.
"""

import bpy
from bpy.types import AnyType, Context, PropertyGroup, UILayout

from ...core.errors import pluralize
from ..bridge.footage_camera import may_move
from ..shell import panel
from ..shell.base_operator import capitalized
from ..shell.footage_view import clip_index
from ..shell.panel import KINDS, RowList, draw_progress, draw_sentence, is_roomy, right_end
from ..shell.takes import active_take, assigned_tracks, find_take, point_of
from . import evidence
from .evidence import keypoint_path, keypoint_reading, people_at
from .marker_search import markers_label, still_boxes
from .properties import segment_title

ROWS = 2  # of a list that is seldom long


class KEYMARK_UL_markers(RowList, bpy.types.UIList):
    """Markers with their colors and the number of sampled frames in which they are found."""

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        row = layout.row(align=True)
        swatch = row.row()
        roomy = is_roomy(context)
        swatch.ui_units_x = 1.6 if roomy else 0.8  # a narrow sidebar is left to the names
        swatch.enabled = item.is_picked
        swatch.prop(item, "color", text="")
        row.prop(item, "name", text="", emboss=False)
        status = right_end(row)
        take = active_take(context.scene)
        if item.warning and not roomy:
            status.label(text="", icon="ERROR")
        elif item.is_picked and roomy and not item.has_readout(take):
            status.label(text="", icon="QUESTION")
        elif item.is_picked and roomy:
            status.label(text=f"{item.found}/{item.sampled}", icon="ERROR" if item.warning else "CHECKMARK")
        here = next((index for index, marker in enumerate(take.markers) if marker == item), -1)
        pick = row.row()
        pick.emboss = "NONE" if item.is_picked else "NORMAL"
        pick.operator("keymark.pick_marker_color", text="", icon="EYEDROPPER").row = here


class KEYMARK_UL_ignored_regions(RowList, bpy.types.UIList):
    """Regions of the picture that are never a marker, each with its frames."""

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        row = layout.row(align=True)
        row.prop(item, "name", text="", emboss=False, icon="BRUSH_DATA" if len(item.stroke) else "MESH_PLANE")
        text = f"{item.first_frame} - {item.last_frame}" if item.some_frames else "All Frames"
        right_end(row).label(text=text, translate=False)


def _draw_list(
    layout: UILayout, kind: str, owner: PropertyGroup, entries: str, active: str, rows: int = ROWS
) -> UILayout:
    row = layout.row()
    row.template_list(kind, "", owner, entries, owner, active, rows=rows)
    return row.column(align=True)


def _draw_markers(layout: UILayout, context: Context, take: PropertyGroup) -> None:
    picked = all(marker.is_picked for marker in take.markers)
    pick = layout.row()
    pick.scale_y = 1.3
    if not draw_progress(pick, context, "keymark.pick_markers", "keymark.pick_marker_color"):
        text = "Pick All Anew" if picked and len(take.markers) else "Pick Markers"
        pick.operator("keymark.pick_markers", text=text, translate=False, icon="EYEDROPPER")
    if not len(take.markers):
        layout.operator("keymark.add_usual_markers", icon="COMMUNITY")
        layout.operator("keymark.add_marker", icon="ADD")
        return
    buttons = _draw_list(layout, "KEYMARK_UL_markers", take, "markers", "active_marker", rows=5)
    buttons.operator("keymark.add_marker", text="", icon="ADD")
    buttons.operator("keymark.remove_marker", text="", icon="REMOVE")
    if take.active_marker < len(take.markers):
        marker = take.markers[take.active_marker]
        panel.property_column(layout.column()).prop(marker, "segment")
        readout = layout.column(align=True)
        rows = {
            "Found In": f"{marker.found} of {marker.sampled} frames",
            "Area": f"{marker.area:.0f} px ({100.0 * marker.area_share:.2f}%)",
            "Distinct": f"{100.0 * marker.distinctness:.0f}%",
        }
        for name, value in rows.items() if marker.has_readout(take) else ():
            split = readout.split(factor=0.4)
            right_end(split).label(text=name)
            split.label(text=value, translate=False)
        for sentence in marker.warning.splitlines() if marker.has_readout(take) else ():
            draw_sentence(layout, context, sentence, icon="ERROR")
    _draw_ignored(layout, context, take)
    row = panel.side_by_side(layout)
    if not draw_progress(row, context, "keymark.check_markers"):
        row.operator("keymark.check_markers", icon="VIEWZOOM")
    shown = context.window_manager.keymark_show_masks
    row.operator("keymark.show_masks", icon="HIDE_OFF" if shown else "HIDE_ON", depress=shown)


def _draw_ignored(layout: UILayout, context: Context, take: PropertyGroup) -> None:
    if not draw_progress(layout, context, "keymark.ignore_region", "keymark.ignore_still_areas"):
        row = layout.row(align=True)
        row.operator("keymark.ignore_region", icon="BRUSH_DATA")
        if still_boxes(take):
            row.operator("keymark.ignore_still_areas")
    if not len(take.ignored_regions):
        return
    buttons = _draw_list(layout, "KEYMARK_UL_ignored_regions", take, "ignored_regions", "active_ignored")
    buttons.operator("keymark.remove_ignored_region", text="", icon="REMOVE")
    if take.active_ignored < len(take.ignored_regions):
        region, column = take.ignored_regions[take.active_ignored], panel.property_column(layout.column())
        column.prop(region, "some_frames")
        if region.some_frames:
            frames = column.column(align=True)
            frames.prop(region, "first_frame")
            frames.prop(region, "last_frame")


class KEYMARK_UL_keypoint_files(RowList, bpy.types.UIList):
    """Files of keypoints: a switch, the detector, and the points it sees in this frame."""

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        take = active_take(context.scene)
        people = keypoint_reading(take, item).people
        row = layout.row(align=True)
        row.prop(item, "is_used", text="")
        row.label(text=keypoint_path(item).name if people is None else people.source, translate=False)
        status = right_end(row)
        if people is None:
            status.label(text="", icon="ERROR")
            return
        here = people_at(people, clip_index(take))
        status.label(text=f"{here.seen_count}/{len(here.names)}", translate=False)


class KEYMARK_UL_clicked_points(RowList, bpy.types.UIList):
    """Points that were clicked on in this frame; a list, so that panels keep their height in all frames."""

    use_filter_show = False

    def filter_items(self, context: Context, data: AnyType, name: str) -> tuple[list[int], list[int]]:
        here = evidence.clip_frame(active_take(context.scene))
        return [self.bitflag_filter_item if each.frame == here else 0 for each in getattr(data, name)], []

    def draw_row(self, context: Context, layout: UILayout, item: PropertyGroup) -> None:
        row = layout.row(align=True)
        row.label(text=segment_title(item.point), icon="DOT")
        row.operator("keymark.remove_clicks", text="", icon="X", emboss=False).point = item.point


def _draw_keypoints(layout: UILayout, context: Context, take: PropertyGroup) -> None:
    follow = take.follow
    if not draw_progress(layout, context, "keymark.detect_keypoints"):
        layout.operator("keymark.detect_keypoints", icon="VIEWZOOM")
    if not len(follow.files):
        layout.operator("keymark.load_keypoints", icon="FILE_FOLDER")
    else:
        buttons = _draw_list(layout, "KEYMARK_UL_keypoint_files", follow, "files", "active_file")
        buttons.operator("keymark.load_keypoints", text="", icon="ADD")
        buttons.operator("keymark.remove_keypoints", text="", icon="REMOVE")
        if follow.active_file < len(follow.files):
            _draw_file(layout, context, take, follow.files[follow.active_file])
    layout.separator()
    column = layout.column()
    column.operator("keymark.click_point", icon="RESTRICT_SELECT_OFF")
    if len(follow.clicks):
        row = column.row(align=True)
        text = f"{len(evidence.clicked_here(take))} here, {len(follow.clicks)} in all"
        row.label(text=text, translate=False, icon="CHECKMARK")
        row.operator("keymark.remove_clicks", text="", icon="TRASH")
        source = (follow, "clicks", follow, "active_click")
        layout.template_list("KEYMARK_UL_clicked_points", "", *source, rows=ROWS)


def _draw_file(layout: UILayout, context: Context, take: PropertyGroup, entry: PropertyGroup) -> None:
    reading, path = keypoint_reading(take, entry), keypoint_path(entry)
    people = reading.people
    if people is None:
        box = layout.box().column()
        if reading.is_missing:
            box.label(text="The file of keypoints is missing", icon="ERROR")
            box.label(text=path.name, translate=False, icon="BLANK1")
            box.operator("keymark.load_keypoints", text="Find File", icon="VIEWZOOM").replace = True
        else:
            draw_sentence(box, context, reading.problem, "ERROR")
        return
    for note in people.notes:
        draw_sentence(layout, context, capitalized(note), "ERROR")
    if people.most_people > 1:
        row = layout.row(align=True)
        count = len(people_at(people, clip_index(take)).pixel)
        row.label(text=pluralize(count, "person here", "people here"), translate=False, icon="COMMUNITY")
        row.operator("keymark.click_performer", text="Click Performer")
    if reading.has_changed:
        row = layout.row(align=True)
        row.label(text="The file has changed", icon="FILE_REFRESH")
        row.operator("keymark.load_keypoints", text="Reload").filepath = str(path)


class KEYMARK_UL_tracks(bpy.types.UIList):
    """Motion tracks of a tracking object, each with the body point that it follows."""

    def draw_item(
        self,
        context: Context,
        layout: UILayout,
        data: AnyType,
        item: AnyType,
        icon: int,
        active_data: AnyType,
        active_property: str,
    ) -> None:
        point = point_of(active_take(context.scene), data.name, item.name)
        row = layout.split(factor=0.45)
        row.label(text=item.name, translate=False, icon="TRACKER" if point else "BLANK1")
        text = segment_title(point) if point else "Not Followed"
        entry = row.operator_menu_enum("keymark.assign_track", "point", text=text)
        entry.owner, entry.track = data.name, item.name


def _draw_tracks(layout: UILayout, context: Context, take: PropertyGroup) -> None:
    objects = [each for each in take.clip.tracking.objects if len(each.tracks)] if take.clip else []
    if not objects:
        hint = "Track elbows, wrists, knees or ankles in the Movie Clip editor, and name the tracks"
        draw_sentence(layout, context, hint, "INFO")
        return
    for each in objects:
        if len(objects) > 1:
            layout.label(text=each.name, translate=False)
        rows = min(max(len(each.tracks), ROWS), 5)
        source = (each, "tracks", take.follow, "active_track")
        layout.template_list("KEYMARK_UL_tracks", each.name, *source, rows=rows)
    text = pluralize(len(assigned_tracks(take)), "track is followed", "tracks are followed")
    layout.label(text=text, translate=False)


def _draw_contours(layout: UILayout, context: Context, take: PropertyGroup) -> None:
    if take.camera is None:
        sentence = "Contours need the camera of the footage"
    elif may_move(take.camera):
        sentence = "The camera moves, so that no background stands still: they cannot be used"
    else:
        sentence = "The camera stands still: the body is told from the background in any clothes"
    draw_sentence(layout, context, sentence, "INFO")


DRAWN = {
    "markers": (markers_label, _draw_markers),
    "keypoints": (evidence.keypoints_label, _draw_keypoints),
    "tracks": (evidence.tracks_label, _draw_tracks),
    "contours": (evidence.contours_label, _draw_contours),
}
"""What each kind sees in this frame, and its settings."""


def draw_evidence(layout: UILayout, context: Context, take: PropertyGroup) -> None:
    """Draw the kinds of evidence; one at most is unfolded."""
    if not followed(take):
        hint = "Any clothes will do: detect or load keypoints. Five strong colors tell most"
        draw_sentence(layout, context, hint, "INFO")
    layout.use_property_split = False  # a list's rows would be split too
    for kind in KINDS:
        readout, draw_settings = DRAWN[kind]
        header, body = layout.panel_prop(context.window_manager.keymark_steps, kind)
        header.prop(take.follow, f"use_{kind}", text=kind.title())
        words = readout(take)
        if is_roomy(context) or len(words) <= 7:  # else it would lie on the name
            right = right_end(header)
            right.active = False
            right.label(text=words, translate=False)
        if body is not None:
            body.active = getattr(take.follow, f"use_{kind}")
            draw_settings(body, context, take)


def followed(take: PropertyGroup) -> str:
    """Names of the kinds that something was picked, loaded or clicked for."""
    follow = take.follow
    used = (
        ("Markers", follow.use_markers and len(take.markers)),
        ("Keypoints", follow.use_keypoints and (len(follow.files) or len(follow.clicks))),
    )
    return ", ".join(name for name, is_used in used if is_used)


class KEYMARK_PT_clip_follow(bpy.types.Panel):
    """The same in the Movie Clip editor."""

    bl_label = "Performer"
    bl_space_type = "CLIP_EDITOR"
    bl_region_type = "UI"
    bl_category = "Keymark"

    @classmethod
    def poll(cls, context: Context) -> bool:
        return find_take(context.scene) is not None

    def draw_header_preset(self, context: Context) -> None:
        self.layout.popover("KEYMARK_PT_overlays", text="", icon="OVERLAY")

    def draw(self, context: Context) -> None:
        if context.space_data.clip != active_take(context.scene).clip:
            self.layout.label(text="The editor shows another clip", icon="INFO")
        draw_evidence(self.layout, context, active_take(context.scene))
