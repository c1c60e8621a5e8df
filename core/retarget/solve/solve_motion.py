"""A performer's motion solved for a character: what its role bones do, before any control."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ...arrays import Array, BoolArray
from ...body.kinematics import SegmentMotion
from ...body.posture import UP, turn_headings_rad, yaw_rotation
from ...body.skeleton import SIDES
from ...feet.fading import ease, smooth_above, smoothed
from ...progress import Job, Progress
from ...take.conversion_settings import Placement, RetargetOptions, RootMotion
from ..character import FINGER_ROLES, JOINTS, LIMBS, Character, Similarity
from ..character_motion import CharacterMotion, HandGoal
from ..maps.character_map import CharacterMap
from .body_frames import bone_turns, joint_places, rest_alignment
from .feet import (
    FootPath,
    FootShape,
    foot_shape,
    performer_ground,
    plan_foot,
    rest_floor_m,
    sole_points,
    toe_bends,
)
from .hands import above_floor, finger_bends, hand_goals, near_floor, reach
from .rest_body import RestBody, Stage, find_stage, rest_notes
from .two_bone import ARM_SOFT, LEG_SOFT, STRAIGHTEST, LimbPose, reach_for

HINGES = {
    "arm.L": (0.0, 0.0, -1.0),
    "arm.R": (0.0, 0.0, 1.0),
    "leg.L": (1.0, 0.0, 0.0),
    "leg.R": (1.0, 0.0, 0.0),
}
"""Axis of elbow or knee by limb, of the performer at rest."""


@dataclass(eq=False)
class Solution:
    """A motion of the character on its stage while it is solved."""

    body: RestBody
    alignment: Mapping[str, Array]
    stage: Stage
    hips: Array  # (F, 3) the midpoint of the hip joints, canonical [m]
    turns: list[Array]  # (F, 3, 3) a bone: its turn from rest, canonical

    def places(self) -> list[Array]:
        """(F, 3) the joint of each bone, canonical [m]."""
        return [self.hips + place for place in joint_places(self.body, self.turns)]

    def limb(self, limb: str) -> LimbPose | None:
        """A limb as it is; None where its end is not there or one of its bones is left alone."""
        roles = JOINTS[limb]
        if not all(self.body.is_moved(role) for role in roles):
            return None
        places = self.places()
        upper, lower, end = (self.body.first[role] for role in roles)
        return LimbPose(
            self.turns[upper] @ self.alignment[roles[0]].T,
            self.turns[lower] @ self.alignment[roles[1]].T,
            places[upper],
            places[lower],
            places[end],
            self.turns[upper] @ (self.alignment[roles[0]].T @ np.array(HINGES[limb])),
        )

    def limbs(self, kind: str) -> dict[str, LimbPose]:
        """The limbs of a kind, `arm` or `leg`, that can reach, by side."""
        found = {side: self.limb(f"{kind}.{side}") for side in SIDES}
        return {side: limb for side, limb in found.items() if limb is not None}

    def move_hips(self, feet: Mapping[str, FootPath], arms: Mapping[str, LimbPose]) -> None:
        """Move the hips with feet that stand, and lower them for these and for hands on the floor."""
        if not feet:
            return
        legs, stage = self.limbs("leg"), self.stage
        time_s, deepest_m = stage.source.time_s, 0.08 * self.body.leg_m
        # They are raised or lowered for the legs that stand to keep their bend, weighed against a constant: a
        # bent leg that stands has about 20, a straight one 100, and an ankle higher than this none.
        total, weights = np.zeros(len(time_s)), np.full(len(time_s), 1.0)
        for side, leg in legs.items():
            weight = leg.straightness * (1.0 - ease(feet[side].over_m, 0.0, 0.04 * self.body.leg_m))
            total += weight * (feet[side].ankle - leg.end)[:, 2]
            weights += weight
        raised = smoothed(total / weights, time_s, 0.08, ends_kept=False)
        raised = np.clip(raised, -deepest_m, deepest_m)
        needed = []
        for side, leg in legs.items():
            moved = feet[side].ankle - raised[:, None] * UP
            needed.append(_needed_drop_m(leg, moved, feet[side].planted, LEG_SOFT, time_s))
        for side, arm in arms.items():
            goal, share = arm.end.copy(), near_floor(stage.source, stage.ground, side)
            goal[:, 2] = stage.heights(stage.source.start[f"hand.{side}"][:, 2])
            moved = goal - raised[:, None] * UP
            needed.append(share * _needed_drop_m(arm, moved, share > 0.0, ARM_SOFT, time_s))
        lowered = np.minimum(np.maximum.reduce(needed), deepest_m)
        # Time [s] over which the hips go down and up again.
        self.hips = self.hips + (raised - smooth_above(lowered, time_s, 0.12))[:, None] * UP

    def plant(self, feet: Mapping[str, FootPath], shapes: Mapping[str, FootShape]) -> None:
        """Bring legs to where the feet belong."""
        legs = self.limbs("leg") if feet else {}
        for side, leg in legs.items():
            foot = feet[side]
            solved = reach_for(leg, leg.start, foot.ankle, LEG_SOFT)
            self._turn(f"thigh.{side}", solved.upper_turn)
            self._turn(f"shin.{side}", solved.lower_turn)
            self._turn(f"foot.{side}", foot.turn)
            toe = toe_bends(foot.turn, shapes[side], solved.end[:, 2] - foot.ground_m)
            self._turn(f"toe.{side}", toe)

    def reach_with_hands(self) -> dict[str, HandGoal]:
        """Bring hands to where they belong, which is returned by side."""
        arms, stage, places = self.limbs("arm"), self.stage, self.places()
        floor_m = stage.heights(stage.ground.lowest_m)
        goals = hand_goals(
            self.body, stage.source, stage, stage.ground, places, self.turns, self.alignment, arms
        )
        for side, arm in arms.items():
            solved = reach(arm, goals[side].place_m, goals[side].share)
            self._turn(f"upper_arm.{side}", solved.upper_turn)
            self._turn(f"forearm.{side}", solved.lower_turn)
            role = f"hand.{side}"
            tip = self.body.tip(role)
            if tip is not None:
                aligned = self.alignment[role]
                turn = self.turns[self.body.first[role]] @ aligned.T
                along = aligned @ (tip - self.body.joint(role))
                self._turn(role, above_floor(turn, solved.end[:, 2] - floor_m, along))
        return goals

    def _turn(self, role: str, turn: Array) -> None:
        if self.body.is_moved(role):
            self.turns[self.body.first[role]] = np.asarray(turn @ self.alignment[role])

    def poses(self, way: Array) -> dict[str, Array]:
        """(F, 4, 4) by name of bone that is moved, in the armature's space, `way` (F, 3) taken off [m]."""
        stance, character = self.body.stance, self.body.character
        found = {}
        for bone, turn, place in zip(self.body.bones, self.turns, self.places(), strict=True):
            if not self.body.is_moved(bone.role):
                continue
            pose = np.broadcast_to(np.eye(4), (len(turn), 4, 4)).copy()
            pose[:, :3, :3] = stance.T @ turn @ stance @ character.bone(bone.name).rest[:3, :3]
            pose[:, :3, 3] = (place - way) @ stance / character.scale
            found[bone.name] = pose
        return found


def _needed_drop_m(limb: LimbPose, goal: Array, needed: BoolArray, soft: float, time_s: Array) -> Array:
    """(F,) how much lower a limb must begin to reach its goal (F, 3) where that is needed (F,) [m]."""
    length_m = sum(limb.lengths_m)
    own = np.minimum(limb.extension_m / length_m, 1.0)
    # A knee that is straight for a moment only is not stretched to the limit for it: it would snap.
    allowed = np.maximum(soft, np.minimum(own, smoothed(own, time_s, 0.07, ends_kept=False)))
    way = goal - limb.start
    aside = np.sum(way[:, :2] ** 2, axis=-1)
    below = np.sqrt(np.maximum((allowed * STRAIGHTEST * length_m) ** 2 - aside, 0.0))
    return np.where(needed, np.maximum(-way[:, 2] - below, 0.0), 0.0)


WAY_S = 0.4  # standard deviation in time of what counts as the way and heading; faster changes are sway


def solve_motion(
    character: Character,
    character_map: CharacterMap,
    source: SegmentMotion,
    options: RetargetOptions,
    object_space: Similarity,
    lifts: Mapping[str, Array] = MappingProxyType({}),
) -> Job[CharacterMotion]:
    """Solve a performer's motion for a character; `object_space` stays with `Placement.CHARACTER`.

    `lifts` (F,) by leg are how much higher its foot goes than its sole at rest demands [m].

    Raises:
        InputError: The map does not fit the character.
    """
    yield Progress("Aligning rest poses", 0.0)
    body = RestBody.of(character, character_map)
    alignment = rest_alignment(body)
    floor_m = rest_floor_m(body)
    shapes = {side: foot_shape(body, side, floor_m) for side in SIDES}
    yield Progress("Finding where the feet rest", 0.1)
    ground = performer_ground(source)
    stand = np.array([*body.middle("thigh")[:2], floor_m])
    ankle_m = float(np.mean([shape.ankle_m for shape in shapes.values()]))
    stage = find_stage(source, ground, stand, body.leg_m, ankle_m)
    yield Progress("Turning bones", 0.2)
    turn = {name: stage.turn @ own for name, own in source.turn.items()}
    hips = 0.5 * (source.start["thigh.L"] + source.start["thigh.R"]) - stage.under
    hips = stage.stand + stage.size * hips @ stage.turn.T + [0.0, 0.0, stage.lift_m]
    if not body.is_moved("hips"):
        hips = np.broadcast_to(body.middle("thigh"), hips.shape).copy()
    turns = bone_turns(body, turn, alignment)  # by the performer's directions alone
    solution = Solution(body, alignment, stage, hips, turns)
    yield Progress("Planting feet", 0.4)
    legs = solution.limbs("leg") if options.plant_feet and body.is_moved("hips") else {}
    feet = {
        side: plan_foot(stage, shapes[side], side, leg, lifts.get(f"leg.{side}", 0.0))
        for side, leg in legs.items()
    }
    arms = solution.limbs("arm") if options.reach_hands else {}
    solution.move_hips(feet, arms)
    solution.plant(feet, shapes)
    yield Progress("Reaching with hands", 0.6)
    hands = solution.reach_with_hands() if arms else {}
    bends = finger_bends(body, source.fingers)
    for index, bone in enumerate(body.bones):  # on the hands where these are now
        if bone.role in FINGER_ROLES:
            carried = turns[bone.carrier]
            turns[index] = np.asarray(carried @ bends[index]) if index in bends else carried
    yield Progress("Going over the ground", 0.8)
    way, root, notes = _root_motion(solution, options)
    to_world = object_space
    if options.place is Placement.PERFORMER:
        place = stage.under - stage.turn.T @ stage.stand
        to_world = Similarity(stage.turn.T @ body.stance, place, character.scale)
    poses = {limb: pose for limb in LIMBS if (pose := solution.limb(limb)) is not None}
    return CharacterMotion(
        poses=solution.poses(way),
        bends={limb: pose.bend @ body.stance for limb, pose in poses.items()},
        root=root,
        to_world=to_world,
        rests=tuple(rest for rest in ground.rests if SIDES[rest.point] in feet),
        soles=sole_points(body, shapes),
        size=stage.size,
        stance=body.stance,
        facing=to_world.rotation @ body.stance.T @ stage.turn,
        way_m=way,
        ground_m={
            f"leg.{side}": stage.heights(ground.height_m[:, point]) for point, side in enumerate(SIDES)
        },
        hands=hands,
        notes=(*rest_notes(body), *notes),
    )


def _root_motion(solution: Solution, options: RetargetOptions) -> tuple[Array, Array | None, tuple[str, ...]]:
    """What is taken off the way (F, 3) [m], the root bone's poses in the armature's space, and notes."""
    body, source = solution.body, solution.stage.source
    time_s = source.time_s
    none = np.zeros_like(solution.hips)
    if options.root_motion is RootMotion.AS_FILMED:
        return none, None, ()
    way = smoothed(solution.hips - solution.hips[0], time_s, WAY_S) * [1.0, 1.0, 0.0]
    way -= way[0]
    if options.root_motion is RootMotion.IN_PLACE:
        return way, None, ()
    name, character = body.character_map.root, body.character
    if name is None or name not in character.index or name in {bone.name for bone in body.bones}:
        note = f"'{character.name}' has no root bone apart from its hips, which keep the way over the ground"
        return none, None, (note,)
    headings_rad = np.unwrap(turn_headings_rad(source.turn["pelvis"]))
    turn = yaw_rotation(smoothed(headings_rad - headings_rad[0], time_s, WAY_S))
    rest, stand = body.stance @ character.bone(name).rest[:3], solution.stage.stand
    poses = np.tile(np.eye(4), (len(way), 1, 1))
    poses[:, :3, :3] = body.stance.T @ turn @ rest[:, :3]
    place = stand + way + turn @ (character.scale * rest[:, 3] - stand)
    poses[:, :3, 3] = place @ body.stance / character.scale
    return none, poses, ()
