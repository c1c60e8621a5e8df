"""Properties of what a take follows: markers, what is never one, keypoints, tracks and clicked points."""

from collections.abc import Iterable
from functools import partial
from typing import Any

import bpy
from bpy.types import Context, PropertyGroup

from ...core.body.human import HUMAN
from ...core.detect.keypoints import FACE, FEET, HANDS, SPINE
from ...core.markers.ignored_regions import IgnoredRegion
from ..shell.fields import HIDDEN, RELATIVE_PATH, Choice, Entries, Integer, Number, Switch, Text, Vector
from ..shell.takes import footage_of, redraw_footage, unique_name


def take_of(entry: PropertyGroup, entries: str) -> PropertyGroup | None:
    """The take in whose list of that name an entry is."""
    takes = entry.id_data.keymark.takes
    return next((take for take in takes if any(each == entry for each in getattr(take, entries))), None)


def clear_readouts(take: PropertyGroup | None) -> None:
    """Clear the readouts of a take's markers: each depends on all markers, and on what is ignored."""
    for marker in take.markers if take is not None else ():
        marker.sampled = 0


def _changed(region: PropertyGroup, context: Context) -> None:
    clear_readouts(take_of(region, "ignored_regions"))


def _scene_frame(name: str, description: str, counted: str) -> Any:
    """A region's first or last frame, `counted` from the clip's first, as the scene's frame."""

    def clip_start(region: PropertyGroup) -> int:
        take = take_of(region, "ignored_regions")
        has_clip = take is not None and take.clip is not None
        return footage_of(region.id_data, take).first_frame if has_clip else 1

    def shown(region: PropertyGroup) -> int:
        return int(getattr(region, counted)) + clip_start(region)

    def choose(region: PropertyGroup, frame: int) -> None:
        chosen = max(frame - clip_start(region), 0)
        setattr(region, counted, chosen)
        if region.last < region.first:
            region.first = region.last = chosen
        _changed(region, bpy.context)

    return Integer(name, description, get=shown, set=choose)


class KEYMARK_PG_stroke_point(bpy.types.PropertyGroup):
    """A point of a brush's path."""

    pixel: Vector("Pixel", "Where, in pixels of the footage from its top left corner", size=2)


class KEYMARK_PG_ignored_region(bpy.types.PropertyGroup):
    """A region of the picture that is never a marker."""

    name: Text("Name", "Your name for this region")
    box: Vector("Box", "Left, top, right, bottom of a box in pixels of the footage; not of a stroke", size=4)
    stroke: Entries(type=KEYMARK_PG_stroke_point)
    radius: Number("Radius", "The brush's radius in pixels of the footage", min=0.0)
    some_frames: Switch(
        "Some Frames Only",
        "Leave the region out in the frames from first to last, not in the whole clip",
        default=False,
        update=_changed,
    )
    first: Integer("First", "Its first frame, counted from the clip's first", options=HIDDEN)
    last: Integer("Last", "Its last frame, counted from the clip's first", options=HIDDEN)
    first_frame: _scene_frame("First Frame", "First scene frame in which the region is left out", "first")
    last_frame: _scene_frame("Last Frame", "Last frame of the scene in which the region is left out", "last")


def ignored_regions(take: PropertyGroup) -> tuple[IgnoredRegion, ...]:
    """The regions of a take."""

    def rounded(numbers: Iterable[float]) -> tuple[Any, ...]:
        # Files keep two decimals of a pixel: Blender's own numbers are of single precision.
        return tuple(round(float(value), 2) for value in numbers)

    regions = []
    for region in take.ignored_regions:
        frames = (int(region.first), int(region.last)) if region.some_frames else None
        stroke, (radius_px,) = tuple(rounded(each.pixel) for each in region.stroke), rounded([region.radius])
        brushed = {"stroke": stroke, "radius_px": radius_px} if stroke else {"box": rounded(region.box)}
        regions.append(IgnoredRegion(**brushed, frames=frames))
    return tuple(regions)


def add_ignored_regions(take: PropertyGroup, regions: Iterable[IgnoredRegion]) -> None:
    """Add regions to a take; the last becomes the active one."""
    length = take.clip.frame_duration if take.clip is not None else 1
    for region in regions:
        name = "Brushed" if region.box is None else "Still Area"
        made = take.ignored_regions.add()
        made.name = unique_name(name, [each.name for each in take.ignored_regions if each != made])
        if region.box is not None:
            made.box = region.box
        for pixel in region.stroke or ():
            made.stroke.add().pixel = pixel
        made.radius = region.radius_px or 0.0
        made.first, made.last = region.frames or (0, max(length - 1, 0))
        made.some_frames = region.frames is not None
        take.active_ignored = len(take.ignored_regions) - 1


SEGMENTS = ("trunk", *(each.name for each in HUMAN.segments if not each.name.startswith("girdle")))
"""Segments that a marker can be bound to: the whole trunk, and all that have a volume."""


def segment_title(segment: str) -> str:
    """Return a segment's label."""
    part, _, side = segment.partition(".")
    return part.replace("_", " ").title() + {"L": " Left", "R": " Right", "": ""}[side]


def _on_changed(marker: PropertyGroup, context: Context) -> None:
    if marker.is_picked:
        clear_readouts(take_of(marker, "markers"))


def _on_segment_changed(marker: PropertyGroup, context: Context) -> None:
    if marker.name == marker.named_after:
        marker.name = marker.named_after = marker.segment


class KEYMARK_PG_marker(bpy.types.PropertyGroup):
    """A colored marker, and its readout from the footage."""

    name: Text("Name", "The marker's name", update=_on_changed)
    segment: Choice(
        "Segment",
        "The body part that wears the marker; left and right are the performer's own",
        items=[(segment, segment_title(segment), "") for segment in SEGMENTS],
        update=_on_segment_changed,
    )
    color: Vector(
        "Color",
        "The marker's color in the footage; one sample is enough",
        subtype="COLOR_GAMMA",
        size=3,
        min=0.0,
        max=1.0,
        default=(0.5, 0.5, 0.5),
        update=_on_changed,
    )
    named_after: Text(
        "Named After",
        "The segment that the name was taken from; the name follows it until you change it",
        options=HIDDEN,
    )
    sampled: Integer("Sampled Frames", "Frames in which the marker was looked for; 0 for none yet")
    found: Integer("Found In", "Sampled frames in which the marker was found")
    area: Number("Area", "Area that the marker usually covers, in pixels of the footage")
    area_share: Number("Share of the Picture", "Share of the picture that the marker usually covers")
    distinctness: Number(
        "Distinctness",
        "Certainty that its color belongs to the marker and nothing else in the footage, 0 to 1",
    )
    warning: Text("Warning", "Likely problems with the marker, one sentence a line")
    still_areas: Entries(type=KEYMARK_PG_ignored_region)
    checked_clip: Text("Checked Clip", "Digest of the clip in which the marker was sought", options=HIDDEN)

    @property
    def is_picked(self) -> bool:
        return bool(self.is_property_set("color"))

    def has_readout(self, take: PropertyGroup) -> bool:
        """Whether the readout is of the footage of the take that the marker belongs to."""
        contents = take.clip_state.contents
        return bool(self.sampled and take.clip is not None and self.checked_clip == contents)


COLUMNS = (
    ("Joints", HUMAN.point_names),
    ("Head and Trunk", (*FACE, *SPINE)),
    ("Hands and Feet", (*HANDS, *FEET)),
)
"""Heading and points of each column."""
NO_POINT = "NONE"


def body_point_items(without: str = "") -> list[tuple[str, str, str]]:
    """Items of a menu of the body points; with an entry for none where that has a label."""
    items: list[tuple[str, str, str]] = [(NO_POINT, without, "")] if without else []
    for heading, points in COLUMNS:
        items.append(("", heading, ""))
        items += [(point, segment_title(point), "") for point in points]
    return items


def _redraw(_group: PropertyGroup, context: Context) -> None:
    redraw_footage(context)  # where the keypoints are drawn


_shown = partial(Switch, default=True, update=_redraw)


class KEYMARK_PG_keypoint_file(bpy.types.PropertyGroup):
    """A file of keypoints, or a folder with a file a frame."""

    filepath: Text(
        "File",
        "The file of keypoints, or the folder with a file a frame",
        subtype="FILE_PATH",
        options=RELATIVE_PATH,
    )
    absolute_path: Text(
        "Absolute Path", "The same from the root, for a .blend that is saved elsewhere", options=HIDDEN
    )
    is_used: _shown("Use", "Hold the motion against these keypoints")
    contents: Text("Contents", "Digest of the file when it was loaded", options=HIDDEN)


class KEYMARK_PG_track_choice(bpy.types.PropertyGroup):
    """What a person chose a motion track of the clip to follow, whatever its name."""

    owner: Text("Object", "Name of the tracking object that the track belongs to")
    track: Text("Track", "Name of the motion track")
    point: Text("Body Point", "The body point that it follows; empty for none")


class KEYMARK_PG_clicked_point(bpy.types.PropertyGroup):
    """A body point that was clicked on in one frame."""

    point: Text("Body Point", "The point of the body")
    frame: Integer("Frame", "Frames after the clip's first one")
    pixel: Vector("Pixel", "Where, in pixels of the footage from its top left corner", size=2)


class KEYMARK_PG_follow(bpy.types.PropertyGroup):
    """What a take follows in the footage."""

    use_markers: _shown("Follow Markers", "Hold the motion against the colored markers of the list")
    use_keypoints: _shown(
        "Follow Keypoints",
        "Hold the motion against points of the body that a detector found or you clicked on",
    )
    use_depth_hints: Switch(
        "Depth Hints",
        "Take a detector's guess of depths as a hint, where its file has one; "
        "it is calibrated at your keyframes and never believed over them",
        default=True,
    )
    use_hands: Switch(
        "Hands",
        "Look at hands where they are large enough, so that palms face where they are seen to; what you pose "
        "stays as it is",
        default=True,
    )
    use_tracks: _shown(
        "Follow Tracks", "Hold the motion against the clip's own motion tracks that follow points of the body"
    )
    use_contours: Switch(
        "Follow Contours",
        "Hold the motion against the outline of the body, where the camera stands still",
        default=True,
    )
    reference: Text(
        "Reference Motion",
        "A 3D motion of the same performance from elsewhere, as a neural network's: it is "
        "turned, placed and mended as the footage shows, and needs no keyframes",
        subtype="FILE_PATH",
        options=RELATIVE_PATH,
    )
    files: Entries(type=KEYMARK_PG_keypoint_file)
    active_file: Integer("Active File", "The file of keypoints that is chosen in the list", default=0, min=0)
    tracks: Entries(type=KEYMARK_PG_track_choice)
    active_track: Integer("Active Track", "The track that is chosen in the list", default=0, min=0)
    clicks: Entries(type=KEYMARK_PG_clicked_point)
    active_click: Integer("Active Click", "The clicked point that is chosen in the list", default=0, min=0)
    clicked_point: Choice(
        "Body Point",
        "The point of the body to click on next; left and right are the performer's own",
        items=body_point_items(),
        default="wrist.L",
    )


ATTACHED = {
    "WindowManager.keymark_show_masks": Switch(
        "Show Masks", "Highlight the markers' colors over the footage", default=False
    )
}
"""No file keeps it."""
