"""A frame's likeliest figure: legs that fork from a trunk, arms higher up, spine and neck between.

Names and a few measures of each bone are added up, each measure bounded so that none decides alone.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...arrays import Array, IndexArray
from ..character import ARM, LEG, MIDDLE
from .names import CLEAR
from .symmetry import Frame

SHORT_LEG = 0.4  # shortest leg whose foot is taken to be smaller with it, in sizes
NO_HEAD = -5.0  # score of a figure without a head


@dataclass(frozen=True, eq=False)
class Figure:
    """Bones of one side and of the middle."""

    frame: Frame
    limbs: Mapping[str, int]  # by part of an arm and a leg, of `frame.one_side`; some may be missing
    middle: Mapping[str, tuple[int, ...]]  # by part of `roles.MIDDLE`, from the hips upward
    fit: float  # what the places alone add up to
    score: float
    upright: float  # cosine between the trunk and up


@dataclass(frozen=True, eq=False)
class _Chains:
    """C chains of three bones on one side, each above the next, which may be a leg or an arm."""

    bones: IndexArray  # (C, 3) upper, middle and end bone; the end -1 after a limb's last bone
    attached: IndexArray  # (C,) bone of the middle on which each hangs; -1 for none


def near(value: Array | float, mean: float, deviation: float, most: float = 6.0) -> Array:
    """How well values (...) fit a mean: 0 at best, `-most` at worst."""
    return -np.minimum(0.5 * ((np.asarray(value) - mean) / deviation) ** 2, most)


def best_figure(frames: list[Frame]) -> Figure | None:
    """The likeliest figure in frames of the same bones; None where there are no two pairs of limbs."""
    chains = _find_chains(frames[0]) if frames else None
    if chains is None or not len(chains.bones):
        return None
    quick = [
        (_leg_fits(frame, chains) + _names_of(frame, chains, LEG[:3])).max()
        + (_arm_fits(frame, chains) + _names_of(frame, chains, ARM[1:])).max()
        for frame in frames
    ]
    # Frames whose limbs fit worse than the best frame's by more than this are passed over.
    close = [frame for frame, fit in zip(frames, quick, strict=True) if fit > max(quick) - 12.0]
    figures = [figure for frame in close if (figure := _figure(frame, chains)) is not None]
    return max(figures, key=lambda figure: figure.score, default=None)


def _find_chains(frame: Frame) -> _Chains:
    """All chains of one side that are long enough for a limb."""
    bones, place = frame.bones, frame.place
    found: list[tuple[int, int, int, int]] = []
    for end in map(int, np.flatnonzero(frame.one_side)):
        above: list[int] = []
        attached = -1
        for bone in bones.ancestors(end):
            if frame.middle[bone]:
                attached = bone
                break
            # Bones upward from a limb's end among which its other bones are sought.
            if frame.partner[bone] < 0 or len(above) == 16:
                break
            above.append(bone)
        for second, middle in enumerate(above):
            found += [(upper, middle, end, attached) for upper in above[second + 1 :]]
        reach = min(_reach(frame, end), _reach(frame, int(frame.partner[end])))
        for upper in above:  # a limb may lack its hand
            if reach < 1.2 * _length(place[end] - place[upper]):
                found.append((upper, end, -1, attached))
    table = np.array(found, dtype=np.intp).reshape(-1, 4)
    ends = np.where(table[:, 2] >= 0, table[:, 2], table[:, 1])
    length = _length(place[table[:, 1]] - place[table[:, 0]]) + _length(place[ends] - place[table[:, 1]])
    table = table[length > 0.08]
    return _Chains(table[:, :3], table[:, 3])


def _figure(frame: Frame, chains: _Chains) -> Figure | None:
    legs, leg_fits = _best_limbs(frame, chains, _leg_fits(frame, chains), LEG[:3])
    arms, arm_fits = _best_limbs(frame, chains, _arm_fits(frame, chains), ARM[1:])
    leg_names, arm_names = _names_of(frame, legs, LEG[:3]), _names_of(frame, arms, ARM[1:])
    fits = leg_fits[:, None] + arm_fits[None] + _pair_fits(frame, legs, arms)
    scores = fits + leg_names[:, None] + arm_names[None]
    for flat in np.argsort(-scores, axis=None, kind="stable"):
        leg, arm = (int(each) for each in np.unravel_index(flat, scores.shape))
        if not np.isfinite(scores[leg, arm]):
            return None
        # The lowest bone that carries both; none where one limb is part of the other.
        first, second, below = int(legs.bones[leg, 0]), int(arms.bones[arm, 0]), frame.bones.subtree
        ends = int(legs.attached[leg]), int(arms.attached[arm])
        if second in below[first] or first in below[second] or min(ends) < 0:
            continue
        above = [ends[0], *frame.bones.ancestors(ends[0])]
        carriers = (bone for bone in (ends[1], *frame.bones.ancestors(ends[1])) if bone in above)
        fork = next(carriers, -1)
        if fork >= 0:
            break
    else:
        return None
    thigh, shin, foot = (int(bone) for bone in legs.bones[leg])
    upper_arm, forearm, hand = (int(bone) for bone in arms.bones[arm])
    limbs = {"thigh": thigh, "shin": shin, "foot": foot, "upper_arm": upper_arm, "forearm": forearm}
    limbs |= {"hand": hand} if hand >= 0 else {}
    for part, options in (("toe", _toes(frame, foot, thigh)), ("shoulder", _shoulders(frame, upper_arm))):
        bone = max(options, key=lambda bone: options[bone], default=-1)
        if bone >= 0 and options[bone] > -4.0:
            limbs[part] = bone
    hip, shoulder = (frame.place[bone] * [0.0, 1.0, 1.0] for bone in (thigh, upper_arm))
    middle, trunk_fit = _trunk(frame, hip, shoulder, int(arms.attached[arm]), fork)
    up = shoulder - hip
    names = sum(_names(frame, part)[bone] for part, those in middle.items() for bone in those)
    return Figure(
        frame,
        limbs,
        middle,
        float(fits[leg, arm]) + trunk_fit,
        float(scores[leg, arm]) + trunk_fit + float(names),
        float(up[2] / max(_length(up), 1e-9)),
    )


def _names(frame: Frame, part: str) -> Array:
    """(N,) what the names say of a part, both sides' names taken together."""
    own = np.array([reading.scores[part] for reading in frame.bones.readings])
    # Names are trusted so much more than a measure of place.
    return np.asarray(1.3 * 0.5 * (own + np.where(frame.partner >= 0, own[frame.partner], own)))


def _names_of(frame: Frame, chains: _Chains, parts: tuple[str, ...]) -> Array:
    found = np.zeros(len(chains.bones))
    for bones, part in zip(chains.bones.T, parts, strict=True):
        found += np.where(bones >= 0, _names(frame, part)[bones], 0.0)
    return found


def _best_limbs(frame: Frame, chains: _Chains, fits: Array, parts: tuple[str, ...]) -> tuple[_Chains, Array]:
    """The chains that fit a kind of limb best by place and name, and how their places fit."""
    names = _names_of(frame, chains, parts)
    # The best are looked at closely, and the best of those weighed against limbs of the other kind.
    many = np.argsort(-(fits + names), kind="stable")[:150]
    many = many[np.isfinite(fits[many])]
    is_leg = parts == LEG[:3]
    closer = [_line_fit(frame, bones) + _end_fit(frame, bones, is_leg) for bones in chains.bones[many]]
    fits, names = fits[many] + np.array(closer), names[many]
    few = np.argsort(-(fits + names), kind="stable")[:40]
    return _Chains(chains.bones[many[few]], chains.attached[many[few]]), fits[few]


def _leg_fits(frame: Frame, chains: _Chains) -> Array:
    hip, knee, ankle = (frame.place[bones] for bones in chains.bones.T)
    upper, lower = _length(knee - hip), _length(ankle - knee)
    length = np.maximum(upper + lower, 1e-9)
    unit = np.maximum(length, SHORT_LEG)
    anatomy = [not reading.mechanism for reading in frame.bones.readings]
    floor = frame.place[anatomy, 2].min() if any(anatomy) else 0.0
    fits = near(upper / length, 0.5, 0.06)
    fits += near(np.minimum((hip[:, 2] - ankle[:, 2]) / length, 0.95), 0.95, 0.12, 12.0)
    fits += near((ankle[:, 2] - floor) / unit, 0.1, 0.1, 5.0)
    fits += near(hip[:, 0] / unit, 0.13, 0.07, 4.0) + near(length, 0.45, 0.15, 3.0)
    fits += np.where(chains.attached >= 0, 0.0, -2.0)
    return np.where(chains.bones[:, 2] >= 0, fits, -np.inf)


def _arm_fits(frame: Frame, chains: _Chains) -> Array:
    shoulder, elbow, wrist = (frame.place[bones] for bones in chains.bones.T)
    ends = frame.ends[chains.bones[:, 1]]
    has_hand = chains.bones[:, 2:] >= 0
    wrist = np.where(has_hand, wrist, np.where(np.isfinite(ends), ends, 2.0 * elbow - shoulder))
    upper, lower = _length(elbow - shoulder), _length(wrist - elbow)
    length = np.maximum(upper + lower, 1e-9)
    fits = near(upper / length, 0.52, 0.06) + near(length, 0.3, 0.12, 3.0)
    fits += near(np.minimum(_length(wrist - shoulder) / length, 0.85), 0.85, 0.15, 8.0)
    fits += near(np.maximum((wrist[:, 2] - shoulder[:, 2]) / length, 0.2), 0.2, 0.3, 8.0)
    fits += near(shoulder[:, 0] / length, 0.33, 0.13, 4.0)
    return fits + np.where(has_hand[:, 0], 0.0, -3.0) + np.where(chains.attached >= 0, 0.0, -2.0)


def _line_fit(frame: Frame, chain: IndexArray) -> float:
    """How little the bones that are left out bend the limb, and that it is no strand of several alike."""
    bones, place = frame.bones, frame.place
    part = [reading.clear_part for reading in bones.readings]
    found = 0.0
    for top, low in zip(chain[:2], chain[1:], strict=True):
        line = place[low] - place[top]
        between = int(bones.parent[low]) if low >= 0 else int(top)
        while between not in (int(top), -1):
            off = place[between] - place[top]
            off = off - line * float(np.clip(off @ line / max(float(line @ line), 1e-9), 0.0, 1.0))
            found -= 0.3 + min(20.0 * float(_length(off)) / max(float(_length(line)), 1e-5), 3.0)
            found -= 2.0 * (part[low] is not None and part[low] == part[between])
            between = int(bones.parent[between])
    top = int(chain[0])
    above = int(bones.parent[top])
    if above >= 0 and frame.one_side[above]:
        found -= 2.0 * (part[top] is not None and part[top] == part[above])
        lower = place[above, 2] > place[top, 2] and place[low, 2] < place[top, 2]
        found -= 2.0 if lower and place[above, 0] > 0.6 * place[top, 0] else 0.0
    while bones.parent[top] >= 0 and frame.one_side[bones.parent[top]]:
        top = int(bones.parent[top])
    beside = bones.children[bones.parent[top]] if bones.parent[top] >= 0 else ()
    alike = [
        bone
        for bone in beside
        if bone not in (top, frame.partner[top])
        and len(bones.subtree[bone]) == len(bones.subtree[top]) > 1
        and 0.8 < _reach(frame, bone) / _reach(frame, top) < 1.25
    ]
    return found - 1.2 * min(len(alike), 2)


def _end_fit(frame: Frame, chain: IndexArray, is_leg: bool) -> float:
    """How well what begins at a limb's end is a foot ahead and not far below, or a hand with fingers.

    Fingers fan out where a hand begins, and nowhere before.
    """
    bones, (_, middle, end) = frame.bones, (int(bone) for bone in chain)
    if end < 0:
        return 0.0
    length = _length(np.diff(frame.place[chain], axis=0)).sum()
    if is_leg:
        points, unit = frame.branch[end] - frame.place[end], max(length, SHORT_LEG)
        ahead, below = np.abs(points[:, 1]).max() / unit, max(-points[:, 2].min() / unit, 0.2)
        return -1.0 if len(points) < 2 else float(near(ahead, 0.25, 0.13, 2.0) + near(below, 0.2, 0.08, 5.0))
    reach = min(_reach(frame, end), _reach(frame, int(frame.partner[end])))  # one hand may hold something
    found = float(near(reach / length, 0.33, 0.2, 4.0)) if reach > 1e-6 else 0.0
    found += 0.8 * min(sum(not bones.children[each] for each in bones.subtree[end]) - 1, 2)
    rivals = [
        each
        for each in bones.children[bones.parent[end]]
        if each != end
        and len(bones.subtree[each]) >= len(bones.subtree[end])
        and not bones.readings[each].mechanism
    ]
    inner = set(bones.subtree[middle]) - set(bones.subtree[end]) - {int(bones.parent[end])}
    fans = sum(len(bones.children[each]) >= 3 for each in inner)
    return found - 1.5 * min(len(rivals), 2) - 0.8 * min(fans, 2)


def _pair_fits(frame: Frame, legs: _Chains, arms: _Chains) -> Array:
    """(legs, arms) how well each leg goes with each arm."""
    hip, ankle = (frame.place[legs.bones[:, part], None] for part in (0, 2))
    shoulder, elbow = (frame.place[None, arms.bones[:, part]] for part in (0, 1))
    up = shoulder - hip
    reach = np.maximum(_length(up[..., 1:]), 1e-9)
    leg, arm = np.maximum(_length(hip - ankle), 1e-9), 2.0 * np.maximum(_length(elbow - shoulder), 1e-9)
    fits = near(np.minimum(up[..., 2] / reach, 0.95), 0.95, 0.15, 12.0)
    fits += near(np.log(reach / leg), np.log(0.6), 0.35) + near(np.log(arm / leg), np.log(0.65), 0.35)
    fits += near(np.log((shoulder[..., 0] + 1e-3) / (hip[..., 0] + 1e-3)), np.log(1.9), 0.45, 5.0)
    return np.asarray(fits)


def _toes(frame: Frame, foot: int, thigh: int) -> dict[int, float]:
    """Bones that may bend below a foot, and their scores; of several toes the one nearest to the middle."""
    place, names = frame.place, _names(frame, "toe")
    unit = max(_length(place[foot] - place[thigh]), SHORT_LEG)
    points = frame.branch[foot] - place[foot]
    ahead = np.sign(points[np.abs(points[:, 1]).argmax(), 1]) or 1.0
    found = {}
    for bone in frame.bones.subtree[foot][1:]:
        x, y, z = (place[bone] - place[foot]) / unit
        depth = frame.bones.ancestors(bone).index(foot)
        score = float(near(ahead * y, 0.2, 0.12) + near(z, -0.09, 0.1, 3.0)) + float(names[bone])
        found[bone] = score - 0.7 * depth - abs(x) - 2.0 * place[bone, 0] / unit
    return found


def _shoulders(frame: Frame, upper_arm: int) -> dict[int, float]:
    place, names = frame.place, _names(frame, "shoulder")
    length = _reach(frame, upper_arm)
    above = [bone for bone in frame.bones.ancestors(upper_arm) if frame.one_side[bone]]
    found = {}
    for rank, bone in enumerate(reversed(above)):
        away = place[upper_arm] - place[bone]
        reach = max(float(_length(away)), 1e-9)
        score = float(near(reach / length, 0.25, 0.15, 5.0)) - 0.3 * rank + float(names[bone])
        found[bone] = score + float(near(min(away[0] / reach, 0.5), 0.5, 0.3, 4.0))
    return found


def _trunk(
    frame: Frame, hip: Array, shoulder: Array, arms_on: int, fork: int
) -> tuple[dict[str, tuple[int, ...]], float]:
    bones, place = frame.bones, frame.place
    names = {part: _names(frame, part) for part in MIDDLE}
    height = max(float(shoulder[2] - hip[2]), 1e-6)
    path = [*reversed(bones.ancestors(arms_on)), arms_on]
    off = _length(place - hip) / height
    over = (place[:, 2] - shoulder[2]) / height
    # A bone this near to its parent begins where that does.
    on_parent = _length(place - place[bones.parent]) < 0.02 * height
    rank = {bone: number - path.index(fork) for number, bone in enumerate(path)}
    late = {bone: -4.0 * (rank[bone] > 0) - 6.0 * (rank[bone] < 0) for bone in path}
    hips_fits = {
        bone: late[bone] + float(near(off[bone] if rank[bone] else 0.0, 0.0, 0.4, 4.0)) for bone in path
    }
    hips = max(path, key=lambda bone: hips_fits[bone] + float(names["hips"][bone]))
    spine = path[path.index(hips) + 1 :]
    options = {}
    for bone in bones.subtree[fork]:
        if not frame.middle[bone] or bone in path or over[bone] < -0.3:
            continue
        fit = float(
            near(over[bone], 0.35, 0.2, 5.0) + near((place[bone, 1] - shoulder[1]) / height, 0.0, 0.25, 4.0)
        )
        fit += 0.8 * min(sum(frame.one_side[child] for child in bones.children[bone]), 2)
        inner = [child for child in bones.children[bone] if not on_parent[child]]
        onward = (
            len(bones.children[bone]) == 1 == len(inner) and frame.middle[inner[0]] and over[inner[0]] < 0.55
        )
        line = [bone, *(each for each in bones.ancestors(bone) if each in options)]
        fit -= 4.0 * int(on_parent[line].sum()) + 1.5 * onward
        options[bone] = fit + float(names["head"][bone])
    head = max(options | {-1: NO_HEAD}, key=lambda bone: options.get(bone, NO_HEAD))
    neck: list[int] = []
    if head >= 0:
        neck = [
            bone
            for bone in reversed(bones.ancestors(head))
            if bone not in path and bone in bones.subtree[fork]
        ]
    carried = [bone for bone in spine if names["neck"][bone] >= CLEAR > names["spine"][bone]]
    low = [bone for bone in neck if over[bone] < -0.08 and names["neck"][bone] < CLEAR]
    neck = [*carried, *(bone for bone in neck if bone not in low)]
    spine = [*(bone for bone in spine if bone not in carried), *low]
    found = {
        part: tuple(bone for bone in those if not bones.readings[bone].mechanism or part == "hips")
        for part, those in (("hips", [hips]), ("spine", spine), ("neck", neck))
    }
    fit = hips_fits[hips] + (options[head] - float(names["head"][head]) if head >= 0 else NO_HEAD)
    return {**found, "head": (head,) if head >= 0 else ()}, fit


def _reach(frame: Frame, bone: int) -> float:
    """How far all below a bone reaches from its head [sizes]."""
    return max(float(_length(frame.branch[bone] - frame.place[bone]).max()), 1e-9)


def _length(vectors: Array) -> Array:
    return np.asarray(np.linalg.norm(vectors, axis=-1))
