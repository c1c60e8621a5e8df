"""The settings of keypoints, tracks and contours."""

import bpy

from ..bridge.footage_camera import may_move
from ..shell.base_operator import capitalized
from ..shell.footage_view import clip_index
from ..shell.panel import RowList, draw_progress, draw_sentence
from ..shell.takes import active_take
from .evidence import clip_frame, keypoint_path
from .frame_keypoints import clicked_label, keypoint_reading, people_at
from .marker_properties import segment_title
from .tracks import assigned_tracks, point_of

FEWEST_ROWS, MOST_ROWS = 2, 5


class KEYMARK_UL_keypoint_files(RowList, bpy.types.UIList):
    """Files of keypoints: a switch, the detector, and the points it sees in this frame."""

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        take = active_take(context.scene)
        reading = keypoint_reading(take, item)
        row = layout.row(align=True)
        row.prop(item, "is_used", text="")
        row.label(
            text=reading.people.source if reading.people is not None else keypoint_path(item).name,
            translate=False,
        )
        status = row.row()
        status.alignment = "RIGHT"
        if reading.people is None:
            status.label(text="", icon="ERROR")
            return
        here = people_at(reading.people, clip_index(take))
        status.label(text=f"{here.seen_count}/{len(here.names)}", translate=False)


class KEYMARK_UL_tracks(bpy.types.UIList):
    """Motion tracks of a tracking object, each with the body point that it follows."""

    def draw_item(
        self,
        context: bpy.types.Context,
        layout: bpy.types.UILayout,
        data: bpy.types.AnyType,
        item: bpy.types.AnyType,
        icon: int,
        active_data: bpy.types.AnyType,
        active_property: str,
    ) -> None:
        take = active_take(context.scene)
        point = point_of(take, data.name, item.name)
        row = layout.split(factor=0.45)
        row.label(text=item.name, translate=False, icon="TRACKER" if point else "BLANK1")
        text = segment_title(point) if point else "Not Followed"
        entry = row.operator_menu_enum("keymark.assign_track", "point", text=text)
        entry.owner, entry.track = data.name, item.name


class KEYMARK_UL_clicked_points(RowList, bpy.types.UIList):
    """Points that were clicked on in this frame; a list, so that panels keep their height in all frames."""

    use_filter_show = False

    def filter_items(
        self, context: bpy.types.Context, data: bpy.types.AnyType, name: str
    ) -> tuple[list[int], list[int]]:
        here = clip_frame(active_take(context.scene))
        return [self.bitflag_filter_item if each.frame == here else 0 for each in getattr(data, name)], []

    def draw_row(
        self, context: bpy.types.Context, layout: bpy.types.UILayout, item: bpy.types.PropertyGroup
    ) -> None:
        row = layout.row(align=True)
        row.label(text=segment_title(item.point), icon="DOT")
        row.operator("keymark.remove_clicks", text="", icon="X", emboss=False).point = item.point


def draw_keypoints(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw files of detectors, and points that are clicked on."""
    _draw_files(layout, context, take)
    layout.separator()
    _draw_clicks(layout, take)


def draw_tracks(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw the motion tracks of each tracking object that has any, and what they follow."""
    objects = [each for each in take.clip.tracking.objects if len(each.tracks)] if take.clip else []
    if not objects:
        hint = "Track elbows, wrists, knees or ankles in the Movie Clip editor, and name the tracks"
        draw_sentence(layout, context, hint, "INFO")
        return
    for each in objects:
        if len(objects) > 1:
            layout.label(text=each.name, translate=False)
        rows = min(max(len(each.tracks), FEWEST_ROWS), MOST_ROWS)
        source = (each, "tracks", take.follow, "active_track")
        layout.template_list("KEYMARK_UL_tracks", each.name, *source, rows=rows)
    count = len(assigned_tracks(take))
    text = "1 track is followed" if count == 1 else f"{count} tracks are followed"
    layout.label(text=text, translate=False)


def draw_contours(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw whether the outline of the body can be followed, and why."""
    if take.camera is None:
        sentence = "Contours need the camera of the footage"
    elif may_move(take.camera):
        sentence = "The camera moves, so that no background stands still: they cannot be used"
    else:
        sentence = "The camera stands still: the body is told from the background in any clothes"
    draw_sentence(layout, context, sentence, "INFO")


def _draw_files(
    layout: bpy.types.UILayout, context: bpy.types.Context, take: bpy.types.PropertyGroup
) -> None:
    """Draw the list of files and the chosen one, or the button that loads the first."""
    follow = take.follow
    if not draw_progress(layout, context, "keymark.detect_keypoints"):
        layout.operator("keymark.detect_keypoints", icon="VIEWZOOM")
    if not len(follow.files):
        layout.operator("keymark.load_keypoints", icon="FILE_FOLDER")
        return
    row = layout.row()
    source = (follow, "files", follow, "active_file")
    row.template_list("KEYMARK_UL_keypoint_files", "", *source, rows=FEWEST_ROWS, maxrows=MOST_ROWS)
    buttons = row.column(align=True)
    buttons.operator("keymark.load_keypoints", text="", icon="ADD")
    buttons.operator("keymark.remove_keypoints", text="", icon="REMOVE")
    if follow.active_file < len(follow.files):
        _draw_file(layout, context, take, follow.files[follow.active_file])


def _draw_file(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    take: bpy.types.PropertyGroup,
    entry: bpy.types.PropertyGroup,
) -> None:
    """Draw what the chosen file sees in this frame, or what is wrong with it."""
    reading, path = keypoint_reading(take, entry), keypoint_path(entry)
    if reading.people is None:
        box = layout.box().column()
        if reading.is_missing:
            box.label(text="The file of keypoints is missing", icon="ERROR")
            box.label(text=path.name, translate=False, icon="BLANK1")
            box.operator("keymark.load_keypoints", text="Find File", icon="VIEWZOOM").replace = True
        else:
            draw_sentence(box, context, reading.problem, "ERROR")
        return
    people = reading.people
    here = people_at(people, clip_index(take))
    for note in people.notes:
        draw_sentence(layout, context, capitalized(note), "ERROR")
    if people.most_people > 1:
        row = layout.row(align=True)
        text = "1 person here" if len(here.pixel) == 1 else f"{len(here.pixel)} people here"
        row.label(text=text, translate=False, icon="COMMUNITY")
        row.operator("keymark.click_performer", text="Click Performer")
    if reading.has_changed:
        row = layout.row(align=True)
        row.label(text="The file has changed", icon="FILE_REFRESH")
        row.operator("keymark.load_keypoints", text="Reload").filepath = str(path)


def _draw_clicks(layout: bpy.types.UILayout, take: bpy.types.PropertyGroup) -> None:
    """Draw the button that asks for points, and those of this frame."""
    follow, column = take.follow, layout.column()
    column.operator("keymark.click_point", icon="RESTRICT_SELECT_OFF")
    if not len(follow.clicks):
        return
    row = column.row(align=True)
    row.label(text=clicked_label(take), translate=False, icon="CHECKMARK")
    row.operator("keymark.remove_clicks", text="", icon="TRASH")
    source = (follow, "clicks", follow, "active_click")
    layout.template_list("KEYMARK_UL_clicked_points", "", *source, rows=FEWEST_ROWS, maxrows=MOST_ROWS)
