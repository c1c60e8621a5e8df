"""Limbs that keep their image: the ways, up to four, in which a limb can lie on lines of sight to its joints.

Each part of a limb leans toward the camera or away from it, and one picture does not tell which (Taylor 2000,
*Reconstruction of articulated objects from point correspondences in a single uncalibrated image*).
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ..arrays import Array, BoolArray
from ..body.kinematics import Body
from ..body.posture import Posture
from ..footage.camera import Camera
from .limb_chain import LimbChain, aimed, limb_excess_rad, limb_points, part_lengths_m
from .sight_lines import SightLine

DISTINCT_M = 0.02
"""Joints closer than this in two postures [m]: turning one into the other shows nothing."""
MOST_STEPS = 60
DEPTH_SHARE = 0.1
"""Weight of a joint's place along its line of sight beside that off it, where joint limits allow not both."""


@dataclass(frozen=True, eq=False)
class LimbInSight:
    """One way in which a limb can lie on given lines of sight, within its joint limits."""

    posture: Posture
    """The whole posture."""
    leans: BoolArray
    """(2,) whether upper and lower part lead to the farther of the two places on their lines."""
    excess_rad: float
    """How far joint limits would have been passed, had the joints been put exactly on their lines [rad]."""
    off_m: float
    """The larger distance of middle and end from their lines of sight [m]."""
    effort: float
    """Mean square distance of the limb's joints from the middle of their ranges, in half ranges: Liégeois
    (1977), *Automatic supervisory control of the configuration and behavior of multibody mechanisms*."""

    @property
    def strain(self) -> float:
        """How implausible the limb is; what lies outside joint limits or beside the image counts most."""
        return OUTSIDE * self.excess_rad + BESIDE * self.off_m + self.effort


OUTSIDE = 4.0
"""Strain of a radian beyond joint limits: a quarter of it weighs as much as the whole of a limb's ranges."""
BESIDE = 20.0
"""Strain of a meter beside the image: 5 cm, half the width of a forearm, weigh as much."""


def ways_in_sight(
    body: Body, posture: Posture, limb: LimbChain, lines: tuple[SightLine, SightLine]
) -> tuple[LimbInSight, ...]:
    """All ways in which a limb can lie on the lines of sight to its middle and end.

    Lengths are exact and the rest of the body stays. Where joint limits forbid a way, it is the nearest
    posture within them, which keeps the image rather than the depth.

    Args:
        body: The actor's body.
        posture: A single posture, whose limb is replaced.
        limb: The limb.
        lines: Lines of sight of its middle and its end.

    Returns:
        Up to four ways, the most plausible first; of those that look the same, that one alone.
    """
    start = limb_points(body, posture, limb)
    lengths = part_lengths_m(body, limb)
    found: list[LimbInSight] = []
    for upper, middle in enumerate(lines[0].at_distance(start[0], lengths[0])):
        for lower, end in enumerate(lines[1].at_distance(middle, lengths[1])):
            if min(lines[0].along_m(middle), lines[1].along_m(end)) <= 0.0:
                continue  # behind the camera
            ideal = aimed(body, posture, limb, middle, end)
            found.append(_within_limits(body, ideal, limb, lines, np.array([upper, lower]) > 0))
    kept: list[LimbInSight] = []
    for way in sorted(found, key=lambda way: way.strain):
        places = limb_points(body, way.posture, limb)
        if all(_apart_m(places, limb_points(body, other.posture, limb)) > DISTINCT_M for other in kept):
            kept.append(way)
    return tuple(kept)


def sight_lines(body: Body, posture: Posture, camera: Camera, limb: LimbChain) -> tuple[SightLine, SightLine]:
    """Lines of sight to a limb's middle and end, as a single posture has them."""
    _, middle, end = limb_points(body, posture, limb)
    return SightLine.to(camera, middle), SightLine.to(camera, end)


def depths_m(body: Body, posture: Posture, limb: LimbChain, lines: tuple[SightLine, SightLine]) -> Array:
    """(2,) how much farther away the middle lies than the root, and the end than the middle [m]."""
    root, middle, end = limb_points(body, posture, limb)
    return np.array([(middle - root) @ lines[0].direction, (end - middle) @ lines[1].direction])


def _apart_m(first: Array, second: Array) -> float:
    return float(np.linalg.norm(first - second, axis=-1).max())


def _within_limits(
    body: Body,
    ideal: Posture,
    limb: LimbChain,
    lines: tuple[SightLine, SightLine],
    leans: BoolArray,
) -> LimbInSight:
    """A way of a limb, moved into its joint limits where it is beyond them."""
    excess = limb_excess_rad(ideal, limb)
    places = limb_points(body, ideal, limb)[1:]
    posture = ideal if not excess.any() else _allowed(body, ideal, limb, lines, places)
    reached = limb_points(body, posture, limb)[1:]
    off = max(line.off_m(place) for line, place in zip(lines, reached, strict=True))
    excess_rad = float(np.linalg.norm(excess))
    return LimbInSight(posture, leans, excess_rad, off, _effort(ideal, limb))


def _allowed(
    body: Body, ideal: Posture, limb: LimbChain, lines: tuple[SightLine, SightLine], places: Array
) -> Posture:
    """The posture within the limb's joint limits whose middle and end are seen nearest to their places."""
    vector = ideal.to_vector()
    lower, upper = body.skeleton.limits[limb.dofs].T
    weights = np.stack([_weights(line) for line in lines])

    def moved(values: Array) -> Posture:
        changed = vector.copy()
        changed[limb.dofs] = values
        return Posture.from_vector(body.skeleton, changed)

    def off(values: Array) -> Array:
        away = limb_points(body, moved(values), limb)[1:] - places
        return np.asarray((weights @ away[..., None]).ravel())

    def rates(values: Array) -> Array:
        posture = moved(values)
        turned = Posture.rest(body.skeleton).plus_jacobian(posture.to_vector())[np.ix_(limb.dofs, limb.dofs)]
        jacobian = body.points_jacobian(body.pose(posture))[limb.columns[1:]][..., limb.dofs]
        return np.asarray((weights @ jacobian @ turned).reshape(-1, len(limb.dofs)))

    inside = np.clip(vector[limb.dofs], lower, upper)
    fitted = least_squares(off, inside, rates, bounds=(lower, upper), max_nfev=MOST_STEPS)
    return moved(np.clip(fitted.x, lower, upper))


def _weights(line: SightLine) -> Array:
    """(3, 3) matrix that leaves what is off a line of sight as it is, and makes less of what is along it."""
    along = np.outer(line.direction, line.direction)
    return np.asarray(np.eye(3) - (1.0 - DEPTH_SHARE) * along)


def strain_of(posture: Posture, limb: LimbChain) -> float:
    """How implausible a limb is as it stands; see `LimbInSight.strain`."""
    return OUTSIDE * float(np.linalg.norm(limb_excess_rad(posture, limb))) + _effort(posture, limb)


def _effort(posture: Posture, limb: LimbChain) -> float:
    lower, upper = posture.skeleton.limits[limb.dofs].T
    values = np.clip(posture.to_vector()[limb.dofs], lower, upper)
    return float(np.mean(((values - 0.5 * (lower + upper)) / (0.5 * (upper - lower))) ** 2))
