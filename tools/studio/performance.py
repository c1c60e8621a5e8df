"""Performances, the posture at any time of a take, from channels in a coach's terms.

Frames count from 0 and may be fractional; angles are degrees here.
"""

from dataclasses import dataclass, field, replace

import numpy as np
from keymark.core.arrays import Array, IndexArray
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import hinge
from scipy.ndimage import gaussian_filter1d

from .build import Build
from .limbs import (
    FreeLeg,
    arm_rotations,
    blended,
    foot_clearance,
    free_leg,
    leg_rotations,
    turned,
    within_reach,
)

Channels = dict[str, Array]

FPS = 30
"""Frames per second of a take that says nothing else."""
STEPS_PER_FRAME = 8
SIDES = ("L", "R")
SOFT_LANDING_FRAMES = 0.5
"""Frames over which the load passes from one foot to the other."""


@dataclass(frozen=True, eq=False)
class Choreography:
    """All channels of a motion, over T times."""

    pelvis: Channels
    """Hips' midpoint x, y, z [m]; yaw turns left, pitch bows, roll raises the right side."""
    trunk: Channels
    """Pitch, roll and yaw of the waist, and the same of the neck (`neck_pitch` and so on)."""
    arms: dict[str, Channels]
    """By side: elevation, forward, twist, flexion, pronation, girdle."""
    feet: dict[str, tuple[Array, Array]]
    """By side: the leg's target, ankle position (T, 3) [m] and world rotation of the foot (T, 3, 3)."""
    free: dict[str, FreeLeg] = field(default_factory=dict)
    """By side: legs that swing by their own angles for a share of the time."""
    grounded: Array | None = None
    """(T,) height [m] of the lowest sole above the floor, which then determines the hips' height. None keeps
    the given one."""
    exact_reach: bool = False
    """Whether a foot beyond the leg's reach is an error; otherwise its heel lifts."""

    def turned(self, heading_deg: float) -> "Choreography":
        """The choreography turned left about the world's origin."""
        turn = hinge(np.array([0.0, 0.0, 1.0]), np.radians(heading_deg))
        x, y, _ = turn @ np.stack([self.pelvis["x"], self.pelvis["y"], 0.0 * self.pelvis["x"]])
        pelvis = {**self.pelvis, "x": x, "y": y, "yaw": self.pelvis["yaw"] + heading_deg}
        feet = {side: (ankle @ turn.T, turn @ foot) for side, (ankle, foot) in self.feet.items()}
        return replace(self, pelvis=pelvis, feet=feet)


@dataclass(frozen=True, eq=False)
class Performance:
    """A motion at stored times."""

    body: Body
    """The performer."""
    frame_count: int
    """Frames of the take."""
    times: Array
    """(T,) times [frames], from 0, evenly spaced by a fraction of a frame."""
    postures: Posture
    """A batch of T postures."""
    feet: dict[str, Array]
    """World rotations (T, 3, 3) of each foot's mesh by side: the skeleton's feet are rigid with the shins, a
    person's are not."""
    fps: int = FPS
    """Frames per second."""
    build: Build | None = None
    """Where the performer's joints lie; None for the skeleton's own."""

    def at(self, times: Array) -> IndexArray:
        """Indices of the stored times nearest to `times` [frames]."""
        step = self.times[1] - self.times[0]
        return np.clip(np.rint((times - self.times[0]) / step), 0, len(self.times) - 1).astype(np.intp)

    @property
    def middles(self) -> IndexArray:
        """Indices of the stored times in the middle of each frame's exposure."""
        return self.at(np.arange(float(self.frame_count)))


def stored_times(frame_count: int) -> Array:
    """The times [frames] at which a performance is composed: one more frame at both ends, for the shutter."""
    return np.arange(-STEPS_PER_FRAME, (frame_count + 1) * STEPS_PER_FRAME) / STEPS_PER_FRAME


def compose(body: Body, times: Array, plan: Choreography, fps: int = FPS) -> Performance:
    """The performance that a plan describes at `stored_times`."""
    posture = Posture.rest(body.skeleton, times.shape)
    balls = {body.skeleton.joints[i].name: column for column, i in enumerate(body.skeleton.ball_joints)}
    hinges = {body.skeleton.joints[i].name: column for column, i in enumerate(body.skeleton.hinge_joints)}
    rotation, angle = posture.rotations.copy(), posture.angles.copy()
    pelvis, trunk = plan.pelvis, plan.trunk
    rotation[:, balls["pelvis"]] = turned(pelvis["yaw"], pelvis["pitch"], pelvis["roll"])
    rotation[:, balls["waist"]] = turned(trunk["yaw"], trunk["pitch"], trunk["roll"])
    rotation[:, balls["neck"]] = turned(trunk["neck_yaw"], trunk["neck_pitch"], trunk["neck_roll"])
    for side, arm in plan.arms.items():
        rotation[:, balls[f"shoulder.{side}"]] = arm_rotations(
            side, arm["elevation"], arm["forward"], arm["twist"]
        )
        angle[:, hinges[f"elbow.{side}"]] = np.radians(arm["flexion"])
        angle[:, hinges[f"forearm.{side}"]] = np.radians(arm["pronation"])
        angle[:, hinges[f"girdle.{side}"]] = np.radians(arm["girdle"])
    place = np.stack([pelvis["x"], pelvis["y"], pelvis["z"]], axis=-1)
    if plan.grounded is not None:
        place[:, 2] = _height_of_hips(body, plan, place, rotation[:, balls["pelvis"]])
    feet = {}
    for side in SIDES:
        legs = _leg(body, side, plan, place, rotation[:, balls["pelvis"]])
        rotation[:, balls[f"hip.{side}"]], angle[:, hinges[f"knee.{side}"]], feet[side] = legs
    count = round(len(times) / STEPS_PER_FRAME) - 2
    return Performance(body, count, times, Posture(body.skeleton, place, rotation, angle), feet, fps)


def _leg(
    body: Body, side: str, plan: Choreography, place: Array, pelvis_rotation: Array
) -> tuple[Array, Array, Array]:
    """Hip rotations (T, 3, 3), knee angles (T,) [rad] and the foot's world rotations (T, 3, 3)."""
    swing = plan.free.get(side)
    if side not in plan.feet:
        if swing is None:
            raise ValueError(f"the plan has neither a place nor angles for leg {side}")
        return free_leg(side, swing, pelvis_rotation)
    ankle, foot = plan.feet[side]
    if not plan.exact_reach:
        ankle = within_reach(body, side, place, pelvis_rotation, ankle)
    hip, knee = leg_rotations(body, side, place, pelvis_rotation, ankle, foot)
    if swing is None:
        return hip, knee, foot
    hip_free, knee_free, foot_free = free_leg(side, swing, pelvis_rotation)
    return (
        blended(hip, hip_free, swing.share),
        knee + swing.share * (knee_free - knee),
        blended(foot, foot_free, swing.share),
    )


def _height_of_hips(body: Body, plan: Choreography, place: Array, pelvis_rotation: Array) -> Array:
    """(T,) height of the hips that puts the lowest sole of freely swinging legs at the planned height."""
    lowest = []
    for side in SIDES:
        hip, knee, foot = free_leg(side, plan.free[side], pelvis_rotation)
        ankle = _ankle(body, side, pelvis_rotation, hip, knee)
        lowest.append(ankle[:, 2] - foot_clearance(foot))
    height = plan.grounded - np.min(lowest, axis=0)
    return np.asarray(gaussian_filter1d(height, SOFT_LANDING_FRAMES * STEPS_PER_FRAME, mode="nearest"))


def _ankle(body: Body, side: str, pelvis_rotation: Array, hip: Array, knee: Array) -> Array:
    """(T, 3) position of an ankle relative to the hips' midpoint [m]."""
    lengths = body.actor.segments_m
    x, _, z = np.eye(3)
    shin = np.stack([0.0 * knee, np.sin(knee), -np.cos(knee)], axis=-1) * lengths[f"shin.{side}"]
    leg = (hip @ (shin - lengths[f"thigh.{side}"] * z)[..., None])[..., 0]
    out = 0.5 * lengths["hip_width"] * (x if side == "L" else -x)
    return np.asarray((pelvis_rotation @ (leg + out)[..., None])[..., 0])


def principal_points(performance: Performance, indices: IndexArray) -> Array:
    """The true principal points (N, 13, 3) [m] at stored times."""
    body, pose = performance.body, performance.body.pose(performance.postures[indices])
    return body.points(pose) if performance.build is None else performance.build.points(body, pose)
