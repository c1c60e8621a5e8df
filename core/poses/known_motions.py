"""All motions of some libraries and their mirror images as postures at small steps of time, on one body."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, IndexArray
from ..body.human import limb_of
from ..body.kinematics import Body, Pose
from ..body.mirror import mirrored
from ..body.posture import Posture, headings_rad, yaw_rotation, yawed_at
from ..prior.library import Library, LibraryMotion
from ..prior.motion_playback import sample_motion
from ..prior.transfer import transferred

STEP_M = 0.045  # mean distance of points between postures: well below performers' differences
MOST_RATE = 25.0  # postures per second of a motion; the least are 8
MOST_POSTURES = 450  # postures of a library, without mirror images; with more the steps are widened


@dataclass(frozen=True, eq=False)
class KnownMotions:
    """S postures, the second half the mirror images of the first; one in no motion is a motion of its own."""

    posture: Posture  # (S,) facing -Y, the hips at the origin
    names: tuple[tuple[str, bool], ...]  # (S,) the library's posture nearest in time, and if it is mirrored
    library: IndexArray  # (S,) number of the library, in the order in which they were given
    motion: IndexArray  # (S,) number of the motion
    time_s: Array  # (S,) time within the motion
    step_s: Array  # (S,) time to the motion's next posture; 0 for a single one
    period_s: Array  # (S,) duration of a cycle; infinite without one
    height_m: Array  # (S,) of the hips over the floor
    velocity: Array  # (S, 2) of the hips over the ground, as the posture faces [m/s]
    turn_rate: Array  # (S,) change of the heading [rad/s]

    def of_library(self, number: int) -> "KnownMotions":
        """Those of one library."""
        own = np.flatnonzero(self.library == number)
        names = tuple(self.names[row] for row in own)
        return KnownMotions(
            self.posture[own],
            names,
            *(getattr(self, each)[own] for each in tuple(self.__dataclass_fields__)[2:]),
        )


@dataclass(frozen=True, eq=False)
class _Sampled:
    """N postures of one motion at equal steps of time, as it goes over the ground."""

    posture: Posture
    names: list[str]
    step_s: float
    is_cyclic: bool


def known_motions(libraries: Sequence[Library], body: Body) -> KnownMotions:
    """The motions of some libraries, at least one of which has a posture, on a body."""
    every = [(number, each) for number, one in enumerate(libraries) for each in _motions(one, body)]
    count = [len(each.names) for _, each in every]
    plain = Posture.concatenate([each.posture for _, each in every])
    posture = Posture.concatenate([plain, mirrored(plain)])
    names = [name for _, each in every for name in each.names]
    rates = [_rates(each) for _, each in every]
    velocity, turning = (np.concatenate([rate[i] for rate in rates]) for i in range(2))

    def twice(values: Sequence[float] | IndexArray) -> Array:
        return np.tile(np.repeat(values, count), 2)

    return KnownMotions(
        yawed_at(posture, -headings_rad(posture), np.zeros((2 * len(names), 3))),
        (*((name, False) for name in names), *((name, True) for name in names)),
        twice([number for number, _ in every]).astype(np.intp),
        np.concatenate([np.repeat(np.arange(len(every)) + shift, count) for shift in (0, len(every))]),
        np.tile(np.concatenate([each.step_s * np.arange(len(each.names)) for _, each in every]), 2),
        twice([each.step_s for _, each in every]),
        twice([each.step_s * len(each.names) if each.is_cyclic else np.inf for _, each in every]),
        posture.translation[:, 2],
        np.concatenate([velocity, velocity * np.array([-1.0, 1.0])]),
        np.concatenate([turning, -turning]),
    )


def _motions(library: Library, body: Body) -> list[_Sampled]:
    found = [_sampled(library, motion, body, 1.0) for motion in library.motions]
    total = sum(len(each.names) for each in found)
    if total > MOST_POSTURES:
        found = [_sampled(library, motion, body, total / MOST_POSTURES) for motion in library.motions]
    used = {step.posture for motion in library.motions for step in motion.steps}
    for loose in library.postures:
        if loose.name not in used:
            posture = Posture.stack([transferred(loose.posture, library.actor, body)])
            found.append(_Sampled(posture, [loose.name], 0.0, False))
    return found


def _sampled(library: Library, motion: LibraryMotion, body: Body, spacing: float) -> _Sampled:
    """A motion at steps of time in which its points move about `STEP_M` times `spacing`."""
    whole = motion.duration_s if motion.cyclic else motion.steps[-1].time_s
    fine = np.linspace(0.0, whole, int(np.clip(np.ceil(whole * MOST_RATE) + 1, 3, MOST_POSTURES)))
    posture = sample_motion(library, motion, body, fine)
    points = body.points(body.pose(posture)) - posture.translation[:, None]
    length = float(np.linalg.norm(np.diff(points, axis=0), axis=-1).mean(axis=1).sum())
    rate = np.clip(length / STEP_M / max(whole, 1e-6), 8.0, MOST_RATE) / spacing
    count = int(np.clip(np.ceil(whole * rate), 3, MOST_POSTURES))
    step = whole / count if motion.cyclic else whole / (count - 1)
    time = step * np.arange(count)
    away = np.abs(time[:, None] - np.array([entry.time_s for entry in motion.steps]))
    if motion.cyclic:
        away = np.minimum(away, whole - away)
    names = [motion.steps[int(i)].posture for i in away.argmin(axis=1)]
    return _Sampled(sample_motion(library, motion, body, time), names, step, motion.cyclic)


def _rates(motion: _Sampled) -> tuple[Array, Array]:
    """(N, 2) velocity over the ground as the posture faces [m/s], and (N,) turning [rad/s]."""
    count = len(motion.names)
    if count == 1 or motion.step_s <= 0.0:
        return np.zeros((count, 2)), np.zeros(count)
    heading = np.unwrap(headings_rad(motion.posture))
    gone = np.gradient(motion.posture.translation, motion.step_s, axis=0)
    own = (yaw_rotation(-heading) @ gone[..., None])[:, :2, 0]
    return own, np.gradient(heading, motion.step_s)


# --- Limbs of postures


CARRIERS = {"arm": "waist", "leg": "pelvis"}  # joint that carries a limb, by its kind


def limb_places(body: Body, pose: Pose, limb: str) -> Array:
    """(N, 2, 3) places of a limb's two farther points in the frame of the joint that carries it [m]."""
    joint = body.skeleton.joint_index(CARRIERS[limb.partition(".")[0]])
    own = [index for index, name in enumerate(body.skeleton.point_names) if limb_of(name) == limb]
    away = body.points(pose)[:, own] - pose.origin[:, None, joint]
    return np.asarray(away @ pose.rotation[:, joint])
