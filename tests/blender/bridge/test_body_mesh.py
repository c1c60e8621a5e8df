"""The simple body on the armature's bones."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.body_volume import body_pieces
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.operators.bridge.body_mesh import build_body_mesh
from keymark.operators.bridge.pose import write_posture


def places(mesh_object: bpy.types.Object, group: str) -> np.ndarray:
    """World positions (N, 3) of the vertices of one limb, as the armature moves them."""
    shown = mesh_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
    index = mesh_object.vertex_groups[group].index
    vertices = [v for v in shown.data.vertices if any(g.group == index for g in v.groups)]
    return np.array([shown.matrix_world @ vertex.co for vertex in vertices])


@pytest.mark.parametrize("seed", [70, 71])
def test_limbs_lie_on_cores_shapes_in_any_posture(
    actor: bpy.types.Object, body: Body, random_posture: Callable[[int], Posture], seed: int
) -> None:
    mesh_object = build_body_mesh(actor, body, ())
    posture = random_posture(seed)
    write_posture(actor, posture)
    pose = body.pose(posture)
    for piece in body_pieces(body):
        vertices = places(mesh_object, piece.segment)
        ends = [pose.place(piece.joint, place) for place in (piece.start, piece.end)]
        lateral = pose.rotation[piece.joint] @ piece.lateral
        axis = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
        for end, width in zip(ends, piece.half_widths, strict=True):
            ring = vertices[np.abs((vertices - end) @ axis) < 1e-5]
            assert len(ring) == 20
            assert ring.mean(axis=0) == pytest.approx(end, abs=1e-5)
            assert np.abs((ring - end) @ lateral).max() == pytest.approx(width[0], abs=1e-5)


def test_faces_look_outwards(actor: bpy.types.Object, body: Body) -> None:
    mesh = build_body_mesh(actor, body, ()).data
    volume = sum(np.dot(np.array(p.center), np.array(p.normal)) * p.area for p in mesh.polygons)
    assert volume > 0.0


def test_a_scaled_actor_has_a_scaled_body(actor: bpy.types.Object, body: Body) -> None:
    mesh_object = build_body_mesh(actor, body, ())
    actor.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    crown = places(mesh_object, "head")[:, 2].max()
    assert crown > 1.8 * body.actor.stature_m
