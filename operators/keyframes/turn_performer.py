"""Turn the performer to face the camera, left, right or away."""

from typing import TYPE_CHECKING

import bpy

from ...core.errors import InputError
from ..keypoints.evidence import scene_evidence
from ..keypoints.requirements import points_to_follow
from ..matching.matches import known_matches
from ..shell.base_operator import BaseOperator
from ..shell.requirements import actor, camera, footage, idle
from ..shell.results import reading_of
from ..shell.takes import active_take, footage_of
from .corrections import camera_now, set_corrected, shown_pose

if TYPE_CHECKING:
    from ...core.body.posture import Posture
    from ...core.posing.turned import Turned

AUTOMATIC = "AUTO"
FACINGS = (
    ("CAMERA", "Camera", "The performer faces the camera"),
    ("LEFT", "Left", "The performer faces the left of the picture"),
    ("RIGHT", "Right", "The performer faces the right of the picture"),
    ("AWAY", "Away", "The performer faces away from the camera"),
)
SIDES = (
    (AUTOMATIC, "Automatic", "Whatever explains the footage best, or else the most natural posture"),
    ("STAY", "Stay in the Picture", "Each arm and leg stays where it is seen; the trunk turns between them"),
    ("EXCHANGE", "Change Places", "Left and right arms and legs change places, so that the outline stays"),
    ("TURN", "Turn with the Trunk", "The pose stays and turns as a whole, as on a turntable"),
)


class KEYMARK_OT_turn_performer(BaseOperator, bpy.types.Operator):
    """Turn the performer to face this way, at the same place, and fit the pose to the footage again"""

    bl_idname = "keymark.turn_performer"
    bl_label = "Turn"
    bl_options = {"REGISTER", "UNDO"}
    requirements = (footage, camera, actor, idle)

    facing: bpy.props.EnumProperty(name="Facing", description="Where the performer faces", items=FACINGS)
    sides: bpy.props.EnumProperty(
        name="Left and Right", description="What becomes of arms and legs in the picture", items=SIDES
    )
    fit: bpy.props.BoolProperty(
        name="Fit to Footage",
        description="Fit the turned pose to the markers and keypoints that this frame shows, if it shows any",
        default=True,
    )

    @classmethod
    def description(cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        """Return the tooltip for the direction."""
        said = next(text for name, _, text in FACINGS if name == properties.facing)
        return f"{said}, at the same place; the pose is fitted to the footage again"

    def run(self, context: bpy.types.Context) -> None:
        """Turn the pose, fit it, and set the likeliest."""
        from ...core.posing.turned import Facing, Sides, facing_of, turned

        take, scene = active_take(context.scene), context.scene
        seen = camera_now(scene, take)
        body, posture = shown_pose(take)
        wanted = list(Sides) if self.sides == AUTOMATIC else [Sides[self.sides]]
        facing = Facing[self.facing]
        ways = [turned(body, posture, seen, facing, sides) for sides in wanted]
        found = _fitted(context, take, ways) if self.fit and points_to_follow(context) is None else []
        # A fit may turn the performer on: what faces elsewhere is not what was asked for.
        fitted = next((each for each in found if facing_of(each, seen) is facing), None)
        chosen = fitted or min(ways, key=lambda way: way.strain).posture
        set_corrected(self, context, take, chosen)
        said = next(name for value, name, _ in FACINGS if value == self.facing)
        if fitted is None:
            self.report({"INFO"}, f"Turned: {said}; not fitted to the footage")
        else:
            self.report({"INFO"}, f"Turned and fitted: {said}")


def _fitted(
    context: bpy.types.Context, take: bpy.types.PropertyGroup, ways: "list[Turned]"
) -> "list[Posture]":
    """Turned postures fitted to the frame, the likeliest first; none if it shows nothing to fit to.

    The actor's pose is as before.
    """
    from ..bridge.pose import write_posture
    from ..bridge.scene_frames import pose_of, restore_pose
    from ..bridge.single_frame_fit import fit_to_frame, frame_in_footage

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


register, unregister = bpy.utils.register_classes_factory((KEYMARK_OT_turn_performer,))
