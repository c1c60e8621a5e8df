"""From a described take to its motion: keyframes that are posed or found, then the estimate."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..detect.keypoints import People
from ..errors import pluralize
from ..estimate.reconstruct import Reconstruction, check_method, reconstruct
from ..estimate.reference_evidence import ReferenceEvidence, reference_evidence, with_reference
from ..posing.found_poses import FoundPoses, referred_poses, with_found
from ..posing.pose_clip import pose_clip
from ..prior.library import Library
from ..progress import Job, stretch
from ..take.checked_keypoints import with_checked_keypoints
from ..take.conversion_settings import METHODS, ConversionSettings
from ..take.description import Description
from ..take.read_footage import read_footage
from ..take.reference import ReferenceMotion
from ..take.steady_camera import steadied
from ..take.take import Take
from ..take.take_file import read_described
from .place import is_unplaced, place_take

ReadArmature = Callable[[Path], ReferenceMotion]


def take_to_pose(
    description: Description,
    keyframes: Path | None,
    settings: ConversionSettings | None = None,
    read_armature: ReadArmature | None = None,
) -> Take:
    """Read a take with the keyframes that a person posed, or with none where no file is named.

    Keyframes that an earlier run has found are left out, since they are found anew. `settings` say which
    keypoints are read and which evidence is used, by default the take's own.
    """
    fewest = 0 if keyframes is None else 1
    take = read_described(
        description,
        keyframes,
        keyframes_required=False,
        fewest_keyframes=fewest,
        settings=settings,
        read_armature=read_armature,
    )
    return replace(take, keyframes=tuple(k for k in take.keyframes if k.matched is None))


READ, POSED = 0.2, 0.7
"""Fractions of the whole job after reading the footage and after finding its keyframes."""


@dataclass(frozen=True, eq=False)
class FoundReconstruction:
    """A motion, and the keyframes it was reconstructed from."""

    take: Take
    reconstruction: Reconstruction
    found: FoundPoses | None = None
    """What was found; None where that was not asked for."""
    findings: tuple[str, ...] = ()
    """What was assumed and found of a take whose camera nobody has said, a line for each stage."""
    floor_m: float | None = None
    """Height of the floor that was found with it [m]."""
    keypoints: tuple[People, ...] = ()
    """Those of such a take as the clip shows them: the motion's are those that a steady camera would see."""


def take_to_convert(
    description: Description, settings: ConversionSettings, read_armature: ReadArmature | None = None
) -> Take:
    """A described take with its posed keyframes, which may lack where others are found.

    `read_armature` reads a reference motion that only Blender can.
    """
    if settings.library is None:
        return read_described(description, settings.keyframes, settings=settings, read_armature=read_armature)
    return take_to_pose(description, settings.keyframes, settings, read_armature)


PLACED = 0.4
"""Fraction of the whole job after which a camera that nobody has said is found."""


def convert(
    description: Description,
    settings: ConversionSettings,
    libraries: Sequence[Library],
    read_armature: ReadArmature | None = None,
) -> Job[FoundReconstruction]:
    """The whole way from a described take, or from a clip and the performer's height, to a motion.

    `read_armature` reads a reference motion that only Blender can.

    Raises:
        InputError: The take or its clip cannot be used, or there is no library with a posture.
        ConversionError: No motion could be computed.
    """
    method, searched = settings.method or METHODS[0], None if settings.library is None else libraries
    if not is_unplaced(description, settings):
        take = take_to_convert(description, settings, read_armature)
        check_method(take, method)
        return (yield from find_and_reconstruct(take, searched, method, settings.floor_m))
    placed = yield from stretch(place_take(description, settings), 0.0, PLACED)
    check_method(placed.take, method)
    floor_m = placed.floor_m if settings.floor_m is None else settings.floor_m
    job = find_and_reconstruct(placed.take, searched, method, floor_m, onto_floor=floor_m is None)
    made = yield from stretch(job, PLACED, 1.0)
    assert made.found is not None
    doubtful = sum(key.matched is not None and key.matched.is_doubtful for key in made.take.keyframes)
    poses = f"Poses: {pluralize(len(made.take.keyframes), 'keyframe')} found, {doubtful} of them doubtful"
    said, floor_m = (*placed.findings, poses), 0.0 if floor_m is None else floor_m
    return replace(made, findings=said, floor_m=floor_m, keypoints=placed.take.keypoints)


def find_and_reconstruct(
    take: Take,
    libraries: Sequence[Library] | None,
    method: str,
    floor_m: float | None = None,
    onto_floor: bool = False,
) -> Job[FoundReconstruction]:
    """Reconstruct a motion, after finding keyframes where that is asked for; the footage is read once.

    `onto_floor`: the world is moved so that the floor that is found with them is z = 0.

    Raises:
        InputError: The clip cannot be used, or there is no library with a posture.
        ConversionError: No motion could be computed.
    """
    reading = yield from stretch(read_footage(take), 0.0, READ)
    take = yield from stretch(with_checked_keypoints(take, reading), READ, READ)
    take, reading = yield from stretch(steadied(take, reading), READ, READ)
    if libraries is None:
        result = yield from stretch(reconstruct(take, method, reading), READ, 1.0)
        return FoundReconstruction(take, result)
    said = None
    if take.reference is not None and method == "map":
        said = reference_evidence(take, reading.tracks)
    if isinstance(said, ReferenceEvidence) and not said.left_out.any():
        take = with_reference(take, said)
        found = referred_poses(take, said)
    else:
        posing = pose_clip(take, reading, libraries, floor_m, floor_open=onto_floor)
        found = yield from stretch(posing, READ, POSED)
        take = with_found(take, found)
        take = lowered(take, found.floor_m) if onto_floor else take
    ground_m = 0.0 if onto_floor else found.floor_m
    job = reconstruct(take, method, reading, referred=said, floor_m=ground_m)
    result = yield from stretch(job, POSED, 1.0)
    return FoundReconstruction(take, result, found)


def lowered(take: Take, by_m: float) -> Take:
    """The take with its camera and its keyframes so much lower."""
    pose = take.camera.matrix_world.copy()
    pose[..., 2, 3] -= by_m
    keyframes = tuple(
        replace(each, posture=replace(each.posture, translation=each.posture.translation - [0.0, 0.0, by_m]))
        for each in take.keyframes
    )
    return replace(take, camera=replace(take.camera, matrix_world=pose), keyframes=keyframes)


def found_summary(take: Take, found: FoundPoses) -> dict[str, Any]:
    """What was found as an object for `--json`."""
    matches = [
        (keyframe.index + take.frame_start, keyframe.matched)
        for keyframe in take.keyframes
        if keyframe.matched is not None
    ]
    return {
        "library": found.library,
        "fit": _rounded(found.fit),
        "reason": found.reason,
        "floor_m": found.floor_m,
        "matches": [
            {
                "frame": frame,
                "posture": said.posture,
                "mirrored": said.mirrored,
                "confidence": _rounded(said.confidence),
                "doubtful": said.is_doubtful,
            }
            for frame, said in matches
        ],
        "contradictions": [
            {"frame": index + take.frame_start, "evidence": list(names)}
            for index, names in sorted(found.contradictions.items())
        ],
    }


def _rounded(value: float) -> float:
    return round(float(value), 4)
