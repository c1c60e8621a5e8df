"""Hands: where they belong on another body, by what the performer's hands are near, and how fingers bend.

The directions of the arms alone leave hands centimeters off, since shoulders are wider or narrower and arms
longer or shorter. A hand near the own body, the other hand or the floor is brought to where it belongs, by
as much as it is near; everywhere else the directions hold.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from ...arrays import Array
from ...body import rotations
from ...body.fingers import flexion_axis, flexions
from ...body.kinematics import SegmentMotion
from ...body.posture import UP
from ...body.rotations import hinge
from ...body.skeleton import FINGERS, SIDES
from ...feet.contacts import speeds
from ...feet.fading import ease, smoothed
from ...feet.ground import Ground
from ...numerics.vectors import unit
from ..character import LONG_BONES
from ..character_motion import HandGoal
from .body_frames import distances_m, in_segment, part_shapes
from .rest_body import RestBody, Stage
from .two_bone import LimbPose, reach_for, stretched_m

NEAR_M = (0.03, 0.065)
"""Distance of a hand from the own body up to which its place there counts in full, and from which not at all;
like the others for a performer of `OF_STATURE_M`."""
TOGETHER_M = (0.15, 0.40)  # the same for the distance of the wrists from each other
FLOOR_M = (0.12, 0.35)  # the same for the height of a wrist over the floor
PASSING_M_S = (0.25, 0.75)
"""Speed of a hand along a part of the body up to which it touches it, and from which it only swings past."""
LINGER_S = 0.25
"""Standard deviation in time of the smoothing of that speed: a hand that turns round in its swing swings."""
OF_STATURE_M = 1.75
CHANGE_S = 0.1  # standard deviation in time of the smoothing of what counts how much
FULL_SHARE = 0.2
"""Share of a goal from which the arm is solved for it; below, it is between that and its directions."""


def near_floor(source: SegmentMotion, ground: Ground, side: str) -> Array:
    """(F,) how near the performer's hand is to the floor, 0 to 1."""
    return _near(source, source.start[f"hand.{side}"][:, 2] - ground.lowest_m, FLOOR_M)


def _near(source: SegmentMotion, distance_m: Array, bounds: tuple[float, float]) -> Array:
    unit_m = source.body.actor.stature_m / OF_STATURE_M
    share = 1.0 - ease(distance_m / unit_m, *bounds)
    return np.clip(smoothed(share, source.time_s, CHANGE_S, ends_kept=False), 0.0, 1.0)


def hand_goals(
    body: RestBody,
    source: SegmentMotion,
    stage: Stage,
    ground: Ground,
    places: Sequence[Array],
    turns: Sequence[Array],
    alignment: Mapping[str, Array],
    arms: Mapping[str, LimbPose],
) -> dict[str, HandGoal]:
    """Where the wrists belong by the body, the floor and the other hand, by side.

    Places (F, 3) [m] and turns from rest (F, 3, 3) are of the character's bones, trunk and legs solved, arms
    by directions; the alignment (3, 3) is by role.
    """
    shapes = part_shapes(body, source, stage.size, alignment)
    goals, shares, floors = {}, {}, {}
    for side in arms:
        wrist, own = source.start[f"hand.{side}"], arms[side].end
        by_part = np.stack([one.place(source, wrist, places[one.bone], turns[one.bone]) for one in shapes])
        end, floors[side] = source.end[f"hand.{side}"], near_floor(source, ground, side)
        near = []
        for segment in (shape.segment for shape in shapes):
            along = [wrist, 0.5 * (wrist + end), end]
            distance_m = np.minimum.reduce([distances_m(source, segment, point) for point in along])
            speed = speeds(in_segment(source, segment, wrist), source.time_s)
            passing = ease(smoothed(speed, source.time_s, LINGER_S, ends_kept=False), *PASSING_M_S)
            near.append(_near(source, distance_m, NEAR_M) * (1.0 - passing))
        weight = np.stack(near)
        total = np.maximum(weight.sum(axis=0), 1e-9)[:, None]
        mean = (weight[..., None] * (by_part - own)).sum(axis=0) / total
        share = 1.0 - np.prod(1.0 - weight, axis=0)
        goal = own + share[:, None] * mean
        goal[:, 2] += floors[side] * (stage.heights(wrist[:, 2]) - goal[:, 2])
        goals[side], shares[side] = goal, 1.0 - (1.0 - share) * (1.0 - floors[side])
    if len(arms) == len(SIDES):
        between = source.start["hand.R"] - source.start["hand.L"]
        together = _near(source, np.linalg.norm(between, axis=-1), TOGETHER_M)
        bones = (*LONG_BONES["arm.L"], *LONG_BONES["arm.R"])
        lengths = source.body.actor.segments_m
        longer = sum(body.length_m(*ends) for ends in bones) / sum(lengths[start] for start, _ in bones)
        apart = longer * between @ stage.turn.T
        alone = dict(goals)
        # Rounds in which two hands find a place that both reach.
        for _ in range(4):
            middle = np.mean([_reachable(arms[side], goals[side]) for side in SIDES], axis=0)
            for side, sign in (("L", -0.5), ("R", 0.5)):
                goals[side] = alone[side] + together[:, None] * (middle + sign * apart - alone[side])
        shares = {side: 1.0 - (1.0 - share) * (1.0 - together) for side, share in shares.items()}
    return {
        side: HandGoal(
            goals[side],
            shares[side],
            floors[side],
            np.linalg.norm(_reachable(arm, goals[side]) - goals[side], axis=-1) <= 1e-6,
        )
        for side, arm in arms.items()
    }


def reach(arm: LimbPose, goal: Array, share: Array) -> LimbPose:
    """An arm that reaches for a goal where that counts, and keeps its directions where not."""
    solved = reach_for(arm, arm.start, goal)
    blend = ease(share, 0.0, FULL_SHARE)[:, None]
    upper, lower = (
        rotations.exponential(blend * rotations.logarithm(new @ np.swapaxes(old, -1, -2))) @ old
        for new, old in ((solved.upper_turn, arm.upper_turn), (solved.lower_turn, arm.lower_turn))
    )
    hinge = unit(arm.hinge + blend * (solved.hinge - arm.hinge))
    middle = arm.middle + blend * (solved.middle - arm.middle)
    end = arm.end + blend * (solved.end - arm.end)
    return LimbPose(upper, lower, arm.start, middle, end, hinge)


def above_floor(turn: Array, wrist_m: Array, along: Array) -> Array:
    """(F, 3, 3) turns of a hand, bent back at the wrist where it would be in the floor.

    `wrist_m` is the wrist's height over the floor, `along` (3,) goes from wrist to fingertips at rest, palm
    down [m].
    """
    length_m = float(np.linalg.norm(along))
    fingers = turn @ (along / length_m)
    least = np.clip(-wrist_m / length_m, -1.0, 0.0)
    # Fingers that point straight down have no heading of their own: they bend toward the back of the hand.
    # Part of the back of the hand in the heading of fingers.
    level = (fingers + 0.02 * turn[..., 2]) * [1.0, 1.0, 0.0]
    level = unit(level) * np.sqrt(1.0 - least**2)[:, None] + least[:, None] * UP
    bent = rotations.smallest(fingers, unit(level)) @ turn
    return np.where((fingers[:, 2] < least)[:, None, None], bent, turn)


def _reachable(arm: LimbPose, goal: Array) -> Array:
    """(F, 3) the place nearest to a goal that an arm reaches [m]."""
    way = goal - arm.start
    wanted_m = np.linalg.norm(way, axis=-1)
    reached_m = stretched_m(wanted_m, arm.extension_m, sum(arm.lengths_m))
    return np.asarray(arm.start + unit(way) * reached_m[:, None])


def finger_bends(body: RestBody, wanted: Mapping[str, Array]) -> dict[int, Array]:
    """(F, 3, 3) by index of bone: its turn from rest in the frame of what carries it.

    `wanted` are flexions (F, 3) of the joints by role. Fingers of a hand whose palm's direction at rest is
    not known stay as they are.
    """
    found: dict[int, Array] = {}
    for side in SIDES:
        palm = body.palm(side)
        for finger in FINGERS:
            role = f"{finger}.{side}"
            if palm is None or role not in wanted or not body.is_moved(role):
                continue
            bones = range(body.first[role], body.last[role] + 1)
            joints = [body.joint(f"hand.{side}"), *(body.bones[bone].head for bone in bones)]
            tip = body.tip(role)
            joints.append(2.0 * joints[-1] - joints[-2] if tip is None else tip)
            ways = unit(np.diff(joints, axis=0))
            axis = flexion_axis(finger, ways[1], palm)
            own = wanted[role]
            if len(bones) < own.shape[1]:  # the last one bends for those that are missing
                last = own[:, len(bones) - 1 :].sum(axis=1, keepdims=True)
                own = np.concatenate([own[:, : len(bones) - 1], last], axis=1)
            bent = own - flexions(ways, axis)
            found |= {bone: hinge(axis, bent[:, number]) for number, bone in enumerate(bones)}
    return found
