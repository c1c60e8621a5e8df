"""Write `presets/body/human.npz`: a smooth human body from measurements, skinned to parts of a skeleton.

Usage: make_human_mesh.py   in a Python that has Blender as a module, whose edge collapse it uses

Surface nets (Gibson 1998) make quads of the skin that `human/` describes, which are decimated where it is
even and moved onto the surface again.
"""

import sys
from pathlib import Path

import bpy
import numpy as np
from human.skin_distance import Array, signed_distance
from human.weights import PARTS, joints, strongest, weights
from numpy.typing import NDArray

FILE = Path(__file__).resolve().parents[1] / "presets" / "body" / "human.npz"
CELL_M = 0.0065  # edge of a cell of the grid that the surface is found in
TRIANGLES = 12_000
LOW = np.array([-1.0, -0.26, -0.96])
HIGH = np.array([1.0, 0.17, 0.86])


def surface() -> tuple[Array, NDArray[np.int64]]:
    """Vertices (N, 3) and quads (Q, 4) of the skin, counterclockwise from outside, by surface nets."""
    shape = np.round((HIGH - LOW) / CELL_M).astype(int)
    shape[0] += 1 - shape[0] % 2  # the body's middle goes through cells, whose vertices lie in it
    axes = [LOW[k] + CELL_M * np.arange(shape[k] + 1) for k in range(3)]
    axes[0] = CELL_M * (np.arange(shape[0] + 1) - shape[0] / 2)
    value = np.empty([len(axis) for axis in axes])
    half = shape[0] // 2 + 1
    grid_yz = np.stack(np.meshgrid(axes[1], axes[2], indexing="ij"), axis=-1).reshape(-1, 2)
    for first in range(half, shape[0] + 1, 24):
        slab = axes[0][first : first + 24]
        points = np.concatenate(
            [np.repeat(slab, len(grid_yz))[:, None], np.tile(grid_yz, (len(slab), 1))], axis=1
        )
        value[first : first + 24] = signed_distance(points).reshape(len(slab), len(axes[1]), len(axes[2]))
    value[:half] = value[half:][::-1]
    inside = value < 0.0
    corners = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    count = sum(
        inside[i : i + shape[0], j : j + shape[1], k : k + shape[2]].astype(np.int8) for i, j, k in corners
    )
    cells = np.argwhere((count > 0) & (count < 8))
    number = np.full(shape, -1)
    number[tuple(cells.T)] = np.arange(len(cells))
    total, crossings = np.zeros((len(cells), 3)), np.zeros(len(cells))
    for axis in range(3):
        step = np.eye(3, dtype=int)[axis]
        others = [k for k in range(3) if k != axis]
        for a in (0, 1):
            for b in (0, 1):
                start = cells.copy()
                start[:, others[0]] += a
                start[:, others[1]] += b
                one, other = value[tuple(start.T)], value[tuple((start + step).T)]
                crossed = (one < 0.0) != (other < 0.0)
                share = np.where(crossed, one / np.where(crossed, one - other, 1.0), 0.0)
                total += np.where(crossed[:, None], start - cells + share[:, None] * step, 0.0)
                crossings += crossed
    origin = np.array([axis[0] for axis in axes])
    vertices = origin + CELL_M * (cells + total / crossings[:, None])
    quads = []
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
        step = np.eye(3, dtype=int)[axis]
        room = np.array(shape) - step
        low = value[: room[0] + 1, : room[1] + 1, : room[2] + 1] < 0.0
        high = value[step[0] :, step[1] :, step[2] :] < 0.0
        edge = np.argwhere(low[: high.shape[0], : high.shape[1], : high.shape[2]] != high)
        out = low[tuple(edge.T)]  # from inside to outside along the axis
        around = np.stack([number[tuple((edge - d).T)] for d in (u + v, v, 0 * u, u)], axis=1)
        quads.append(np.where(out[:, None], around, around[:, ::-1]))
    return vertices, np.concatenate(quads)


def onto_skin(vertices: Array, rounds: int) -> Array:
    """Vertices moved onto the surface along its gradient."""
    moved, h = vertices.copy(), 5e-4
    for _ in range(rounds):
        value = signed_distance(moved)
        gradient = np.stack(
            [signed_distance(moved + h * e) - signed_distance(moved - h * e) for e in np.eye(3)], axis=1
        ) / (2.0 * h)
        squared = np.maximum((gradient**2).sum(axis=1), 0.25)
        moved -= np.clip(value / squared, -0.004, 0.004)[:, None] * gradient
    return moved


def decimated(vertices: Array, quads: NDArray[np.int64]) -> tuple[Array, NDArray[np.int64]]:
    """Fewer vertices and triangles, by Blender's edge collapse of the left half, which is mirrored."""
    left = quads[(vertices[quads, 0] > -1e-6).all(axis=1)]
    used, corners = np.unique(left, return_inverse=True)
    bpy.ops.wm.read_homefile(use_empty=True)
    mesh = bpy.data.meshes.new("Body")
    mesh.from_pydata(vertices[used].tolist(), [], corners.reshape(-1, 4).tolist())
    body = bpy.data.objects.new("Body", mesh)
    bpy.context.scene.collection.objects.link(body)
    modifier = body.modifiers.new("Decimate", "DECIMATE")
    modifier.ratio = 0.5 * TRIANGLES / (2.0 * len(left))
    shown = body.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    shown.calc_loop_triangles()
    places = np.array([vertex.co for vertex in shown.vertices], dtype=np.float64)
    triangles = np.array([triangle.vertices for triangle in shown.loop_triangles], dtype=np.int64)
    rim = np.zeros(len(places), dtype=bool)
    rim[[index for edge, uses in _edges(triangles) if uses == 1 for index in edge]] = True
    places[rim, 0] = 0.0
    other = np.where(rim, np.arange(len(places)), len(places) + np.cumsum(~rim) - 1)
    mirrored = places[~rim] * [-1.0, 1.0, 1.0]
    return np.concatenate([places, mirrored]), np.concatenate([triangles, other[triangles[:, ::-1]]])


def _edges(triangles: NDArray[np.int64]) -> list[tuple[tuple[int, int], int]]:
    """Edges as pairs of vertices, with the number of triangles that each has."""
    edges = np.sort(
        np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1
    )
    pairs, uses = np.unique(edges, axis=0, return_counts=True)
    return [((int(a), int(b)), int(count)) for (a, b), count in zip(pairs, uses, strict=True)]


def main() -> int:
    """Make the body and write it."""
    dense, quads = surface()
    vertices, triangles = decimated(onto_skin(dense, 1), quads)
    middle = vertices[:, 0] == 0.0
    vertices = onto_skin(vertices, 3)
    vertices[middle, 0] = 0.0
    parts, shares = strongest(weights(vertices, triangles))
    FILE.parent.mkdir(exist_ok=True)
    np.savez_compressed(
        FILE,
        vertices=np.round(vertices * 20_000.0).astype(np.int16),
        triangles=triangles.astype(np.uint16),
        parts=parts,
        shares=shares,
        names=np.array(PARTS),
        joint_names=np.array(list(joints())),
        joints=np.array(list(joints().values())),
    )
    holes = sum(uses % 2 for _, uses in _edges(triangles))  # fingers may touch along an edge
    if holes:
        raise SystemExit(f"The skin has holes along {holes} edges.")
    print(f"{len(vertices)} vertices, {len(triangles)} triangles, {FILE.stat().st_size} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
