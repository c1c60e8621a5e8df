"""Characters for tests: a skeleton of many shapes, and those of other conventions beside the project."""

import json
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from keymark.core.arrays import Array
from keymark.core.retarget.character import Character, CharacterBone
from keymark.core.retarget.maps.character_map import CharacterMap, RoleBones

SHARED = Path(__file__).resolve().parents[2] / "shared" / "characters"

JOINTS = {
    "hips": (0.0, 0.0, 0.95),
    "spine": (0.0, 0.01, 1.05),
    "chest": (0.0, 0.015, 1.22),
    "neck": (0.0, 0.02, 1.45),
    "head": (0.0, 0.0, 1.54),
    "shoulder": (0.03, 0.01, 1.40),
    "upper_arm": (0.17, 0.02, 1.38),
    "forearm": (0.44, 0.03, 1.38),
    "hand": (0.68, 0.02, 1.38),
    "finger": (0.78, 0.01, 1.37),
    "thigh": (0.09, 0.0, 0.90),
    "shin": (0.095, -0.01, 0.49),
    "foot": (0.1, 0.02, 0.08),
    "toe": (0.105, -0.11, 0.02),
    "top": (0.0, -0.01, 1.72),
    "fingertip": (0.86, 0.005, 1.36),
    "toetip": (0.106, -0.19, 0.015),
}
"""Joints of a body of 1.72 m in a T pose [m], left side, facing -Y."""
CHAINS = (
    (None, "hips spine chest neck head top"),
    ("chest", "shoulder upper_arm forearm hand finger fingertip"),
    ("hips", "thigh shin foot toe toetip"),
)
"""What each chain of bones hangs on, and its joints; the last is an end."""
TAILS = {part: end for _, chain in CHAINS for part, end in pairwise(chain.split())}
PARENTS = {
    part: above
    for on, chain in CHAINS
    for above, part in pairwise((on, *chain.split()[:-1]))
    if part is not None
}
SIDED = ("shoulder", "upper_arm", "forearm", "hand", "finger", "thigh", "shin", "foot", "toe")


def plain_character(
    *,
    names: Mapping[str, str] | None = None,
    without: tuple[str, ...] = (),
    arms_down_deg: float = 0.0,
    scale: float = 1.0,
    turn: Array | None = None,
    root: str | None = None,
    roll_rad: float = 0.0,
) -> Character:
    """A deform skeleton.

    Args:
        names: Bone names by `hips`, `upper_arm.L` ...; by default those keys themselves.
        without: Parts that it lacks, such as `shoulder`, `toe`, `chest`; children hang on the next above.
        arms_down_deg: 0 for a T pose, about 45 for an A pose.
        scale: Size of the object; bones are larger by its inverse, so that the body keeps its meters.
        turn: (3, 3) turns all bones in the armature's space.
        root: Name of a bone on the ground that carries the hips.
        roll_rad: Turns every bone about its own length.
    """
    turning = np.eye(3) if turn is None else turn
    bones: list[CharacterBone] = []
    index: dict[str, int] = {}
    if root is not None:
        bones.append(
            CharacterBone(root, -1, _matrix(np.zeros(3), turning @ [0, 0.3, 0], 0.0), turning @ [0, 0.3, 0])
        )
        index[root] = 0
    for key in _keys(without):
        part, _, side = key.partition(".")
        head, tail = (_place(name, side, arms_down_deg) / scale for name in (part, _end(part, without)))
        head, tail = turning @ head, turning @ tail
        above = PARENTS[part]
        while above in without:
            above = PARENTS[str(above)]
        own = f"{above}.{side}" if above in SIDED else above
        parent = index.get(str(own), 0 if root is not None else -1)
        index[key] = len(bones)
        bones.append(CharacterBone((names or {}).get(key, key), parent, _matrix(head, tail, roll_rad), tail))
    return Character("Character", tuple(bones), scale)


def plain_map(character: Character) -> CharacterMap:
    """The map of a `plain_character` with its default names."""
    there = set(character.index)
    roles = {
        role: RoleBones((role,))
        for role in (*_keys(()),)
        if role in there and role not in ("spine", "chest") and not role.startswith("finger")
    }
    spine = tuple(name for name in ("spine", "chest") if name in there)
    if spine:
        roles["spine"] = RoleBones(spine)
    return CharacterMap("Plain", roles)


def shared_characters() -> dict[str, Character]:
    """The skeletons beside the project by name; none where there are no such files."""
    return {
        file.name.split(".")[1]: shared_character(file) for file in sorted(SHARED.glob("mpfb2/rig.*.json"))
    }


def shared_character(file: Path) -> Character:
    """A skeleton of MPFB's format, in meters; bones without length, which Blender drops, are left out."""
    value = json.loads(file.read_text(encoding="utf-8"))
    listed: dict[str, Any] = value.get("bones", value)
    given = {name: bone for name, bone in listed.items() if _length(bone) > 1e-6}
    for bone in given.values():
        while bone.get("parent") and bone["parent"] not in given:
            bone["parent"] = listed[bone["parent"]].get("parent")
    order: list[str] = []
    while len(order) < len(given):
        ready = [
            n for n in given if n not in order and (not given[n].get("parent") or given[n]["parent"] in order)
        ]
        order += ready
    index = {name: number for number, name in enumerate(order)}
    bones = []
    for name in order:
        bone = given[name]
        head, tail = (np.array(bone[end]["default_position"], dtype=np.float64) for end in ("head", "tail"))
        rest = _matrix(head, tail, float(bone.get("roll", 0.0)))
        above = bone.get("parent")
        bones.append(
            CharacterBone(
                name,
                index[above] if above else -1,
                rest,
                tail,
                connected=bool(bone.get("use_connect", False)),
            )
        )
    return Character(file.name.split(".")[1], tuple(bones))


def _length(bone: dict[str, Any]) -> float:
    head, tail = (np.array(bone[end]["default_position"]) for end in ("head", "tail"))
    return float(np.linalg.norm(tail - head))


def renamed(character: Character) -> Character:
    """The character with bones called `bone_000` and so on."""
    bones = tuple(replace(bone, name=f"bone_{n:03}") for n, bone in enumerate(character.bones))
    return Character(character.name, bones, character.scale)


def _keys(without: tuple[str, ...]) -> tuple[str, ...]:
    found = []
    for part in PARENTS:
        if part in without:
            continue
        found += [f"{part}.{side}" for side in "LR"] if part in SIDED else [part]
    return tuple(found)


def _end(part: str, without: tuple[str, ...]) -> str:
    end = TAILS[part]
    while end in without and end in TAILS:
        end = TAILS[end]
    return end


def _place(part: str, side: str, arms_down_deg: float) -> Array:
    place = np.array(JOINTS[part])
    if part in ("forearm", "hand", "finger", "fingertip"):
        pivot, angle = np.array(JOINTS["upper_arm"]), np.radians(arms_down_deg)
        x, z = place[0] - pivot[0], place[2] - pivot[2]
        place[0] = pivot[0] + np.cos(angle) * x + np.sin(angle) * z
        place[2] = pivot[2] - np.sin(angle) * x + np.cos(angle) * z
    return place * [-1.0, 1.0, 1.0] if side == "R" else place


def _matrix(head: Array, tail: Array, roll_rad: float) -> Array:
    """(4, 4) a bone's rest matrix as Blender makes it from head, tail and roll."""
    along = np.asarray(tail - head) / np.linalg.norm(tail - head)
    x, y, z = along
    if y > -1.0 + 1e-9:
        theta = 1.0 + y
        turn = np.array(
            [[1.0 - x * x / theta, x, -x * z / theta], [-x, y, -z], [-x * z / theta, z, 1.0 - z * z / theta]]
        )
    else:
        turn = np.diag([-1.0, -1.0, 1.0])
    cos, sin = np.cos(roll_rad), np.sin(roll_rad)
    matrix = np.eye(4)
    matrix[:3, :3] = turn @ np.array([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
    matrix[:3, 3] = head
    return matrix
