"""One take, looked through before it is converted."""

from collections.abc import Callable
from dataclasses import dataclass

from ...footage.clips.clip import Clip
from ...footage.marker_check import MarkerReadout
from ...matching.match_take import take_to_match
from ...take.clip_check import open_footage
from ...take.conversion_settings import NOTHING_CHOSEN, ConversionSettings
from ...take.description import Description
from ...take.methods import METHODS
from ...take.take import Take
from ...take.take_file import read_described
from ..shoot import ShootTake
from .cost_estimate import Effort, effort
from .findings import Findings
from .footage_check import check_footage, count_frames
from .keyframe_check import check_keyframes
from .unfilled_fields import unfilled


@dataclass(frozen=True, eq=False)
class TakeCheck:
    """What a look at a take tells."""

    name: str
    """The take's, in its shoot."""
    problems: tuple[str, ...]
    """Why it would not convert."""
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
    effort: Effort | None = None
    """What converting it asks for; None where it would not convert."""

    @property
    def converts(self) -> bool:
        """Whether nothing is known that would stop the conversion."""
        return not self.problems


def check_take(
    found: ShootTake,
    find_libraries: Callable[[str], object],
    farther: ConversionSettings = NOTHING_CHOSEN,
) -> TakeCheck:
    """Look through one take; nothing is written.

    Args:
        found: The take.
        find_libraries: Raises `InputError` where there is no such library.
        farther: How it is converted where nothing nearer says so.
    """
    said = Findings()
    description = None
    with said.noting():
        description = found.describe()
    if description is None:
        return TakeCheck(found.name, said.problems, said.warnings)
    settings = found.settings(description, farther)
    if settings.library is not None:
        with said.noting():
            find_libraries(settings.library)
    clip = None
    with said.noting():
        clip = open_footage(description.clip, None)
    missing = unfilled(description.fields)
    said.problem(*missing)
    frames = None if clip is None else count_frames(clip, said)
    take = None if missing or clip is None else _read(description, settings, said)
    markers: tuple[MarkerReadout, ...] = ()
    if take is not None and clip is not None and frames is not None:
        check_keyframes(take, frames, settings.library is not None, said)
        markers = check_footage(take, clip, frames, said)
    return _checked(found.name, said, clip, frames, take, markers, settings)


def _read(description: Description, settings: ConversionSettings, said: Findings) -> Take | None:
    """Read the take as its conversion will; where its keyframes cannot be used, without them."""
    with said.noting():
        if settings.library is None:
            return read_described(description, settings.keyframes)
        return take_to_match(description, settings.keyframes)
    with said.noting():
        return read_described(description, keyframes_required=False, fewest_keyframes=0)
    return None


def _checked(
    name: str,
    said: Findings,
    clip: Clip | None,
    frames: int | None,
    take: Take | None,
    markers: tuple[MarkerReadout, ...],
    settings: ConversionSettings,
) -> TakeCheck:
    asked = None
    if clip is not None and frames is not None and not said.problems:
        asked = effort(frames, clip.size, settings.method or METHODS[0], settings.library)
    fps = None if take is None else take.fps
    return TakeCheck(
        name=name,
        problems=said.problems,
        warnings=said.warnings,
        size=None if clip is None else clip.size,
        fps=clip.fps if clip is not None and clip.knows_its_rate else fps,
        frames=frames,
        markers=markers,
        keyframes=0 if take is None else len(take.keyframes),
        library=settings.library,
        effort=asked,
    )
