"""Keyframes at any frames of a take with truth: exact, or with the errors of hand posing."""

import sys
import zlib
from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from takes import ROOT, load_project
from trials import Trial

load_project()
sys.path.append(str(ROOT / "tools"))  # its posing module models people's errors

from keymark.core.arrays import IndexArray  # noqa: E402
from keymark.core.body.posture import Posture  # noqa: E402
from keymark.core.body.posture_fit import fit_posture  # noqa: E402
from keymark.core.prior.keyframe_proposals import (  # noqa: E402
    marker_speed,  # noqa: E402
    propose_keyframes,  # noqa: E402
)
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from studio.posing import ERROR_RMS_M, pose_by_hand  # noqa: E402

SEED = 20


def random_source(trial: Trial) -> np.random.Generator:
    """A random source seeded by the take, the same in every run."""
    return np.random.default_rng([SEED, zlib.crc32(trial.take.folder.name.encode())])


def exact_postures(trial: Trial) -> Posture:
    """A posture for every frame, fitted to the true points as keyframes given by points are."""
    return fit_posture(trial.take.body, trial.truth).posture


def hand_posed(trial: Trial, exact: Posture, rms_m: float = ERROR_RMS_M) -> Posture:
    """Postures with hand-posing errors of about `rms_m`; a frame's error does not depend on others."""
    sight = -trial.take.camera.matrix_world.reshape(-1, 4, 4)[0, :3, 2]
    posed = pose_by_hand(trial.take.body, exact, sight, random_source(trial))
    return exact.plus(rms_m / ERROR_RMS_M * posed.minus(exact))


def spread_frames(trial: Trial, count: int, *, snap: bool = False) -> IndexArray:
    """Frames, including the first and the last, evenly spaced or moved to minima of the markers' speed."""
    speed = marker_speed(trial.tracks) if snap else np.zeros(len(trial.truth))
    return propose_keyframes(speed, count)


def keyed(trial: Trial, postures: Posture, indices: Iterable[int]) -> Trial:
    """The trial with the postures at `frames` as its keyframes."""
    frames = tuple(int(index) for index in indices)
    keyframes = tuple(Keyframe(index, postures[index]) for index in frames)
    return replace(trial, take=replace(trial.take, keyframes=keyframes), unscored=frames)
