"""Write the JSON Schemas of records into presets/schemas, from their declarations.

Usage: make_schemas.py, with the Python of the development environment. A field's description is the docstring
below it. Equal sources give equal files.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(Path(__file__).resolve().parent)]
from _boot import load_package  # noqa: E402

load_package()

from keymark.core.body.actor import REQUIRED  # noqa: E402
from keymark.core.camera.camera_fields import CameraFields  # noqa: E402
from keymark.core.detect.keypoint_file import NAMES, OwnFile  # noqa: E402
from keymark.core.files.json_file import format_json  # noqa: E402
from keymark.core.files.kinds import relative_path  # noqa: E402
from keymark.core.files.records import Record, declared  # noqa: E402
from keymark.core.prior.library import Library  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.retarget.maps.character_map import CharacterMap  # noqa: E402
from keymark.core.retarget.retarget_record import RetargetRecord  # noqa: E402
from keymark.core.review.score import TruthFile  # noqa: E402
from keymark.core.shoot.discovery import KNOWN_FIELDS  # noqa: E402
from keymark.core.take.conversion_record import ConversionRecord  # noqa: E402
from keymark.core.take.conversion_settings import ConversionSettings  # noqa: E402
from keymark.core.take.description import SCHEMA_VERSION, SETTING_FIELDS, SHARED_FIELDS  # noqa: E402
from keymark.core.take.evidence import DEPTH_HINTS, KEYPOINTS  # noqa: E402
from keymark.core.take.keyframe_file import KeyframeFile  # noqa: E402
from keymark.core.take.motion import MotionFile  # noqa: E402
from keymark.core.take.take_file import ActorFields, MarkerFields, TakeFields  # noqa: E402
from schemas.kinds import COMMENT, NULL, Schema, filled, inherited_schema, kind_schema, object_schema, or_null  # noqa: E402

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
    for record in (TakeFields, ConversionSettings):
        properties |= inherited_schema(record, defs)["properties"]
    properties["evidence"] |= {
        "if": {"type": "array", "contains": {"const": DEPTH_HINTS}},
        "then": {"contains": {"const": KEYPOINTS}},
    }
    clip = (
        "The footage: a video, a folder of images or a pattern of numbered ones (img_####.png), relative to "
        "the take's folder and inside it; the default is clip.mp4."
    )
    properties["clip"] = {"description": clip} | or_null(kind_schema(relative_path("a path"), defs))
    camera = {"anyOf": [filled("matrix_world", "array"), filled("matrix_world_frames", "array")]}
    camera["anyOf"].append(filled("height_m", "number"))
    lengths = {"type": "object", "required": list(REQUIRED)}
    segments = {"required": ["segments_m"], "properties": {"segments_m": lengths}}
    needed = {
        "camera": (CameraFields, camera),
        "actor": (ActorFields, {"anyOf": [filled("height_m", "number"), segments]}),
    }
    complete = whole_schema(TakeFields)
    for name, (record, rule) in needed.items():
        complete["properties"][name] = whole_schema(record) | rule
    marker = {"^(?!//)": whole_schema(MarkerFields)}
    complete["properties"]["markers"] = {"type": ["object", "null"], "patternProperties": marker}
    defs["complete"] = {"title": "A take that inherits nothing", "allOf": [{"$ref": "#"}, complete]}
    told = (
        "take.json, or NAME.take.json beside a clip: one recorded performance. Fields of a shoot.json above "
        "may be omitted; null removes an inherited field. Unknown fields are ignored."
    )
    head = {"$schema": DRAFT, "title": "Keymark take", "description": told, "type": "object"}
    return head | {"properties": properties, "patternProperties": COMMENT, "$defs": defs}


def whole_schema(record: type[Record]) -> Schema:
    """What a record requires of an object: its required fields, none of them null."""
    names = [name for name, one in declared(record).items() if one.required]
    return {"type": "object", "required": names, "properties": {name: {"not": NULL} for name in names}}


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
        "shoot.json: shared fields of all takes below its folder. Each take, and each shoot.json nearer "
        "to it, may override them, field by field; null removes an inherited field. Required fields of a "
        "take may come from any file between it and the root."
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


TAKES = {"take": take_schema, "shoot": shoot_schema, "takes": takes_schema}


def text_of(name: str) -> str:
    """The schema's file."""
    return format_json(schema_of(name)) + "\n"


def main() -> None:
    """Write all schemas."""
    for name in (*RECORDS, *TAKES):
        (FOLDER / f"{name}.schema.json").write_text(text_of(name), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
