"""Notes on a take and its result for people, one sentence each."""

from ..arrays import BoolArray
from ..errors import frames_in_words
from ..markers.region_tracks import RegionTracks, is_variable_frame_rate
from ..take.read_footage import VARIABLE_RATE
from ..take.take import Take
from .clip_problem import KeyframeEvidence

MOST_NAMED = 3  # largest number of frames that a note names


def marker_notes(tracks: RegionTracks, there: BoolArray) -> tuple[str, ...]:
    """Notes on markers: found too seldom, variable frame rate, and those of the tracks.

    `there` (F,): frames in which the performer is there.
    """
    notes = list(tracks.notes)
    for marker, name in enumerate(tracks.names):
        seen = int(tracks.visible[:, marker].sum())
        if seen < 0.5 * there.sum():
            notes.append(
                f"marker {name} was found in {seen} of {there.sum()} frames only; check its "
                "color, or pose keyframes where it is hidden"
            )
    if is_variable_frame_rate(tracks.time_s):
        notes.append(VARIABLE_RATE)
    return tuple(notes)


def evidence_notes(take: Take, evidence: KeyframeEvidence) -> tuple[str, ...]:
    """Notes where the footage at the keyframes contradicts the take: lens, timing, posing, markers."""
    notes = []
    lens, stated = evidence.model.camera.lens_mm, take.camera.lens_mm
    if abs(lens / stated - 1.0) > 0.03:
        notes.append(
            f"the lens is {lens:.1f} mm by keyframes and footage, and the estimate used that "
            f"instead of {stated:.1f} mm as stated; check the camera"
        )
    if evidence.posing_scale > 2.0:
        known = {"the markers' segments": take.markers, "whom the keypoints show": take.keypoints}
        checked = [what for what, seen in known.items() if seen] or ["the poses"]
        *lengths, last = "the actor's lengths", *checked
        notes.append(
            "the keyframes differ from the footage by much more than the usual posing error; check "
            f"{', '.join(['the frames they are set at, the camera', *lengths])} and {last}"
        )
    for marker, distrust in zip(take.markers, evidence.distrust, strict=True):
        if distrust > 3.0:
            notes.append(
                f"marker {marker.name} is seldom where the keyframes put it and counts for little; "
                "check whether another thing has its color"
            )
    return tuple(notes)


def contour_notes(take: Take, followed: bool) -> tuple[str, ...]:
    """Note where contours are all that a take has, and no still background was seen to tell them from."""
    if followed or not take.contours or take.markers or take.keypoints:
        return ()
    return (
        "contours were not followed: too little of the background stands still; between keyframes "
        "the motion is their interpolation alone; hold the camera still, or add keypoints or "
        "markers",
    )


def found_notes(take: Take) -> tuple[str, ...]:
    """Notes on a result from found keyframes: what it rests on, and which frames to pose."""
    found = [(keyframe, keyframe.matched) for keyframe in take.keyframes if keyframe.matched is not None]
    if not found:
        return ()
    referred = {match.is_referred for _, match in found}
    origins = {True: "postures of a motion from elsewhere", False: "postures composed of all libraries"}
    origin = " and ".join(words for kind, words in origins.items() if kind in referred)
    posed = len(take.keyframes) - len(found)
    if posed == 0 and referred == {True}:
        notes = [f"no keyframe was posed: the motion rests on {len(found)} {origin}"]
    elif posed == 0:
        notes = [
            (
                f"no keyframe was posed: the motion rests on {len(found)} {origin}, other performers'; "
                "what the footage does not show, depth above all, is like theirs"
            )
        ]
    else:
        notes = [f"{posed} of {len(take.keyframes)} keyframes are posed; the others are {origin}"]
    doubtful = [(keyframe, match) for keyframe, match in found if match.is_doubtful]
    if doubtful:
        worst = sorted(doubtful, key=lambda one: one[1].confidence)[:MOST_NAMED]
        frames = sorted(keyframe.index + take.frame_start for keyframe, _ in worst)
        named, single = frames_in_words(frames, MOST_NAMED), len(doubtful) == 1
        notes.append(
            f"{len(doubtful)} of {len(found)} found keyframes {'is' if single else 'are'} doubtful; pose "
            f"{named} to set {'it' if single else 'them'} right"
        )
    return tuple(notes)


def filter_notes(take: Take) -> tuple[str, ...]:
    """Notes on what the paper's filter does not know of: keypoints, and other people's keyframes."""
    notes = []
    if take.keypoints:
        notes.append(
            "method ekf (Fuzzy Kalman Filter) follows markers alone and leaves keypoints aside; "
            "method map (Whole Clip) follows both"
        )
    if any(keyframe.matched is not None for keyframe in take.keyframes):
        notes.append(
            "method ekf (Fuzzy Kalman Filter) takes found keyframes for posed ones; method map (Whole "
            "Clip) allows for the larger errors of found keyframes"
        )
    return tuple(notes)
