"""A reference motion: a 3D motion of the same performance from elsewhere, as its file has it.

Axes, scale, place and time are its own (`estimate/reference_alignment` finds them); here everything has Z up.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..arrays import Array
from ..detect.keypoints import Keypoints, People
from ..errors import InputError, shown
from ..files.fields import listed
from ..files.json_file import ENDING
from ..files.paths import regular_file_size
from .motion import read_motion
from .named_points import MHR_UP, PointTable, principal_points
from .point_files import POINT_ENDINGS, UPRIGHT, read_points

ReadArmature = Callable[[Path, str | None], "ReferenceMotion"]
"""From a file with an animated armature, and which of several, to its motion; only Blender can."""
REFERENCE_ENDINGS = (*POINT_ENDINGS, ENDING)
ARMATURE_ENDINGS = (".bvh", ".fbx", ".glb", ".gltf", ".vrm", ".usd", ".usda", ".usdc", ".usdz", ".blend")
"""Of files with an animated armature, which Blender reads."""
FEWEST_FRAMES = 2


@dataclass(frozen=True, eq=False)
class ReferenceMotion:
    """The principal points of a motion of R frames."""

    points_m: Array  # (R, 13, 3) in the skeleton's order, about in meters, Z up; NaN where absent
    fps: float | None = None  # frames a second; None where the file does not say, for the clip's own
    file: str = ""  # for sentences
    notes: tuple[str, ...] = ()  # which of several subjects it is
    source: str = ""  # what saw it, where no file has it

    @property
    def name(self) -> str:
        """What it is called in sentences."""
        return Path(self.file).name or self.source or "the reference motion"


def reference_of_take(
    path: Path | None, subject: str | None, read_armature: ReadArmature | None
) -> ReferenceMotion | None:
    """The reference motion that a take names; None without one, and of an armature that nobody can read."""
    if path is None or path.suffix.lower() not in ARMATURE_ENDINGS:
        return None if path is None else read_reference(path, subject)
    regular_file_size(path, "a reference motion")
    return None if read_armature is None else read_armature(path, subject)


def seen_reference(
    keypoints: Keypoints, people: Sequence[People]
) -> tuple[ReferenceMotion | None, Keypoints]:
    """What a network of somebody's own saw of the performer in space, and the keypoints without that.

    None where no source's points in space are a motion.
    """
    found = None
    for second in (one.second for one in people if one.second is not None and one.second.motion):
        own = np.array([source == second.detector for source in keypoints.sources])
        names = tuple(name for name, is_own in zip(keypoints.names, own, strict=True) if is_own)
        table = PointTable(names, keypoints.hint_m[:, own], up=MHR_UP)
        if found is None and np.isfinite(table.values).all(axis=(1, 2)).sum() >= FEWEST_FRAMES:
            points = principal_points(table, Path(second.detector))
            found = ReferenceMotion(points @ np.array(UPRIGHT[MHR_UP]).T, source=second.detector)
        keypoints = replace(keypoints, hint_m=np.where(own[:, None], np.nan, keypoints.hint_m))
    return found, keypoints


def read_reference(path: Path, subject: str | None = None) -> ReferenceMotion:
    """Read a reference motion: points by name, as MHR-70's csv and FreeMoCap have them, or a motion.json.

    Raises:
        InputError: The file is none of these or damaged, has no such subject, or fewer than two of its
            frames have a performer.
    """
    ending = path.suffix.lower()
    if ending not in REFERENCE_ENDINGS:
        raise InputError(
            f"{path}: is no reference motion; it must end in {listed(REFERENCE_ENDINGS)}: points by name, "
            f"or a motion.json; or be an armature's, in {listed(ARMATURE_ENDINGS)}"
        )
    if ending == ENDING:
        if subject is not None:
            raise InputError(f"{path}: has no subject {shown(subject)}; a motion.json is of one performer")
        motion = read_motion(path)
        reference = ReferenceMotion(motion.points, motion.fps, str(path))
    else:
        points, rate, notes = read_points(path, subject)
        reference = ReferenceMotion(points, rate, str(path), notes)
    known = np.isfinite(reference.points_m).all(axis=(1, 2))
    if known.sum() < FEWEST_FRAMES:
        raise InputError(
            f"{path}: a performer is in {int(known.sum())} of its frames; at least {FEWEST_FRAMES} are needed"
        )
    return reference
