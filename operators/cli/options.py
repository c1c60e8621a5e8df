"""Options that several commands share: evidence, keyframes and libraries, shoots, characters."""

import argparse
from pathlib import Path, PureWindowsPath

from ...core.prior.texts import EVERY_LIBRARY
from ...core.take.conversion_settings import (
    HIGHEST_FLOOR_M,
    LARGEST_TOLERANCE_MM,
    LIMB_KEYS,
    METHODS,
    PLACEMENTS,
    ROOT_MOTIONS,
    CharacterOptions,
    ConversionSettings,
)
from ...core.take.evidence import EVIDENCE, evidence_mistake, in_order
from .parser import Argument, UsageError, argument

KINDS = ",".join(EVIDENCE)
HEIGHT = "--height"
SHOOT_HELP = "folder of takes, or a list of them (JSON Lines, .jsonl)"
CHARACTER_HELP = (
    "the character's file (.blend, .fbx, .glb, .gltf or .vrm), and after a colon the name of its armature "
    "where it has several"
)
REPLACE_HELP = "replace what is there already"
MAP_HELP = (
    "character map, by title or file; auto, the default: a saved one that knows the character's bones, else "
    "recognition; none: recognition"
)


def bare_clip_fields(height_m: float) -> dict[str, object]:
    """The fields of a take of which nothing but the performer's height is known."""
    return {"actor": {"height_m": height_m}, "keyframes": EVERY_LIBRARY}


def output(metavar: str, words: str, *, required: bool = True, replace: str = "") -> tuple[Argument, ...]:
    """Where a command writes, and, with the help for it, whether it may replace what is there."""
    to = argument("--output", "-o", metavar=metavar, type=Path, required=required, help=words)
    return (to, argument("--replace", action="store_true", help=replace)) if replace else (to,)


def evidence_option(condition: str = "") -> Argument:
    """The kinds of evidence; `condition` says for which takes the option counts."""
    return argument(
        "--evidence",
        metavar="KINDS",
        type=_kinds,
        help=f"what the motion is held against{condition}, one or more of {KINDS}; by default whatever a "
        "take has",
    )


KEYPOINT_FILES = argument(
    "--keypoints",
    metavar="FILE",
    type=Path,
    action="append",
    help="file or folder of keypoints that a detector has found in the clip; may be given several times; "
    "by default TAKE/keypoints.json where it is there",
)
"""Keypoint files of one take."""


REFERENCE_FILE = argument(
    "--reference",
    metavar="FILE",
    type=Path,
    help="3D motion of the same performance from elsewhere, as a neural network's, that is mended by the "
    "footage; by default the one that the take names",
)


def _kinds(text: str) -> tuple[str, ...] | None:
    """The kinds of evidence; None for an empty text, which farms pass for a setting that is not filled in."""
    if not text:
        return None
    kinds = [kind.strip().replace("-", "_") for kind in text.split(",")]
    mistake = evidence_mistake(kinds)
    if mistake is not None:
        raise argparse.ArgumentTypeError(f"evidence is {text}; {mistake}")
    return in_order(kinds)


def _name_in_take(text: str) -> Path | None:
    """A path within a take; None for an empty text, as above."""
    if not text:
        return None
    path = PureWindowsPath(text)  # it reads both kinds of slash
    if path.anchor or Path(text).is_absolute() or ".." in path.parts or not path.name:
        raise argparse.ArgumentTypeError(
            f"keypoints is {text}; the name that the file has in every take is valid, as in keypoints.json"
        )
    return Path(text)


def _auto(text: str) -> str | None:
    """The word for finding keyframes; None for an empty text, as above."""
    if text not in ("", EVERY_LIBRARY):
        raise argparse.ArgumentTypeError(
            f"keyframes is {text}; {EVERY_LIBRARY} is valid: a keyframe file is a take's own, named in its "
            "description"
        )
    return text or None


SHOOT_OPTIONS = (
    argument(
        "--keypoints",
        metavar="NAME",
        type=_name_in_take,
        action="append",
        help="name of the keypoint file or folder of every take where nothing in SHOOT names one: "
        "TAKE/NAME, or CLIP.NAME beside a clip; may be given several times; by default keypoints.json where "
        "it is there",
    ),
    evidence_option(" where nothing in SHOOT says it"),
    argument(
        "--keyframes",
        metavar="auto",
        type=_auto,
        help="auto: find keyframes in the footage with all libraries there are, beside those that a take has "
        "posed, where nothing in SHOOT says how",
    ),
    argument(
        "--library",
        metavar="NAME|FILE|auto",
        type=lambda text: text or None,
        help="find keyframes by matching takes with this keyframe library alone where nothing in SHOOT says "
        "how; auto is --keyframes auto",
    ),
    argument(
        "--floor",
        metavar="HEIGHT",
        type=float,
        help="height of the floor in meters where nothing in SHOOT says it",
    ),
    argument("--method", choices=METHODS, help="method where nothing in SHOOT names one; map is the default"),
)
"""For takes whose shoot does not say it."""
RETARGET_OPTIONS = (
    argument(
        "--limbs",
        choices=LIMB_KEYS,
        help="controls of arms and legs that are keyed; both, the default, shows IK. A limb without IK "
        "controls is keyed in FK",
    ),
    argument("--arms", choices=LIMB_KEYS, help="of the arms, where it is not that of --limbs"),
    argument("--legs", choices=LIMB_KEYS, help="of the legs, where it is not that of --limbs"),
    argument(
        "--root-motion",
        choices=ROOT_MOTIONS,
        default=ROOT_MOTIONS[0],
        help="where the way over the ground goes: on the hips, nowhere, or on the root bone "
        "(default: %(default)s)",
    ),
    argument(
        "--place",
        choices=PLACEMENTS,
        default=PLACEMENTS[0],
        help="where the character performs: where the performer stood and faced, or where it stands itself "
        "(default: %(default)s)",
    ),
    argument("--no-plant-feet", action="store_true", help="let resting feet move"),
    argument("--no-reach-hands", action="store_true", help="let hands miss what the performer's reached"),
    argument(
        "--tolerance",
        metavar="MM|none",
        default="5",
        help="largest distance of any joint from the motion in millimeters, for few keys; none keeps a key "
        "on every frame (default: %(default)s)",
    ),
)
"""How a motion is put onto a character."""


def character_options(arguments: argparse.Namespace) -> CharacterOptions:
    """How a motion is put onto a character, by the command line."""
    usual = CharacterOptions()
    return CharacterOptions(
        root_motion=arguments.root_motion,
        place=arguments.place,
        arms=arguments.arms or arguments.limbs or usual.arms,
        legs=arguments.legs or arguments.limbs or usual.legs,
        plant_feet=not arguments.no_plant_feet,
        reach_hands=not arguments.no_reach_hands,
        tolerance_mm=_tolerance_mm(arguments.tolerance),
    )


def _tolerance_mm(text: str) -> float:
    if text.strip().lower() == "none":
        return 0.0
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 < value <= LARGEST_TOLERANCE_MM:
        raise UsageError(
            f"--tolerance is {text}; millimeters above 0 and up to {LARGEST_TOLERANCE_MM:g} are valid, "
            "or none for a key on every frame"
        )
    return value


def given_settings(arguments: argparse.Namespace) -> ConversionSettings:
    """What the command line says of a conversion; None for what it leaves out, or is empty."""
    given = vars(arguments)
    keyframes, library, floor_m = (given.get(name) for name in ("keyframes", "library", "floor"))
    if keyframes == EVERY_LIBRARY and library not in (None, EVERY_LIBRARY):
        raise UsageError(
            f"--keyframes {keyframes} finds keyframes with all libraries, --library {library} with one; give "
            "one of them"
        )
    if floor_m is not None and not abs(floor_m) <= HIGHEST_FLOOR_M:
        raise UsageError(f"--floor is {floor_m:g}; a height within {HIGHEST_FLOOR_M:g} m is valid")
    every = keyframes == EVERY_LIBRARY
    return ConversionSettings(
        keyframes=Path(keyframes) if keyframes and not every else None,
        library=EVERY_LIBRARY if every else library,
        floor_m=floor_m,
        method=given.get("method"),
        pictures=False if given.get("no_report") else None,
        keypoints=tuple(filter(None, given.get("keypoints") or ())) or None,
        evidence=given.get("evidence"),
        reference=given.get("reference"),
    )
