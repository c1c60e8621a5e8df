"""Options that several commands share; those of a record follow from its declaration."""

import argparse
import re
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from ...core.files.kinds import Choice, Flag, Nullable, Number, Whole, relative_path
from ...core.files.records import Record, declared, descriptions
from ...core.prior.texts import EVERY_LIBRARY
from ...core.take import conversion_settings
from ...core.take.conversion_settings import (
    CharacterFile,
    CharacterSettings,
    ConversionSettings,
    RetargetOptions,
)
from ...core.take.evidence import EVIDENCE
from .console import Argument, UsageError, argument

WHERE = "the command line"
HEIGHT = "--height"
SHOOT_HELP = "folder of takes, or a list of them (JSON Lines, .jsonl)"
CHARACTER_HELP = (
    "the character's file (.blend, .fbx, .glb, .gltf or .vrm), and after a colon the name of its armature "
    "where it has several"
)
REPLACE_HELP = "replace what is there already"


def output(metavar: str, words: str, *, required: bool = True, replace: str = "") -> tuple[Argument, ...]:
    """Where a command writes, and, with the help for it, whether it may replace what is there."""
    to = argument(f"--output -o {metavar}", words, type=Path, required=required)
    return (to, argument("--replace", replace)) if replace else (to,)


def field_option(
    record: type[Record], field: str, usage: str, condition: str = "", **settings: Any
) -> Argument:
    """The option of a record's field, as that declares it; None if left out, or by `condition`."""
    kind = declared(record)[field].kind
    kind = kind.item if isinstance(kind, Nullable) else kind
    words = descriptions(record)[field].rstrip(".")
    if isinstance(kind, Choice):
        settings |= {"choices": kind.names}
    elif isinstance(kind, Flag):
        settings |= {"action": argparse.BooleanOptionalAction}
    elif isinstance(kind, Number | Whole):
        settings |= {"type": checked(kind, usage.split()[0])}
    return argument(usage, words[:1].lower() + words[1:] + condition, **{"dest": field} | settings)


def checked(kind: Number | Whole, option: str) -> Callable[[str], float]:
    """The type of an option whose value is a number of a kind; `none` is 0, where 0 is valid."""

    def number(text: str) -> float:
        value: float | str = text
        with suppress(ValueError):  # the kind says what is valid
            value = 0.0 if text == "none" and kind.low == 0.0 else float(text)
        return kind.read(value, WHERE, option)

    return number


def jobs_option(most: int, words: str) -> Argument:
    """How many takes are worked on at a time."""
    return argument("--jobs -j N", words, type=checked(Whole(1, most), "--jobs"))


def _kinds(text: str) -> tuple[str, ...] | None:
    """The kinds of evidence; None for an empty text, which farms pass for a setting that is not filled in."""
    kinds = [kind.strip().replace("-", "_") for kind in text.split(",")]
    return conversion_settings.KINDS.read(kinds, WHERE, "--evidence") if text else None


def _name_in_take(text: str) -> Path | None:
    valid = "the name that the file has in every take, as in keypoints.json"
    name: Path | None = relative_path(valid).read(text, WHERE, "--keypoints") if text else None
    return name


def _frames(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(-?\d{1,9})-(-?\d{1,9})", text.strip(), re.ASCII)
    value: Any = text if found is None else [int(number) for number in found.groups()]
    read: tuple[int, int] = conversion_settings.SHOT.read(value, WHERE, "--frames")
    return read


def setting_options(*names: str, condition: str = "", **changes: dict[str, Any]) -> tuple[Argument, ...]:
    """The options of settings of a conversion; `changes` are those of an option."""
    made = []
    for name in names:
        usage, settings = SETTINGS[name]
        settings = settings | changes.get(name, {})
        made.append(field_option(ConversionSettings, name, usage, condition, **settings))
    return tuple(made)


SETTINGS: dict[str, tuple[str, dict[str, Any]]] = {
    "keyframes": ("--keyframes FILE|auto", {}),
    "keypoints": ("--keypoints FILE", {"type": Path, "action": "append"}),
    "network": ("--network FILE.onnx", {"type": Path}),
    "reference": ("--reference FILE", {"type": Path}),
    "subject": ("--subject NAME", {}),
    "shot": ("--frames FIRST-LAST", {"type": _frames}),
    "performer": ("--performer N", {}),
    "evidence": (f"--evidence {','.join(EVIDENCE)}", {"type": _kinds}),
    "library": ("--library NAME|FILE|auto", {}),
    "floor_m": ("--floor HEIGHT", {}),
    "method": ("--method", {}),
}
"""Option of each setting, and what it does not take from the declaration."""
PICTURES = argument("--no-report", "draw no pictures", dest="pictures", action="store_false", default=None)
HANDS = argument(
    "--no-hands",
    "do not look at hands: palms face naturally",
    dest="hands",
    action="store_false",
    default=None,
)
SHOOT_OPTIONS = setting_options(
    *("keypoints", "network", "evidence", "keyframes", "library", "floor_m", "method"),
    condition="; counts where nothing in SHOOT says it",
    keypoints={"metavar": "NAME", "type": _name_in_take},
    keyframes={"metavar": EVERY_LIBRARY, "choices": (EVERY_LIBRARY, "")},
)
"""For takes whose shoot does not say it; a keyframe file is a take's own."""
RETARGET_OPTIONS = (
    argument(
        "--limbs",
        "controls of arms and legs that are keyed; both, the default, shows IK. A limb without IK "
        "controls is keyed in FK",
        choices=tuple(map(str, conversion_settings.LimbKeys)),
    ),
    *(
        field_option(
            RetargetOptions,
            name,
            "--tolerance MM|none" if name == "tolerance_mm" else f"--{name.replace('_', '-')}",
        )
        for name in declared(RetargetOptions)
    ),
)
"""How a motion is put onto a character."""
MAP = argument(
    "--map TITLE|FILE|auto|none",
    "character map, by title or file; auto, the default: a saved one that knows the character's bones, "
    "else recognition; none: recognition",
    default="auto",
)


def character_options(*, required: bool = False) -> tuple[Argument, ...]:
    """The character that gets the motion, its map, and how the motion is put onto it."""
    named = argument("--character -c FILE[:OBJECT]", CHARACTER_HELP, required=required)
    return (named, MAP, *RETARGET_OPTIONS)


def character_settings(arguments: argparse.Namespace) -> CharacterSettings | None:
    """The character of the command line, None where it names none, and how the motion is put onto it."""
    if arguments.character is None:
        return None
    file = CharacterFile.parse(arguments.character)
    values = {name: getattr(arguments, name) for name in declared(RetargetOptions)}
    for limbs in ("arms", "legs"):
        values[limbs] = values[limbs] or arguments.limbs
    options = RetargetOptions.from_json(values, WHERE)
    return CharacterSettings(file=file.path, object=file.object, map=arguments.map, **vars(options))


def given_settings(arguments: argparse.Namespace) -> ConversionSettings:
    """What the command line says of a conversion; None for what it leaves out, or is empty."""
    values = {name: vars(arguments).get(name) or None for name in declared(ConversionSettings)}
    keyframes, library = values["keyframes"], values["library"]
    if keyframes == EVERY_LIBRARY and library not in (None, EVERY_LIBRARY):
        raise UsageError(
            f"--keyframes {keyframes} finds keyframes with all libraries, --library {library} with one; give "
            "one of them"
        )
    if keyframes == EVERY_LIBRARY:
        values |= {"keyframes": None, "library": EVERY_LIBRARY}
    elif keyframes is not None:
        values["keyframes"] = Path(keyframes)
    return ConversionSettings(
        **values
        | {
            "floor_m": vars(arguments).get("floor_m"),
            "pictures": vars(arguments).get("pictures"),
            "hands": vars(arguments).get("hands"),
            "character": character_settings(arguments) if values["character"] else None,
            "keypoints": tuple(filter(None, values["keypoints"] or ())) or None,
        }
    )
