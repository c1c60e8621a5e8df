"""A performer's motion solved for a character: what its role bones do, before any control."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from ...arrays import Array
from ...body.kinematics import SegmentMotion
from ...body.posture import turn_headings_rad, yaw_rotation
from ...body.skeleton import SIDES
from ...feet.fading import smoothed
from ...progress import Job, Progress
from ...take.character_settings import Placement, RetargetOptions, RootMotion
from ..character import Character
from ..character_motion import CharacterMotion, Similarity
from ..maps.character_map import CharacterMap
from .body_frames import rest_alignment
from .foot_shape import foot_shape, performer_ground, rest_floor_m, sole_points
from .rest_body import RestBody, rest_notes
from .solution import Solution
from .stage import find_stage

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
    stand = np.array([*body.hip_joints[:2], floor_m])
    ankle_m = float(np.mean([shape.ankle_m for shape in shapes.values()]))
    stage = find_stage(source, ground, stand, body.leg_m, ankle_m)
    yield Progress("Turning bones", 0.2)
    solution = Solution.by_directions(body, alignment, source, stage, ground)
    yield Progress("Planting feet", 0.4)
    feet = solution.plan_feet(shapes, lifts) if options.plant_feet else {}
    arms = solution.arms() if options.reach_hands else {}
    solution.move_hips(feet, arms)
    solution.plant(feet, shapes)
    yield Progress("Reaching with hands", 0.6)
    hands = solution.reach_with_hands() if arms else {}
    yield Progress("Going over the ground", 0.8)
    way, root, notes = _root_motion(solution, options)
    filmed = options.place is Placement.PERFORMER
    to_world = stage.to_world(body.stance, character.scale) if filmed else object_space
    return CharacterMotion(
        poses=solution.poses(way),
        bends=solution.bends(),
        root=root,
        to_world=to_world,
        rests=solution.rests(feet),
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
    body, time_s = solution.body, solution.source.time_s
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
    headings_rad = np.unwrap(turn_headings_rad(solution.source.turn["pelvis"]))
    turn = yaw_rotation(smoothed(headings_rad - headings_rad[0], time_s, WAY_S))
    rest, stand = body.stance @ character.bone(name).rest[:3], solution.stage.stand
    poses = np.tile(np.eye(4), (len(way), 1, 1))
    poses[:, :3, :3] = body.stance.T @ turn @ rest[:, :3]
    place = stand + way + turn @ (character.scale * rest[:, 3] - stand)
    poses[:, :3, 3] = place @ body.stance / character.scale
    return none, poses, ()
