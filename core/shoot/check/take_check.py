"""The check of one take before it is converted: description, clip, keyframes, evidence, cost."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from ...estimate.reconstruct import check_method
from ...footage.clips.clip import Clip
from ...footage.marker_check import MarkerReadout
from ...posing.posing_input import check_followed
from ...take.character_settings import CharacterSettings
from ...take.clip_check import open_footage
from ...take.conversion_settings import NO_SETTINGS, ConversionSettings
from ...take.description import Description
from ...take.evidence import evidence_of
from ...take.evidence_kinds import CONTOURS
from ...take.methods import METHODS
from ...take.take import Take
from ...take.take_file import read_described
from ...take.take_to_pose import take_to_pose
from ...text import Sentence
from ..shoot import ShootTake
from .cost_estimate import CostEstimate, estimate_cost
from .findings import Findings
from .footage_check import check_footage, count_frames
from .keyframe_check import check_keyframes
from .keypoint_check import KeypointReadout, check_keypoints
from .unfilled_fields import find_unfilled_fields

CONTOURS_ALONE = Sentence(
    "the motion is held against contours alone, which tell least of all evidence; keypoints of a detector, "
    "as of keymark detect, or markers in strong colors tell more"
)


@dataclass(frozen=True, eq=False)
class TakeCheck:
    """The findings on one take."""

    name: str
    """The take's, in its shoot."""
    problems: tuple[str, ...]
    """Reasons why it would not convert."""
    warnings: tuple[str, ...]
    """What is likely to go wrong."""
    size: tuple[int, int] | None = None
    """Width and height of the clip [px]; None where it cannot be opened."""
    fps: float | None = None
    frames: int | None = None
    evidence: tuple[str, ...] = ()
    """Kinds of evidence that it would be held against."""
    markers: tuple[MarkerReadout, ...] = ()
    keypoints: tuple[KeypointReadout, ...] = ()
    keyframes: int = 0
    """Keyframes that a person posed."""
    library: str | None = None
    """Setting by which the others are found; None where all are posed."""
    cost: CostEstimate | None = None
    """Cost of its conversion; None where it would not convert."""

    @property
    def converts(self) -> bool:
        """Whether no problem is known that would stop the conversion."""
        return not self.problems


def check_take(
    found: ShootTake,
    find_libraries: Callable[[str], object],
    defaults: ConversionSettings = NO_SETTINGS,
    check_character: Callable[[CharacterSettings], Sequence[str]] = lambda _settings: (),
) -> TakeCheck:
    """Check one take; nothing is written.

    Args:
        found: The take.
        find_libraries: Raises `InputError` where there is no such library.
        defaults: Settings for what its description leaves out.
        check_character: Raises `InputError` where a character or its map cannot be used, and returns what is
            doubtful about it.
    """
    findings = Findings()
    description = None
    with findings.catching():
        description = found.describe()
    if description is None:
        return TakeCheck(found.name, findings.problems, findings.warnings)
    settings = found.settings(description, defaults)
    if settings.library is not None:
        with findings.catching():
            find_libraries(settings.library)
    if settings.character is not None:
        with findings.catching():
            findings.warn(*check_character(settings.character))
    clip = None
    with findings.catching():
        clip = open_footage(description.clip, None)
    missing = find_unfilled_fields(description.fields)
    findings.problem(*missing)
    frames = None if clip is None else count_frames(clip, findings)
    take = None if missing or clip is None else _read(description, settings, findings)
    markers: tuple[MarkerReadout, ...] = ()
    keypoints: tuple[KeypointReadout, ...] = ()
    if take is not None and clip is not None and frames is not None:
        with findings.catching():
            check_method(take, settings.method or METHODS[0])
        if settings.library is not None:
            with findings.catching():
                check_followed(take)
        check_keyframes(take, frames, settings.library is not None, findings)
        keypoints = check_keypoints(take, frames, findings)
        markers = check_footage(take, clip, frames, findings)
        if evidence_of(take) == (CONTOURS,) and not findings.problems:
            findings.warn(CONTOURS_ALONE)
    check = _checked(found.name, findings, clip, frames, take, settings)
    return replace(check, markers=markers, keypoints=keypoints)


def _read(description: Description, settings: ConversionSettings, findings: Findings) -> Take | None:
    """Read the take as its conversion will; without keyframes and keypoints where one is unusable."""
    with findings.catching():
        if settings.library is None:
            return read_described(description, settings.keyframes, settings=settings)
        return take_to_pose(description, settings.keyframes, settings)
    with findings.catching():
        without = replace(settings, keypoints=())
        return read_described(
            description, keyframes_required=False, fewest_keyframes=0, settings=without, whole=True
        )
    return None


def _checked(
    name: str,
    findings: Findings,
    clip: Clip | None,
    frames: int | None,
    take: Take | None,
    settings: ConversionSettings,
) -> TakeCheck:
    cost, evidence = None, () if take is None else evidence_of(take)
    if clip is not None and frames is not None and not findings.problems:
        cost = estimate_cost(frames, clip.size, settings.method or METHODS[0], settings.library, evidence)
    fps = None if take is None else take.fps
    return TakeCheck(
        name=name,
        problems=findings.problems,
        warnings=findings.warnings,
        size=None if clip is None else clip.size,
        fps=clip.fps if clip is not None and clip.knows_its_rate else fps,
        frames=frames,
        evidence=evidence,
        keyframes=0 if take is None else len(take.keyframes),
        library=settings.library,
        cost=cost,
    )
