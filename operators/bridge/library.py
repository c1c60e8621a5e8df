"""Keyframe libraries in Blender: files, poses on an armature, and pose assets."""

import json
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from bpy.types import Action, BlendData, Object, Scene

from ...core.arrays import Array
from ...core.body.actor import Actor
from ...core.body.body_volume import lower_sole_m
from ...core.body.kinematics import Body
from ...core.body.posture import Posture, headings_rad, turned_and_shifted
from ...core.errors import InputError
from ...core.files.json_file import parse_json
from ...core.prior import library as prior_library
from ...core.prior.learning import LibraryMetadata, numbered_names
from ...core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep
from ...core.prior.texts import LONGEST_NAME, LONGEST_TAG, identifier_from, text_fault, unique_name
from ...core.report.mannequin import posture_picture
from .armature import read_body
from .asset_catalogs import catalog_identifier, write_asset_blend
from .assets import AssetDetails, mark_asset
from .blend_files import check_blend, load_blocks
from .keyframes import keyed_frames, read_keyframes
from .pose import read_posture_curves, write_posture_curves

LARGEST_BYTES = 256 * 2**20  # enough for a thousand postures with pictures; a film's scene is refused


def write_library_blend(path: Path, library: Library, root: Path | None = None) -> None:
    """Write a library's pose assets alone into a .blend, and its catalogs into `root` or else beside it."""
    catalogs = [catalog_of(library, posture) for posture in library.postures]
    with bpy.data.temp_data() as data:
        assets = zip(add_assets(library, data), catalogs, strict=True)
        write_asset_blend(path, root or path.parent, data, assets)


def read_library_blend(path: Path) -> tuple[Library, ...]:
    """The libraries whose pose assets a .blend holds; nothing of it stays in the open file.

    Only Actions marked as assets are loaded, and of these only curves and texts are read: scripts, drivers
    and other data are neither loaded nor run. InputError where the file has no library, or is unusable.
    """
    check_blend(path, "a library", LARGEST_BYTES)
    before, names = set(bpy.data.user_map()), []

    def few(there: list[str]) -> list[str]:
        names.extend(there)
        return there if len(there) <= prior_library.MOST_POSTURES else []

    try:
        actions = load_blocks(path, "actions", "it may be damaged or cut off", few, assets_only=True)
        if len(names) > prior_library.MOST_POSTURES:
            raise InputError(
                f"{path}: holds {len(names)} Actions marked as assets; at most "
                f"{prior_library.MOST_POSTURES} are read"
            )
        libraries = library_from_assets(actions)
    finally:
        bpy.data.batch_remove(set(bpy.data.user_map()) - before)
    if not libraries:
        raise InputError(
            f"{path}: holds no pose assets of a keyframe library; export one with Keymark, as .blend or .json"
        )
    return libraries


def read_libraries(path: Path) -> tuple[Library, ...]:
    """The libraries of a file: one in a .json, one or more in a .blend; InputError for another."""
    suffix = path.suffix.lower()
    if suffix == ".blend":
        return read_library_blend(path)
    if suffix == ".json":
        return (prior_library.read_library(path),)
    raise InputError(f"{path}: is neither a .json nor a .blend; libraries are kept in these")


def library_of_keyframes(
    scene: Scene, armature_object: Object, action: Action, about: LibraryMetadata
) -> Library:
    """The keyframes of an Action, of which there must be two, as postures and a motion through them."""
    body = read_body(armature_object)
    frames = np.array(keyed_frames(armature_object, action))
    if len(frames) < 2:
        raise InputError(f"the take has {len(frames)} keyframes; a library needs two or more")
    posed = read_keyframes(scene, armature_object, action, body, frames).keyframes
    postures = _leveled(body, Posture.stack([keyframe.posture for keyframe in posed]))
    names = numbered_names(about.title, len(posed))
    time_s: Array = (frames - frames[0]) * scene.render.fps_base / scene.render.fps
    steps = tuple(MotionStep(name, round(float(at), 4)) for name, at in zip(names, time_s, strict=True))
    entries = tuple(LibraryPosture(name, postures[row]) for row, name in enumerate(names))
    motion = LibraryMotion(about.title, steps, steps[-1].time_s)
    return checked(replace(_empty(body, about), postures=entries, motions=(motion,)))


def library_of_assets(
    actions: Iterable[Action], armature_object: Object | None, about: LibraryMetadata, identifier: str
) -> Library:
    """The library of pose assets, with an actor's own of one frame; a new one is `about`, or InputError."""
    local = [action for action in actions if action.library is None]
    found = {library.identifier: library for library in library_from_assets(local)}
    if len(found) > 1 and identifier not in found:
        there = ", ".join(found)
        raise InputError(f"this file has the pose assets of {there}; choose one of these in the list")
    library = found.get(identifier) or next(iter(found.values()), None)
    loose: list[tuple[str, Body, Posture]] = []
    if armature_object is not None:
        body = read_body(armature_object)
        for action in local:
            first, last = action.curve_frame_range
            if action.asset_data is not None and not is_posture(action) and first == last:
                posture = read_posture_curves(action, body)
                if posture is not None:
                    loose.append((action.name, body, _leveled(body, Posture.stack([posture]))[0]))
    if library is None:
        if not loose:
            raise InputError("this file has no pose assets of a library, and none of the take's actor")
        library = _empty(loose[0][1], about)
    entries = list(library.postures)
    for name, body, posture in loose:
        fitted = prior_library.transferred(posture, body.actor, Body(library.actor))
        entries.append(LibraryPosture(unique_name(name, [entry.name for entry in entries]), fitted))
    return checked(replace(library, postures=tuple(entries)))


def _leveled(body: Body, postures: Posture) -> Posture:
    """Postures (F,) of one performance, the first above the origin facing -Y, the lowest sole at z = 0."""
    turned = turned_and_shifted(postures, -headings_rad(postures[:1])[0], np.zeros(3))
    offset = turned.translation[0] * [-1.0, -1.0, 0.0]
    offset[2] = -lower_sole_m(body, turned).min()
    return turned_and_shifted(turned, np.zeros(1), offset)


def _empty(body: Body, about: LibraryMetadata) -> Library:
    identifier = about.identifier or identifier_from(about.title)
    return Library(identifier, about.title, 1, about.author, about.license, body.actor, ())


def checked(library: Library) -> Library:
    """The library, which is what a file may hold: names are typed by people."""
    Library.from_json(library.to_json(), f"library '{library.title}'")
    return library


# --- Keyframe libraries as pose assets: an Action of one frame for each posture, and back without loss


HEADER, POSTURE = "keymark_library", "keymark_posture"
"""Custom properties of an Action: header of the library, and the posture."""
CATALOGS = "Keymark"  # parent of the catalogs of all libraries
CUT_FROM = 55  # length in bytes from which Blender 4.5 may have cut a name to make room for a number
LONGEST_TEXT = 2_000_000  # characters of a custom property; longer ones are not read


def catalog_of(library: Library, posture: LibraryPosture) -> str:
    """Catalog path of a posture: its library's, and below it its first motion's where there are several."""
    of_it = [m.name for m in library.motions if any(step.posture == posture.name for step in m.steps)]
    names = [library.title, *(of_it[:1] if len(library.motions) > 1 else [])]
    # Slashes and colons have a meaning in catalog paths.
    return "/".join([CATALOGS, *("".join("-" if a in ":/\\" else a for a in name) for name in names)])


def add_assets(library: Library, data: BlendData | None = None) -> list[Action]:
    """Add an Action for each posture, in order, marked as asset, to a file; to the open one by default."""
    made, body = [], _body(tuple(library.actor.segments_m.items()))
    header = _text(replace(library, postures=()).to_json())
    for order, posture in enumerate(library.postures):
        action = (data or bpy.data).actions.new(posture.name)
        write_posture_curves(action, body, posture.posture)
        details = AssetDetails(
            catalog=catalog_identifier(catalog_of(library, posture)),
            tags=posture.tags,
            author=library.author,
            license=library.license,
            description=library.description,
        )
        mark_asset(action, details, posture_picture(body, posture.posture))
        alone = replace(library, postures=(posture,), motions=()).to_json()["postures"]
        asset = {"name": action.name, "tags": _asset_tags(action)}
        action[POSTURE] = _text({"order": order, "postures": alone, "asset": asset})
        action[HEADER] = header
        made.append(action)
    return made


def is_posture(action: Action) -> bool:
    """Whether an Action is marked as a library's posture."""
    return isinstance(action.get(HEADER), str) and isinstance(action.get(POSTURE), str)


@dataclass(frozen=True, eq=False)
class PoseAsset:
    """An Action of a library's posture with the texts that it stores."""

    action: Action
    header: dict[str, Any]  # the library's, not to be mutated
    own: dict[str, Any]

    @classmethod
    def of(cls, action: Action) -> "PoseAsset":
        """Parse the texts of an Action; InputError where they are not what Keymark writes."""
        return cls(action, _fields(action, HEADER), _fields(action, POSTURE))

    @property
    def order(self) -> float:
        """Its place in the library."""
        order = self.own.get("order")
        return float(order) if isinstance(order, int) else float("inf")

    def library(self) -> Library:
        """The library of this posture alone, as stored, without motions."""
        fields = {**self.header, "motions": [], "postures": self.own.get("postures")}
        return Library.from_json(fields, _where(self.action))

    def posture(self) -> LibraryPosture:
        """The posture, the animator's changes included; InputError where it has none, or other texts."""
        library, where = self.library(), _where(self.action)
        if len(library.postures) != 1:
            raise InputError(f"{where}: holds {len(library.postures)} postures; a pose asset holds one")
        stored = library.postures[0]
        body = _body(tuple(library.actor.segments_m.items()))
        shown = read_posture_curves(self.action, body, stored.posture)
        if shown is None:
            raise InputError(f"{where}: none of its curves turns a bone of Keymark's actors")
        asset = self.own.get("asset")
        known = asset if isinstance(asset, Mapping) else {}
        name, tags, now = stored.name, stored.tags, self.action.name.strip()
        if not _is_named(self.action, known.get("name")) and not text_fault(now, LONGEST_NAME):
            name = now
        if known.get("tags") != _asset_tags(self.action):
            tags = tuple(tag for tag in _asset_tags(self.action) if not text_fault(tag, LONGEST_TAG))
        return LibraryPosture(name, shown, tags)


def library_from_assets(actions: Iterable[Action]) -> tuple[Library, ...]:
    """The libraries that Actions belong to, by the headers of their newest versions; others are ignored."""
    return tuple(_merged(members) for members in assets_by_library(actions).values())


def assets_by_library(actions: Iterable[Action]) -> dict[str, list[PoseAsset]]:
    """The pose assets of each library, in its order, by its identifier; other Actions are ignored."""
    found: dict[str, list[PoseAsset]] = {}
    for asset in (PoseAsset.of(action) for action in actions if is_posture(action)):
        found.setdefault(str(asset.header.get("identifier")), []).append(asset)
    return {name: sorted(members, key=lambda asset: asset.order) for name, members in found.items()}


def _merged(assets: Sequence[PoseAsset]) -> Library:
    """The library of pose assets; its motions keep the steps whose postures are there."""
    versions = [asset.header.get("version") for asset in assets]
    known = [version if isinstance(version, int) else 0 for version in versions]
    newest = replace(assets[0], header=assets[known.index(max(known))].header)
    postures: list[LibraryPosture] = []
    now: dict[str, str] = {}  # names of postures by those in the motions
    for asset in assets:
        posture = asset.posture()
        name = unique_name(posture.name, [other.name for other in postures])
        now.setdefault(str(asset.own["postures"][0]["name"]), name)
        postures.append(replace(posture, name=name))
    header, motions = newest.library(), newest.header.get("motions") or []
    where, kept = f"library {header.identifier!r}", []
    for index, value in enumerate(motions if isinstance(motions, list) else [motions]):
        motion = LibraryMotion.from_json(value, f"{where}: motions[{index}]")
        there = [step for step in motion.steps if step.posture in now]
        steps = [MotionStep(now[step.posture], step.time_s - there[0].time_s) for step in there]
        kept += [replace(motion, steps=tuple(steps))] if steps else []
    merged = replace(header, postures=tuple(postures), motions=tuple(kept))
    return Library.from_json(merged.to_json(), where)


def _fields(action: Action, name: str) -> dict[str, Any]:
    text, where = action.get(name), f"{_where(action)}: its property {name}"
    if not isinstance(text, str) or len(text) > LONGEST_TEXT:
        raise InputError(f"{where} is not what Keymark writes")
    if name == HEADER:
        with suppress(InputError):  # parsed again below, where the sentence names the Action
            return _parsed(text)
    return parse_json(text, where)


@lru_cache(maxsize=4)
def _parsed(text: str) -> dict[str, Any]:
    """A JSON object, not to be mutated; cached, as all assets of a library have the same long header."""
    return parse_json(text, "")


@lru_cache(maxsize=4)
def _body(lengths: tuple[tuple[str, float], ...]) -> Body:
    """The body of these lengths; cached, so that bones and skin are made once."""
    return Body(Actor(dict(lengths)))


def _is_named(action: Action, name: Any) -> bool:
    """Whether an Action still has a name, but for a number that Blender may have added."""
    stem, _, number = action.name.rpartition(".")
    if not isinstance(name, str) or action.name == name:
        return action.name == name
    numbered = len(number) >= 3 and number.isdigit()
    return numbered and (stem == name or (len(stem.encode()) >= CUT_FROM and name.startswith(stem)))


def _where(action: Action) -> str:
    return f"pose asset {action.name!r}"


def _asset_tags(action: Action) -> list[str]:
    return [tag.name for tag in action.asset_data.tags] if action.asset_data is not None else []


def _text(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False, ensure_ascii=False)
