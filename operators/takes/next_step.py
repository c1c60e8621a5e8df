"""The next step of the work on a take, from properties alone, so that it can be drawn."""

import bpy

from ..keypoints.evidence import has_contours, has_keypoints
from ..overlays.timeline_figures import DOUBTED
from ..shell.found_frames import doubtful_matches
from ..shell.keyed_frames import is_posed, keyframes_of, matched_frames, unposed_proposals
from ..shell.placement_guess import placement_is_guess
from ..shell.takes import has_lost_actor, present_actor

FEWEST_KEYFRAMES = 2


def next_step(take: bpy.types.PropertyGroup) -> str:
    """Return a label short enough for a narrow sidebar."""
    if take.clip is None:
        return "Next: load the footage"
    if take.clip_state.missing:
        return "Next: find the clip's file"
    if placement_is_guess(take):
        return "Next: say where the camera stood"
    follow = take.follow
    if follow.use_markers and any(not marker.is_picked for marker in take.markers):
        return "Next: pick the markers' colors"
    if has_lost_actor(take):
        return "Next: bring the actor back"
    has_actor = present_actor(take) is not None
    followed = (follow.use_markers and len(take.markers)) or has_keypoints(take)
    # Contours need nothing to be done: whoever goes on to the actor follows these alone.
    if not followed and not (has_actor and has_contours(take)):
        return "Next: choose what to follow"
    if not has_actor:
        return "Next: build the actor"
    if not len(take.proposals) and not keyframes_of(take):
        return "Next: pose all keyframes" if followed else "Next: propose keyframes"
    if take.motion_action is None:
        if unposed_proposals(take) and not matched_frames(take):
            return "Next: pose all keyframes" if followed else "Next: pose the proposed frames"
        if len(keyframes_of(take)) < FEWEST_KEYFRAMES:
            return "Next: pose and store keyframes"
        if doubtful_matches(take):
            return "Next: check doubtful ones, reconstruct"
        return "Next: reconstruct the motion"
    if (take.finish.action is None or take.finish.outdated) and is_doubtful(take):
        return _how_to_better(take)
    if take.finish.action is None:
        return "Next: review, then finish"
    if take.finish.outdated:
        return "Next: review, then bake again"
    if any(result.outdated for character in take.characters for result in character.results):
        return "Next: retarget the character again"
    if not any(result.action for character in take.characters for result in character.results):
        return "Next: a character, or export"
    return "Next: mark as asset, or export"


def is_doubtful(take: bpy.types.PropertyGroup) -> bool:
    """Whether a take's motion is to be corrected and not finished: no better than chance."""
    return 0.0 <= take.review.confidence < DOUBTED


def _how_to_better(take: bpy.types.PropertyGroup) -> str:
    """What makes a doubtful motion better: the keyframes are what it lacks."""
    weak = [each.frame for each in take.review.weak_frames]
    if doubtful_matches(take):
        return "Next: check the doubtful poses"
    if any(not is_posed(take, frame) for frame in weak):
        return "Next: pose the weak frames"
    return "Next: reconstruct again" if weak else "Next: pose more keyframes"
