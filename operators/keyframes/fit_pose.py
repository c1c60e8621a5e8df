"""Fit the pose of a frame to the footage, and show the poses that it may have; nothing is keyed."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.types import Context, Event, PropertyGroup

from ...core.prior.texts import COMPOSED
from ..follow.evidence import scene_evidence
from ..shell.base_operator import BaseOperator
from ..shell.contradictions import note_contradictions
from ..shell.fields import Choice
from ..shell.keyed_frames import show_keyframes
from ..shell.requirements import actor, camera, footage, idle, points_to_follow
from ..shell.results import reading_of
from ..shell.takes import active_take, footage_of
from .found_keyframes import known_matches
from .store_keyframe import note_corrected

if TYPE_CHECKING:
    from ...core.poses.candidates import Candidate


def offer_poses(take: PropertyGroup, frame: float, candidates: Sequence["Candidate"]) -> None:
    """Offer candidates at a scene frame, the one that the actor shows first, in place of all others."""
    from .found_result import add_candidate

    offered = take.offered
    offered.candidates.clear()
    offered.frame, offered.library, offered.chosen = frame, COMPOSED, 0
    for each in candidates if len(candidates) > 1 else ():
        add_candidate(offered, each.posture, each.name, each.mirrored, each.confidence)


class KEYMARK_OT_fit_pose(BaseOperator, bpy.types.Operator):
    """Pose the actor so that markers and keypoints lie where this frame has them; you decide what is keyed"""

    bl_label = "Fit Pose to Footage"
    requirements = (footage, camera, actor, points_to_follow, idle)

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
        from ..bridge.pose import write_posture
        from ..bridge.single_frame_fit import fit_to_frame, frame_in_footage
        from ..library.registry_files import all_libraries

        scene, take = context.scene, active_take(context.scene)
        frame = frame_in_footage(footage_of(scene, take), scene_evidence(take), reading_of(take))
        libraries = () if self.start == "POSE" else all_libraries()
        known, floor_m = known_matches(take), take.matching.known_floor_m
        actor_and_keys = take.armature, take.keyframe_action
        found = fit_to_frame(frame, *actor_and_keys, self.start, known, libraries, floor_m)
        show_keyframes(take)
        write_posture(take.armature, found.candidates[0].posture)
        offer_poses(take, scene.frame_current_final, found.candidates)
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
