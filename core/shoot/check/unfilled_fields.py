"""Unfilled fields of a description: null where a person has still to give a value."""

from collections.abc import Mapping
from typing import Any

from ...files.fields import Fields
from ...files.inherited_fields import PLACED, child_location

_CAMERA = {
    "lens_mm": "the focal length in millimeters",
    "sensor_width_mm": "the sensor's width in millimeters, 36 where lens_mm is that of full frame",
    "height_m": "the camera's height above the floor in meters",
    "tilt_deg": "by how many degrees the camera looked up, negative where it looked down, 0 where level",
    "matrix_world": "where the camera stood, four rows of four numbers; height_m and tilt_deg do as well",
}
_POSES = ("matrix_world", "matrix_world_frames")
_PLACE = (*PLACED, *_POSES)
_COLOR = "three numbers from 0 to 255, as an eyedropper gives them on the marker"
_HEIGHT = "the performer's height in meters"


def find_unfilled_fields(fields: Fields) -> tuple[str, ...]:
    """A sentence on each field of a take that is null and must not be.

    Args:
        fields: The fields of its description.
    """
    sentences = []
    camera = _child(fields, "camera")
    posed = any(camera.has(name) for name in _POSES)
    for name, valid in _CAMERA.items():
        said_otherwise = (name in _PLACE and posed) or (name in _POSES and camera.has("height_m"))
        if name in camera.values and not camera.has(name) and not said_otherwise:
            sentences.append(_sentence(camera, name, valid))
    markers = _child(fields, "markers")
    for name in markers.values:
        marker = _child(markers, name)
        if "color_srgb" in marker.values and not marker.has("color_srgb"):
            sentences.append(_sentence(marker, "color_srgb", _COLOR))
    actor = _child(fields, "actor")
    if "height_m" in actor.values and not actor.has("height_m") and not actor.has("segments_m"):
        sentences.append(_sentence(actor, "height_m", _HEIGHT))
    return tuple(sentences)


def _child(fields: Fields, name: str) -> Fields:
    value: Any = fields.values.get(name)
    values: Mapping[str, Any] = value if isinstance(value, Mapping) else {}
    return Fields(values, child_location(fields.source_of(name), name))


def _sentence(fields: Fields, name: str, valid: str) -> str:
    return f"{fields.source_of(name)}: {name} is still to be filled in: {valid}"
