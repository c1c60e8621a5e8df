"""A corrected pose: how a correction is set and kept; copying a neighbor, turning, flipping depth."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.types import Context, Operator, OperatorProperties, PropertyGroup, Scene

from ...core.arrays import Array
from ...core.body.human import HUMAN, TRUNK, limb_of
from ...core.body.kinematics import Body
from ...core.body.posture import Posture
from ...core.camera.camera import Camera
from ...core.errors import InputError
from ..bridge.armature import read_body
from ..bridge.footage import read_camera
from ..bridge.pose import read_posture, write_posture
from ..bridge.scene_frames import at_scene_frame, pose_of, restore_pose, showing_action
from ..follow.evidence import scene_evidence
from ..library.registry import named_libraries
from ..shell import need
from ..shell.base_operator import BaseOperator, Unchanged
from ..shell.fields import SKIP_SAVE, Choice, Switch
from ..shell.job_progress import job_is_running
from ..shell.keyed_frames import SAME_FRAME, has_frame, show_keyframes
from ..shell.results import reading_of
from ..shell.take_state import TakeState
from ..shell.takes import active_take, footage_of, redraw_footage
from .found_properties import known_matches, neighbor
from .posing import SAME_POSE, key_pose, note_corrected

if TYPE_CHECKING:
    from ...core.poses.turned import Turned


DRAGGING = "keymark.drag_joints"


def shown_pose(take: PropertyGroup) -> tuple[Body, Posture]:
    """The actor's sizes, and the posture that it shows now."""
    body = read_body(take.armature)
    return body, read_posture(take.armature, body).posture


def camera_now(scene: Scene, take: PropertyGroup) -> Camera:
    """The take's camera as it stands in the current frame."""
    return read_camera(footage_of(scene, take), np.array([scene.frame_current_final]))


def set_corrected(
    operator: Operator, context: Context, take: PropertyGroup, posture: Posture, in_depth: bool
) -> None:
    """Give the actor a corrected posture, at once as the frame's keyframe; tell how many near improved."""
    show_keyframes(take)
    write_posture(take.armature, posture)
    redraw_footage(context)
    frame = context.scene.frame_current_final
    if not has_frame(TakeState(take).keyed.all, frame):
        note_corrected(take, frame, in_depth)
        return
    improved = key_pose(context, take, depth_found=not in_depth and TakeState(take).depth_is_found(frame))
    if improved:
        operator.report({"INFO"}, f"{improved} found keyframes around this one were posed anew")


def put_right(
    scene: Scene,
    take: PropertyGroup,
    body: Body,
    found: Posture,
    shown: Posture,
    places: Mapping[str, Array],
    held: str,
) -> Posture:
    """A posture `shown` with points at `places` (3,), leaning as is likely where `found` told the depth."""
    frame = scene.frame_current_final
    if not has_frame(TakeState(take).keyed.all, frame) or not TakeState(take).depth_is_found(frame):
        return shown
    from ...core.poses import picture_depth

    match = known_matches(take).get(round(frame, 3))
    confidence = 0.5 if match is None else match.confidence  # even odds where it was corrected before
    libraries = named_libraries(take.matching.library_name)
    camera, floor_m = camera_now(scene, take), take.matching.known_floor_m
    pair = found, shown
    return picture_depth.put_right(body, camera, 0, *pair, places, confidence, libraries, floor_m, held)


DIRECTIONS = (
    ("PREVIOUS", "Previous", "Copy the pose of the keyframe before this frame; the performer stays in place"),
    ("NEXT", "Next", "Copy the pose of the keyframe after this frame; the performer stays in place"),
)


class KEYMARK_OT_copy_neighbor(BaseOperator, bpy.types.Operator):
    """Copy the pose of the keyframe before or after this frame; the performer stays in place"""

    bl_label = "Copy from Neighbor"
    requirements = (need.actor, need.keyframes, need.idle)

    direction: Choice("Neighbor", "The keyframe whose pose is copied", items=DIRECTIONS)

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        return {name: text for name, _, text in DIRECTIONS}[properties.direction]

    def run(self, context: Context) -> None:
        take, scene = active_take(context.scene), context.scene
        now, keyed = scene.frame_current_final, TakeState(take).keyed.all
        beside = neighbor(keyed, now, self.direction, SAME_FRAME)
        if beside is None:
            side = "after" if self.direction == "NEXT" else "before"
            raise Unchanged(f"there is no keyframe {side} this frame")
        body, here = shown_pose(take)
        with showing_action(take.armature, take.keyframe_action), at_scene_frame(scene) as go_to:
            go_to(beside)
            there = read_posture(take.armature, body).posture
        posture = Posture(HUMAN, here.translation, there.rotations, there.angles)
        set_corrected(self, context, take, posture, in_depth=not TakeState(take).depth_is_found(beside))
        self.report({"INFO"}, f"Pose of frame {beside:g}, at the place of this one")


FACINGS = (
    ("CAMERA", "Camera", "The performer faces the camera"),
    ("LEFT", "Left", "The performer faces the left of the picture"),
    ("RIGHT", "Right", "The performer faces the right of the picture"),
    ("AWAY", "Away", "The performer faces away from the camera"),
)
SIDES = (
    ("AUTO", "Automatic", "Whatever explains the footage best, or else the most natural posture"),
    ("STAY", "Stay in the Picture", "Each arm and leg stays where it is seen; the trunk turns between them"),
    ("EXCHANGE", "Change Places", "Left and right arms and legs change places, so that the outline stays"),
    ("TURN", "Turn with the Trunk", "The pose stays and turns as a whole, as on a turntable"),
)


class KEYMARK_OT_turn_performer(BaseOperator, bpy.types.Operator):
    """Turn the performer to face this way, at the same place, and fit the pose to the footage again"""

    bl_label = "Turn"
    requirements = (need.footage, need.camera, need.actor, need.idle)

    facing: Choice("Facing", "Where the performer faces", items=FACINGS)
    sides: Choice("Left and Right", "What becomes of arms and legs in the picture", items=SIDES)
    fit: Switch(
        "Fit to Footage",
        "Fit the turned pose to the markers and keypoints that this frame shows, if it shows any",
        default=True,
    )

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        facing = {name: text for name, _, text in FACINGS}[properties.facing]
        return f"{facing}, at the same place; the pose is fitted to the footage again"

    def run(self, context: Context) -> None:
        from ...core.poses.turned import Facing, Sides, facing_of, turned

        take, scene = active_take(context.scene), context.scene
        seen = camera_now(scene, take)
        body, posture = shown_pose(take)
        facing = Facing[self.facing]
        wanted = list(Sides) if self.sides == "AUTO" else [Sides[self.sides]]
        ways = [turned(body, posture, seen, facing, sides) for sides in wanted]
        found = _fitted(context, take, ways) if self.fit and TakeState(take).has_points else []
        # A fit may turn the performer on: what faces elsewhere is not what was asked for.
        fitted = next((each for each in found if facing_of(each, seen) is facing), None)
        chosen = fitted or min(ways, key=lambda way: way.strain).posture
        set_corrected(self, context, take, chosen, in_depth=True)
        title = self.facing.title()
        fits = f"Turned and fitted: {title}"
        self.report({"INFO"}, f"Turned: {title}; not fitted to the footage" if fitted is None else fits)


def _fitted(context: Context, take: PropertyGroup, ways: "list[Turned]") -> list[Posture]:
    """Turned postures fitted to the frame, the likeliest first; none if it shows nothing to fit to."""
    from ..bridge.take_from_scene import fit_to_frame, frame_in_footage

    found: list[tuple[float, Posture]] = []
    matches, before = known_matches(take), pose_of(take.armature)
    try:
        frame = frame_in_footage(footage_of(context.scene, take), scene_evidence(take), reading_of(take))
        for way in ways:
            write_posture(take.armature, way.posture)
            fit = fit_to_frame(frame, take.armature, take.keyframe_action, "POSE", matches)
            found.append((fit.cost + way.strain, fit.candidates[0].posture))
    except InputError:  # the frame lies outside the footage, or shows nothing of what is followed
        return []
    finally:
        restore_pose(take.armature, before)
    return [posture for _, posture in sorted(found, key=lambda each: each[0])]


LIMBS = {"arm.L": "left arm", "arm.R": "right arm", "leg.L": "left leg", "leg.R": "right leg", TRUNK: "trunk"}
"""Names of the parts of the body, the performer's own left and right."""


def selected_limbs(take: PropertyGroup) -> list[str]:
    """The parts of the body that are selected, in the order of `LIMBS`; of all of them the active bone's."""
    active = take.armature.data.bones.active
    chosen = {
        limb_of(bone.name)
        for bone in take.armature.pose.bones
        # Blender 5.0 moved the selection from bones to pose bones.
        if (bone.select if hasattr(bone, "select") else bone.bone.select)
    }
    if len(chosen) == len(LIMBS):
        return [limb_of(active.name)] if active is not None else []
    return [name for name in LIMBS if name in chosen]


def limb_chosen(context: Context, state: TakeState | None) -> str | None:
    """A bone is selected in Pose Mode, or joints are being dragged, where the one under the mouse counts."""
    if job_is_running(context, DRAGGING) or state is None or state.take.armature is None:
        return None  # without an actor another requirement's
    if state.take.armature.mode != "POSE" or not selected_limbs(state.take):
        return "Select a bone of an arm, a leg or the trunk in Pose Mode first"
    return None


@dataclass(frozen=True, eq=False)
class Ways:
    """A posture and the ways to flip it, the most plausible first."""

    key: tuple[int, float, str]  # Number of the armature in this session, scene frame, part of the body
    postures: tuple[Posture, ...]  # The first is the one that was flipped

    def shown(self, posture: Posture) -> int | None:
        """Which of the ways a posture is; None where it is none of them."""
        apart = [float(np.abs(posture.minus(way)).max()) for way in self.postures]
        nearest = int(np.argmin(apart))
        return nearest if apart[nearest] < SAME_POSE else None


_last: dict[str, Ways] = {}  # The last ways by part of the body


class KEYMARK_OT_flip_depth(BaseOperator, bpy.types.Operator):
    """Lean the selected limb away from the camera, not toward it, or back; press again for other ways"""

    bl_label = "Flip Depth"
    requirements = (need.footage, need.camera, need.actor, limb_chosen, need.idle)

    limb: Choice(
        "Part",
        "The part of the body that is flipped",
        items=[
            ("SELECTED", "Selected", "The part of which a bone is selected"),
            *((name, words.title(), "This part of the body") for name, words in LIMBS.items()),
        ],
        options=SKIP_SAVE,
    )

    def run(self, context: Context) -> set[str] | None:
        """Show of each part the way after the one that is shown, from the last back to the first."""
        from ...core.poses.depth_flip import flipped

        take, scene = active_take(context.scene), context.scene
        limbs = selected_limbs(take) if self.limb == "SELECTED" else [self.limb]
        if not limbs:
            self.report({"WARNING"}, "Select a bone of an arm, a leg or the trunk first")
            return {"CANCELLED"}
        seen = camera_now(scene, take)
        body, posture = shown_pose(take)
        words = []
        for limb in limbs:
            key, ways = (take.armature.session_uid, scene.frame_current_final, limb), _last.get(limb)
            shown = None if ways is None or ways.key != key else ways.shown(posture)
            if ways is None or shown is None:
                ways, shown = Ways(key, (posture, *flipped(body, posture, seen, limb))), 0
                _last[limb] = ways
            count = len(ways.postures)
            if count > 1:
                number = (shown + 1) % count
                posture = ways.postures[number]
                way = f": way {number} of {count - 1}" if number else " as it was"
                words.append(f"{LIMBS[limb].title()}{way}")
        if not words:
            flat = "The selected part lies flat in the picture, or its joints allow no other way"
            self.report({"WARNING"}, flat)
            return {"CANCELLED"}
        set_corrected(self, context, take, posture, in_depth=True)
        self.report({"INFO"}, "; ".join(words))
        return None
