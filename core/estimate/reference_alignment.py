"""A reference motion brought into the take: size, time, sides, axes, and place frame by frame.

Its size is that of the performer's segments, and only directions, sides and time are asked of the picture.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ..arrays import Array, BoolArray
from ..body.human import HIPS, LIMB_SEGMENTS, SHOULDERS
from ..body.kinematics import Body
from ..body.mirror import OPPOSITE
from ..numerics.markov_chain import exchanged_path
from ..numerics.robust import DEGREES, multivariate_cost
from ..take.reference import ReferenceMotion
from .keypoint_trust import CHANGE
from .reference_placement import POINTS, Placed, SeenPoints, place

HEAD = POINTS.index("head")


UPRIGHT = Rotation.from_euler("x", -90.0, degrees=True)
"""Z up is Y up in camera axes, where a camera that looks level has a heading alone."""
HEADINGS = 12
LEANS_DEG = (-30.0, 0.0, 30.0)
LONGEST_LAG = 8  # frames


# --- Size and sides


def about_hips(points: Array) -> Array:
    """Points (..., 13, 3) from the middle between the hips."""
    return np.asarray(points - points[..., HIPS, :].mean(axis=-2, keepdims=True))


def of_performer(body: Body, points: Array) -> Array:
    """Points (R, 13, 3) about the hips with the lengths of the performer's segments [m].

    Each segment gets its length in the median over time; how it grows and shrinks meanwhile stays.
    """
    length = body.actor.segments_m
    hips, shoulders = points[:, HIPS].mean(axis=1), points[:, SHOULDERS].mean(axis=1)
    result = np.empty_like(points)
    across = points[:, HIPS] - hips[:, None]
    result[:, HIPS] = across * _ratio(0.5 * length["hip_width"], across)
    trunk = shoulders - hips
    above = trunk * _ratio(length["trunk"], trunk)
    across = points[:, SHOULDERS] - shoulders[:, None]
    result[:, SHOULDERS] = above[:, None] + across * _ratio(0.5 * length["shoulder_width"], across)
    head = points[:, HEAD] - shoulders
    result[:, HEAD] = above + head * _ratio(length["neck_head"], head)
    for segment, near, far in LIMB_SEGMENTS:
        ends = [[POINTS.index(f"{end}.{side}") for side in "LR"] for end in (near, far)]
        limb = points[:, ends[1]] - points[:, ends[0]]
        wanted = 0.5 * (length[f"{segment}.L"] + length[f"{segment}.R"])
        result[:, ends[1]] = result[:, ends[0]] + limb * _ratio(wanted, limb)
    return result


def _ratio(wanted_m: float, vectors: Array) -> float:
    found = np.linalg.norm(vectors, axis=-1)
    found = found[np.isfinite(found)]
    usual = float(np.median(found)) if len(found) else 0.0
    return wanted_m / usual if usual > 1e-6 else 1.0


def _sides(points: Array, seen: SeenPoints) -> BoolArray:
    """(F,) whether a motion in camera axes has left for right, by its own steps and by the picture."""
    both = np.stack([points, points[:, OPPOSITE]])
    # 0.02: What the picture says of sides errs for seconds where a detector has them wrong, so it counts
    # little; a network that exchanges them jumps. A frame is thought exchanged at this cost.
    own = np.nan_to_num(place(both, seen).cost) * (seen.confidence > 0.0).sum(axis=1) * 0.02
    # 0.3: cost at which a frame is thought exchanged
    own[1] += 0.3
    known = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
    if len(known) < 2:
        return np.zeros(len(points), dtype=bool)
    # 0.08: of a point from where it was a frame before
    stays, turns = (
        (multivariate_cost(((two - both[0, known[:-1]]) / 0.08) ** 2, DEGREES, 1.0))
        .sum(axis=(1, 2)) / 3.0
        for two in (both[0, known[1:]], both[1, known[1:]])
    )  # fmt: skip
    result = np.zeros(len(points), dtype=bool)
    result[known] = exchanged_path(own[:, known].T, stays, turns - np.log(CHANGE))
    return result


# --- Time and axes


@dataclass(frozen=True, eq=False)
class AlignedReference:
    """A reference motion in the take's world, F frames."""

    points: Array  # (F, 13, 3) about the hips, in world axes [m]; NaN where absent
    hips: Array  # (F, 3) their middle by the picture [m]; between frames where nothing is known
    placed: Placed  # by the picture
    lag: int  # frames by which it was late
    exchanged: BoolArray  # (F,) where it had left for right

    @property
    def known(self) -> BoolArray:
        """(F,) in which frames it is there."""
        return np.asarray(np.isfinite(self.points).all(axis=(1, 2)))


def align(
    reference: ReferenceMotion, body: Body, seen: SeenPoints, time_s: Array, fps: float
) -> AlignedReference:
    """Bring a reference motion into a take.

    `time_s` (F,) the clip's times [s], `fps` its rate.
    """
    points = reference.points_m.copy()
    # Frames that repeat the one before to the last digit were absent.
    points[1:][(points[1:] == points[:-1]).all(axis=(1, 2))] = np.nan
    points = of_performer(body, about_hips(points))
    best: tuple[float, Array, Rotation, bool] | None = None
    for at in _times(len(points), reference.fps, time_s, fps):
        for fixed in (False, True)[: 1 + seen.camera.is_moving]:
            cost, turn = _turn(_sampled(points, at), seen, fixed)
            if best is None or cost < best[0]:
                best = cost, at, turn, fixed
    assert best is not None
    _, at, turn, fixed = best
    lag, cost = 0, np.inf
    for step in sorted(range(-LONGEST_LAG, LONGEST_LAG + 1), key=abs):
        shifted = place(_in_camera(_sampled(points, at + step), turn, seen, fixed), seen).cost
        found = float(np.nanmean(shifted)) if np.isfinite(shifted).any() else np.inf
        # 0.97: the cost in time must be this share of that without a lag, or less
        if found < cost * (0.97 if step else 1.0):
            lag, cost = step, found
    own = _sampled(points, at + lag)
    exchanged = _sides(_in_camera(own, turn, seen, fixed), seen)
    own = np.where(exchanged[:, None, None], own[:, OPPOSITE], own)
    _, turn = _refined(own, seen, fixed, turn)
    stated = Rotation.identity() if fixed else UPRIGHT
    # 8: A network that has its motion in the camera's axes knows the vertical better than the picture does.
    turn = stated if np.degrees((turn * stated.inv()).magnitude()) < 8.0 else turn
    inside = _in_camera(own, turn, seen, fixed)
    # 0.25: a distance is smoothed over this time
    placed = place(inside, seen, 0.25 * fps)
    _, location = seen.camera.pose(np.arange(len(own)))
    hips = np.einsum("fij,fj->fi", seen.rotation, placed.place) + location
    known = np.isfinite(placed.cost)
    if known.any():
        frame = np.arange(len(hips))
        hips = np.stack([np.interp(frame, frame[known], hips[known, axis]) for axis in range(3)], axis=-1)
    world = np.einsum("fij,fpj->fpi", seen.rotation, inside)
    return AlignedReference(world, hips, placed, lag, exchanged)


def _times(count: int, rate: float | None, time_s: Array, fps: float) -> list[Array]:
    """Frames of the reference (F,) at those of the clip: by the stated rate, frame by frame, and evenly."""
    every = np.arange(len(time_s), dtype=np.float64)
    found = [every]
    if rate is not None and abs(rate / fps - 1.0) > 1e-3:
        found.insert(0, time_s * rate)
    even = count / len(time_s)
    if abs(even - 1.0) > 0.2 and all(abs(one[-1] / every[-1] / even - 1.0) > 0.05 for one in found):
        found.append(every * even)
    return found


def _sampled(points: Array, at: Array) -> Array:
    """Points (F, 13, 3) at fractional frames (F,); NaN beyond."""
    below = np.floor(at + 1e-6).astype(np.intp)
    share = np.clip(at - below, 0.0, 1.0)
    share[share < 1e-6] = 0.0
    above = below + (share > 0.0)
    inside = (below >= 0) & (above < len(points))
    first, second = (points[np.clip(one, 0, len(points) - 1)] for one in (below, above))
    mixed = first + share[:, None, None] * (second - first)
    return np.where(inside[:, None, None], mixed, np.nan)


def _in_camera(points: Array, turn: Rotation, seen: SeenPoints, fixed: bool) -> Array:
    """Points about the hips in camera axes: turned alike in these in all frames or, `fixed`, in the world."""
    turned = points @ turn.as_matrix().T
    return np.einsum("fji,fpj->fpi", seen.rotation, turned) if fixed else turned


def _turn(points: Array, seen: SeenPoints, fixed: bool) -> tuple[float, Rotation]:
    """The turn that the picture prefers, among starts in all headings, and its cost."""
    both = np.isfinite(points).all(axis=(1, 2)) & (seen.confidence > 0.0).any(axis=1)
    known = np.flatnonzero(both)
    if len(known) < 2:
        return np.inf, Rotation.identity()
    # 48: that are asked for the turn
    known = known[np.unique(np.linspace(0, len(known) - 1, 48).round().astype(int))]
    some, part = points[known], seen[known]
    upright = Rotation.identity() if fixed else UPRIGHT
    starts = [
        Rotation.from_euler("x", lean, degrees=True)
        * upright
        * Rotation.from_euler("z", heading, degrees=True)
        for lean in LEANS_DEG
        for heading in np.arange(HEADINGS) * 360.0 / HEADINGS
    ]
    costs = np.array([_cost(some, part, fixed, turn) for turn in starts])
    # 4: of the best of these turns, so many are refined
    refined = [_refined(some, part, fixed, starts[one]) for one in np.argsort(costs)[:4]]
    return min(refined, key=lambda one: one[0])


def _cost(points: Array, seen: SeenPoints, fixed: bool, turn: Rotation) -> float:
    cost = place(_in_camera(points, turn, seen, fixed), seen).cost
    return float(np.nanmean(cost)) if np.isfinite(cost).any() else np.inf


def _refined(points: Array, seen: SeenPoints, fixed: bool, turn: Rotation) -> tuple[float, Rotation]:
    """Gauss-Newton on the turn, of rows weighed by Student's t; and the cost."""
    known = np.isfinite(points).all(axis=(1, 2))
    step_rad = 0.01
    cost = _cost(points, seen, fixed, turn)
    for _ in range(6):
        here = place(_in_camera(points, turn, seen, fixed), seen).residual_m
        moved = np.stack(
            [
                place(_in_camera(points, Rotation.from_rotvec(axis) * turn, seen, fixed), seen).residual_m
                for axis in step_rad * np.eye(3)
            ],
            axis=-1,
        )
        squared = (here**2).sum(axis=-1, keepdims=True) / seen.std_m[:, None] ** 2
        weight = np.sqrt((DEGREES + 2.0) / (DEGREES + squared)) / seen.std_m[:, None]
        row = np.isfinite(here) & known[:, None, None]
        if not row.any():
            break
        slope = (((moved - here[..., None]) / step_rad) * weight[..., None])[row]
        change, *_ = np.linalg.lstsq(slope, -(here * weight)[row], rcond=None)
        size = float(np.linalg.norm(change))
        tried = Rotation.from_rotvec(change * min(1.0, 0.5 / max(size, 1e-9))) * turn
        found = _cost(points, seen, fixed, tried)
        if not found < cost:
            break
        cost, turn = found, tried
        if size < 1e-3:
            break
    return cost, turn
