"""Which part of the body moves which vertex: boundaries at joints, spread along the skin as heat is."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import splu

from .measures import JOINTS

Array = NDArray[np.float64]
MIDDLE_PARTS = ("hips", "waist", "ribs", "chest", "neck", "head")
SIDE_PARTS = ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe")
PARTS = (*MIDDLE_PARTS, *(f"{part}.{side}" for side in "LR" for part in SIDE_PARTS))
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
