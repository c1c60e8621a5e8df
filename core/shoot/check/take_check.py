"""The check of one take before it is converted: description, clip, keyframes, markers, cost."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ...footage.clips.clip import Clip
from ...footage.marker_check import MarkerReadout
from ...matching.match_take import take_to_match
from ...take.character_settings import CharacterSettings
from ...take.clip_check import open_footage
from ...take.conversion_settings import NO_SETTINGS, ConversionSettings
from ...take.description import Description
from ...take.methods import METHODS
from ...take.take import Take
from ...take.take_file import read_described
from ..shoot import ShootTake
from .cost_estimate import CostEstimate, estimate_cost
from .findings import Findings
from .footage_check import check_footage, count_frames
from .keyframe_check import check_keyframes
from .unfilled_fields import find_unfilled_fields


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
    markers: tuple[MarkerReadout, ...] = ()
    keyframes: int = 0
    """Keyframes that a person posed."""
    library: str | None = None
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
    if take is not None and clip is not None and frames is not None:
        check_keyframes(take, frames, settings.library is not None, findings)
        markers = check_footage(take, clip, frames, findings)
    return _checked(found.name, findings, clip, frames, take, markers, settings)


def _read(description: Description, settings: ConversionSettings, findings: Findings) -> Take | None:
    """Read the take as its conversion will; without keyframes where these are unusable."""
    with findings.catching():
        if settings.library is None:
            return read_described(description, settings.keyframes)
        return take_to_match(description, settings.keyframes)
    with findings.catching():
        return read_described(description, keyframes_required=False, fewest_keyframes=0)
    return None


def _checked(
    name: str,
    findings: Findings,
    clip: Clip | None,
    frames: int | None,
    take: Take | None,
    markers: tuple[MarkerReadout, ...],
    settings: ConversionSettings,
) -> TakeCheck:
    cost = None
    if clip is not None and frames is not None and not findings.problems:
        cost = estimate_cost(frames, clip.size, settings.method or METHODS[0], settings.library)
    fps = None if take is None else take.fps
    return TakeCheck(
        name=name,
        problems=findings.problems,
        warnings=findings.warnings,
        size=None if clip is None else clip.size,
        fps=clip.fps if clip is not None and clip.knows_its_rate else fps,
        frames=frames,
        markers=markers,
        keyframes=0 if take is None else len(take.keyframes),
        library=settings.library,
        cost=cost,
    )
