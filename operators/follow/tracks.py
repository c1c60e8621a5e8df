"""Which of a clip's motion tracks follow which body points: as a person chose, else by the tracks' names."""

import bpy
from bpy.types import Context, PropertyGroup

from ...core.body.human import HUMAN
from ...core.detect.keypoints import FACE, FEET, HANDS, SPINE
from ...core.detect.layouts import named_point
from ...core.errors import InputError
from ..bridge.scene_evidence import clip_tracks
from ..shell.base_operator import BaseOperator
from ..shell.fields import Choice, Text
from ..shell.requirements import footage, idle
from ..shell.takes import active_take, redraw_footage
from .marker_properties import segment_title


def assign(take: PropertyGroup, owner: str, track: str, point: str) -> None:
    """Let a motion track follow a body point, or none where it is empty."""
    choices = take.follow.tracks
    for number in reversed(range(len(choices))):
        if (choices[number].owner, choices[number].track) == (owner, track):
            choices.remove(number)
    if point != (named_point(track) or ""):
        choice = choices.add()
        choice.owner, choice.track, choice.point = owner, track, point


Item = tuple[str, str, str]

COLUMNS = (
    ("Joints", HUMAN.point_names),
    ("Head and Trunk", (*FACE, *SPINE)),
    ("Hands and Feet", (*HANDS, *FEET)),
)
"""Heading and points of each column."""
NO_POINT = "NONE"


def body_point_items(without: str = "") -> list[Item]:
    """Items of a menu of the body points; with an entry for none where that has a label."""
    items: list[Item] = [(NO_POINT, without, "")] if without else []
    for heading, points in COLUMNS:
        items.append(("", heading, ""))
        items += [(point, segment_title(point), "") for point in points]
    return items


class KEYMARK_OT_assign_track(BaseOperator, bpy.types.Operator):
    """Choose the body point that this motion track follows; tracks that are named after one need no choice"""

    bl_label = "Assign Track"
    requirements = (footage, idle)

    owner: Text("Object", "Name of the tracking object that the track belongs to")
    track: Text("Track", "Name of the motion track")
    point: Choice(
        "Body Point",
        "The body point that the track follows; left and right are the performer's own",
        items=body_point_items("No Body Point"),
    )

    def run(self, context: Context) -> None:
        take = active_take(context.scene)
        if (self.owner, self.track) not in {(owner, track.name) for owner, track in clip_tracks(take.clip)}:
            raise InputError(f"clip '{take.clip.name}' has no track '{self.track}' of object '{self.owner}'")
        assign(take, self.owner, self.track, "" if self.point == NO_POINT else self.point)
        redraw_footage(context)
