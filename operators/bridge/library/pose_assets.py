"""Keyframe libraries as pose assets: an Action of one frame for each posture, and back without loss.

Each Action stores what its curves cannot, as text in two custom properties: the library's header, and its own
posture to the last digit. So a library can be restored from its Actions alone, in any file. An animator's
changes of an asset's curves, name and tags take precedence over the text.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import bpy
from bpy.types import Action, BlendData

from ....core.body.actor import Actor
from ....core.body.kinematics import Body
from ....core.errors import InputError
from ....core.files.json_file import parse_json
from ....core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep
from ....core.prior.texts import LONGEST_NAME, LONGEST_TAG, text_fault, unique_name
from ....core.report.mannequin import posture_picture
from ..asset_catalogs import catalog_identifier
from ..assets import AssetDetails, mark_asset
from ..posture_curves import read_posture_curves, write_posture_curves

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
    """The parsed JSON of one of an Action's two properties."""
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
