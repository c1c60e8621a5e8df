"""Write the JSON Schemas of records into presets/schemas, from their declarations.

Usage: make_schemas.py, with the Python of the development environment. A field's description is the docstring
below it. Equal sources give equal files.
"""

import ast
import inspect
import re
import sys
from functools import cache, singledispatch
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests")]
from _boot import load_package  # noqa: E402

load_package()

from keymark.core.body.actor import REQUIRED  # noqa: E402
from keymark.core.body.posture_fields import PostureValues  # noqa: E402
from keymark.core.files import records  # noqa: E402
from keymark.core.files.json_layout import format_json  # noqa: E402
from keymark.core.files.number_lists import NumberArray  # noqa: E402
from keymark.core.files.records import Kind, Record, declared  # noqa: E402
from keymark.core.files.safe_path import relative_path  # noqa: E402
from keymark.core.footage.camera_fields import (  # noqa: E402
    FARTHEST_M,
    MOST_DISTORTION,
    CameraFields,
    Distortion,
    Pose,
)
from keymark.core.footage.ignored_region_fields import RegionFields  # noqa: E402
from keymark.core.footage.keypoints.detected_frames import FARTHEST_M as FARTHEST_GUESS_M  # noqa: E402
from keymark.core.footage.keypoints.detected_frames import FARTHEST_PX, MOST_PEOPLE  # noqa: E402
from keymark.core.footage.keypoints.layouts import OWN  # noqa: E402
from keymark.core.footage.keypoints.own_file import NAMES, OwnFile  # noqa: E402
from keymark.core.library.library import Library, LibraryMotion, TravelKind  # noqa: E402
from keymark.core.library.several_libraries import EVERY_LIBRARY  # noqa: E402
from keymark.core.retarget.maps.character_map import CharacterMap, PropertyValue, Turn  # noqa: E402
from keymark.core.retarget.retarget_record import RetargetRecord  # noqa: E402
from keymark.core.review.score import TruthFile  # noqa: E402
from keymark.core.shoot.discovery.take_list import KNOWN_FIELDS  # noqa: E402
from keymark.core.take.character_settings import CharacterFields  # noqa: E402
from keymark.core.take.conversion_record import ConversionRecord  # noqa: E402
from keymark.core.take.conversion_settings import (  # noqa: E402
    EvidenceKinds,
    KeypointFiles,
    SettingsFields,
)
from keymark.core.take.evidence_kinds import DEPTH_HINTS, EVIDENCE, KEYPOINTS  # noqa: E402
from keymark.core.take.keyframe_file import KeyframeFile, KeyframeRow  # noqa: E402
from keymark.core.take.motion_file import Diagnostic, MotionFile  # noqa: E402
from keymark.core.take.shoot_file import SCHEMA_VERSION, SETTING_FIELDS, SHARED_FIELDS  # noqa: E402
from keymark.core.take.take_file import (  # noqa: E402
    ActorFields,
    CameraKind,
    MarkerFields,
    TakeFields,
)

FOLDER = ROOT / "presets" / "schemas"
DRAFT = "https://json-schema.org/draft/2020-12/schema"
RECORDS: dict[str, tuple[type[Record], str]] = {
    "keypoints": (
        OwnFile,
        "Points of the body seen in a clip, frame by frame: Keymark's own file. Files of other programs are "
        "read too, see docs/keypoint_format.md.",
    ),
    "truth": (TruthFile, "truth.json, in test takes: true positions of the thirteen points."),
    "library": (Library, "Named postures and the motions through them; see docs/library_format.md."),
    "character": (
        CharacterMap,
        "Which bones and controls of a character play which role; see docs/character_map_format.md.",
    ),
    "keyframes": (
        KeyframeFile,
        "keyframes.json: posed frames, or frames whose posture was found in the footage.",
    ),
    "motion": (
        MotionFile,
        "motion.json: the motion of one take, for other programs. Lists run over the frames of the clip; "
        "world axes, meters, Z up.",
    ),
    "conversion": (
        ConversionRecord,
        "conversion.json: the record of a finished conversion, its input and its results. It is the last "
        "file written and the first removed.",
    ),
    "retarget": (
        RetargetRecord,
        "retarget.json: the record of a motion on a character: what was recognized, and how good "
        "it came out.",
    ),
}


def _filled(name: str, kind: str) -> dict[str, Any]:
    """The rule that a field is there, and not null."""
    return {"required": [name], "properties": {name: {"type": kind}}}


def _numbers(count: int, limit: float, *types: str) -> dict[str, Any]:
    number = {"type": ["number", *types], "minimum": -limit, "maximum": limit}
    row = {"type": "array", "minItems": count, "maxItems": count, "items": number}
    return {"type": "array", "minItems": 1, "items": row}


_NULL = {"type": "null"}
_PERSON, _GUESS = _numbers(3, FARTHEST_PX), {"anyOf": [_NULL, _numbers(3, FARTHEST_GUESS_M, "null")]}
RULES: dict[type[Record], dict[str, Any]] = {
    OwnFile: {
        "oneOf": [
            {
                **_filled("frames", "array"),
                "properties": {
                    "frames": {"type": "array", "items": {"anyOf": [_NULL, _PERSON]}},
                    "people": _NULL,
                    "world": {"items": _GUESS},
                },
            },
            {
                **_filled("people", "array"),
                "properties": {
                    "frames": _NULL,
                    "people": {
                        "type": "array",
                        "items": {"type": ["array", "null"], "maxItems": MOST_PEOPLE, "items": _PERSON},
                    },
                    "world": {"items": {"anyOf": [_NULL, {"type": "array", "items": _GUESS}]}},
                },
            },
        ],
        "if": {"properties": {"layout": {"const": OWN}}},
        "then": {"required": ["names"], "properties": {"names": {"$ref": "#/$defs/names"}}},
    },
    RegionFields: {
        "oneOf": [
            {
                **_filled("box", "array"),
                "properties": {"box": {"type": "array"}, "stroke": _NULL, "radius_px": _NULL},
            },
            {
                "required": ["stroke", "radius_px"],
                "properties": {"box": _NULL, "stroke": {"type": "array"}, "radius_px": {"type": "number"}},
            },
        ]
    },
    KeyframeRow: {
        "anyOf": [
            {"required": [name], "properties": {name: {"type": "object"}}} for name in ("posture", "points")
        ]
    },
    LibraryMotion: {
        "if": {"properties": {"cyclic": {"const": False}}},
        "then": {"properties": {"travel": {"type": "null"}}},
    },
}
"""What holds between fields, as far as schemas can say it; `mistake` of the record says it all."""

Schema = dict[str, Any]


def schema_of(name: str) -> Schema:
    """The schema of a format."""
    if name in TAKES:
        return TAKES[name]()
    record, description = RECORDS[name]
    defs: dict[str, Schema] = {"names": kind_schema(NAMES, {})} if record is OwnFile else {}
    head = {"$schema": DRAFT, "title": f"Keymark {record.TITLE}", "description": description}
    whole = head | object_schema(record, defs, record.STRICT)
    return whole | ({"$defs": defs} if defs else {})


def take_schema() -> Schema:
    """That of takes: every field may be inherited, and null takes one away."""
    defs: dict[str, Schema] = {}
    properties: dict[str, Schema] = {}
    for record in (TakeFields, SettingsFields):
        properties |= inherited_schema(record, defs)["properties"]
    clip = (
        "The footage: a video, a folder of images or a pattern of numbered ones (img_####.png), relative to the "
        "take's folder and inside it; the default is clip.mp4."
    )
    properties["clip"] = {"description": clip} | or_null(kind_schema(relative_path("a path"), defs))
    camera = {"anyOf": [_filled("matrix_world", "array"), _filled("matrix_world_frames", "array")]}
    camera["anyOf"].append(_filled("height_m", "number"))
    lengths = {"type": "object", "required": list(REQUIRED)}
    segments = {"required": ["segments_m"], "properties": {"segments_m": lengths}}
    needed = {
        "camera": (CameraFields, camera),
        "actor": (ActorFields, {"anyOf": [_filled("height_m", "number"), segments]}),
    }
    filled = whole_schema(TakeFields)
    for name, (record, rule) in needed.items():
        filled["properties"][name] = whole_schema(record) | rule
    marker = {"^(?!//)": whole_schema(MarkerFields)}
    filled["properties"]["markers"] = {"type": ["object", "null"], "patternProperties": marker}
    defs["complete"] = {"title": "A take that inherits nothing", "allOf": [{"$ref": "#"}, filled]}
    told = (
        "take.json, or NAME.take.json beside a clip: one recorded performance. Fields of a shoot.json above may "
        "be omitted; null removes an inherited field. Unknown fields are ignored."
    )
    head = {"$schema": DRAFT, "title": "Keymark take", "description": told, "type": "object"}
    return head | {"properties": properties, "patternProperties": COMMENT, "$defs": defs}


def inherited_schema(record: type[Record], defs: dict[str, Schema]) -> Schema:
    """The schema of an object whose fields may each be inherited, with comments among them."""
    told = docstrings(record)
    named = {
        name: {"description": told[name]} | or_null(_partial(kind_schema(one.kind, defs)))
        for name, one in declared(record).items()
    }
    whole: Schema = {"type": "object", "properties": named, "patternProperties": COMMENT}
    return whole | RULES.get(record, {}) | ({"additionalProperties": False} if record.STRICT else {})


def _partial(schema: Schema) -> Schema:
    """An object of which each field may be inherited."""
    if schema.get("type") not in ("object", ["object", "null"]):
        return schema
    kept = {name: one for name, one in schema.items() if name not in ("required", "propertyNames")}
    others = schema.get("additionalProperties")
    taken_away = {"additionalProperties": or_null(others)} if others else {}
    return kept | taken_away | {"patternProperties": COMMENT}


def whole_schema(record: type[Record]) -> Schema:
    """What a record requires of an object: its required fields, none of them null."""
    names = [name for name, one in declared(record).items() if one.required]
    return {"type": "object", "required": names, "properties": {name: {"not": _NULL} for name in names}}


def shoot_schema() -> Schema:
    """That of shoots, whose fields are those of takes."""
    properties: Schema = {
        "$schema": {"description": "Location of this schema, for editors; not read."},
        "schema_version": {"description": "Version of the file format.", "enum": [SCHEMA_VERSION, None]},
        "root": {"description": "Whether nothing is inherited from folders above.", "type": "boolean"},
        **{name: _of_take(name) for name in (*SHARED_FIELDS, *SETTING_FIELDS)},
        "keyframes": {
            "description": "auto: keyframes of all takes are found in the footage with all libraries; posed "
            "ones of a take stay.",
            "enum": [EVERY_LIBRARY, None],
        },
    }
    told = (
        "shoot.json: shared fields of all takes below its folder. Each take, and each shoot.json nearer to it, "
        "may override them, field by field; null removes an inherited field. Required fields of a take may come "
        "from any file between it and the root."
    )
    return _list_of_fields("Keymark shoot", told, properties)


def takes_schema() -> Schema:
    """That of a line of a list of takes."""
    take = "The take's folder, or the clip, relative to the list's folder and inside it; each take once."
    properties = {name: _of_take(name) for name in KNOWN_FIELDS}
    properties["take"] = {"description": take} | kind_schema(relative_path("a path"), {})
    told = "One line of a list of takes (JSON Lines, .jsonl): a take, and fields that override all files."
    return _list_of_fields("Keymark list of takes: a line", told, properties) | {"required": ["take"]}


def _of_take(name: str) -> Schema:
    return {"$ref": f"take.schema.json#/properties/{name}"}


def _list_of_fields(title: str, description: str, properties: Schema) -> Schema:
    head = {"$schema": DRAFT, "title": title, "description": description, "type": "object"}
    return head | {"properties": properties, "patternProperties": COMMENT, "additionalProperties": False}


COMMENT: Schema = {"^//": {"description": "A comment of any type."}}
TAKES = {"take": take_schema, "shoot": shoot_schema, "takes": takes_schema}
INHERITED = (TakeFields, SettingsFields, CameraFields, CharacterFields, ActorFields, MarkerFields)
"""Records of which each field may come from another file."""


def text_of(name: str) -> str:
    """The schema's file."""
    return format_json(schema_of(name)) + "\n"


def object_schema(record: type[Record], defs: dict[str, Schema], strict: bool) -> Schema:
    """The schema of an object; nested ones go into `defs`."""
    properties: dict[str, Schema] = {}
    if record.SCHEMA:
        properties["schema"] = {"const": record.SCHEMA}
    if record.VERSION:
        properties["schema_version"] = {"const": record.VERSION}
    required = list(properties)
    told = docstrings(record)
    for name, one in declared(record).items():
        value = kind_schema(one.kind, defs)
        properties[name] = {"description": told[name]} | (value if one.required else or_null(value))
        required += [name] * one.required
    whole = {"type": "object", "required": required, "properties": properties} | RULES.get(record, {})
    return whole | ({"additionalProperties": False} if strict else {})


@cache
def docstrings(record: type[Record]) -> dict[str, str]:
    """The docstrings of a record's fields, its bases' included, each in one line."""
    told: dict[str, str] = {}
    for one in reversed(record.__mro__):
        if one in (object, Record) or not issubclass(one, Record):
            continue
        body = ast.parse(inspect.getsource(one)).body[0]
        assert isinstance(body, ast.ClassDef)
        for field, after in zip(body.body, body.body[1:], strict=False):
            if isinstance(field, ast.AnnAssign) and isinstance(after, ast.Expr):
                assert isinstance(field.target, ast.Name) and isinstance(after.value, ast.Constant)
                words = " ".join(str(after.value.value).split()).replace("None", "null")
                told[field.target.id] = re.sub(r"; see `\w+`|`", "", words)
    return told


def or_null(schema: Schema) -> Schema:
    """A schema that null fits too."""
    if not schema:
        return schema
    if "$ref" in schema or "anyOf" in schema:
        return {"anyOf": [{"type": "null"}, schema]}
    if "enum" in schema:
        return schema | {"enum": [*schema["enum"], None]}
    types = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
    return schema | {"type": types if "null" in types else [*types, "null"]}


@singledispatch
def kind_schema(kind: Kind, defs: dict[str, Schema]) -> Schema:
    """The schema of a value."""
    raise TypeError(f"there is no schema of {type(kind).__name__}")


@kind_schema.register
def _(kind: records.Number, defs: dict[str, Schema]) -> Schema:
    return {"type": "number", "minimum": kind.low, "maximum": kind.high}


@kind_schema.register
def _(kind: records.Whole, defs: dict[str, Schema]) -> Schema:
    return {"type": "integer", "minimum": kind.low, "maximum": kind.high}


@kind_schema.register
def _(kind: records.Flag, defs: dict[str, Schema]) -> Schema:
    return {"type": "boolean"}


@kind_schema.register
def _(kind: records.Text, defs: dict[str, Schema]) -> Schema:
    pattern = f"^$|{kind.pattern}" if kind.empty else kind.pattern
    return {"type": "string", "maxLength": kind.longest, "pattern": pattern}


@kind_schema.register
def _(kind: records.Choice, defs: dict[str, Schema]) -> Schema:
    return {"enum": list(kind.names)}


@kind_schema.register
def _(kind: records.Never, defs: dict[str, Schema]) -> Schema:
    return {"type": "null"}


@kind_schema.register
def _(kind: records.Nullable, defs: dict[str, Schema]) -> Schema:
    return or_null(kind_schema(kind.item, defs))


@kind_schema.register
def _(kind: records.Items, defs: dict[str, Schema]) -> Schema:
    counts: Schema = {"type": "array", "minItems": kind.least, "maxItems": kind.most}
    unique = {"uniqueItems": True} if kind.unique else {}
    return counts | unique | {"items": kind_schema(kind.item, defs)}


@kind_schema.register
def _(kind: records.ByName, defs: dict[str, Schema]) -> Schema:
    item = kind_schema(kind.item, defs)
    if kind.names:
        if "$ref" not in item and len(kind.names) > 4:  # once, not for every name
            name = kind.of_what.replace(" ", "_")
            while defs.setdefault(name, item) != item:
                name += "_"
            item = {"$ref": f"#/$defs/{name}"}
        others = {name: kind_schema(other, defs) for name, other in kind.others.items()}
        named: Schema = {name: others.get(name, item) for name in kind.names}
        whole: Schema = {"type": "object", "properties": named}
        whole |= {"additionalProperties": False} if kind.strict else {}
        whole |= {"minProperties": 1} if kind.empty else {}
        return whole | ({"required": list(kind.needs)} if kind.needs else {})
    names = {} if kind.key is None else {"propertyNames": kind_schema(kind.key, defs)}
    return {"type": "object", "maxProperties": kind.most} | names | {"additionalProperties": item}


@kind_schema.register
def _(kind: records.Object, defs: dict[str, Schema]) -> Schema:
    name = kind.record.__name__
    if name not in defs:
        defs[name] = {}  # keeps its place before those within it
        told = {"description": inspect.cleandoc(kind.record.__doc__ or "").split("\n\n")[0]}
        strict = kind.strict or kind.record.STRICT
        inherited = kind.record in INHERITED
        made = inherited_schema(kind.record, defs) if inherited else object_schema(kind.record, defs, strict)
        defs[name] = told | made
    return {"$ref": f"#/$defs/{name}"}


@kind_schema.register
def _(kind: PostureValues, defs: dict[str, Schema]) -> Schema:
    numbers = kind.numbers
    named = {name: kind_schema(number, defs) for name, number in numbers.items()}
    needs = {} if kind.zeros_left_out else {"required": list(numbers)}
    return {"type": "object", "properties": named, "additionalProperties": False} | needs


@kind_schema.register
def _(kind: NumberArray, defs: dict[str, Schema]) -> Schema:
    item: Schema = {"type": "number", "minimum": -kind.limit, "maximum": kind.limit}
    for length in reversed(kind.shape):
        counts = {"minItems": 1} if length < 0 else {"minItems": length, "maxItems": length}
        item = {"type": "array"} | counts | {"items": item}
    return item


@kind_schema.register
def _(kind: Diagnostic, defs: dict[str, Schema]) -> Schema:
    ref = {"$ref": "#/$defs/diagnostic"}
    defs["diagnostic"] = {"type": ["number", "null", "array"], "items": ref}
    return ref


@kind_schema.register
def _(kind: records.Anything, defs: dict[str, Schema]) -> Schema:
    return {}


@kind_schema.register
def _(kind: Pose, defs: dict[str, Schema]) -> Schema:
    return kind_schema(NumberArray((-1, 4, 4) if kind.several else (4, 4), FARTHEST_M), defs)


@kind_schema.register
def _(kind: Distortion, defs: dict[str, Schema]) -> Schema:
    number = kind_schema(records.Number(-MOST_DISTORTION, MOST_DISTORTION), defs)
    named = {"type": "object", "properties": dict.fromkeys(kind.names, number), "patternProperties": COMMENT}
    numbers = {"type": "array", "maxItems": len(kind.names), "items": number}
    return {"anyOf": [numbers, named | {"additionalProperties": False}]}


@kind_schema.register
def _(kind: KeypointFiles, defs: dict[str, Schema]) -> Schema:
    files = kind_schema(kind.paths, defs) | {"uniqueItems": True}
    return {"anyOf": [kind_schema(kind.path, defs), files]}


@kind_schema.register
def _(kind: EvidenceKinds, defs: dict[str, Schema]) -> Schema:
    rule = {
        "if": {"type": "array", "contains": {"const": DEPTH_HINTS}},
        "then": {"contains": {"const": KEYPOINTS}},
    }
    kinds = {"type": "array", "minItems": 1, "uniqueItems": True, "items": {"enum": list(EVIDENCE)}}
    return {"anyOf": [kinds | rule]}


@kind_schema.register
def _(kind: Turn | TravelKind | CameraKind, defs: dict[str, Schema]) -> Schema:
    return kind_schema(kind.like, defs)


@kind_schema.register
def _(kind: PropertyValue, defs: dict[str, Schema]) -> Schema:
    return {"type": ["number", "boolean"], "minimum": -kind.farthest, "maximum": kind.farthest}


def main() -> None:
    """Write all schemas."""
    for name in (*RECORDS, *TAKES):
        (FOLDER / f"{name}.schema.json").write_text(text_of(name), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
