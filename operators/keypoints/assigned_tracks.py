"""Which of a clip's motion tracks follow which body points: as a person chose, else by the tracks' names."""

import bpy

from ...core.footage.keypoints.track_names import named_point
from ..bridge.track_keypoints import AssignedTrack, clip_tracks


def assigned_tracks(take: bpy.types.PropertyGroup) -> tuple[AssignedTrack, ...]:
    """The motion tracks of a take's clip that follow a body point."""
    if take.clip is None:
        return ()
    chosen = _chosen(take)
    found = []
    for owner, track in clip_tracks(take.clip):
        point = chosen.get((owner, track.name))
        point = (named_point(track.name) or "") if point is None else point
        if point:
            found.append(AssignedTrack(owner, track.name, point))
    return tuple(found)


def point_of(take: bpy.types.PropertyGroup, owner: str, track: str) -> str:
    """The body point that a motion track follows; empty for none."""
    point = _chosen(take).get((owner, track))
    return (named_point(track) or "") if point is None else point


def assign(take: bpy.types.PropertyGroup, owner: str, track: str, point: str) -> None:
    """Let a motion track follow a body point, or none where it is empty."""
    choices = take.follow.tracks
    for number in reversed(range(len(choices))):
        if (choices[number].owner, choices[number].track) == (owner, track):
            choices.remove(number)
    if point != (named_point(track) or ""):
        choice = choices.add()
        choice.owner, choice.track, choice.point = owner, track, point


def _chosen(take: bpy.types.PropertyGroup) -> dict[tuple[str, str], str]:
    return {(choice.owner, choice.track): choice.point for choice in take.follow.tracks}
