"""Properties of a region of the picture that is never a marker: a box, or the stroke of a brush."""

import bpy

from ..shell.takes import footage_of


def _changed(region: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """What was found of the markers depends on what is ignored."""
    for take in region.id_data.keymark.takes:
        if any(other == region for other in take.ignored_regions):
            for marker in take.markers:
                marker.sampled = 0


def _clip_start(region: bpy.types.PropertyGroup) -> int:
    """Scene frame of the first frame of the clip of the region's take; 1 without a clip."""
    scene = region.id_data
    for take in scene.keymark.takes:
        if take.clip is not None and any(other == region for other in take.ignored_regions):
            return footage_of(scene, take).first_frame
    return 1


def _shown_first(region: bpy.types.PropertyGroup) -> int:
    return int(region.first) + _clip_start(region)


def _shown_last(region: bpy.types.PropertyGroup) -> int:
    return int(region.last) + _clip_start(region)


def _set_first(region: bpy.types.PropertyGroup, frame: int) -> None:
    region.first = max(frame - _clip_start(region), 0)
    region.last = max(region.last, region.first)
    _changed(region, bpy.context)


def _set_last(region: bpy.types.PropertyGroup, frame: int) -> None:
    region.last = max(frame - _clip_start(region), 0)
    region.first = min(region.first, region.last)
    _changed(region, bpy.context)


class KEYMARK_PG_stroke_point(bpy.types.PropertyGroup):
    """A point of a brush's path."""

    pixel: bpy.props.FloatVectorProperty(
        name="Pixel", description="Where, in pixels of the footage from its top left corner", size=2
    )


class KEYMARK_PG_ignored_region(bpy.types.PropertyGroup):
    """A region of the picture that is never a marker."""

    name: bpy.props.StringProperty(name="Name", description="Your name for this region")
    box: bpy.props.FloatVectorProperty(
        name="Box",
        description="Left, top, right and bottom of a box in pixels of the footage; unused by a stroke",
        size=4,
    )
    stroke: bpy.props.CollectionProperty(type=KEYMARK_PG_stroke_point)
    radius: bpy.props.FloatProperty(
        name="Radius", description="The brush's radius in pixels of the footage", min=0.0
    )
    some_frames: bpy.props.BoolProperty(
        name="Some Frames Only",
        description="Leave the region out in the frames from first to last, not in the whole clip",
        default=False,
        update=_changed,
    )
    first: bpy.props.IntProperty(
        name="First", description="Its first frame, counted from the clip's first", options={"HIDDEN"}
    )
    last: bpy.props.IntProperty(
        name="Last", description="Its last frame, counted from the clip's first", options={"HIDDEN"}
    )
    first_frame: bpy.props.IntProperty(
        name="First Frame",
        description="First frame of the scene in which the region is left out",
        get=_shown_first,
        set=_set_first,
    )
    last_frame: bpy.props.IntProperty(
        name="Last Frame",
        description="Last frame of the scene in which the region is left out",
        get=_shown_last,
        set=_set_last,
    )


register, unregister = bpy.utils.register_classes_factory(
    (KEYMARK_PG_stroke_point, KEYMARK_PG_ignored_region)
)
