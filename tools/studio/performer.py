"""The performer as one smooth mesh that bends at its joints, dressed in five colors."""

from dataclasses import dataclass

import bpy
import numpy as np
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import hinge
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.spatial import cKDTree

from .limbs import arm_rotations
from .look import Color, Look
from .performance import Performance
from .performer_shape import body_parts, movers, part_mesh

VOXEL_M = 0.009
SMOOTHING_PASSES = 5
BLEND_M = 0.016
"""Falloff distance of a part's skinning weights from its surface."""
WEIGHT_PASSES = 10
FOLD_M = 0.035
"""Wavelength of a garment's folds."""
NECKLINE_M = 0.075
ARMS_OUT_DEG, LEGS_APART_DEG = 52.0, 14.0


@dataclass(frozen=True, eq=False)
class Performer:
    """The mesh and its movers."""

    thing: bpy.types.Object
    """The Blender object, placed at the world's origin."""
    places: Array
    """(V, 3) vertices in the modeling posture."""
    weights: Array
    """(V, N) skinning weight of each mover for every vertex."""
    names: tuple[str, ...]
    """Names of the N movers."""
    modeled: tuple[Array, Array]
    """Rotations (N, 3, 3) and origins (N, 3) of the movers in the modeling posture."""

    def bend(self, performance: Performance, index: int) -> None:
        """Move the mesh to a stored time of the performance."""
        one = np.array([index])
        pose = performance.body.pose(performance.postures[one])
        placed = movers(performance.body, pose, {s: r[one] for s, r in performance.feet.items()})
        if performance.build is not None:
            placed = performance.build.placed(performance.body, pose, placed)
        bent = np.zeros_like(self.places)
        for column, name in enumerate(self.names):
            rotation = placed[name][0][0] @ self.modeled[0][column].T
            moved = (self.places - self.modeled[1][column]) @ rotation.T + placed[name][1][0]
            bent += self.weights[:, column, None] * moved
        self.thing.data.vertices.foreach_set("co", bent.astype(np.float32).ravel())
        self.thing.data.update()

    def world_places(self) -> Array:
        """(V, 3) current positions of the vertices [m]."""
        return _read(self.thing.data.vertices, "co")


def build_performer(body: Body, look: Look) -> Performer:
    """Model the performer with arms and legs apart, compute skinning weights, and assign materials."""
    pose = body.pose(_modeling_posture(body))
    placed = movers(body, pose, {side: np.eye(3)[None] for side in ("L", "R")})
    parts = body_parts(body, look.girths)
    meshes = [part_mesh(part, placed[part.mover][0][0], placed[part.mover][1][0]) for part in parts]
    thing = one_surface(meshes)
    mesh = thing.data
    places, normals = _read(mesh.vertices, "co"), _read(mesh.vertices, "normal")
    names = tuple(dict.fromkeys(part.mover for part in parts))
    samples = {
        name: np.concatenate([m[0] for part, m in zip(parts, meshes, strict=True) if part.mover == name])
        for name in names
    }
    weights = skin_weights(mesh, places, [samples[name] for name in names])
    dressed = _paint(mesh, body, look.painted, places, weights, names, placed)
    thickness = np.array([look.cloth_m.get(name.split(".")[0], 0.0) for name in dressed])
    places = places + (thickness * (1.0 + look.folds * _folds(places)))[:, None] * normals
    rotation = np.stack([placed[name][0][0] for name in names])
    origin = np.stack([placed[name][1][0] for name in names])
    return Performer(thing, places, weights, names, (rotation, origin))


def _folds(places: Array) -> Array:
    """Irregular waves (V,) between -1 and 1 over the surface."""
    x, y, z = (2.0 * np.pi / FOLD_M * places).T
    return np.asarray(
        np.sin(0.9 * z + 0.7 * np.sin(0.31 * x + 0.4 * y)) * np.sin(0.45 * x - 0.35 * y + 0.2 * z)
    )


def _modeling_posture(body: Body) -> Posture:
    posture = Posture.rest(body.skeleton, (1,))
    rotation = posture.rotations.copy()
    for column, index in enumerate(body.skeleton.ball_joints):
        name = body.skeleton.joints[index].name
        out = 1.0 if name.endswith(".L") else -1.0
        if name.startswith("shoulder"):
            angles = (np.array([ARMS_OUT_DEG]), np.zeros(1), np.zeros(1))
            rotation[:, column] = arm_rotations(name[-1], *angles)
        elif name.startswith("hip"):
            rotation[:, column] = hinge(np.array([0.0, 1.0, 0.0]), -out * np.radians(LEGS_APART_DEG))
    return Posture(body.skeleton, posture.translation, rotation, posture.angles)


def one_surface(meshes: list[tuple[Array, list[list[int]]]], voxel_m: float = VOXEL_M) -> bpy.types.Object:
    """Join closed meshes, vertices (N, 3) and faces, into one smooth surface of quads of about `voxel_m`."""
    vertices, faces, count = [], [], 0
    for places, quads in meshes:
        vertices.append(places)
        faces += [[corner + count for corner in quad] for quad in quads]
        count += len(places)
    mesh = bpy.data.meshes.new("Performer")
    mesh.from_pydata(np.concatenate(vertices).tolist(), [], faces)
    thing = bpy.data.objects.new("Performer", mesh)
    bpy.context.scene.collection.objects.link(thing)
    remesh = thing.modifiers.new("One surface", "REMESH")
    remesh.mode, remesh.voxel_size = "VOXEL", voxel_m
    smooth = thing.modifiers.new("Smooth", "SMOOTH")
    smooth.iterations = SMOOTHING_PASSES
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    surface = bpy.data.meshes.new_from_object(evaluated)
    thing.modifiers.clear()
    thing.data = surface
    surface.polygons.foreach_set("use_smooth", np.ones(len(surface.polygons), bool))
    return thing


def skin_weights(mesh: bpy.types.Mesh, places: Array, samples: list[Array]) -> Array:
    """Skinning weights (V, N) by distance to each mover's parts, blended along the surface."""
    distance = np.stack([cKDTree(sample).query(places)[0] for sample in samples], axis=-1)
    distance -= distance.min(axis=1, keepdims=True)
    weights = np.exp(-((distance / BLEND_M) ** 2))
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    first, second = edges.reshape(-1, 2).T
    ones = np.ones(2 * len(first))
    pairs = (np.concatenate([first, second]), np.concatenate([second, first]))
    beside = coo_matrix((ones, pairs), shape=(len(places), len(places))).tocsr()
    degree = np.asarray(beside.sum(axis=1))
    for _ in range(WEIGHT_PASSES):
        weights = 0.5 * weights + 0.5 * (beside @ weights) / degree
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def _paint(
    mesh: bpy.types.Mesh,
    body: Body,
    colors: dict[str, Color],
    places: Array,
    weights: Array,
    names: tuple[str, ...],
    placed: dict[str, tuple[Array, Array]],
) -> NDArray[np.str_]:
    """Give every face a material; return the material of each vertex."""
    holder = np.array(names)[weights.argmax(axis=1)]
    dressed = np.full(len(places), "cloth", dtype="<U12")
    for name in set(names):
        rotation, origin = placed[name][0][0], placed[name][1][0]
        here = holder == name
        dressed[here] = _dress(name, body, (places[here] - origin) @ rotation)
    order = list(colors)
    for material, color in colors.items():
        mesh.materials.append(_material(material, color))
    corners = np.empty(4 * len(mesh.polygons), np.int32)
    mesh.polygons.foreach_get("vertices", corners)
    index = np.array([order.index(name) for name in dressed], np.int32)[corners.reshape(-1, 4)]
    mesh.polygons.foreach_set("material_index", np.sort(index, axis=1)[:, 1].copy())
    return dressed


def _dress(name: str, body: Body, local: Array) -> NDArray[np.str_]:
    """Material names of vertices (V, 3) in their mover's frame."""
    lengths = body.actor.segments_m
    kind, _, side = name.partition(".")
    worn = np.full(len(local), "cloth", dtype="<U12")
    if kind in ("pelvis", "waist"):
        height = local[:, 2] + body.offsets[body.skeleton.joint_index(name), 2] * (kind == "waist")
        worn[height > 0.03] = "trunk"
        from_neck = np.hypot(local[:, 0], local[:, 1] + 0.01)
        worn[(height > 1.02 * lengths["trunk"]) & (from_neck < NECKLINE_M)] = "skin"
    elif kind == "girdle":
        worn[:] = "trunk"
    elif kind == "forearm":
        share = np.abs(local[:, 0]) / lengths[name]
        worn[(share > 0.07) & (share < 0.94)] = name
        worn[share >= 0.94] = "skin"
    elif kind == "shin":
        share = -local[:, 2] / lengths[name]
        worn[(share > 0.10) & (share < 0.90)] = name
    elif kind == "shoe":
        worn[local[:, 2] < 0.025] = "shoe"
    elif kind == "neck":
        worn[:] = np.where(local[:, 2] > 0.02, "skin", "trunk")
        center = local - np.array([0.0, 0.0, lengths["neck_head"]])
        hairline = 0.055 - 0.9 * (center[:, 1] + 0.055).clip(min=0.0)
        worn[(center[:, 2] > hairline) & (center[:, 2] > -0.075)] = "hair"
        eyes = (np.abs(np.abs(center[:, 0]) - 0.030) < 0.013) & (np.abs(center[:, 2] - 0.012) < 0.009)
        worn[eyes & (center[:, 1] < -0.06)] = "eye"
    return worn


def _material(name: str, color: Color) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*((np.array(color) / 255.0) ** 2.2), 1.0)
    shader.inputs["Roughness"].default_value = 0.55 if name in ("skin", "shoe") else 0.85
    if name not in ("skin", "eye"):
        noise, bump = nodes.new("ShaderNodeTexNoise"), nodes.new("ShaderNodeBump")
        noise.inputs["Scale"].default_value = 14.0
        bump.inputs["Strength"].default_value = 0.35
        bump.inputs["Distance"].default_value = 0.02
        links.new(noise.outputs["Fac"], bump.inputs["Height"])
        links.new(bump.outputs["Normal"], shader.inputs["Normal"])
    return material


def _read(items: bpy.types.bpy_prop_collection, name: str) -> Array:
    values = np.empty(3 * len(items), np.float32)
    items.foreach_get(name, values)
    return values.reshape(-1, 3).astype(np.float64)
