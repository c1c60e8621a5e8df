"""The skin as a signed distance [m], negative inside: lofts and muscles, joined by a smooth minimum."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from .measures import ARM, FINGERS, FOOT, HEAD, LEG, NECK, PALM, SOLE_Z, THUMB, TOES, TRUNK

Array = NDArray[np.float64]
Distance = Callable[[Array], Array]
NEAR_M = 0.07  # distance up to which a shape is evaluated


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
