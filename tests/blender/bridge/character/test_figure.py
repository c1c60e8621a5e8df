"""The figure of a character for pictures: its meshes in their colors, or octahedra from joint to joint."""

import bpy
import numpy as np
import pytest
from _armatures import build_character
from _characters import plain_character, plain_map
from keymark.core.report.canvas import LEFT, RIGHT
from keymark.core.report.mannequin import SKIN
from keymark.operators.bridge.character.figure import character_figure, character_picture

RED = (0.8, 0.05, 0.05, 1.0)


@pytest.fixture
def armature() -> bpy.types.Object:
    """A plain skeleton of scale 0.01 that stands beside the origin."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    built = build_character(plain_character(scale=0.01))
    built.location = (1.0, 2.0, 0.0)
    bpy.context.view_layer.update()
    return built


def add_box(armature: bpy.types.Object, color: tuple[float, float, float, float] | None) -> None:
    """A box of 20 cm that the armature carries."""
    mesh = bpy.data.meshes.new("Box")
    corners = [(x, y, z) for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (0.9, 1.1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata([tuple(100.0 * value for value in corner) for corner in corners], [], faces)
    if color is not None:
        material = bpy.data.materials.new("Red")
        material.diffuse_color = color
        mesh.materials.append(material)
    box = bpy.data.objects.new("Box", mesh)
    bpy.context.scene.collection.objects.link(box)
    box.parent = armature
    bpy.context.view_layer.update()


def test_bones_are_drawn_from_joint_to_joint_in_the_world(armature: bpy.types.Object) -> None:
    figure = character_figure(armature, plain_map(plain_character()))
    low, high = figure.points.min(axis=0), figure.points.max(axis=0)
    assert high[2] == pytest.approx(1.72, abs=0.02) and low[2] == pytest.approx(0.0, abs=0.03)
    assert 0.5 * (low + high)[0] == pytest.approx(1.0, abs=0.02)
    by_side = {
        color: figure.points[figure.triangles[(figure.colors == color).all(axis=1)]][..., 0].mean()
        for color in (LEFT, RIGHT, SKIN)
    }
    assert by_side[LEFT] > 1.1 and by_side[RIGHT] < 0.9 and by_side[SKIN] == pytest.approx(1.0, abs=0.01)


def test_triangles_face_outwards(armature: bpy.types.Object) -> None:
    figure = character_figure(armature, plain_map(plain_character()))
    for first in range(0, len(figure.triangles), 8):
        corners = figure.points[figure.triangles[first : first + 8]]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        outward = corners.mean(axis=1) - corners.reshape(-1, 3).mean(axis=0)
        assert (np.sum(normals * outward, axis=-1) > 0.0).all()


@pytest.mark.parametrize(("color", "redder"), [(RED, True), (None, False)])
def test_a_mesh_is_drawn_instead_in_the_color_it_has(
    armature: bpy.types.Object, color: tuple[float, float, float, float] | None, redder: bool
) -> None:
    add_box(armature, color)
    figure = character_figure(armature, plain_map(plain_character()))
    assert len(figure.triangles) == 12
    np.testing.assert_allclose(np.ptp(figure.points, axis=0), 0.2, atol=1e-6)
    assert (figure.colors[:, 2] > 3.0 * figure.colors[:, 0]).all() == redder
    assert (figure.colors == SKIN).all() != redder


def test_without_footage_there_is_no_picture(armature: bpy.types.Object) -> None:
    shown = character_picture(
        bpy.context.scene, armature, plain_map(plain_character()), np.arange(1.0, 5.0), 0.0
    )
    assert shown is None
