"""JSON Schemas of records and of kinds of values, from their declarations."""

import inspect
import re
from functools import singledispatch
from typing import Any

from keymark.core.body.posture import PostureValues
from keymark.core.camera.camera_fields import FARTHEST_M, MOST_DISTORTION, CameraFields, Distortion, Pose
from keymark.core.detect.detected_frames import FARTHEST_M as FARTHEST_GUESS_M
from keymark.core.detect.detected_frames import FARTHEST_PX, MOST_PEOPLE
from keymark.core.detect.keypoint_file import OwnFile
from keymark.core.detect.keypoints import FACE_NUMBERS, HAND_NUMBERS
from keymark.core.detect.layouts import OWN
from keymark.core.files import kinds, records
from keymark.core.files.kinds import Kind, NumberArray
from keymark.core.files.records import Record, declared, descriptions
from keymark.core.markers.ignored_regions import IgnoredRegion
from keymark.core.prior.library import LibraryMotion, TravelKind
from keymark.core.retarget.maps.character_map import PropertyValue, Turn
from keymark.core.take.conversion_settings import (
    CharacterSettings,
    ConversionSettings,
    KeypointFiles,
)
from keymark.core.take.keyframe_file import KeyframeRow
from keymark.core.take.motion import Diagnostic
from keymark.core.take.take_file import ActorFields, CameraKind, MarkerFields, TakeFields

Schema = dict[str, Any]


COMMENT: Schema = {"^//": {"description": "A comment of any type."}}

INHERITED = (TakeFields, ConversionSettings, CameraFields, CharacterSettings, ActorFields, MarkerFields)
"""Records of which each field may come from another file."""


def filled(name: str, kind: str) -> dict[str, Any]:
    """The rule that a field is there, and not null."""
    return {"required": [name], "properties": {name: {"type": kind}}}


def _numbers(count: int, limit: float, *types: str) -> dict[str, Any]:
    number = {"type": ["number", *types], "minimum": -limit, "maximum": limit}
    row = {"type": "array", "minItems": count, "maxItems": count, "items": number}
    return {"type": "array", "minItems": 1, "items": row}


NULL = {"type": "null"}
_PERSON, _GUESS = _numbers(3, FARTHEST_PX), {"anyOf": [NULL, _numbers(3, FARTHEST_GUESS_M, "null")]}
_FACE = {"anyOf": [NULL, _numbers(FACE_NUMBERS, FARTHEST_PX, "null")["items"]]}
_HANDS = {"anyOf": [NULL, _numbers(HAND_NUMBERS, FARTHEST_PX, "null") | {"minItems": 2, "maxItems": 2}]}
RULES: dict[type[Record], dict[str, Any]] = {
    OwnFile: {
        "oneOf": [
            {
                **filled("frames", "array"),
                "properties": {
                    "frames": {"type": "array", "items": {"anyOf": [NULL, _PERSON]}},
                    "people": NULL,
                    "world": {"items": _GUESS},
                    "face": {"items": _FACE},
                    "hands": {"items": _HANDS},
                },
            },
            {
                **filled("people", "array"),
                "properties": {
                    "frames": NULL,
                    "people": {
                        "type": "array",
                        "items": {"type": ["array", "null"], "maxItems": MOST_PEOPLE, "items": _PERSON},
                    },
                    "world": {"items": {"anyOf": [NULL, {"type": "array", "items": _GUESS}]}},
                    "face": {"items": {"anyOf": [NULL, {"type": "array", "items": _FACE}]}},
                    "hands": {"items": {"anyOf": [NULL, {"type": "array", "items": _HANDS}]}},
                },
            },
        ],
        "if": {"properties": {"layout": {"const": OWN}}},
        "then": {"required": ["names"], "properties": {"names": {"$ref": "#/$defs/names"}}},
    },
    IgnoredRegion: {
        "oneOf": [
            {
                **filled("box", "array"),
                "properties": {"box": {"type": "array"}, "stroke": NULL, "radius_px": NULL},
            },
            {
                "required": ["stroke", "radius_px"],
                "properties": {"box": NULL, "stroke": {"type": "array"}, "radius_px": {"type": "number"}},
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


def docstrings(record: type[Record]) -> dict[str, str]:
    """The docstrings of a record's fields as descriptions of JSON."""
    words = descriptions(record).items()
    return {name: re.sub(r"; see `\w+`|`", "", text.replace("None", "null")) for name, text in words}


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
def _(kind: kinds.Number, defs: dict[str, Schema]) -> Schema:
    return {"type": "number", "minimum": kind.low, "maximum": kind.high}


@kind_schema.register
def _(kind: kinds.Whole, defs: dict[str, Schema]) -> Schema:
    return {"type": "integer", "minimum": kind.low, "maximum": kind.high}


@kind_schema.register
def _(kind: kinds.Flag, defs: dict[str, Schema]) -> Schema:
    return {"type": "boolean"}


@kind_schema.register
def _(kind: kinds.Text, defs: dict[str, Schema]) -> Schema:
    pattern = f"^$|{kind.pattern}" if kind.empty else kind.pattern
    return {"type": "string", "maxLength": kind.longest, "pattern": pattern}


@kind_schema.register
def _(kind: kinds.Choice, defs: dict[str, Schema]) -> Schema:
    return {"enum": list(kind.names)}


@kind_schema.register
def _(kind: kinds.Never, defs: dict[str, Schema]) -> Schema:
    return {"type": "null"}


@kind_schema.register
def _(kind: kinds.Nullable, defs: dict[str, Schema]) -> Schema:
    return or_null(kind_schema(kind.item, defs))


@kind_schema.register
def _(kind: kinds.Items, defs: dict[str, Schema]) -> Schema:
    counts: Schema = {"type": "array", "minItems": kind.least, "maxItems": kind.most}
    unique = {"uniqueItems": True} if kind.unique else {}
    return counts | unique | {"items": kind_schema(kind.item, defs)}


@kind_schema.register
def _(kind: kinds.ByName, defs: dict[str, Schema]) -> Schema:
    item = kind_schema(kind.item, defs)
    if kind.names:
        if "$ref" not in item and len(kind.names) > 4:  # once, not for every name
            name = kind.of_what.replace(" ", "_")
            while defs.setdefault(name, item) != item:
                name += "_"
            item = {"$ref": f"#/$defs/{name}"}
        others = {name: kind_schema(other, defs) for name, other in kind.exceptions.items()}
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
    for axis, length in reversed(list(enumerate(kind.shape))):
        if kind.null_rows and axis == 0:
            item = {"anyOf": [item, {"type": "null"}]}
        counts = {"minItems": 1} if length < 0 else {"minItems": length, "maxItems": length}
        item = {"type": "array"} | counts | {"items": item}
    return item


@kind_schema.register
def _(kind: Diagnostic, defs: dict[str, Schema]) -> Schema:
    ref = {"$ref": "#/$defs/diagnostic"}
    defs["diagnostic"] = {"type": ["number", "null", "array"], "items": ref}
    return ref


@kind_schema.register
def _(kind: kinds.Anything, defs: dict[str, Schema]) -> Schema:
    return {}


@kind_schema.register
def _(kind: Pose, defs: dict[str, Schema]) -> Schema:
    return kind_schema(NumberArray((-1, 4, 4) if kind.several else (4, 4), FARTHEST_M), defs)


@kind_schema.register
def _(kind: Distortion, defs: dict[str, Schema]) -> Schema:
    number = kind_schema(kinds.Number(-MOST_DISTORTION, MOST_DISTORTION), defs)
    named = {"type": "object", "properties": dict.fromkeys(kind.names, number), "patternProperties": COMMENT}
    numbers = {"type": "array", "maxItems": len(kind.names), "items": number}
    return {"anyOf": [numbers, named | {"additionalProperties": False}]}


@kind_schema.register
def _(kind: KeypointFiles, defs: dict[str, Schema]) -> Schema:
    files = kind_schema(kind.paths, defs) | {"uniqueItems": True}
    return {"anyOf": [kind_schema(kind.path, defs), files]}


@kind_schema.register
def _(kind: Turn | TravelKind | CameraKind, defs: dict[str, Schema]) -> Schema:
    return kind_schema(kind.like, defs)


@kind_schema.register
def _(kind: PropertyValue, defs: dict[str, Schema]) -> Schema:
    return {"type": ["number", "boolean"], "minimum": -kind.farthest, "maximum": kind.farthest}
