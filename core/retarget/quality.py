"""Figures of a retargeted motion, from the joints' paths as they are shown.

All paths are in the world and in meters, by role: the joint that a role's first bone begins at, which of the
performer is the beginning of the segment of that name. So what Blender shows of a character can be measured,
whatever keys and controls made it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..body.skeleton import SIDES
from ..feet.contacts import Contact
from ..files.fields import listed
from .character import LONG_BONES
from .character_motion import CharacterMotion


@dataclass(frozen=True)
class Quality:
    """Figures of a motion on a character; None where there is nothing to measure."""

    arms_deg: float | None = None  # mean angle between the arms' bones and the performer's
    arms_worst_deg: float | None = None
    legs_deg: float | None = None  # mean angle between the legs' bones and the performer's
    legs_worst_deg: float | None = None
    skate_mm: float | None = None  # mean way of a rest's ankle, heel or toes a frame, of the farthest
    skate_worst_mm: float | None = None
    penetration_mm: float | None = None  # greatest depth of a foot, its mesh if there is one, in the ground
    lifted_mm: float | None = None  # mean height of a resting foot's lowest point over the ground
    hands_mm: float | None = None  # mean distance of wrists in reach from where they belong
    hands_worst_mm: float | None = None
    hands_floor_mm: float | None = None  # greatest error of height of wrists that are at the floor
    ik_fk_mm: float | None = None  # greatest distance of ankles and wrists between the limbs in FK and in IK
    keys: int | None = None  # keys of the motion
    dense_keys: int | None = None  # keys that one on every frame would be

    def to_dict(self) -> dict[str, Any]:
        """The figures as JSON has them, rounded; those that are not there are left out."""
        return {
            name: round(value, 3) if isinstance(value, float) else value
            for name, value in asdict(self).items()
            if value is not None
        }


BOUNDS = {
    "arms_deg": (10.0, "arms are {:.0f} degrees from the performer's"),
    "legs_deg": (10.0, "legs are {:.0f} degrees from the performer's"),
    "skate_mm": (15.0, "resting feet slide {:.0f} mm a frame"),
    "penetration_mm": (20.0, "soles are up to {:.0f} mm below the floor"),
    "lifted_mm": (20.0, "resting feet are {:.0f} mm above the floor"),
}
"""Figures beyond which a motion is not the performer's any more; lengths at the performer's size."""


def warnings_of(figures: Mapping[str, float | None], size: float) -> tuple[str, ...]:
    """Sentences on figures of `Quality` that are out of bounds, on a character of a size."""
    found = []
    for name, (most, words) in BOUNDS.items():
        value = figures.get(name)
        if value is not None and value > most * (size if name.endswith("_mm") else 1.0):
            found.append(words.format(value))
    advice = "see whether a constraint, driver or parent holds the character, or name its controls in a map"
    return (f"The motion is not right on the character: {listed(found)}; {advice}",) if found else ()


def direction_errors_deg(
    source: Mapping[str, Array], shown: Mapping[str, Array], bones: Sequence[tuple[str, str]]
) -> Array:
    """(F, B) angle between the directions of the bones whose two joints (F, 3) by role both bodies have.

    The performer's are turned as the character faces.
    """
    angles = []
    for start, end in bones:
        if not all(role in paths for role in (start, end) for paths in (source, shown)):
            continue
        first, second = source[end] - source[start], shown[end] - shown[start]
        # The angle from both sine and cosine: the arc cosine alone is blind below a hundredth of a degree.
        sine = np.linalg.norm(np.cross(first, second), axis=-1)
        angles.append(np.degrees(np.arctan2(sine, np.sum(first * second, axis=-1))))
    return np.stack(angles, axis=1) if angles else np.empty((0, 0))


def skate_mm(feet: Mapping[str, Array], rests: Sequence[Contact], sole_m: float) -> Array:
    """(N,) way of resting feet from each frame to the next, of all rests: of the point that goes farthest.

    Feet (F, K, 3) are by limb, the ankle first; of its other points those count that are no higher than
    `sole_m` over the lowest in the middle of the rest.
    """
    steps = []
    for rest in rests:
        if rest.leg in feet:
            path = feet[rest.leg][rest.frames]
            height = path[len(path) // 2, :, 2]
            sole = height - height.min() < sole_m
            sole[0] = True
            steps.append(np.linalg.norm(np.diff(path[:, sole], axis=0), axis=-1).max(axis=1))
    return 1000.0 * np.concatenate(steps) if steps else np.empty(0)


def depths_m(heights_m: Mapping[str, Array], ground_m: Mapping[str, Array]) -> dict[str, Array]:
    """(F,) by leg: depth of a foot's lowest point (F, N) by role below its ground (F,), negative above."""
    found: dict[str, Array] = {}
    for role, heights in heights_m.items():
        limb = f"leg.{role.rpartition('.')[2]}"
        if heights.size and limb in ground_m:
            depth = ground_m[limb] - heights.min(axis=1)
            found[limb] = np.maximum(found.get(limb, depth), depth)
    return found


def farthest_mm(
    first: Mapping[str, Array], second: Mapping[str, Array], roles: Sequence[str]
) -> float | None:
    """Greatest distance between two paths (F, 3) of the same joints, of the roles that both have."""
    found = [
        float(np.linalg.norm(first[role] - second[role], axis=-1).max())
        for role in roles
        if role in first and role in second
    ]
    return 1000.0 * max(found) if found else None


@dataclass(frozen=True, eq=False)
class Measured:
    """What is measured of a motion as it is shown."""

    quality: Quality
    depth_m: Mapping[str, Array]  # (F,) by leg: depth of its foot below the ground, negative above it [m]


def measured(
    source: Mapping[str, Array],
    motion: CharacterMotion,
    shown: Mapping[str, Array],
    soles: Mapping[str, Array],
) -> Measured:
    """The figures of what is shown of a solved motion, without those of controls and keys.

    In the world: joints (F, 3) by role of the performer and of the character, and points (F, N, 3) of its
    feet by role of foot and toe.
    """
    space = motion.to_world
    up, turn = space.rotation @ motion.stance.T, motion.facing
    turned = {role: path @ turn.T for role, path in source.items()}
    arms, legs = (
        direction_errors_deg(turned, shown, (*LONG_BONES[f"{limb}.L"], *LONG_BONES[f"{limb}.R"]))
        for limb in ("arm", "leg")
    )
    carried = {role: (path - space.location) @ up + motion.way_m for role, path in shown.items()}
    under = {role: (points - space.location) @ up for role, points in soles.items()}
    feet = {}
    for side in SIDES:
        if f"foot.{side}" in carried:
            own = [points + motion.way_m[..., None, :] for role, points in under.items() if role[-1] == side]
            feet[f"leg.{side}"] = np.concatenate([carried[f"foot.{side}"][:, None], *own], axis=1)
    # A foot touches the ground up to this height over its lowest point, at the performer's size.
    skate = skate_mm(feet, motion.rests, 0.01 * motion.size)
    depth_m = depths_m({role: points[..., 2] for role, points in under.items()}, motion.ground_m)
    deepest = max((float(depth.max()) for depth in depth_m.values()), default=None)
    lifted = [-depth_m[one.leg][one.frames] for one in motion.rests if one.leg in depth_m]
    hands, floor = [], []
    for side, goal in motion.hands.items():
        if f"hand.{side}" in carried:
            off = carried[f"hand.{side}"] - goal.place_m
            full = (goal.share >= 0.95) & goal.in_reach  # shares from which goals count in full
            hands.append(1000.0 * np.linalg.norm(off, axis=-1)[full])
            floor.append(1000.0 * np.abs(off[full & (goal.floor_share >= 0.95), 2]))
    quality = Quality(
        *_mean_and_most([arms]),
        *_mean_and_most([legs]),
        *_mean_and_most([skate]),
        penetration_mm=None if deepest is None else 1000.0 * max(deepest, 0.0),
        lifted_mm=None if not lifted else 1000.0 * max(float(np.concatenate(lifted).mean()), 0.0),
        hands_mm=_mean_and_most(hands)[0],
        hands_worst_mm=_mean_and_most(hands)[1],
        hands_floor_mm=_mean_and_most(floor)[1],
    )
    return Measured(quality, depth_m)


def _mean_and_most(values: Sequence[Array]) -> tuple[float | None, float | None]:
    """The mean of values and the largest; None where there are none."""
    known = [one.ravel() for one in values if one.size]
    if not known:
        return None, None
    return float(np.concatenate(known).mean()), float(np.concatenate(known).max())
