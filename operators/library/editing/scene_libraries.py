"""The keyframe libraries that are made in a scene: their postures are pose assets, the rest properties."""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

import bpy

from ....core.body.actor import Actor
from ....core.errors import InputError
from ....core.files.json_file import parse_json
from ....core.library.texts import unique_name

if TYPE_CHECKING:
    from ....core.body.actor import Actor
    from ....core.library.library import Library, LibraryMotion, LibraryPosture

SEPARATOR = ", "
NOBODY = "Unknown"
"""Author of a library that says none."""
_silent: list[None] = []
"""Not empty while many properties change, so that pose assets follow once and not at each."""


def find_library_here(scene: bpy.types.Scene) -> bpy.types.PropertyGroup | None:
    """The library that is worked on in a scene; None where there is none."""
    settings = scene.keymark
    count = len(settings.libraries)
    return settings.libraries[min(settings.active_library, count - 1)] if count else None


def library_here(scene: bpy.types.Scene) -> bpy.types.PropertyGroup:
    """The same.

    Raises:
        InputError: There is none.
    """
    library = find_library_here(scene)
    if library is None:
        raise InputError("no keyframe library is made in this file; make a new one, or edit one of the list")
    return library


def active_posture(library: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The posture chosen in a library's list."""
    chosen = library.active_posture
    return library.postures[chosen] if chosen < len(library.postures) else None


def active_motion(library: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The motion chosen in a library's list."""
    chosen = library.active_motion
    return library.motions[chosen] if chosen < len(library.motions) else None


def add_library(
    scene: bpy.types.Scene, library: "Library", actions: Sequence[bpy.types.Action] | None = None
) -> bpy.types.PropertyGroup:
    """Make a library one of the scene's; it becomes the active one.

    Args:
        scene: The scene.
        library: The library.
        actions: The pose assets of its postures, where the file has them already; made by default.
    """
    from ...bridge.library.pose_assets import add_assets

    settings = scene.keymark
    group = settings.libraries.add()
    with _quiet():
        describe(group, library)
        assets = add_assets(library) if actions is None else actions
        for posture, action in zip(library.postures, assets, strict=True):
            add_posture_to(group, posture, action)
        for motion in library.motions:
            add_motion_to(group, motion)
    settings.active_library = len(settings.libraries) - 1
    return group


def describe(group: bpy.types.PropertyGroup, library: "Library") -> None:
    """Let a scene's library say what a library says of itself."""
    group.actor = json.dumps(dict(library.actor.segments_m))
    group.identifier, group.name, group.version = library.identifier, library.title, library.version
    group.author, group.license = library.author, library.license
    group.description, group.tags = library.description, SEPARATOR.join(library.tags)
    group.exact_tags = json.dumps(library.tags)
    group.sources.clear()
    for source in library.sources:
        group.sources.add().text = source


def add_posture_to(
    group: bpy.types.PropertyGroup, posture: "LibraryPosture", action: bpy.types.Action
) -> bpy.types.PropertyGroup:
    """Put a posture at the end of a library's list."""
    entry = group.postures.add()
    entry.tags, entry.exact_tags = SEPARATOR.join(posture.tags), json.dumps(posture.tags)
    entry.named = entry.name = posture.name
    entry.action = action
    return entry


def add_motion_to(group: bpy.types.PropertyGroup, motion: "LibraryMotion") -> bpy.types.PropertyGroup:
    """Put a motion at the end of a library's list."""
    entry = group.motions.add()
    entry.duration_exact = repr(motion.duration_s)
    for name, value in zip(("travel_x", "travel_y", "travel_turn"), motion.travel, strict=True):
        setattr(entry, f"{name}_exact", repr(value))
    for step in motion.steps:
        row = entry.steps.add()
        row.posture, row.time_exact = step.posture, repr(step.time_s)
    entry.cyclic = motion.cyclic
    entry.name = motion.name
    return entry


def library_of(group: bpy.types.PropertyGroup) -> "Library":
    """A scene's library as it is now: what the pose assets show, under what the properties say.

    Postures whose asset has been deleted are left out, and so are the steps that lead to them. A name or tags
    that were given in an asset browser count.

    Raises:
        InputError: Something is missing, or not what a library may hold; the sentence says what.
    """
    from ....core.library.library_file import library_from_json, library_to_json

    there = postures_of(group)
    if not there:
        raise InputError(f"library '{group.name}' has no postures yet; pose the actor and add one")
    library = _said(group, there)
    library_from_json(library_to_json(library), f"library '{group.name}'")  # checks it
    return library


def postures_of(group: bpy.types.PropertyGroup) -> "dict[str, LibraryPosture]":
    """The postures of a scene's library, in order, by the names in its list.

    Raises:
        InputError: An asset is not what Keymark has written.
    """
    from ...bridge.library.pose_assets import read_asset

    found: dict[str, LibraryPosture] = {}
    for entry in group.postures:
        if entry.action is None:
            continue
        posture = read_asset(entry.action)
        name = entry.name if posture.name == entry.named else posture.name
        name = unique_name(name, [other.name for other in found.values()])
        exact = tuple(json.loads(entry.exact_tags or "[]"))
        tags = posture.tags if entry.tags == SEPARATOR.join(exact) else _split(entry.tags)
        found[entry.name] = replace(posture, name=name, tags=tags)
    return found


def draft(group: bpy.types.PropertyGroup) -> "Library":
    """What a scene's library says of itself, unchecked and without postures: it may not be complete yet."""
    return _said(group, {})


def actor_of_library(group: bpy.types.PropertyGroup) -> "Actor":
    """Whom a library's postures were posed on."""
    return Actor(parse_json(group.actor or "{}", f"library '{group.name}': actor"))


def show_again(group: bpy.types.PropertyGroup, drawn: Sequence[bpy.types.PropertyGroup] = ()) -> None:
    """Let every pose asset say its name, its tags, its place and its library as they are now.

    Args:
        group: The library.
        drawn: Postures whose pictures are drawn again too.

    Raises:
        InputError: An asset is not what Keymark has written.
    """
    from ....core.body.kinematics import Body
    from ....core.report.posture_picture import posture_picture
    from ...bridge.library.pose_assets import show_asset

    postures = postures_of(group)
    library = _said(group, postures)
    entries = [entry for entry in group.postures if entry.action is not None]
    body = Body(library.actor)
    with _quiet():
        for order, (entry, posture) in enumerate(zip(entries, postures.values(), strict=True)):
            _rename_steps(group, entry.name, posture.name)
            entry.named = entry.name = posture.name
            entry.tags, entry.exact_tags = SEPARATOR.join(posture.tags), json.dumps(posture.tags)
            entry.action.name = posture.name
            again = any(entry == other for other in drawn)
            picture = posture_picture(body, posture.posture) if again else None
            show_asset(entry.action, library, posture, order, picture)


def details_changed(part: bpy.types.PropertyGroup) -> None:
    """Let the pose assets of a library say what its properties say now, after a part of it was changed.

    Raises:
        InputError: The properties are not what a library may hold.
    """
    from ...bridge.library.pose_assets import header_text, stamp_header

    group = None if _silent else _library_with(part)
    if group is None:
        return
    header = header_text(library_of(group))
    for entry in group.postures:
        if entry.action is not None:
            stamp_header(entry.action, header)


def posture_changed(entry: bpy.types.PropertyGroup) -> None:
    """Let the motions and the pose asset follow a posture's name, which stays unique, and its tags.

    Raises:
        InputError: The asset is not what Keymark has written.
    """
    group = None if _silent else _library_with(entry)
    if group is None or entry.action is None:
        return
    with _quiet():
        others = [other.name for other in group.postures if other != entry]
        entry.name = unique_name(entry.name.strip() or "Posture", others)
        _rename_steps(group, entry.named, entry.name)
    show_again(group)


@contextmanager
def _quiet() -> Iterator[None]:
    _silent.append(None)
    try:
        yield
    finally:
        _silent.pop()


def _library_with(part: bpy.types.PropertyGroup) -> bpy.types.PropertyGroup | None:
    """The scene's library that a part of one belongs to: a motion, a step, a line; None for none."""
    for library in part.id_data.keymark.libraries:
        if part == library or any(part == other for other in _parts(library)):
            return library
    return None


def _rename_steps(group: bpy.types.PropertyGroup, before: str, now: str) -> None:
    if before == now:
        return
    for motion in group.motions:
        for step in motion.steps:
            if step.posture == before:
                step.posture = now


def _said(group: bpy.types.PropertyGroup, postures: "Mapping[str, LibraryPosture]") -> "Library":
    """What a scene's library says of itself, unchecked."""
    from ....core.library.library import Library

    return Library(
        identifier=group.identifier.strip(),
        title=group.name.strip(),
        version=group.version,
        author=group.author.strip() or NOBODY,
        license=group.license.strip(),
        actor=actor_of_library(group),
        postures=tuple(postures.values()),
        motions=tuple(_motions(group, {old: new.name for old, new in postures.items()})),
        description=group.description.strip(),
        sources=tuple(line.text.strip() for line in group.sources if line.text.strip()),
        tags=_tags(group.tags, tuple(json.loads(group.exact_tags or "[]"))),
    )


def _motions(group: bpy.types.PropertyGroup, known: Mapping[str, str]) -> "Iterable[LibraryMotion]":
    from ....core.library.library import LibraryMotion, MotionStep

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
    """Tags from a field with commas between them; as they were where nobody has changed it."""
    return exact if text == SEPARATOR.join(exact) else _split(text)


def _split(text: str) -> tuple[str, ...]:
    return tuple(dict.fromkeys(tag.strip() for tag in text.split(",") if tag.strip()))


def _parts(library: bpy.types.PropertyGroup) -> Iterable[bpy.types.PropertyGroup]:
    yield from library.sources
    yield from library.postures
    for motion in library.motions:
        yield motion
        yield from motion.steps
