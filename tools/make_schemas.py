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

from keymark.core.body.posture_fields import PostureValues  # noqa: E402
from keymark.core.files import records  # noqa: E402
from keymark.core.files.json_layout import format_json  # noqa: E402
from keymark.core.files.number_lists import NumberArray  # noqa: E402
from keymark.core.files.records import Kind, Record, declared  # noqa: E402
from keymark.core.library.library import Library, LibraryMotion, TravelKind  # noqa: E402
from keymark.core.retarget.maps.character_map import CharacterMap, PropertyValue, Turn  # noqa: E402
from keymark.core.retarget.retarget_record import RetargetRecord  # noqa: E402
from keymark.core.take.conversion_record import ConversionRecord  # noqa: E402
from keymark.core.take.keyframe_file import KeyframeFile, KeyframeRow  # noqa: E402
from keymark.core.take.motion_file import Diagnostic, MotionFile  # noqa: E402

FOLDER = ROOT / "presets" / "schemas"
RECORDS: dict[str, tuple[type[Record], str]] = {
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
RULES: dict[type[Record], dict[str, Any]] = {
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
    record, description = RECORDS[name]
    defs: dict[str, Schema] = {}
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": f"Keymark {record.TITLE}"}
    whole = head | {"description": description} | object_schema(record, defs, record.STRICT)
    return whole | ({"$defs": defs} if defs else {})


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
        defs[name] = told | object_schema(kind.record, defs, kind.strict or kind.record.STRICT)
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
def _(kind: Turn | TravelKind, defs: dict[str, Schema]) -> Schema:
    return kind_schema(kind.like, defs)


@kind_schema.register
def _(kind: PropertyValue, defs: dict[str, Schema]) -> Schema:
    return {"type": ["number", "boolean"], "minimum": -kind.farthest, "maximum": kind.farthest}


def main() -> None:
    """Write all schemas."""
    for name in RECORDS:
        (FOLDER / f"{name}.schema.json").write_text(text_of(name), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
