"""Where a figure faces, and with it which side is its left: feet, knees, elbows and names."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ..character import Character
from ..maps.character_map import CharacterMap
from .figure import Figure
from .names import read_name


@dataclass(frozen=True)
class Facing:
    """Which way a figure faces."""

    ahead: float  # 1 where it faces along the second axis of `Frame.place`, -1 where it faces the other way
    confidence: float
    by_names: float  # vote of the names, positive for `ahead`; 0 where they name no sides
    by_shape: float  # vote of feet, knees and elbows, positive for `ahead`


def find_facing(figure: Figure) -> Facing:
    """Where a figure faces; `frame.one_side` is its left side if `ahead` is 1, its right side otherwise."""
    frame, limbs = figure.frame, figure.limbs
    hip, knee, ankle, shoulder, elbow = (
        frame.place[limbs[part]] for part in ("thigh", "shin", "foot", "upper_arm", "forearm")
    )
    leg = max(float(np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee)), 1e-9)
    toes = frame.branch[limbs["foot"]] - ankle  # what hangs on an ankle lies mostly ahead of it
    far = float(toes[np.abs(toes[:, 1]).argmax(), 1]) / leg
    # Feet alone do not outvote names; feet, knees and elbows together do.
    shape = 2.5 * float(np.clip(far / 0.1, -1.0, 1.0))
    shape += 1.0 * float(np.clip(_bulge(hip, knee, ankle) / 0.03, -1.0, 1.0))
    if "hand" in limbs:
        wrist = frame.place[limbs["hand"]]
        shape -= 0.8 * float(np.clip(_bulge(shoulder, elbow, wrist) / 0.04, -1.0, 1.0))
    sides = [
        sign if frame.bones.readings[bone].side == "L" else -sign
        for own in limbs.values()
        for bone, sign in ((own, 1.0), (int(frame.partner[own]), -1.0))
        if frame.bones.readings[bone].side is not None
    ]
    names = 3.0 * float(np.mean(sides)) if sides else 0.0
    ahead = 1.0 if shape + names >= 0.0 else -1.0
    confidence = float(1.0 / (1.0 + np.exp(-1.3 * abs(shape + names))))
    return Facing(ahead, confidence, ahead * names, ahead * shape)


def _bulge(first: Array, middle: Array, last: Array) -> float:
    """How far, in lengths, the middle joint lies ahead of the line through its neighbors."""
    line = last - first
    reach = max(float(line @ line), 1e-12)
    off = middle - first - line * float(np.clip((middle - first) @ line / reach, 0.0, 1.0))
    return float(off[1]) / float(np.sqrt(reach))


ROOT_WORDS = frozenset({"root", "master", "traj", "origin", "reference", "全ての親", "world", "motion"})


def find_root(character: Character, character_map: CharacterMap, up: Array) -> str | None:
    """The lowest bone above all that is keyed that lies near the ground, or is named after what it does.

    Bones with roles are keyed where the map gives no controls; up (3,) is in the armature's axes.
    """
    hips = character_map.bone("hips")
    if hips is None:
        return None
    bones = [character.index[name] for role in character_map.roles.values() for name in role.bones]
    ground = min(float(character.bones[bone].head @ up) for bone in bones)
    height = max(float(character.bone(hips).head @ up) - ground, 1e-9)
    keyed = [name for role in character_map.roles for name in character_map.keyed_bones(role)]
    keyed += [name for ik in character_map.ik.values() for name in (ik.goal, ik.pole)]
    above = [set(character.ancestors(character.index[name])) for name in keyed if name is not None]
    moving = next((name for name in character_map.keyed_bones("hips") if name is not None), hips)
    for bone in character.ancestors(character.index[moving]):
        carries = all(bone in each for each in above)
        # A root's head is no higher above the feet than this share of the hips' height.
        low = float(character.bones[bone].head @ up) - ground < 0.15 * height
        named = not ROOT_WORDS.isdisjoint(read_name(character.bones[bone].name).words)
        if carries and (low or named):
            return character.bones[bone].name
    return None
