"""Performances for tests of retargeting: what a performer does, and a character after him."""

import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from _characters import plain_character, plain_map
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body, SegmentMotion, segment_motion
from keymark.core.body.posture import Posture, turned_and_shifted
from keymark.core.body.posture_fit import fit_posture
from keymark.core.feet.natural_extremities import natural_extremities
from keymark.core.progress import run
from keymark.core.retarget.character import Character
from keymark.core.retarget.character_motion import CharacterMotion, Similarity
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.retarget.quality import Quality, measured
from keymark.core.retarget.solve.solve_motion import solve_motion
from keymark.core.take.character_settings import RetargetOptions

DEMO = Path(__file__).resolve().parents[1] / "presets" / "demo" / "aerobic"
FPS = 30.0


@cache
def stepping() -> tuple[Body, Posture]:
    """The demonstration's steps to the side and jumping jacks, by its true points."""
    take = json.loads((DEMO / "take.json").read_text(encoding="utf-8"))
    points = json.loads((DEMO / "truth.json").read_text(encoding="utf-8"))["points"]
    body = Body(Actor(take["actor"]["segments_m"]))
    rows = np.stack([np.array(points[name]) for name in body.skeleton.point_names], axis=1)
    return body, fit_posture(body, rows).posture


def performance(body: Body, posture: Posture) -> SegmentMotion:
    """The segments of a motion of 30 frames a second, with natural hands and feet."""
    time_s = np.arange(posture.batch[0]) / FPS
    return segment_motion(body, posture, time_s, natural_extremities(body, posture, time_s))


@cache
def steps() -> SegmentMotion:
    """The performance of `stepping`."""
    return performance(*stepping())


@cache
def steps_elsewhere() -> SegmentMotion:
    """The same, turned by 70 degrees and done elsewhere."""
    body, posture = stepping()
    return performance(body, turned_and_shifted(posture, np.radians(70.0), np.array([2.0, -1.0, 0.0])))


def with_hands(left: Array, right: Array, frames: int = 60) -> SegmentMotion:
    """A performer of 1.75 m who stands, hips at 0.93 m, and brings the wrists to two places [m]."""
    body = Body(Actor.from_stature(1.75))
    skeleton = body.skeleton
    vector = np.zeros((frames, skeleton.dof_count))
    vector[:, 2] = 0.93
    points = body.points(body.pose(Posture.from_vector(skeleton, vector)))
    share = np.clip(np.linspace(-0.3, 1.6, frames), 0.0, 1.0)[:, None]
    share = share * share * (3.0 - 2.0 * share)
    for side, out, place in (("L", 1.0, left), ("R", -1.0, right)):
        shoulder = points[0, skeleton.point_names.index(f"shoulder.{side}")]
        hanging = shoulder + [0.05 * out, -0.05, -0.5]
        points[:, skeleton.point_names.index(f"wrist.{side}")] = (1.0 - share) * hanging + share * place
        points[:, skeleton.point_names.index(f"elbow.{side}")] = np.nan
        vector[:, skeleton.dof_names.index(f"elbow.{side}.flexion")] = 0.8
        vector[:, skeleton.dof_names.index(f"shoulder.{side}.rotation_y")] = 1.1 * out
    return performance(body, fit_posture(body, points, Posture.from_vector(skeleton, vector)).posture)


def shaped(change: Callable[[str, Array], Array], **shape: float) -> tuple[Character, CharacterMap]:
    """A plain character whose joints are moved: `change` takes a bone's name and a place (3,) of it."""
    character = plain_character(**shape)  # type: ignore[arg-type]
    bones = []
    for bone in character.bones:
        rest = bone.rest.copy()
        rest[:3, 3] = change(bone.name, bone.head)
        bones.append(replace(bone, rest=rest, tail=change(bone.name, bone.tail)))
    moved = Character(character.name, tuple(bones), character.scale)
    return moved, plain_map(moved)


def solved(
    character: Character,
    character_map: CharacterMap,
    source: SegmentMotion,
    options: RetargetOptions | None = None,
    object_space: Similarity | None = None,
) -> CharacterMotion:
    """The motion on a character whose object stands at the origin unless another place is given."""
    space = object_space or Similarity(np.eye(3), np.zeros(3), character.scale)
    return run(solve_motion(character, character_map, source, options or RetargetOptions(), space))


def joints(character_map: CharacterMap, motion: CharacterMotion) -> dict[str, Array]:
    """(F, 3) joints by role in the world [m]."""
    return {
        role: motion.to_world.to_world(motion.poses[bones.bones[0]][:, :3, 3])
        for role, bones in character_map.roles.items()
        if bones.bones[0] in motion.poses
    }


def soles(character: Character, character_map: CharacterMap, motion: CharacterMotion) -> dict[str, Array]:
    """(F, N, 3) soles by role of foot and toe in the world [m]."""
    found = {}
    for role, points in motion.soles.items():
        bone = character.bone(character_map.bones(role)[0])
        local = (points - bone.head) @ bone.rest[:3, :3]
        pose = motion.poses[bone.name]
        found[role] = motion.to_world.to_world(
            local @ np.swapaxes(pose[:, :3, :3], -1, -2) + pose[:, None, :3, 3]
        )
    return found


def source_joints(source: SegmentMotion) -> dict[str, Array]:
    """(F, 3) the performer's joints by role in the world [m]."""
    return {name.replace("girdle", "shoulder"): path for name, path in source.start.items()}


def quality(
    character: Character, character_map: CharacterMap, source: SegmentMotion, motion: CharacterMotion
) -> Quality:
    """Figures of a solved motion."""
    return measured(
        source_joints(source), motion, joints(character_map, motion), soles(character, character_map, motion)
    ).quality
