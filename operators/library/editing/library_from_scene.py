"""Read a scene's library as core's: postures from the pose assets, the rest from the properties."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType

import bpy

from ....core.body.actor import Actor
from ....core.errors import InputError
from ....core.files.json_file import parse_json
from ....core.library.library import Library, LibraryMotion, LibraryPosture, MotionStep
from ....core.library.texts import unique_name
from ...bridge.library.pose_assets import read_asset
from .scene_libraries import TAG_SEPARATOR

NO_POSTURES: Mapping[str, LibraryPosture] = MappingProxyType({})
UNKNOWN_AUTHOR = "Unknown"
"""Author of a library that names none."""


def library_from_scene(group: bpy.types.PropertyGroup) -> Library:
    """A scene's library: the postures that the pose assets show now, with the details of the properties.

    Postures whose asset has been deleted are left out, and so are the steps to them. A name or tags that were
    given in an asset browser count.

    Raises:
        InputError: Something is missing, or not what a library may hold.
    """
    there = postures_from_scene(group)
    if not there:
        raise InputError(
            "library '{library}' has no postures yet; pose the actor and add one", library=group.name
        )
    library = unchecked_library(group, there)
    Library.from_json(library.to_json(), f"library '{group.name}'")  # checks it
    return library


def postures_from_scene(group: bpy.types.PropertyGroup) -> dict[str, LibraryPosture]:
    """Postures of a scene's library, in order, by their names in its list.

    Raises:
        InputError: An asset is not what Keymark has written.
    """
    found: dict[str, LibraryPosture] = {}
    for entry in group.postures:
        if entry.action is None:
            continue
        posture = read_asset(entry.action)
        name = entry.name if posture.name == entry.named else posture.name
        name = unique_name(name, [other.name for other in found.values()])
        exact = tuple(json.loads(entry.exact_tags or "[]"))
        tags = posture.tags if entry.tags == TAG_SEPARATOR.join(exact) else _split(entry.tags)
        found[entry.name] = replace(posture, name=name, tags=tags)
    return found


def actor_of_library(group: bpy.types.PropertyGroup) -> Actor:
    """The actor that a library's postures were posed on."""
    return Actor(parse_json(group.actor or "{}", f"library '{group.name}': actor"))


def unchecked_library(
    group: bpy.types.PropertyGroup, postures: Mapping[str, LibraryPosture] = NO_POSTURES
) -> Library:
    """A scene's library by its properties, which may not be complete yet.

    Args:
        group: The scene's library.
        postures: Its postures by the names in its list; steps to others are left out.
    """
    return Library(
        identifier=group.identifier.strip(),
        title=group.name.strip(),
        version=group.version,
        author=group.author.strip() or UNKNOWN_AUTHOR,
        license=group.license.strip(),
        actor=actor_of_library(group),
        postures=tuple(postures.values()),
        motions=tuple(_motions(group, {old: new.name for old, new in postures.items()})),
        description=group.description.strip(),
        sources=tuple(line.text.strip() for line in group.sources if line.text.strip()),
        tags=_tags(group.tags, tuple(json.loads(group.exact_tags or "[]"))),
    )


def _motions(group: bpy.types.PropertyGroup, known: Mapping[str, str]) -> Iterable[LibraryMotion]:
    for entry in group.motions:
        there = [
            (float(step.time_exact or 0.0), known[step.posture])
            for step in entry.steps
            if step.posture in known
        ]
        if not there:
            continue
        there.sort(key=lambda step: step[0])
        steps = tuple(MotionStep(posture, time_s - there[0][0]) for time_s, posture in there)
        travel = (0.0, 0.0, 0.0)
        if entry.cyclic:
            x, y, turn = entry.travel_x_exact, entry.travel_y_exact, entry.travel_turn_exact
            travel = (float(x or 0.0), float(y or 0.0), float(turn or 0.0))
        duration_s = float(entry.duration_exact or 0.0)
        yield LibraryMotion(entry.name.strip(), steps, duration_s, entry.cyclic, travel)


def _tags(text: str, exact: tuple[str, ...]) -> tuple[str, ...]:
    """Tags from a text field with commas between them; the exact ones where the field is unchanged."""
    return exact if text == TAG_SEPARATOR.join(exact) else _split(text)


def _split(text: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(tag.strip() for tag in text.split(",") if tag.strip()))
