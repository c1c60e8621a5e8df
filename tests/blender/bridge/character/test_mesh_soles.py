"""Soles are found on the mesh, where it shows feet."""

import bpy
import numpy as np
import pytest
from _armatures import build_character
from _characters import plain_character, plain_map
from keymark.core.retarget.character import Character
from keymark.operators.bridge.character.measure import mesh_soles
from keymark.operators.bridge.character.read_character import read_character


def shoe(side: str, low: float = -0.02) -> np.ndarray:
    """(N, 3) corners of a shoe around ankle and toes, and of a leg above it."""
    x = 0.1 if side == "L" else -0.1
    return np.array(
        [[x + dx, y, z] for dx in (-0.04, 0.04) for y in (0.09, 0.0, -0.11, -0.2) for z in (low, 0.06)]
        + [[x, 0.02, 0.3]]
    )


def add_mesh(character: bpy.types.Object, points: np.ndarray, groups: list[str]) -> bpy.types.Object:
    """A mesh of loose vertices, each with one bone, that the armature deforms."""
    mesh = bpy.data.meshes.new("Skin")
    mesh.from_pydata(points.tolist(), [], [])
    made = bpy.data.objects.new("Skin", mesh)
    bpy.context.scene.collection.objects.link(made)
    made.modifiers.new("Armature", "ARMATURE").object = character
    for index, name in enumerate(groups):
        group = made.vertex_groups.get(name) or made.vertex_groups.new(name=name)
        group.add([index], 1.0, "REPLACE")
    return made


def bone_of(point: np.ndarray) -> str:
    """The bone that moves a vertex of the shoe."""
    side = "L" if point[0] > 0.0 else "R"
    if point[2] > 0.2:
        return f"shin.{side}"
    return f"toe.{side}" if point[1] < -0.15 else f"foot.{side}"


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_soles_lie_under_the_feet(scale: float) -> None:
    plain = plain_character(scale=scale)
    character = build_character(plain)
    points = np.concatenate([shoe("L"), shoe("R")])
    made = add_mesh(character, points, [bone_of(point) for point in points])
    made.location = (0.0, 0.0, 0.0)
    bpy.context.view_layer.update()
    soles = mesh_soles(character, read_character(character), plain_map(plain))
    assert set(soles) == {"foot.L", "toe.L", "foot.R", "toe.R"}
    foot = scale * np.array(soles["foot.L"])
    assert foot[:, 2] == pytest.approx(-0.02, abs=1e-5)
    assert (foot[:, 0].min(), foot[:, 0].max()) == pytest.approx((0.06, 0.14), abs=1e-5)
    assert (foot[:, 1].min(), foot[:, 1].max()) == pytest.approx((-0.11, 0.09), abs=1e-5)
    assert scale * np.array(soles["toe.R"])[:, 1] == pytest.approx(-0.2, abs=1e-5)


def test_bones_that_copy_a_foot_count_as_it() -> None:
    plain = plain_character()
    bones = [*plain.bones]
    for side in "LR":
        bones.append(
            type(bones[0])(f"DEF-foot.{side}", -1, plain.bone(f"foot.{side}").rest, plain.bones[0].tail)
        )
    character = build_character(Character("Copies", tuple(bones)))
    for side in "LR":
        copy = character.pose.bones[f"DEF-foot.{side}"].constraints.new("COPY_TRANSFORMS")
        copy.target, copy.subtarget = character, f"foot.{side}"
    points = np.concatenate([shoe("L"), shoe("R")])
    names = [bone_of(point).replace("foot", "DEF-foot").replace("toe", "DEF-foot") for point in points]
    add_mesh(character, points, names)
    soles = mesh_soles(character, read_character(character), plain_map(plain))
    assert set(soles) == {"foot.L", "foot.R"}


@pytest.mark.parametrize("case", ["skirt", "stump", "none"])
def test_what_is_no_foot_gives_no_sole(case: str) -> None:
    plain = plain_character()
    character = build_character(plain)
    points = np.concatenate([shoe("L"), shoe("R")])
    if case == "skirt":
        add_mesh(character, points, ["hips"] * len(points))
    if case == "stump":
        points = points[points[:, 1] < -0.05]
        add_mesh(character, points, [bone_of(point) for point in points])
    assert mesh_soles(character, read_character(character), plain_map(plain)) == {}
