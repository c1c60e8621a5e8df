"""Recognition of a character: roles and sides from preset, names, hierarchy and symmetry, or a refusal."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ...body.human import HUMAN
from ...body.mirror import other_side
from ...errors import InputError, shown
from ..character import ARM, CHAINS, LEG, REQUIRED, ROLES, TRUNK_CHAINS, Character
from ..character_motion import find_stance
from ..maps.character_map import CharacterMap, RoleBones
from ..maps.presets import Preset, find_preset
from .bones import candidate_bones
from .figure import Figure, best_figure
from .fingers import find_fingers
from .names import CLEAR, read_name
from .symmetry import Frame, find_frames

AGREED, NAMED, UNSEEN, PLACED, AGAINST = 0.99, 0.95, 0.9, 0.7, 0.6
"""Confidence of a role: of a preset and confirmed by its place, of a name, of a preset alone, of a place, and
where something speaks against it."""
LEAST_UPRIGHT, HANDS_ABOVE = 0.6, 0.1  # cosine of trunk and up; hands over ankles, in lengths of a leg
LIMB_WORDS = {"upper_arm": "arm", "forearm": "forearm", "thigh": "leg", "shin": "shin", "foot": "foot"}
"""Parts of limbs that a character must have, in words."""
VALID = "a character stands on two legs and has two arms"


@dataclass(frozen=True)
class Facing:
    """Which way a figure faces."""

    ahead: float  # 1 where it faces along the second axis of `Frame.place`, -1 where it faces the other way
    confidence: float
    by_names: float  # vote of the names, positive for `ahead`; 0 where they name no sides
    by_shape: float  # vote of feet, knees and elbows, positive for `ahead`


def find_facing(figure: Figure) -> Facing:
    """Where a figure faces; `frame.one_side` is its left side if `ahead` is 1, its right side otherwise."""
    frame, limbs = figure.frame, figure.limbs
    hip, knee, ankle, shoulder, elbow = (
        frame.place[limbs[part]] for part in ("thigh", "shin", "foot", "upper_arm", "forearm")
    )
    leg = max(float(np.linalg.norm(knee - hip) + np.linalg.norm(ankle - knee)), 1e-9)
    toes = frame.branch[limbs["foot"]] - ankle  # what hangs on an ankle lies mostly ahead of it
    far = float(toes[np.abs(toes[:, 1]).argmax(), 1]) / leg
    # Feet alone do not outvote names; feet, knees and elbows together do.
    shape = 2.5 * float(np.clip(far / 0.1, -1.0, 1.0))
    shape += 1.0 * float(np.clip(_bulge(hip, knee, ankle) / 0.03, -1.0, 1.0))
    if "hand" in limbs:
        wrist = frame.place[limbs["hand"]]
        shape -= 0.8 * float(np.clip(_bulge(shoulder, elbow, wrist) / 0.04, -1.0, 1.0))
    sides = [
        sign if frame.bones.readings[bone].side == "L" else -sign
        for own in limbs.values()
        for bone, sign in ((own, 1.0), (int(frame.partner[own]), -1.0))
        if frame.bones.readings[bone].side is not None
    ]
    names = 3.0 * float(np.mean(sides)) if sides else 0.0
    ahead = 1.0 if shape + names >= 0.0 else -1.0
    confidence = float(1.0 / (1.0 + np.exp(-1.3 * abs(shape + names))))
    return Facing(ahead, confidence, ahead * names, ahead * shape)


def _bulge(first: Array, middle: Array, last: Array) -> float:
    """How far, in lengths, the middle joint lies ahead of the line through its neighbors."""
    line = last - first
    reach = max(float(line @ line), 1e-12)
    off = middle - first - line * float(np.clip((middle - first) @ line / reach, 0.0, 1.0))
    return float(off[1]) / float(np.sqrt(reach))


ROOT_WORDS = frozenset({"root", "master", "traj", "origin", "reference", "全ての親", "world", "motion"})


def find_root(character: Character, character_map: CharacterMap, up: Array) -> str | None:
    """The lowest bone above all that is keyed that lies near the ground, or is named after what it does.

    Bones with roles are keyed where the map gives no controls; up (3,) is in the armature's axes.
    """
    hips = character_map.bone("hips")
    if hips is None:
        return None
    bones = [character.index[name] for role in character_map.roles.values() for name in role.bones]
    ground = min(float(character.bones[bone].head @ up) for bone in bones)
    height = max(float(character.bone(hips).head @ up) - ground, 1e-9)
    keyed = [name for role in character_map.roles for name in character_map.keyed_bones(role)]
    keyed += [name for ik in character_map.ik.values() for name in (ik.goal, ik.pole)]
    above = [set(character.ancestors(character.index[name])) for name in keyed if name is not None]
    moving = next((name for name in character_map.keyed_bones("hips") if name is not None), hips)
    for bone in character.ancestors(character.index[moving]):
        carries = all(bone in each for each in above)
        # A root's head is no higher above the feet than this share of the hips' height.
        low = float(character.bones[bone].head @ up) - ground < 0.15 * height
        named = not ROOT_WORDS.isdisjoint(read_name(character.bones[bone].name).words)
        if carries and (low or named):
            return character.bones[bone].name
    return None


@dataclass(frozen=True)
class Recognition:
    """Roles found for a character's bones."""

    character_map: CharacterMap  # of a preset also its controls and settings
    doubts: tuple[str, ...] = ()  # what a person should look at, in sentences without a full stop


def recognize(character: Character, presets: tuple[Preset, ...] | None = None) -> Recognition:
    """Recognize a character's bones, by the shipped conventions of names or other ones, and by their places.

    Raises:
        InputError: It is no character: too few bones, an animal, a prop, an actor of Keymark, a rig
            half built, or numbers that cannot be used.
    """
    _check_character(character)
    preset = find_preset(character, presets)
    figure, frame, reason = _best_figure(character)
    doubts: list[str] = []
    if figure is not None:
        facing = find_facing(figure)
        roles = _roles_of(figure, facing)
        if facing.by_names * facing.by_shape < 0.0 and abs(facing.by_shape) > 1.0:
            doubts.append(
                "left and right are taken from the shape, against the names of the bones: feet and knees "
                "point the other way"
                if facing.by_names < 0.0
                else "left and right are taken from the names of the bones, although the feet point the "
                "other way"
            )
        elif facing.confidence < 0.9:
            doubts.append(
                "left and right may be swapped for all roles of a side: names, feet, knees and elbows hardly "
                "tell where the character faces"
            )
        if preset is None:
            character_map = CharacterMap(character.name, roles)
            doubts += _place_doubts(figure, roles)
        else:
            if facing.by_names < 0.0:  # its sides are the other way round
                preset = replace(
                    preset,
                    roles={
                        one: preset.roles[other_side(one)] for one in ROLES if other_side(one) in preset.roles
                    },
                    fk={other_side(role): bones for role, bones in preset.fk.items()},
                    ik={other_side(limb): controls for limb, controls in preset.ik.items()},
                )
            character_map, against = _merged(character, preset, roles, figure)
            doubts += against
    elif preset is not None and _stands_upright(character, preset):
        unseen = {role: replace(bones, confidence=UNSEEN) for role, bones in preset.roles.items()}
        character_map = replace(preset, roles=unseen)
        doubts.append(f"no body was recognized by shape: all roles are those of the names of {preset.title}")
    else:
        raise _refusal(character, frame, reason)
    if "head" not in character_map.roles:
        doubts.append("head not found: no bone of the middle lies where a head begins")
    hands = [role for role in ("hand.L", "hand.R") if role not in character_map.roles]
    if hands:
        doubts.append(f"{' and '.join(hands)} not found: the forearm is the last bone of the arm")
    fingers = find_fingers(character, character_map)
    character_map = replace(character_map, roles={**character_map.roles, **fingers})
    if character_map.root is None:
        up = find_stance(character, character_map)[2]
        character_map = replace(character_map, root=find_root(character, character_map, up))
    return Recognition(character_map, tuple(doubts))


def _best_figure(character: Character) -> tuple[Figure | None, Frame | None, str]:
    """The likeliest figure that is a character's; else a frame, and why the likeliest is none."""
    first, reason = None, ""
    for bones in candidate_bones(character):
        best: Figure | None = None
        for frames in find_frames(bones):
            first = first or next(iter(frames), None)
            figure = best_figure(frames)
            why = "" if figure is None else _why_no_character(figure)
            reason = reason or why
            if figure is not None and not why and (best is None or figure.score > best.score):
                best = figure
            # Fit from which no other plane of symmetry is tried.
            if best is not None and best.fit > -6.0:
                break
        if best is not None:
            return best, first, ""
    return None, first, reason


def _roles_of(figure: Figure, facing: Facing) -> dict[str, RoleBones]:
    frame, bones = figure.frame, figure.frame.bones
    sides = ("L", "R") if facing.ahead > 0 else ("R", "L")
    chosen = [(part, part, those, 1.0) for part, those in figure.middle.items() if those]
    for part in (part for part in (*ARM, *LEG) if part in figure.limbs):
        pair = figure.limbs[part], int(frame.partner[figure.limbs[part]])
        for side, own in zip(sides, pair, strict=True):
            chosen.append((f"{part}.{side}", part, (own,), facing.confidence))
        if part == "forearm" and "hand" not in figure.limbs:
            # A hand whose counterpart lacks is as far from the elbow as the shoulder, about.
            reach = float(np.linalg.norm(frame.place[pair[0]] - frame.place[figure.limbs["upper_arm"]]))
            for side, elbow in zip(sides, pair, strict=True):
                for bone in bones.children[elbow]:
                    way = float(np.linalg.norm(bones.head[bone] - bones.head[elbow])) / bones.size
                    alone = frame.partner[bone] < 0 and not bones.readings[bone].other
                    if alone and 0.5 * reach < way < 1.7 * reach:
                        chosen.append((f"hand.{side}", "hand", (bone,), facing.confidence))
                        break
    found: dict[str, RoleBones] = {}
    for role, part, those, share in chosen:
        named = all(bones.readings[bone].scores[part] >= CLEAR for bone in those)
        names = tuple(bones.names[bone] for bone in those)
        found[role] = RoleBones(names, (NAMED if named else PLACED) * share, "names" if named else "shape")
    return found


def _place_doubts(figure: Figure, roles: Mapping[str, RoleBones]) -> list[str]:
    named: dict[str, str] = {}
    for name, reading in zip(figure.frame.bones.names, figure.frame.bones.readings, strict=True):
        if reading.clear_part in (*ARM, *LEG) and reading.side:
            named.setdefault(f"{reading.clear_part}.{reading.side}", name)
    found: list[str] = []
    for role, other in named.items():
        if role not in roles:
            found.append(f"{role} not found, but {shown(other)} has the name for it")
        elif roles[role].source != "names":
            found.append(
                f"{role} is doubtful: {shown(roles[role].bones[0])} was chosen by its place, and "
                f"{shown(other)} has the name for it"
            )
    placed = [role for role, bones in roles.items() if bones.source == "shape" and role not in named]
    if placed:
        found.append(
            f"no name tells which bone plays {', '.join(placed)}: they are chosen by their places alone"
        )
    return found


def _merged(
    character: Character, preset: CharacterMap, roles: Mapping[str, RoleBones], figure: Figure
) -> tuple[CharacterMap, list[str]]:
    """The preset's map with its roles held against the figure's, and what is doubtful about them."""
    kept, arm = dict(preset.roles), preset.bone("upper_arm.L")
    start = None if arm is None else character.index[arm]
    above = [] if start is None else [start, *character.ancestors(start)]
    carrying = {character.bones[bone].name for bone in above}.intersection(preset.bones("neck"))
    if any("neck" not in name.casefold() for name in carrying):
        # What carries an arm and is no neck by name: the trunk is as names and shape say.
        trunk = (*TRUNK_CHAINS, "head")
        kept = {role: bones for role, bones in kept.items() if role not in trunk}
        kept |= {role: roles[role] for role in trunk if role in roles}
    taken = {bone for bones in kept.values() for bone in bones.bones}
    merged: dict[str, RoleBones] = {}
    found: list[str] = []
    for role in ROLES:
        given, seen = kept.get(role), roles.get(role)
        if given is None:
            if seen is not None and taken.isdisjoint(seen.bones):
                merged[role] = seen
            continue
        if seen is None or role in CHAINS:
            merged[role] = replace(given, confidence=UNSEEN if seen is None else AGREED)
            continue
        apart = character.bone(given.bones[0]).head - character.bone(seen.bones[0]).head
        # Heads this near to each other, in sizes, are one joint.
        agreed = np.linalg.norm(apart) < 0.03 * figure.frame.bones.size
        merged[role] = replace(given, confidence=AGREED if agreed else AGAINST)
        if not agreed:
            found.append(
                f"{role} is doubtful: {shown(given.bones[0])} was chosen by the names of "
                f"{preset.title}, and by its place {shown(seen.bones[0])} fits better"
            )
    return replace(preset, roles=merged), found


def _stands_upright(character: Character, character_map: CharacterMap) -> bool:
    """Whether a map has all roles that a character must have, on a body that stands upright on its legs."""
    if any(role not in character_map.roles for role in REQUIRED):
        return False
    shoulder, hip, ankle, hand = (
        np.mean([character.bone(str(character_map.bone(f"{part}.{side}"))).head for side in "LR"], axis=0)
        for part in ("upper_arm", "thigh", "foot", "hand" if "hand.L" in character_map.roles else "forearm")
    )
    leg, trunk = hip - ankle, shoulder - hip
    lengths = float(np.linalg.norm(leg)), float(np.linalg.norm(trunk))
    upright = min(lengths) > 0.0 and float(leg @ trunk) >= LEAST_UPRIGHT * lengths[0] * lengths[1]
    return upright and float((hand - ankle) @ leg) > HANDS_ABOVE * lengths[0] ** 2


def _check_character(character: Character) -> None:
    name = f"armature {shown(character.name)}"
    if not character.bones:
        raise InputError(f"{name} has no bones; {VALID}")
    if {segment.name for segment in HUMAN.segments} <= set(character.index):
        raise InputError(f"{name} is an actor of Keymark; choose the character that is to get its motion")
    if len(character.bones) < len(REQUIRED):
        count = f"{len(character.bones)} bone{'s' if len(character.bones) > 1 else ''}"
        raise InputError(f"{name} has {count}, at least {len(REQUIRED)} are needed; {VALID}")
    if not np.isfinite(character.scale) or character.scale <= 0.0:
        raise InputError(f"{name}: its scale is {character.scale:g}; it must be one positive number")
    for bone in character.bones:
        if not (np.isfinite(bone.rest).all() and np.isfinite(bone.tail).all()):
            placeless = f"{name}: bone {shown(bone.name)} has a place that is no number"
            raise InputError(f"{placeless}; all must be finite")
    extent = float(np.max(np.ptp([bone.head for bone in character.bones], axis=0)))
    if not extent * character.scale > 1e-6:
        raise InputError(f"{name} has no size, all its bones begin at one point; {VALID}")


def _why_no_character(figure: Figure) -> str:
    """Why a figure is no character's, to follow the armature's name; empty for a character's."""
    places, limbs = figure.frame.place, figure.limbs
    hip, ankle = places[limbs["thigh"]], places[limbs["foot"]]
    leg = max(float(np.linalg.norm(ankle - hip)), 1e-9)
    if figure.upright < LEAST_UPRIGHT or (hip[2] - ankle[2]) / leg < 0.7:
        # An animal's forelegs reach the ground; a body that only lies or hangs is none.
        hand = places[limbs.get("hand", limbs["forearm"]), 2]
        like = ", like an animal's" if hand - ankle[2] < 0.5 * leg else ""
        return "its trunk does not stand upright on its legs" + like
    if (places[limbs.get("hand", limbs["forearm"]), 2] - ankle[2]) / leg < HANDS_ABOVE:
        return "its hands are as low as its feet, like an animal's"
    readings = figure.frame.bones.readings
    named = all(
        readings[limbs[part]].scores[part] >= CLEAR for part in ("upper_arm", "forearm", "thigh", "shin")
    )
    # Least fit of a figure's places, where names speak for its arms and legs and where not.
    if figure.fit < (-26.0 if named else -12.0):
        return "its bones do not have the proportions of a body with two legs and two arms"
    return ""


def _refusal(character: Character, frame: Frame | None, reason: str) -> InputError:
    """The error for a character that is refused: what is missing by a frame of its bones, or the reason."""
    name = f"armature {shown(character.name)}"
    if frame is None:
        return InputError(f"{name} has no bones that mirror each other; {VALID}")
    sides = {
        part: {r.side for r in frame.bones.readings if r.side and r.clear_part == part} for part in LIMB_WORDS
    }
    half = next((part for part in LIMB_WORDS if len(sides[part]) == 1), None)
    if half is not None:
        side, other = ("left", "right") if "L" in sides[half] else ("right", "left")
        missing = f"a {side} {LIMB_WORDS[half]} but no {other} one"
        return InputError(f"{name} has {missing}; {VALID}, so complete the rig or choose another")
    if [part for part in LIMB_WORDS if not sides[part]] == ["foot"]:
        return InputError(f"{name} has legs without feet; {VALID}, so complete the rig or choose another")
    feet = [
        bone.name for bone in character.bones if bone.parent < 0 and read_name(bone.name).clear_part == "foot"
    ]
    if feet:
        names = " and ".join(shown(foot) for foot in feet)
        return InputError(
            f"{name} is not recognized as a character: the feet {names} have no parent, and no leg is found "
            f"that they end; {VALID}, so give each foot its shin as a parent or name the bones in a map"
        )
    if reason:
        return InputError(f"{name} is not recognized as a character: {reason}; {VALID}")
    return InputError(f"{name} has no pair of legs and pair of arms on one trunk; {VALID}")
