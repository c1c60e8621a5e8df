"""A motion from elsewhere mended without footage: jitter, exchanged sides, sliding feet, floor, poses.

Thirteen points go in and a motion of the skeleton comes out. Posed frames are exact, and the error beside
them is what it is there and wanders from it (`core/numerics/wandering`).
"""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array, BoolArray, IndexArray, chunks
from ..body.actor import LONGEST_M, REQUIRED, SHORTEST_M, Actor
from ..body.human import ANKLES, HIPS, HUMAN, LIMB_SEGMENTS
from ..body.kinematics import Body
from ..body.mirror import OPPOSITE
from ..body.posture import Posture
from ..body.posture_fit import fit_posture, guess_posture, nearest_rotation
from ..body.skeleton import SIDES
from ..errors import InputError, pluralize
from ..feet.contacts import Contact
from ..feet.place_by_feet import place_by_feet
from ..feet.planted_feet import plant_feet
from ..feet.soles import Soles
from ..numerics.markov_chain import exchanged_path
from ..numerics.vectors import gaussian, unit, weighted_median
from ..numerics.wandering import Sizes, learn_sizes, smooth_path
from ..progress import Job, Progress, within
from ..take.motion import Motion

METHOD = "mend"
MOST_FRAMES = 36_000  # twenty minutes at 30 frames a second
LEAST_SEEN = 0.5  # share of the frames that must show the whole body
PLACE_M = 0.1  # usual error of the place that a network gives, after its jitter


@dataclass(frozen=True, eq=False)
class MendOptions:
    """What is known of a motion beside its points."""

    posed: tuple[int, ...] = ()  # frames, from 0, that a person posed and vouches for
    plant_feet: bool = True  # whether resting feet stand still, and the hips go where the feet say
    floor: bool = True  # whether the floor becomes z = 0
    place_m: float = PLACE_M  # usual error of the hips' place
    ankle_m: float | None = None  # height of a standing ankle above its sole; None for the usual one


@dataclass(frozen=True, eq=False)
class Mended:
    """A mended motion of F frames."""

    motion: Motion
    contacts: tuple[Contact, ...]  # where which ankle rests; points are counted left, right
    exchanged: BoolArray  # (F,) whether the sides had changed places
    sizes: Sizes  # what the given points consist of
    notes: tuple[str, ...]  # what a person should know, in sentences without a full stop


def named_frames(text: str, where: str) -> tuple[int, ...]:
    """Frames in a text with commas between them; `where` is its name for messages."""
    try:
        return tuple(sorted({int(word) for word in text.split(",") if word.strip()}))
    except ValueError as error:
        raise InputError(f"{where} is {text}; frames with commas between them are valid") from error


def mend_motion(points: Array, rate: float, options: MendOptions, frame_start: int = 1) -> Job[Mended]:
    """Mend points (F, 13, 3) [m], Z up, NaN where one is missing, at a rate [1/s].

    Raises:
        InputError: Frames are too few, too many, or too seldom show a whole body; no size of a person.
    """
    yield Progress("Looking through the motion", 0.0)
    given, notes = _checked(points, options, frame_start)
    posed = np.array(options.posed, dtype=np.intp)
    exchanged = exchanged_frames(given)
    exchanged[posed] = False
    if exchanged.any():
        notes.append(f"Left and right were exchanged in {pluralize(int(exchanged.sum()), 'frame')}")
        given[exchanged] = given[exchanged][:, OPPOSITE]
    yield Progress("Smoothing", 0.1)
    hips = given[:, HIPS].mean(axis=1)
    relative = given - hips[:, None]
    loose = relative.copy()
    loose[posed] = np.nan  # a posed frame leaps out of those beside it
    sizes = learn_sizes(loose, rate)
    relative = np.stack(
        [smooth_path(loose[:, p], sizes, posed, relative[posed, p]) for p in range(len(HUMAN.point_names))],
        axis=1,
    )
    yield Progress("Finding the way", 0.2)
    # Hips that move less than this were left at the origin by whoever wrote the file [m].
    has_place = bool(np.nanmax(np.ptp(hips[np.isfinite(hips).all(axis=1)], axis=0)) > 0.02)
    hips = _smooth_hips(hips, rate, posed)
    if not has_place:
        notes.append("The file has the hips in one place; the way over the ground was found by the feet")
    if options.plant_feet:
        place_m = options.place_m if has_place else np.inf
        hips = place_by_feet(hips, relative[:, ANKLES], rate, place_m, posed if has_place else None)
    wanted = relative + hips[:, None]
    body = Body(measured_actor(given))
    posture = yield from _fitted(body, wanted, rate)
    time_s = np.arange(len(wanted)) / rate
    contacts: tuple[Contact, ...] = ()
    if options.plant_feet:
        planting = plant_feet(body, posture, time_s)
        planted = yield from within("Planting feet", planting, 0.8, 1.0)
        posture, contacts = planted.posture, planted.contacts
    if options.floor:
        posture, contacts = _on_floor(body, posture, contacts, options.ankle_m)
    mended = body.points(body.pose(posture))
    motion = Motion(
        body=body,
        fps=rate,
        frame_start=frame_start,
        time_s=time_s,
        posture=posture,
        points=mended,
        point_covariance=np.full((*mended.shape, 3), np.nan),
        keyframe_indices=tuple(options.posed),
        method=METHOD,
    )
    return Mended(motion, contacts, exchanged, sizes, tuple(notes))


def _checked(points: Array, options: MendOptions, frame_start: int) -> tuple[Array, list[str]]:
    """The points, NaN in frames that are missing or repeat the one before, and notes; or InputError."""
    frames = len(points)
    if not 3 <= frames <= MOST_FRAMES:
        raise InputError(
            f"the motion has {pluralize(frames, 'frame')}; one of 3 to {MOST_FRAMES} can be mended"
        )
    wrong = [frame for frame in options.posed if not 0 <= frame < frames]
    if wrong:
        raise InputError(
            f"posed frame {wrong[0] + frame_start} is not in the motion, whose frames are {frame_start} to "
            f"{frame_start + frames - 1}"
        )
    given = np.where(np.isfinite(points).all(axis=(1, 2), keepdims=True), points, np.nan)
    repeats = np.zeros(frames, dtype=bool)
    repeats[1:] = np.abs(np.diff(given, axis=0)).max(axis=(1, 2)) < 1e-7
    if repeats.mean() < LEAST_SEEN:  # else a body that is held still
        repeats[list(options.posed)] = False
        given[repeats] = np.nan
    missing = int((~np.isfinite(given).all(axis=(1, 2))).sum())
    if frames - missing < max(3.0, LEAST_SEEN * frames):
        raise InputError(
            f"the motion shows the whole body in {frames - missing} of {frames} frames; it must in half of "
            "them, with a number for every coordinate"
        )
    if any(not np.isfinite(given[frame]).all() for frame in options.posed):
        raise InputError("a posed frame lacks points; a pose must have all of them")
    free = frames - missing - len(set(options.posed))
    if free < 3:
        raise InputError(f"{free} of {frames} frames show a body and are not posed; at least 3 must be so")
    notes = [f"{pluralize(missing, 'frame')} without a body, or a copy of the one before, were filled in"]
    return given, notes if missing else []


def measured_actor(points: Array) -> Actor:
    """The actor of median lengths of points (F, 13, 3) [m].

    Raises:
        InputError: A length is that of no person.
    """
    at = {name: points[:, index] for index, name in enumerate(HUMAN.point_names)}
    at |= {part: 0.5 * (at[f"{part}.L"] + at[f"{part}.R"]) for part in ("hip", "shoulder")}
    ends = {
        f"{segment}.{side}": (f"{upper}.{side}", f"{lower}.{side}")
        for segment, upper, lower in LIMB_SEGMENTS
        for side in SIDES
    } | {
        "shoulder_width": ("shoulder.L", "shoulder.R"),
        "hip_width": ("hip.L", "hip.R"),
        "trunk": ("hip", "shoulder"),
        "neck_head": ("shoulder", "head"),
    }
    lengths = {
        name: float(np.nanmedian(np.linalg.norm(at[one] - at[other], axis=-1)))
        for name, (one, other) in ends.items()
    }
    for name in REQUIRED:
        if not SHORTEST_M <= lengths[name] <= LONGEST_M:
            raise InputError(
                f"{name} of the motion is {lengths[name]:.3g} m long; a person's is {SHORTEST_M} to "
                f"{LONGEST_M} m, so look at the file's unit and scale"
            )
    return Actor(lengths)


def _smooth_hips(hips: Array, rate: float, posed: IndexArray) -> Array:
    """The hips' way (F, 3) without its jitter, which is several times as large along the line of sight."""
    loose = hips.copy()
    loose[posed] = np.nan
    known = np.isfinite(loose).all(axis=1)
    middle = loose[known].mean(axis=0)
    bends = np.diff(loose, n=2, axis=0)
    bends = bends[np.isfinite(bends).all(axis=1)]
    axes = np.linalg.eigh(bends.T @ bends)[1] if len(bends) else np.eye(3)
    columns = []
    for axis in axes.T:
        along = np.repeat(((loose - middle) @ axis)[:, None], 3, axis=1)
        exact = np.repeat(((hips[posed] - middle) @ axis)[:, None], 3, axis=1)
        columns.append(smooth_path(along, learn_sizes(along[:, None], rate), posed, exact)[:, 0])
    return np.asarray(middle + np.stack(columns, axis=1) @ axes.T)


def _fitted(body: Body, points: Array, rate: float) -> Job[Posture]:
    """Postures of points; turns that the points hardly show, as a straight arm's, change slowly."""
    guess = guess_posture(body, points)
    turns, angles = (gaussian(values, 0.1 * rate) for values in (guess.rotations, guess.angles))
    start = Posture(body.skeleton, guess.translation, nearest_rotation(turns), angles)
    fitted: list[Posture] = []
    parts = chunks(np.arange(len(points)), 500)
    for number, part in enumerate(parts):
        # After so many iterations no point moves by a millimeter.
        fitted.append(fit_posture(body, points[part], start[part], 15).posture)
        yield Progress("Fitting the body", 0.2 + 0.6 * (number + 1) / len(parts))
    return Posture.concatenate(fitted)


def _on_floor(
    body: Body, posture: Posture, contacts: tuple[Contact, ...], ankle_m: float | None
) -> tuple[Posture, tuple[Contact, ...]]:
    """The postures and contacts with the height on which the feet mostly stand at z = 0."""
    if contacts:
        heights = np.array([contact.place[2] for contact in contacts])
        frames = np.array([contact.last - contact.first + 1.0 for contact in contacts])
        height = weighted_median(heights, frames)
    else:
        height = float(np.percentile(body.points(body.pose(posture))[:, ANKLES, 2].min(axis=1), 5.0))
    own = float(Soles.of(body).flat_m.mean()) if ankle_m is None else ankle_m
    shift = np.array([0.0, 0.0, own - height])
    moved = Posture(posture.skeleton, posture.translation + shift, posture.rotations, posture.angles)
    return moved, tuple(replace(one, place=one.place + shift) for one in contacts)


# --- Frames in which left and right have changed places, as a network sees them behind a body


def exchanged_frames(points: Array) -> BoolArray:
    """(F,) where the points (F, 13, 3) have their sides exchanged; frames with NaN are as their neighbors.

    A body that turns moves on from frame to frame, exchanged sides jump to each other's places; which of the
    two ways is right, knees and the longer time tell.
    """
    known = np.flatnonzero(np.isfinite(points).all(axis=(1, 2)))
    exchanged = np.zeros(len(points), dtype=bool)
    if len(known) < 2:
        return exchanged
    seen = points[known]
    own = 2.0 * _wrong_way(seen)  # cost of knees that bend the wrong way, once in each frame
    middled = seen - seen.mean(axis=1, keepdims=True)
    # How far the points move about their middle, with heavy tails beyond what they usually move in a frame
    # with the network's own error, 0.05 m.
    stay, change = (
        np.log1p(((middled[1:] - before[:-1]) ** 2).sum(axis=-1) / 0.05**2).sum(axis=1)
        for before in (middled, middled[:, OPPOSITE])
    )
    # A change between two frames costs about as much as one limb that jumps by its usual error.
    states = exchanged_path(np.stack([own, -own], axis=-1), stay, change + 8.0)
    if not states.any() or states.all():  # a body that is wrong from end to end is left as it is
        return exchanged
    halfway = 0.5 * (known[1:] + known[:-1])
    return np.asarray(states[np.searchsorted(halfway, np.arange(len(points)))])


def _wrong_way(points: Array) -> Array:
    """(F,) from -1 to 1 how clearly the knees bend backward, seen from the hips; 0 for straight legs."""
    at = {name: points[:, index] for index, name in enumerate(HUMAN.point_names)}
    across = unit(at["hip.L"] - at["hip.R"])
    trunk = unit(at["shoulder.L"] + at["shoulder.R"] - at["hip.L"] - at["hip.R"])
    ahead = unit(np.cross(across, trunk))
    total = np.zeros(len(points))
    for side in ("L", "R"):
        leg = unit(at[f"ankle.{side}"] - at[f"hip.{side}"])
        out = at[f"knee.{side}"] - at[f"hip.{side}"]
        out = out - (out * leg).sum(axis=-1, keepdims=True) * leg
        total -= (out * ahead).sum(axis=-1)
    # Distance of a knee from the line of its leg that is clear: a bend of about 40 degrees.
    return np.asarray(np.clip(total / 0.15, -1.0, 1.0))
