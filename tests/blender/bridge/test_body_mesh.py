"""The skin on the armature's bones: a human's, closed, in the actor's size, with the markers it wears."""

from collections import Counter
from collections.abc import Callable

import bpy
import numpy as np
import pytest
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import segment_piece, sole_offsets
from keymark.core.body.human_mesh import FILE
from keymark.core.body.kinematics import Body, Pose
from keymark.core.body.posture import Posture
from keymark.core.markers.region_tracks import MarkerStyle
from keymark.operators.bridge.armature import build_armature
from keymark.operators.bridge.body_mesh import build_body_mesh
from keymark.operators.bridge.pose import write_posture


def shown(mesh_object: bpy.types.Object) -> np.ndarray:
    """World positions (N, 3) of the vertices, as the armature moves them."""
    evaluated = mesh_object.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([evaluated.matrix_world @ vertex.co for vertex in evaluated.data.vertices])


def at_rest(actor: bpy.types.Object, body: Body) -> Pose:
    """The body as the armature rests."""
    vector = np.zeros(body.skeleton.dof_count)
    vector[:3] = actor.data.bones["pelvis"].head_local
    return body.pose(Posture.from_vector(body.skeleton, vector))


def weights(mesh_object: bpy.types.Object) -> dict[str, np.ndarray]:
    """(N,) weights of the vertices by group."""
    names = [group.name for group in mesh_object.vertex_groups]
    table = np.zeros((len(mesh_object.data.vertices), len(names)))
    for vertex in mesh_object.data.vertices:
        for group in vertex.groups:
            table[vertex.index, group.group] = group.weight
    return dict(zip(names, table.T, strict=True))


@pytest.mark.parametrize("seed", [70, 71])
def test_each_bone_carries_its_skin_in_any_posture(
    actor: bpy.types.Object, body: Body, random_posture: Callable[[int], Posture], seed: int
) -> None:
    mesh_object = build_body_mesh(actor, body, ())
    rest = shown(mesh_object)
    posture = random_posture(seed)
    write_posture(actor, posture)
    moved, pose, still = shown(mesh_object), body.pose(posture), at_rest(actor, body)
    table = weights(mesh_object)
    assert sum(table.values()) == pytest.approx(1.0, abs=2e-3)
    for segment in body.skeleton.segments:
        own = np.flatnonzero(table[segment.name] > 0.999)
        if segment.name.startswith("girdle"):
            continue
        assert len(own) > 5, segment.name
        local = (rest[own] - still.origin[segment.joint]) @ still.rotation[segment.joint]
        wanted = pose.origin[segment.joint] + local @ pose.rotation[segment.joint].T
        np.testing.assert_allclose(moved[own], wanted, atol=2e-4)


@pytest.mark.parametrize("stature_m", [1.3, 1.72, 2.0])
def test_the_skin_is_a_closed_body_of_the_actors_height_on_its_soles(stature_m: float) -> None:
    body = Body(Actor.from_stature(stature_m))
    actor = build_armature(bpy.context.scene, body, "Actor")
    mesh_object = build_body_mesh(actor, body, ())
    mesh = mesh_object.data
    edges = Counter(tuple(sorted(pair)) for face in mesh.polygons for pair in face.edge_keys)
    assert set(edges.values()) <= {2, 4}  # fingers may touch
    places = np.array([vertex.co for vertex in mesh.vertices])
    corners = places[[list(face.vertices) for face in mesh.polygons]]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
    # An adult of 1.72 m fills 55 to 80 liters.
    assert 0.055 < volume * (1.72 / stature_m) ** 3 < 0.080
    ankle = body.segment_ends(at_rest(actor, body), "foot.L")[0]
    assert places[:, 2].min() == pytest.approx(ankle[2] + sole_offsets(body)[..., 2].min(), abs=0.004)
    assert np.ptp(places[:, 2]) == pytest.approx(stature_m, rel=0.02)
    left, right = places[places[:, 0] > 1e-4], places[places[:, 0] < -1e-4]
    assert left.mean(axis=0) == pytest.approx(right.mean(axis=0) * [-1.0, 1.0, 1.0], abs=1e-4)


@pytest.mark.parametrize("segment", ["upper_arm.L", "forearm.R", "thigh.R", "shin.L"])
def test_limbs_are_as_thick_as_cores_volume_has_them(
    actor: bpy.types.Object, body: Body, segment: str
) -> None:
    mesh_object = build_body_mesh(actor, body, ())
    piece = segment_piece(body, segment)
    pose = at_rest(actor, body)
    start, end = (pose.place(piece.joint, place) for place in (piece.start, piece.end))
    places = shown(mesh_object)
    share = (places - start) @ (end - start) / float((end - start) @ (end - start))
    ring = places[(np.abs(share - 0.5) < 0.08) & (weights(mesh_object)[segment] > 0.9)]
    radius = np.linalg.norm(np.cross(ring - start, (end - start) / np.linalg.norm(end - start)), axis=1)
    assert radius.mean() == pytest.approx(piece.half_widths.mean(), rel=0.25)


def test_a_marker_colors_the_skin_from_joint_to_joint(actor: bpy.types.Object, body: Body) -> None:
    styles = (MarkerStyle("jacket", "trunk", (30, 140, 60)), MarkerStyle("sock", "shin.L", (230, 200, 30)))
    mesh = build_body_mesh(actor, body, styles).data
    assert [material.name.split(".")[0] for material in mesh.materials] == ["Body", "jacket", "sock"]
    pose = at_rest(actor, body)
    by_material = {
        number: np.array(
            [
                mesh.vertices[index].co
                for face in mesh.polygons
                if face.material_index == number
                for index in face.vertices
            ]
        )
        for number in range(3)
    }
    knee, ankle = body.segment_ends(pose, "shin.L")
    sock = by_material[2]
    assert (sock[:, 2].max(), sock[:, 2].min()) == pytest.approx((knee[2], ankle[2]), abs=1e-4)
    assert (sock[:, 0] > 0.0).all()
    hips, neck = body.segment_ends(pose, "pelvis")[0], body.segment_ends(pose, "chest")[1]
    jacket = by_material[1]
    assert (jacket[:, 2].max(), jacket[:, 2].min()) == pytest.approx((neck[2], hips[2]), abs=1e-4)
    assert np.abs(jacket[:, 0]).max() < 0.25


def test_a_scaled_actor_has_a_scaled_body(actor: bpy.types.Object, body: Body) -> None:
    mesh_object = build_body_mesh(actor, body, ())
    before = np.ptp(shown(mesh_object), axis=0)
    actor.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    np.testing.assert_allclose(np.ptp(shown(mesh_object), axis=0), 2.0 * before, rtol=1e-5)


def test_the_shipped_body_is_small() -> None:
    assert FILE.stat().st_size <= 300_000
