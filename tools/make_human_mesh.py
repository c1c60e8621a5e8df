"""Write `presets/body/human.npz`: a smooth human body from measurements, skinned to parts of a skeleton.

Usage: make_human_mesh.py   in a Python that has Blender as a module, whose edge collapse it uses

The body is a signed distance: lofts of superelliptical cross-sections along limbs, trunk, neck and head,
with masses of muscle, joined by a smooth minimum. Breadths, depths and circumferences are rounded averages of
adults of both sexes (Gordon et al. 2014, *2012 Anthropometric Survey of U.S. Army Personnel*), scaled to a
stature of 1.75 m; joints are those of Keymark's own skeleton at rest, in a T pose, Z up, facing -Y, hips at
the origin.
Surface nets (Gibson 1998) make quads of it, which are decimated where it is even and moved onto the surface.
Weights are the parts of the body, spread along the skin by the heat equation.
"""

import sys
from collections.abc import Callable
from pathlib import Path

import bpy
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import splu

Array = NDArray[np.float64]
Distance = Callable[[Array], Array]

FILE = Path(__file__).resolve().parents[1] / "presets" / "body" / "human.npz"
STATURE_M = 1.75
CELL_M = 0.0065  # edge of a cell of the grid that the surface is found in
TRIANGLES = 12_000
LOW = np.array([-1.0, -0.26, -0.96])
HIGH = np.array([1.0, 0.17, 0.86])
SOLE_Z = -0.9283  # the floor under the standing body
NEAR_M = 0.07  # distance up to which a shape is evaluated

# --- The body's measures: stations along an axis with half-widths and the center across it [m]

# Height; half of breadth and depth; how far the center lies behind the hips (+Y).
TRUNK = (
    (-0.105, 0.060, 0.060, 0.010),
    (-0.060, 0.140, 0.098, 0.012),
    (-0.010, 0.168, 0.110, 0.013),
    (0.040, 0.168, 0.110, 0.010),
    (0.090, 0.156, 0.104, 0.004),
    (0.145, 0.141, 0.096, -0.002),
    (0.195, 0.133, 0.091, -0.004),
    (0.250, 0.136, 0.096, -0.002),
    (0.310, 0.147, 0.106, 0.002),
    (0.370, 0.157, 0.113, 0.007),
    (0.420, 0.157, 0.110, 0.012),
    (0.465, 0.140, 0.094, 0.017),
    (0.500, 0.100, 0.074, 0.020),
    (0.530, 0.066, 0.060, 0.016),
)
NECK = (
    (0.480, 0.066, 0.064, 0.022),
    (0.520, 0.060, 0.060, 0.016),
    (0.560, 0.056, 0.057, 0.009),
    (0.600, 0.054, 0.058, 0.005),
    (0.660, 0.052, 0.060, 0.006),
)
HEAD = (
    (0.602, 0.024, 0.022, -0.062),
    (0.612, 0.036, 0.040, -0.048),
    (0.630, 0.049, 0.064, -0.026),
    (0.655, 0.059, 0.081, -0.010),
    (0.690, 0.067, 0.091, -0.001),
    (0.725, 0.072, 0.096, 0.005),
    (0.750, 0.0735, 0.096, 0.008),
    (0.778, 0.0715, 0.0925, 0.011),
)
# Height; half of breadth and depth; the center aside from the body's middle and behind it.
LEG = (
    (0.090, 0.040, 0.060, 0.085, 0.006),
    (0.030, 0.066, 0.086, 0.094, 0.010),
    (-0.040, 0.083, 0.099, 0.098, 0.011),
    (-0.100, 0.0865, 0.097, 0.099, 0.007),
    (-0.180, 0.080, 0.088, 0.100, 0.000),
    (-0.260, 0.071, 0.079, 0.101, -0.004),
    (-0.340, 0.061, 0.069, 0.101, -0.005),
    (-0.395, 0.055, 0.062, 0.101, -0.005),
    (-0.429, 0.053, 0.060, 0.101, -0.003),
    (-0.465, 0.051, 0.056, 0.101, 0.002),
    (-0.505, 0.053, 0.058, 0.102, 0.009),
    (-0.550, 0.0555, 0.061, 0.103, 0.014),
    (-0.600, 0.053, 0.058, 0.103, 0.014),
    (-0.670, 0.044, 0.049, 0.102, 0.010),
    (-0.740, 0.036, 0.041, 0.101, 0.007),
    (-0.800, 0.032, 0.038, 0.101, 0.006),
    (-0.850, 0.0335, 0.041, 0.101, 0.005),
    (-0.880, 0.034, 0.043, 0.101, 0.008),
)
# Distance aside; half of thickness and breadth; the center's height over the shoulder and how far behind it.
ARM = (
    (0.150, 0.060, 0.058, -0.004, 0.004),
    (0.195, 0.063, 0.061, -0.006, 0.002),
    (0.245, 0.058, 0.057, -0.007, 0.000),
    (0.310, 0.052, 0.051, -0.003, -0.001),
    (0.370, 0.049, 0.048, 0.000, -0.002),
    (0.430, 0.045, 0.044, 0.000, -0.001),
    (0.480, 0.041, 0.0415, 0.000, 0.000),
    (0.518, 0.039, 0.042, 0.000, 0.000),
    (0.555, 0.042, 0.046, 0.000, -0.003),
    (0.595, 0.042, 0.044, 0.000, -0.003),
    (0.650, 0.036, 0.038, 0.000, -0.002),
    (0.710, 0.028, 0.032, 0.000, 0.000),
    (0.750, 0.0225, 0.029, 0.000, 0.000),
    (0.774, 0.0210, 0.0285, 0.000, 0.000),
)
PALM = (
    (0.762, 0.0205, 0.0275, 0.000, 0.000),
    (0.790, 0.0185, 0.034, 0.000, -0.001),
    (0.820, 0.0165, 0.0405, 0.000, -0.001),
    (0.850, 0.0150, 0.0420, 0.000, -0.001),
    (0.872, 0.0120, 0.0400, 0.000, -0.001),
)
# How far ahead of the ankle; half of breadth and height; the center aside and over the floor.
FOOT = (
    (-0.052, 0.026, 0.026, 0.101, 0.030),
    (-0.025, 0.033, 0.034, 0.101, 0.036),
    (0.015, 0.035, 0.039, 0.102, 0.042),
    (0.055, 0.0375, 0.032, 0.103, 0.035),
    (0.095, 0.0425, 0.0245, 0.103, 0.026),
    (0.130, 0.0465, 0.0195, 0.102, 0.020),
    (0.155, 0.0450, 0.0160, 0.101, 0.016),
)
"""Knuckles: aside, ahead (-Y), height; then two joints and the tip relative to the knuckle, and two radii."""
FINGERS = (
    ((0.862, -0.0310, 0.000), 0.076, 0.0098),
    ((0.868, -0.0105, 0.001), 0.084, 0.0102),
    ((0.864, 0.0105, 0.000), 0.078, 0.0097),
    ((0.854, 0.0300, -0.002), 0.062, 0.0086),
)
THUMB = (
    ((0.790, -0.022, -0.004), 0.0175),
    ((0.822, -0.049, -0.012), 0.0135),
    ((0.846, -0.061, -0.015), 0.0115),
    ((0.868, -0.066, -0.017), 0.0090),
)
"""Joints and radii of the thumb."""
TOES = (
    # Aside from the body's middle; where the toe begins and ends ahead of the ankle; its radius.
    (0.074, 0.150, 0.193, 0.0135),
    (0.0945, 0.150, 0.196, 0.0105),
    (0.1115, 0.147, 0.189, 0.0098),
    (0.1265, 0.142, 0.179, 0.0092),
    (0.1395, 0.135, 0.166, 0.0088),
)


# --- Shapes as signed distances [m], negative inside, of points (N, 3) of the left half


def loft(
    stations: tuple[tuple[float, ...], ...], axis: int, sign: float, power: float
) -> tuple[Distance, Array]:
    """A tube of superelliptical cross-sections, rounded at its ends, and its bounds (2, 3).

    Stations have the place along the axis times `sign`, half-widths across it, and the center across it.
    """
    table = np.array(sorted((sign * row[0], *row[1:]) for row in stations))
    across = [index for index in range(3) if index != axis]
    if axis == 0:
        across = across[::-1]  # thickness along Z first
    along = table[:, 0]
    curves = PchipInterpolator(along, table[:, 1:])
    first, last = along[0], along[-1]

    def distance(points: Array) -> Array:
        place = points[:, axis]
        inside = np.clip(place, first, last)
        values = curves(inside)
        half = values[:, :2]
        center = np.zeros_like(half)
        count = values.shape[1] - 2
        center[:, 2 - count :] = values[:, 2:]
        offset = (points[:, across] - center) / half
        beyond = (place - inside) / (0.6 * half.min(axis=1))
        level = (np.abs(offset) ** power).sum(axis=1) ** (1.0 / power)
        radius = np.hypot(level, beyond)
        # A first-order distance: the level set's value over its gradient's length.
        slope = np.maximum(np.sqrt(((offset / half) ** 2).sum(axis=1)), 1e-6) / np.maximum(level, 1e-6)
        steep = np.maximum(level, 1e-6) * slope
        steep = np.hypot(
            steep / np.maximum(radius, 1e-6),
            np.abs(beyond) / (0.6 * half.min(axis=1)) / np.maximum(radius, 1e-6),
        )
        return np.asarray((radius - 1.0) / np.maximum(steep, 1.0 / half.max(axis=1)))

    low, high = np.full(3, -1e9), np.full(3, 1e9)
    low[axis], high[axis] = first - 0.1, last + 0.1
    widest = table[:, 1:3].max(axis=0)
    for number, index in enumerate(across):
        column = number + 3 - (2 - (table.shape[1] - 3))
        centers = table[:, column] if table.shape[1] > column >= 3 else np.zeros(1)
        low[index], high[index] = centers.min() - widest[number], centers.max() + widest[number]
    return distance, np.array([low, high])


def ellipsoid(
    center: tuple[float, float, float], radii: tuple[float, float, float]
) -> tuple[Distance, Array]:
    """An ellipsoid along the axes."""
    middle, size = np.array(center), np.array(radii)

    def distance(points: Array) -> Array:
        offset = points - middle
        outer, inner = np.linalg.norm(offset / size, axis=1), np.linalg.norm(offset / size**2, axis=1)
        return np.asarray(outer * (outer - 1.0) / np.maximum(inner, 1e-6))

    return distance, np.array([middle - size, middle + size])


def capsule(start: Array, end: Array, first: float, last: float) -> tuple[Distance, Array]:
    """A tapered round rod."""
    along = end - start

    def distance(points: Array) -> Array:
        share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
        return np.asarray(
            np.linalg.norm(points - start - share[:, None] * along, axis=1) - (first + share * (last - first))
        )

    reach = max(first, last)
    return distance, np.array([np.minimum(start, end) - reach, np.maximum(start, end) + reach])


Shape = tuple[tuple[Distance, Array], float]
"""A shape with its bounds, and the width of the seam that joins it [m]; negative where it is cut away."""


def shapes() -> list[Shape]:
    """All shapes of the body's left half, in the order in which they are joined."""
    shoulder = 0.499

    def at_shoulder(stations: tuple[tuple[float, ...], ...]) -> tuple[tuple[float, ...], ...]:
        return tuple((x, thick, wide, shoulder + z, y) for x, thick, wide, z, y in stations)

    def rod(
        start: tuple[float, float, float], end: tuple[float, float, float], first: float, last: float
    ) -> tuple[Distance, Array]:
        return capsule(np.array(start), np.array(end), first, last)

    found: list[Shape] = [
        (loft(TRUNK, 2, 1.0, 2.35), 0.0),
        (ellipsoid((0.078, 0.078, -0.045), (0.080, 0.056, 0.082)), 0.035),  # buttock
        (loft(LEG, 2, 1.0, 2.0), 0.035),
        (ellipsoid((0.068, -0.068, 0.388), (0.082, 0.040, 0.062)), 0.060),  # breast
        (rod((0.070, 0.056, 0.425), (0.096, 0.056, 0.350), 0.052, 0.048), 0.070),  # shoulder blade
        (rod((0.108, 0.022, 0.270), (0.166, 0.020, 0.440), 0.026, 0.036), 0.070),  # back of the armpit
        (rod((0.100, -0.045, 0.415), (0.178, -0.022, 0.465), 0.034, 0.032), 0.045),  # front of the armpit
        (loft(NECK, 2, 1.0, 2.0), 0.030),
        (rod((0.032, 0.026, 0.560), (0.150, 0.014, 0.508), 0.026, 0.034), 0.050),  # trapezius
        (ellipsoid((0.185, 0.002, 0.497), (0.062, 0.058, 0.056)), 0.040),  # deltoid
        (loft(at_shoulder(ARM), 0, 1.0, 2.0), 0.030),
        (loft(HEAD, 2, 1.0, 2.15), 0.022),
        (ellipsoid((0.0, 0.012, 0.744), (0.0765, 0.0985, 0.0855)), 0.020),  # skull
        (rod((0.0, -0.0935, 0.729), (0.0, -0.1065, 0.698), 0.0070, 0.0118), 0.018),  # nose
        (ellipsoid((0.028, -0.0725, 0.739), (0.025, 0.015, 0.006)), 0.030),  # brow
        (ellipsoid((0.032, -0.1035, 0.721), (0.013, 0.012, 0.008)), -0.016),  # eye's hollow
        (ellipsoid((0.0315, -0.0785, 0.7205), (0.0135, 0.0125, 0.0095)), 0.006),  # eye
        (ellipsoid((0.0, -0.0875, 0.6620), (0.023, 0.0100, 0.0046)), 0.012),  # upper lip
        (ellipsoid((0.0, -0.0860, 0.6540), (0.019, 0.0100, 0.0050)), 0.012),  # lower lip
        (ellipsoid((0.0, -0.0780, 0.6200), (0.022, 0.0150, 0.0140)), 0.026),  # chin
        (ellipsoid((0.0785, 0.018, 0.704), (0.0080, 0.0165, 0.029)), 0.008),  # ear
        (ellipsoid((0.101, -0.050, -0.424), (0.026, 0.015, 0.030)), 0.030),  # knee cap
        (ellipsoid((0.083, 0.040, -0.540), (0.026, 0.032, 0.070)), 0.030),  # calf, inside
        (ellipsoid((0.122, 0.038, -0.530), (0.024, 0.028, 0.065)), 0.030),  # calf, outside
        (ellipsoid((0.072, 0.000, -0.855), (0.010, 0.012, 0.014)), 0.018),  # inner ankle
        (ellipsoid((0.130, 0.008, -0.862), (0.010, 0.012, 0.014)), 0.018),  # outer ankle
        (
            loft(tuple((ahead, wide, high, x, SOLE_Z + z) for ahead, wide, high, x, z in FOOT), 1, -1.0, 2.2),
            0.020,
        ),
    ]
    for x, start, end, radius in TOES:
        height = SOLE_Z + radius
        found.append(
            (
                rod((x, -start, height + 0.004), (x - 0.002, -end + radius, height), radius + 0.002, radius),
                0.006,
            )
        )
    found.append((loft(at_shoulder(PALM), 0, 1.0, 2.3), 0.012))
    for (x, y, z), length, radius in FINGERS:
        # Fingers are spread a little and bent as a relaxed hand's.
        spread = 2.1 * y
        joints = [np.array([x - 0.012, y, shoulder + z])]
        for share, bend in ((0.50, 0.10), (0.28, 0.25), (0.22, 0.40)):
            way = np.array([np.cos(bend), np.sin(spread), -np.sin(bend)])
            joints.append(joints[-1] + (length * share + 0.012 * (share == 0.50)) * way / np.linalg.norm(way))
        radii = radius * np.array([1.0, 0.95, 0.88, 0.78])
        for number in range(3):
            seam = 0.010 if number == 0 else 0.002
            found.append(
                (capsule(joints[number], joints[number + 1], radii[number], radii[number + 1]), seam)
            )
    joints = [(np.array(place) + [0.0, 0.0, shoulder], radius) for place, radius in THUMB]
    for number, ((start, first), (end, last)) in enumerate(zip(joints, joints[1:], strict=False)):
        found.append((capsule(start, end, first, last), 0.014 if number == 0 else 0.003))
    return found


def signed_distance(points: Array) -> Array:
    """(N,) distance of points (N, 3) from the skin [m], negative inside; both halves are mirrored."""
    left = points * [1.0, 1.0, 1.0]
    left[:, 0] = np.abs(left[:, 0])
    found = np.full(len(points), 10.0)
    for (distance, bounds), seam in shapes():
        near = ((left > bounds[0] - NEAR_M) & (left < bounds[1] + NEAR_M)).all(axis=1)
        own = distance(left[near])
        found[near] = joined(found[near], own, seam) if seam >= 0.0 else -joined(-found[near], own, -seam)
    # The sole is flat.
    return np.asarray(-joined(-found, left[:, 2] - SOLE_Z, 0.006))


def joined(one: Array, other: Array, seam: float) -> Array:
    """Smooth minimum of two distances: a quadratic fillet of a width [m]."""
    overlap = np.maximum(seam - np.abs(one - other), 0.0)
    return np.asarray(np.minimum(one, other) - (0.25 * overlap**2 / seam if seam > 0.0 else 0.0))


# --- The surface


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


# --- Which part of the body moves which vertex

MIDDLE_PARTS = ("hips", "waist", "ribs", "chest", "neck", "head")
SIDE_PARTS = ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe")
PARTS = (*MIDDLE_PARTS, *(f"{part}.{side}" for side in "LR" for part in SIDE_PARTS))
JOINTS = {
    "neck": (0.0, 0.0, 0.499),
    "head": (0.0, 0.0, 0.600),
    "crown": (0.0, 0.0, 0.830),
    "upper_arm": (0.1925, 0.0, 0.499),
    "forearm": (0.5180, 0.0, 0.499),
    "hand": (0.7735, 0.0, 0.499),
    "hand_end": (0.9625, 0.0, 0.499),
    "thigh": (0.1006, 0.0, 0.0),
    "shin": (0.1006, 0.0, -0.429),
    "foot": (0.1006, 0.0, -0.859),
    "toe": (0.1006, -0.130, -0.910),
    "toe_end": (0.1006, -0.195, -0.910),
}
"""Joints of the left side and the middle, by the skeleton at rest [m]."""
SPREAD_M = {
    "hips": 0.055,
    "waist": 0.055,
    "ribs": 0.055,
    "chest": 0.05,
    "neck": 0.03,
    "head": 0.025,
    "shoulder": 0.042,
    "upper_arm": 0.036,
    "forearm": 0.028,
    "hand": 0.018,
    "thigh": 0.055,
    "shin": 0.036,
    "foot": 0.018,
    "toe": 0.014,
}
"""How far a part's boundary is spread along the skin."""


STEPS = 6  # of implicit time; in one alone what is far away would be moved a little as well


def part_of(points: Array) -> NDArray[np.int64]:
    """(N,) index of the part that each vertex belongs to, by planes through the joints."""
    x, y, z = np.abs(points[:, 0]), points[:, 1], points[:, 2]
    side = np.where(points[:, 0] >= 0.0, "L", "R")
    name = np.full(len(points), "hips", dtype=object)
    name[z > 0.10] = "waist"
    name[z > 0.20] = "ribs"
    name[z > 0.35] = "chest"
    name[(z > 0.53 - 0.25 * y) & (x < 0.085)] = "neck"
    name[(z > 0.605 + 0.55 * y) & (x < 0.12)] = "head"
    sided = {
        "shoulder": (z > 0.44) & (x > 0.085) & (z < 0.60),
        "upper_arm": (x > 0.178 - 0.30 * (z - 0.499)) & (z > 0.36),
        "forearm": x > 0.518,
        "hand": x > 0.7735,
        "thigh": (z < -0.055 + 0.50 * x - 0.25 * y) & (z < 0.05) & (x < 0.3),
        "shin": z < -0.429,
        "foot": z < -0.866 - 0.55 * y,
        "toe": (z < -0.86) & (y < -0.130),
    }
    for part, there in sided.items():
        name[there] = [f"{part}.{s}" for s in side[there]]
    index = {part: number for number, part in enumerate(PARTS)}
    return np.array([index[each] for each in name])


def weights(vertices: Array, triangles: NDArray[np.int64]) -> Array:
    """(N, P) how much of each vertex each part moves: the parts' boundaries spread as heat does."""
    part = part_of(vertices)
    count = len(vertices)
    hard = np.zeros((count, len(PARTS)))
    hard[np.arange(count), part] = 1.0
    spread = np.array([SPREAD_M[PARTS[index].partition(".")[0]] for index in part])
    rows, columns, values, mass = [], [], [], np.zeros(count)
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        first, second, apex = (triangles[:, k] for k in (a, b, c))
        one, other = vertices[first] - vertices[apex], vertices[second] - vertices[apex]
        area = np.linalg.norm(np.cross(one, other), axis=1)
        cotangent = np.clip((one * other).sum(axis=1) / np.maximum(area, 1e-12), 0.02, 10.0)
        # Heat after the time of half the squared width has spread so far.
        flow = 0.5 * cotangent * 0.5 * (0.5 * (spread[first] + spread[second])) ** 2 / STEPS
        rows += [first, second]
        columns += [second, first]
        values += [flow, flow]
        np.add.at(mass, apex, area / 6.0)
    stiffness = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))).tocsr()
    system = diags(mass + np.asarray(stiffness.sum(axis=1)).ravel()) - stiffness
    solve = splu(system.tocsc())
    soft = hard
    for _ in range(STEPS):
        soft = solve.solve(mass[:, None] * soft)
    return np.asarray(soft)


def strongest(soft: Array) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """The four strongest parts (N, 4) of each vertex, and their weights in 255ths, which add up to 255."""
    order = np.argsort(-soft, axis=1, kind="stable")[:, :4]
    kept = np.take_along_axis(soft, order, axis=1)
    kept[kept < 0.04] = 0.0
    kept *= 255.0 / kept.sum(axis=1, keepdims=True)
    whole = np.round(kept).astype(int)
    whole[:, 0] += 255 - whole.sum(axis=1)
    return order.astype(np.uint8), whole.astype(np.uint8)


def joints() -> dict[str, Array]:
    """(3,) all joints by name [m]."""
    found = {}
    for name, place in JOINTS.items():
        if place[0] == 0.0 and name in ("neck", "head", "crown"):
            found[name] = np.array(place)
        else:
            found |= {f"{name}.L": np.array(place), f"{name}.R": np.array(place) * [-1.0, 1.0, 1.0]}
    return found


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
