"""Posing a frame: fitted to the footage, and keyed, which improves the found keyframes around it."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.types import Context, Event, Operator, PropertyGroup, Scene

from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.errors import KeymarkError
from ...core.prior.texts import COMPOSED
from ...core.progress import run
from ..bridge.actions import assign_action
from ..bridge.armature import read_body
from ..bridge.keyframes import NOTICEABLE_M, store_pose
from ..bridge.pose import read_posture, write_posture
from ..bridge.scene_frames import at_scene_frame, scene_frames, showing_action
from ..follow.evidence import scene_evidence
from ..follow.marker_search import marker_styles
from ..follow.properties import ignored_regions
from ..library.registry import named_libraries
from ..shell import keyed_frames, need
from ..shell.base_operator import BaseOperator, operator, warn
from ..shell.fields import Choice
from ..shell.keyed_frames import has_frame, new_keyframe_action, show_keyframes, straighten_unposed
from ..shell.notes import give_notices, note_contradictions
from ..shell.results import MADE, reading_of
from ..shell.take_state import TakeState
from ..shell.takes import active_take, footage_of
from .found_properties import known_matches
from .scene_session import read_session

if TYPE_CHECKING:
    from ...core.markers.reading import Reading


SAME_POSE = 1e-3  # change of a pose below which nobody changed it [m, rad]


def improve_neighbors(context: Context, take: PropertyGroup, frame: float) -> int:
    """Pose the found keyframes around one that was just stored, accepted or replaced; return their number.

    To be called within the same operator, so that one undo takes both back. Posed keyframes, and those whose
    candidate a person chose, never change; none does where the footage was not read as it is followed now.
    """
    reading = reading_of(take)
    if not known_matches(take, by_hand=False) or reading is None or take.clip_state.missing:
        return 0
    from ...core.markers.reading import of_same_footage, reading_key

    # The correction holds even where nothing can be found around it.
    with suppress(KeymarkError), _waiting(context):
        footage = footage_of(context.scene, take)
        markers, ignored = marker_styles(take) if take.follow.use_markers else (), ignored_regions(take)
        if of_same_footage(reading.key, reading_key(footage.path, footage.rate, markers, None, ignored)):
            return _pose_anew(context.scene, take, reading, frame)
    return 0


def _pose_anew(scene: Scene, settings: PropertyGroup, reading: "Reading", frame: float) -> int:
    from ...core.poses.clip import pose_clip
    from ...core.poses.clip_input import section_around, take_around
    from ...core.session.stages import seen_in
    from .found_result import write_found

    known = run(read_session(scene, settings, known_matches(settings, by_hand=False))).session.inputs.take
    frames = scene_frames(reading.tracks.time_s, known.frame_start, known.fps)
    corrected = int(np.argmin(np.abs(frames - frame)))
    section = section_around(reading.tracks.time_s, corrected, known.keyframes)
    if not section.changed:
        return 0
    take = take_around(known, section)
    matching = settings.matching
    floor_m = float(matching.floor_found) if matching.is_property_set("floor_found") else None
    libraries = named_libraries(matching.library_name)
    between = section.first, section.last
    job = pose_clip(seen_in(take, reading, MADE), libraries, floor_m, between=between, frames=section.changed)
    found = run(job)
    keyframes = [found.keyframe(each) for each in found.frames]
    for each in keyframes:
        matching.matches.remove(TakeState(settings).match_at(float(frames[each.index])))
    write_found(settings, frames, keyframes, found)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    return len(keyframes)


@contextmanager
def _waiting(context: Context) -> Iterator[None]:
    """The mouse shows meanwhile that Blender is busy."""
    window = None if bpy.app.background else context.window
    if window is not None:
        window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        if window is not None:
            window.cursor_modal_restore()


def note_corrected(take: PropertyGroup, frame: float, in_depth: bool) -> None:
    """Remember that the pose shown at a frame without a key was corrected, and whether in depth as well."""
    matching = take.matching
    before = matching.corrected_in_depth and abs(matching.corrected_frame - frame) < keyed_frames.SAME_FRAME
    matching.corrected_frame, matching.corrected_in_depth = frame, in_depth or before


def _depth_found(take: PropertyGroup, body: Body, posture: Posture, frame: float) -> bool:
    """Whether the pose shown has the depth that was found: corrected in the picture alone, or as keyed."""
    if take.keyframe_action is None or not TakeState(take).depth_is_found(frame):
        return False
    if not has_frame(TakeState(take).keyed.all, frame):
        matching = take.matching
        return (
            abs(matching.corrected_frame - frame) < keyed_frames.SAME_FRAME
            and not matching.corrected_in_depth
        )
    with showing_action(take.armature, take.keyframe_action), at_scene_frame(take.id_data) as go_to:
        go_to(frame)
        keyed = read_posture(take.armature, body).posture
    return float(np.abs(posture.minus(keyed)).max()) < SAME_POSE


def key_pose(context: Context, take: PropertyGroup, depth_found: bool = False) -> int:
    """Key the pose, as deep as found or posed; how many found keyframes around it were posed anew."""
    frame = context.scene.frame_current_final
    store_pose(take.armature, take.keyframe_action, frame, depth_found)
    assign_action(take.armature, take.keyframe_action)
    note_contradictions(take, frame, ())
    take.offered.candidates.clear()
    return 0 if depth_found else improve_neighbors(context, take, frame)


@operator("Store Keyframe", need.actor, need.idle)
def store_keyframe(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Key the actor's whole pose at the current frame in the keyframe Action, and show that Action"""
    frame = context.scene.frame_current_final
    body = read_body(take.armature)
    read = read_posture(take.armature, body)
    if take.keyframe_action is None:
        take.keyframe_action = new_keyframe_action(take.armature)
    switched = not TakeState(take).shows_keyframes
    straighten_unposed(take)
    was_found = frame in known_matches(take)
    depth_found = _depth_found(take, body, read.posture, frame)
    about = f"pose at {frame:g}"
    give_notices(take, "keyframes", about)
    improved = key_pose(context, take, depth_found)
    if read.furthest_m > NOTICEABLE_M:
        sentence = (
            f"Stored at frame {frame:g}; the pose goes {1000.0 * read.furthest_m:.0f} mm beyond "
            "what the skeleton can do, and its nearest posture will be used"
        )
        give_notices(take, "keyframes", about, (warn(operator, sentence),), frame=frame)
        return
    also = ""
    if improved:
        also = f"; {improved} found ones around it were posed anew"
    elif was_found:
        also = "; it was found, and counts as posed now"
    elif switched:
        also = "; the actor shows the keyframes now"
    operator.report({"INFO"}, f"Stored a keyframe at frame {frame:g}{also}")


class KEYMARK_OT_fit_pose(BaseOperator, bpy.types.Operator):
    """Pose the actor so that markers and keypoints lie where this frame has them; you decide what is keyed"""

    bl_label = "Fit Pose to Footage"
    requirements = (need.footage, need.camera, need.actor, need.points_to_follow, need.idle)

    start: Choice(
        "Start From",
        "What the pose may depend on beside what this frame shows",
        items=[
            (
                "KEYFRAMES",
                "Nearest Keyframes",
                "Any pose that this frame shows, whichever way the performer faces; keyframes near it count "
                "as well",
            ),
            (
                "POSE",
                "Current Pose",
                "The pose as it is, set roughly by you or applied from a pose library, is changed as little "
                "as the footage allows",
            ),
            ("ANEW", "Nothing", "Any pose that this frame shows, whatever the keyframes say"),
        ],
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Fit the pose, and enter Pose Mode, to correct it, if nothing else is edited."""
        finished = self.execute(context)
        actor, layer = active_take(context.scene).armature, context.view_layer
        free = layer.objects.active is None or layer.objects.active.mode == "OBJECT"
        if finished == {"FINISHED"} and actor.mode != "POSE" and free and actor.visible_get(view_layer=layer):
            layer.objects.active = actor
            bpy.ops.object.mode_set(mode="POSE")
        return finished

    def run(self, context: Context) -> None:
        from ..bridge.take_from_scene import fit_to_frame, frame_in_footage
        from .found_result import add_candidate

        scene, take = context.scene, active_take(context.scene)
        frame = frame_in_footage(footage_of(scene, take), scene_evidence(take), reading_of(take))
        libraries = () if self.start == "POSE" else named_libraries("")
        known, floor_m = known_matches(take), take.matching.known_floor_m
        actor_and_keys = take.armature, take.keyframe_action
        found = fit_to_frame(frame, *actor_and_keys, self.start, known, libraries, floor_m)
        show_keyframes(take)
        write_posture(take.armature, found.candidates[0].posture)
        offered = take.offered  # the one that the actor shows first, in place of all others
        offered.candidates.clear()
        offered.frame, offered.library, offered.chosen = scene.frame_current_final, COMPOSED, 0
        for each in found.candidates if len(found.candidates) > 1 else ():
            add_candidate(offered, each.posture, each.name, each.mirrored, each.confidence)
        take.matching.corrected_in_depth = False
        note_corrected(take, scene.frame_current_final, in_depth=False)
        note_contradictions(take, scene.frame_current_final, found.contradictions)
        if found.contradictions:
            names = ", ".join(found.contradictions)
            advice = "check what else looks like it, or pose the frame"
            self.report({"WARNING"}, f"No plausible pose explains {names} here; {advice}")
        elif not np.isfinite(found.residual_px).any():
            hidden = "Seen from the camera, the body hides the markers that this frame shows; check the pose"
            self.report({"WARNING"}, hidden)
        elif len(found.candidates) > 1:
            sure = f"{found.candidates[0].confidence:.0%} sure, {len(found.candidates) - 1} more in the panel"
            self.report({"INFO"}, f"{sure}; look at it from the side too, then store it")
        else:
            off = f"Off by {float(np.nanmean(found.residual_px)):.1f} pixels"
            advice = "look at it from the side too, as little tells the depth, then store it"
            self.report({"INFO"}, f"{off}; {advice}")
