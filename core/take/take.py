"""A take: one recorded performance, validated, and the kinds of evidence that it has."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..body.kinematics import Body
from ..camera.camera import Camera
from ..detect.keypoints import People
from ..errors import InputError
from ..files.fields import listed
from ..markers.ignored_regions import IgnoredRegion
from ..markers.region_tracks import MarkerStyle
from ..prior.keyframes import Keyframe
from .conversion_settings import METHODS
from .description import TAKE_FILE
from .evidence import CONTOURS, DEPTH_HINTS, EVIDENCE, KEYPOINTS, MARKERS
from .reference import ReferenceMotion

POORLY_FITTED_M = 0.06
"""Hand-posed points fit an actor of the right size within two or three centimeters."""


@dataclass(frozen=True, eq=False)
class Take:
    """One recorded performance, validated."""

    folder: Path
    clip: Path
    """The footage: a video, a folder of images, or a pattern of numbered images."""
    fps: float
    frame_start: int
    """Scene frame of the clip's first decoded frame."""
    frame_count: int | None
    """Number of frames of the clip; None where it is not given."""
    camera: Camera
    body: Body
    markers: tuple[MarkerStyle, ...]
    """The colored garments that are followed; none where the performer wears any clothes."""
    keyframes: tuple[Keyframe, ...]
    described_in: Path | None = None
    """The nearest file that describes it; None for the `take.json` of its folder."""
    title: str = ""
    """Its name; empty for the folder's name."""
    keypoints: tuple[People, ...] = ()
    """People seen by each source of keypoints: detectors, Blender's tracks, clicks."""
    contours: bool = True
    """Whether the contours of the body are followed, where the camera stands still."""
    ignored_regions: tuple[IgnoredRegion, ...] = ()
    reference: ReferenceMotion | None = None
    """A motion of the same performance from elsewhere."""

    @property
    def file(self) -> Path:
        """The nearest file that describes it, for sentences."""
        return self.described_in or self.folder / TAKE_FILE

    @property
    def name(self) -> str:
        """Its title, or the name of its folder."""
        return self.title or self.folder.absolute().name

    @property
    def marker_segments(self) -> tuple[str, ...]:
        """The segment each marker is bound to."""
        return tuple(style.segment for style in self.markers)

    @property
    def keyframe_indices(self) -> tuple[int, ...]:
        """Frame indices of the keyframes."""
        return tuple(keyframe.index for keyframe in self.keyframes)

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on keyframes that are usable but look wrong."""
        return tuple(
            (
                f"keyframe {keyframe.index + self.frame_start}: its points are "
                f"{100 * keyframe.residual_m:.0f} cm on average from any posture of this actor; check "
                "them and the actor's lengths"
            )
            for keyframe in self.keyframes
            if keyframe.residual_m > POORLY_FITTED_M
        )


REMEDIES = {
    MARKERS: "markers must say which are worn",
    KEYPOINTS: "a file of them must be given, as keymark detect writes it",
    DEPTH_HINTS: "none of its files of keypoints guesses depths",
    CONTOURS: "they need a camera that stands still",
}
"""What a kind of evidence takes, for a take that lacks it."""


def evidence_of(take: Take) -> tuple[str, ...]:
    """The kinds of evidence that a take has."""
    hints = any(np.isfinite(frame.hint_m).any() for people in take.keypoints for frame in people.frames)
    has = {
        MARKERS: bool(take.markers),
        KEYPOINTS: bool(take.keypoints),
        DEPTH_HINTS: hints,
        CONTOURS: take.contours and not take.camera.is_moving,
    }
    return tuple(kind for kind in EVIDENCE if has[kind])


def with_evidence(take: Take, kinds: tuple[str, ...]) -> Take:
    """The take with only these kinds of evidence; hints of depth come with keypoints alone."""
    keypoints = take.keypoints if KEYPOINTS in kinds else ()
    if DEPTH_HINTS not in kinds:
        keypoints = tuple(people.without_hints() for people in keypoints)
    return replace(
        take,
        markers=take.markers if MARKERS in kinds else (),
        keypoints=keypoints,
        contours=take.contours and CONTOURS in kinds,
    )


def check_evidence(take: Take, kinds: tuple[str, ...] | None, source: str) -> None:
    """Check that a take has the evidence that is asked for, and any at all."""
    has = evidence_of(take)
    lacking = [] if kinds is None else [kind for kind in kinds if kind not in has]
    if lacking:
        raise InputError(
            f"{source}: evidence names {lacking[0]}, which this take has not got ({REMEDIES[lacking[0]]}); "
            f"it has {listed(has) or 'nothing to follow'}"
        )
    if not has:
        raise InputError(
            f"{take.file}: has nothing to follow, neither markers nor keypoints, and contours need a camera "
            "that stands still; it must have one of them"
        )


def check_method(take: Take, method: str) -> None:
    """Check that a take can be reconstructed by a method, once it has keyframes.

    Raises:
        InputError: The method is unknown, or needs markers that the take has not got.
    """
    if method not in METHODS:
        raise InputError(f"method is '{method}'; valid are {', '.join(METHODS)}")
    if method == "ekf" and not take.markers:
        raise InputError(
            f"{take.name}: method is ekf, the paper's filter, which follows markers alone, and this take is "
            "held against none; map is valid, which uses keypoints and contours too"
        )
