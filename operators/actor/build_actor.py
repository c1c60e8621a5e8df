"""Make the performer's armature: from a body height, from lengths, or measured in the footage."""

import bpy
from bpy.types import Context, Event, Operator, PropertyGroup

from ...core.body.actor import Actor
from ...core.body.kinematics import Body
from ..bridge.armature import set_lengths
from ..bridge.footage import read_camera
from ..bridge.pose import write_posture
from ..follow.evidence import scene_evidence
from ..shell import need
from ..shell.base_operator import BaseOperator, operator, warn
from ..shell.fields import SKIP_SAVE, Pixel, Switch, Vector
from ..shell.footage_view import ClickSequence, FootageRequest
from ..shell.notes import give_notices
from ..shell.results import reading_of
from ..shell.take_state import TakeState
from ..shell.takes import active_take, ensure_take, find_take, footage_of
from .properties import Stature, panel_lengths
from .take_actor import has_keyframes, performers_stance, restore_actor, size_actor


class KEYMARK_OT_build_actor(Stature, BaseOperator, bpy.types.Operator):
    """Build an armature of the performer's height and stand it where the performer is in this frame"""

    bl_label = "Build Actor"
    requirements = (need.bones_editable, need.idle)

    place: Switch(
        "Stand in the Footage",
        "Stand the actor where markers or keypoints show the performer in this frame, facing the "
        "camera; without either, in the middle of the picture. An actor with keyframes stays where it is",
        default=True,
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        take = find_take(context.scene)
        if take is not None:
            self.stature = take.stature
        return self.execute(context)

    def run(self, context: Context) -> None:
        """Build or resize the actor, stand it in the footage, and report which."""
        body = Body(Actor.from_stature(self.given_stature()))
        take = ensure_take(context.scene)
        had_actor = size_actor(context, take, body)
        take.stature = self.stature
        if has_keyframes(take):
            self.report({"INFO"}, f"The actor is {self.stature:.4g} m tall now; its keyframes are kept")
            return
        stance = performers_stance(context.scene, take, body) if self.place else None
        sentence = "The actor stands at the world's origin"
        if stance is not None:
            write_posture(take.armature, stance[0])
            sentence = "The actor stands where the performer is seen in this frame"
            if not stance[1]:
                sentence = "The actor stands in the middle of the picture; with markers or keypoints it would"
                sentence += " stand at the performer"
        elif had_actor:
            sentence = f"The actor is {self.stature:.4g} m tall now"
        self.report({"INFO"}, sentence)


@operator("Apply Lengths", need.any_actor, need.bones_editable, need.idle)
def apply_lengths(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Give the actor these lengths, or bring a deleted one back; its pose, keyframes and motion stay"""
    if TakeState(take).has_lost_actor:
        restore_actor(context, take)
        operator.report({"INFO"}, "The actor is back, with its keyframes and its motion")
        return
    set_lengths(take.armature, Body(Actor(panel_lengths(take.lengths))))
    give_notices(take, "actor", "lengths")
    operator.report({"INFO"}, "The actor has these lengths now; keyframes and pose are kept")


class KEYMARK_OT_measure_actor(ClickSequence, Stature, BaseOperator, bpy.types.Operator):
    """Click on the top of the head and the floor between the feet, in a frame where the performer stands"""

    bl_label = "Measure Actor"
    requirements = (need.footage, need.camera, need.bones_editable, need.idle)

    head_pixel: Vector(
        "Top of Head", "In pixels of the footage from its top left corner", size=2, options=SKIP_SAVE
    )
    floor_pixel: Pixel("Floor", "The floor between the feet")
    arms_stretched: Switch(
        "Arms Stretched Sideways",
        "The performer holds both arms out sideways, so that their lengths are measured as well",
    )

    _head: tuple[float, float] | None = None

    def invoke(self, context: Context, event: Event) -> set[str]:
        self.stature, self._head = active_take(context.scene).stature, None
        return super().invoke(context, event)

    def request(self, context: Context) -> tuple[FootageRequest, str]:
        if self._head is None:
            return FootageRequest("Click on the top of the head"), "Esc: Cancel"
        wanted = FootageRequest("Now click on the floor", "between the feet", head=self._head)
        return wanted, "Backspace: Back   |   Esc: Cancel"

    def go_back(self, context: Context) -> None:
        self._head = None

    def clicked(self, context: Context, pixel: tuple[float, float]) -> set[str]:
        if self._head is None:
            self._head = pixel
            self.ask(context)
            return {"RUNNING_MODAL"}
        self.head_pixel, self.floor_pixel = self._head, pixel
        self.cancel(context)
        return self.execute(context)

    def run(self, context: Context) -> None:
        """Measure the performer, resize the actor, and stand it there unless it has keyframes."""
        from ...core.estimate.actor_measure import measure_standing
        from ..bridge.take_from_scene import frame_in_footage

        take = active_take(context.scene)
        frame = frame_in_footage(footage_of(context.scene, take), scene_evidence(take), reading_of(take))
        head, floor = tuple(self.head_pixel), tuple(self.floor_pixel)
        camera, stature_m = read_camera(frame.footage, frame.clip_frames[[frame.index]]), self.given_stature()
        regions = frame.regions() if frame.styles else None
        keypoints = frame.keypoints(Body(Actor.from_stature(stature_m))).frame(frame.index)
        measured = measure_standing(
            camera, 0, stature_m, head, floor, regions, frame.segments, self.arms_stretched, keypoints
        )
        size_actor(context, take, measured.body)
        take.stature = self.stature
        if not has_keyframes(take):
            write_posture(take.armature, measured.posture)
        if not measured.stands:
            sentence = (
                "The footage does not fit a performer who stands upright, so the lengths are little "
                "better than average; go to a frame in which the performer stands, and check the height"
            )
            give_notices(take, "actor", "lengths", (warn(self, sentence),))
        else:
            distance = f"The performer stands {measured.distance_m:.2f} m from the camera"
            self.report({"INFO"}, f"{distance}; unseen lengths are average")
