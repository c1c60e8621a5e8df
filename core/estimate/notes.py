"""Notes on a take and its result for people, one sentence each, and which of them exclude each other."""

import re
from collections.abc import Iterable

from ..arrays import BoolArray
from ..errors import MOST_NAMED, frames_in_words
from ..markers.region_tracks import RegionTracks, is_variable_frame_rate
from ..take.read_footage import VARIABLE_RATE
from ..take.take import Take
from .clip_problem import KeyframeEvidence

LEFT_OUT = r"the keypoints of (?P<of>.+?) are .* left out"
UNFOLLOWED = r"does not follow its control (?P<of>.+) rigidly"
CAUSES = {
    r"the clip is cut at": (
        r"the whole picture changes at",
        r": jumps to somebody else",
        r" s are missing after frame",
    ),
    r"the clip is cut at [^;]*$": (r"the camera moves, by", r"its picture moves by up to"),
    r"the camera moves, by": (
        r"the lens is .* by keyframes and footage",
        r"the keyframes differ from the footage",
        r"is seldom where the keyframes put it",
        r"contours were not followed",
        r"lie far from where everything else has",
    ),
    r"where the picture is (on its side|upside down)": (
        r"the lens is .* by keyframes and footage",
        r"the keyframes differ from the footage",
        r"is seldom where the keyframes put it",
        r"hardly ever seen, as beyond the picture's edge",
        r"no plausible pose explains",
    ),
    r"pictures? repeats? the one before": (r"results? repeats? the one before",),
    r" s are missing after frame": (r"the clip has a variable frame rate",),
    r"markers (?P<of>.+) have almost the same color": (
        r"marker (?P<of>.+) is seldom where the keyframes put it",
        r"marker (?P<of>.+) was found in .* frames only",
    ),
    r"its points lie where the person": (r": was found in pictures of",),
    r"(?P<of>.+): is of a mirrored copy of the clip": (r"(?P<of>.+) takes left for right throughout",),
    r"(?P<of>.+): nobody in it is where most of the posed keyframes": (LEFT_OUT,),
    LEFT_OUT: (
        r"(?P<of>.+): its points (lie|are) where the person",
        r"(?P<of>.+): is of a mirrored copy of the clip",
        r"(?P<of>.+): up to .* people in",
        r"(?P<of>.+): .* somebody else than the performer",
    ),
    r"method ekf .* leaves keypoints aside": (r": up to .* people in", r": jumps to somebody else"),
    r"Drivers win over the keys of bone (?P<of>.+);": (UNFOLLOWED,),
    r"Bone (?P<of>.+) hangs on something that moves by itself": (UNFOLLOWED,),
    r"the hands.* hardly ever seen, as beyond": (
        r"hand is surely seen in 0 % of the frames, the right in 0 %",
    ),
}
"""What notes say, and what they then exclude: it follows from the same, or was taken for it. Notes on
something else (`of`: a marker, a source of keypoints) stay."""


def of_true_causes(notes: Iterable[str]) -> tuple[str, ...]:
    """The notes without those that others exclude, each once."""
    every, excluded = tuple(dict.fromkeys(notes)), set()
    for cause, effects in CAUSES.items():
        for said in filter(None, (re.search(cause, note) for note in every)):
            about = said.groupdict().get("of", "")
            for found in filter(None, (re.search(effect, note) for effect in effects for note in every)):
                own = found.groupdict().get("of", "")
                if own in about or about in own:
                    excluded.add(found.string)
    return tuple(note for note in every if note not in excluded)


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
    postures = "posture" if len(found) == 1 else "postures"
    origins = {True: f"{postures} of a motion from elsewhere", False: f"{postures} composed of all libraries"}
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
        are, others = "is" if posed == 1 else "are", "other is a" if len(found) == 1 else "others are"
        notes = [f"{posed} of {len(take.keyframes)} keyframes {are} posed; the {others} {origin}"]
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
