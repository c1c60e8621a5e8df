"""Keyframe libraries as pose assets: an Action of one frame for each posture, and back without loss.

Each Action stores what its curves cannot, as text in two custom properties: the library's header, and its own
posture to the last digit. So a library can be restored from its Actions alone, in any file. An animator's
changes of an asset's curves, name and tags take precedence over the text.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from typing import Any

import bpy

from ....core.body.actor import Actor
from ....core.body.kinematics import Body
from ....core.errors import InputError
from ....core.files.json_file import parse_json
from ....core.prior.library import Library, LibraryPosture
from ....core.prior.texts import LONGEST_NAME, LONGEST_TAG, text_fault, unique_name
from ....core.report.mannequin import posture_picture
from ..assets.catalogs import catalog_identifier
from ..assets.marking import AssetDetails, mark_asset
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


def add_assets(library: Library, data: bpy.types.BlendData | None = None) -> list[bpy.types.Action]:
    """Add an Action for each posture, in order, marked as asset, to a file; to the open one by default."""
    made = []
    for order, posture in enumerate(library.postures):
        action = (data or bpy.data).actions.new(posture.name)
        write_posture_curves(action, _body(library), posture.posture)
        _stamp_asset(action, library, posture, order)
        made.append(action)
    return made


def _stamp_asset(action: bpy.types.Action, library: Library, posture: LibraryPosture, order: int) -> None:
    """Write into an Action which posture of which library it is, for people and for `library_from_assets`."""
    details = AssetDetails(
        catalog=catalog_identifier(catalog_of(library, posture)),
        tags=posture.tags,
        author=library.author,
        license=library.license,
        description=library.description,
    )
    mark_asset(action, details, posture_picture(_body(library), posture.posture))
    alone = replace(library, postures=(posture,), motions=()).to_json()["postures"]
    asset = {"name": action.name, "tags": _asset_tags(action)}
    action[POSTURE] = _text({"order": order, "postures": alone, "asset": asset})
    action[HEADER] = _header_text(library)


@lru_cache(maxsize=4)
def _header_text(library: Library) -> str:
    """A library without its postures, as JSON."""
    return _text(replace(library, postures=()).to_json())


def is_posture(action: bpy.types.Action) -> bool:
    """Whether an Action is marked as a library's posture."""
    return isinstance(action.get(HEADER), str) and isinstance(action.get(POSTURE), str)


def read_asset(action: bpy.types.Action) -> LibraryPosture:
    """Read the posture of an Action, the animator's changes included.

    Raises:
        InputError: The Action's properties are not what Keymark writes, or it has no curves of a posture.
    """
    header, own = _fields(action, HEADER), _fields(action, POSTURE)
    where = _where(action)
    library = Library.from_json({**header, "motions": [], "postures": own.get("postures")}, where)
    if len(library.postures) != 1:
        raise InputError(f"{where}: holds {len(library.postures)} postures; a pose asset holds one")
    stored = library.postures[0]
    shown = read_posture_curves(action, _body(library), stored.posture)
    if shown is None:
        raise InputError(f"{where}: none of its curves turns a bone of Keymark's actors")
    asset = own.get("asset")
    known = asset if isinstance(asset, Mapping) else {}
    name, tags = stored.name, stored.tags
    if not _is_named(action, known.get("name")) and not text_fault(action.name.strip(), LONGEST_NAME):
        name = action.name.strip()
    if known.get("tags") != _asset_tags(action):
        tags = tuple(tag for tag in _asset_tags(action) if not text_fault(tag, LONGEST_TAG))
    return LibraryPosture(name, shown, tags)


def library_from_assets(actions: Iterable[bpy.types.Action]) -> tuple[Library, ...]:
    """The libraries that Actions belong to, in order of their first Actions; other Actions are ignored.

    Where headers of one library differ, that of its newest version counts. Motions keep the steps whose
    postures are there.
    """
    return tuple(_merged(members) for members in assets_by_library(actions).values())


def assets_by_library(actions: Iterable[bpy.types.Action]) -> dict[str, list[bpy.types.Action]]:
    """The pose assets of each library, in its order, by its identifier; other Actions are ignored."""
    found: dict[str, list[bpy.types.Action]] = {}
    for action in actions:
        if is_posture(action):
            found.setdefault(str(_fields(action, HEADER).get("identifier")), []).append(action)
    return {identifier: sorted(members, key=_order) for identifier, members in found.items()}


def _merged(actions: Sequence[bpy.types.Action]) -> Library:
    header = max((_fields(action, HEADER) for action in actions), key=_version)
    postures: list[LibraryPosture] = []
    now: dict[str, str] = {}
    for action in actions:
        posture = read_asset(action)
        name = unique_name(posture.name, [other.name for other in postures])
        now.setdefault(_stored_name(action), name)
        postures.append(replace(posture, name=name))
    one = Library.from_json({**header, "motions": [], "postures": _alone(actions[0])}, _where(actions[0]))
    document = replace(one, postures=tuple(postures)).to_json()
    motions = _present_motions(header.get("motions", []), now)
    return Library.from_json({**document, "motions": motions}, f"library {one.identifier!r}")


def _stored_name(action: bpy.types.Action) -> str:
    """The name of a pose asset's posture in the motions of its header."""
    alone = _alone(action)
    first = alone[0] if isinstance(alone, list) and alone else {}
    return str(first.get("name", "")) if isinstance(first, Mapping) else ""


def _present_motions(motions: Any, now: Mapping[str, str]) -> Any:
    """Motions in JSON, reduced to the postures that are there; `now` has their present names by former ones.

    What is not a motion stays, for the reader to refuse.
    """
    if not isinstance(motions, list):
        return motions
    kept = []
    for motion in motions:
        steps = motion.get("steps") if isinstance(motion, Mapping) else None
        if not isinstance(steps, list) or not all(_is_step(step) for step in steps):
            kept.append(motion)
            continue
        left = [{**step, "posture": now[step["posture"]]} for step in steps if step["posture"] in now]
        if not left:
            continue
        begin = left[0]["time_s"]
        left = [{**step, "time_s": step["time_s"] - begin} for step in left]
        kept.append({**motion, "steps": left})
    return kept


def _is_step(step: Any) -> bool:
    usable = isinstance(step, Mapping) and isinstance(step.get("posture"), str)
    return usable and isinstance(step.get("time_s"), int | float)


def _fields(action: bpy.types.Action, name: str) -> dict[str, Any]:
    """The parsed JSON of one of an Action's two properties."""
    text = action.get(name)
    if not isinstance(text, str) or len(text) > LONGEST_TEXT:
        raise InputError(f"{_where(action)}: its property {name} is not what Keymark writes")
    if name == HEADER:
        with suppress(InputError):  # parsed again below, where the sentence names the Action
            return _parsed(text)
    return parse_json(text, f"{_where(action)}: its property {name}")


@lru_cache(maxsize=4)
def _parsed(text: str) -> dict[str, Any]:
    """A JSON object, not to be mutated; cached, as all assets of a library have the same long header."""
    return parse_json(text, "")


def _body(library: Library) -> Body:
    """The library's body; cached by lengths, so that bones and skin are made once."""
    return _body_of(tuple(library.actor.segments_m.items()))


@lru_cache(maxsize=4)
def _body_of(lengths: tuple[tuple[str, float], ...]) -> Body:
    return Body(Actor(dict(lengths)))


def _is_named(action: bpy.types.Action, name: Any) -> bool:
    """Whether an Action still has a name, but for a number that Blender may have added."""
    stem, _, number = action.name.rpartition(".")
    if not isinstance(name, str) or action.name == name:
        return action.name == name
    numbered = len(number) >= 3 and number.isdigit()
    return numbered and (stem == name or (len(stem.encode()) >= CUT_FROM and name.startswith(stem)))


def _alone(action: bpy.types.Action) -> Any:
    return _fields(action, POSTURE).get("postures")


def _order(action: bpy.types.Action) -> float:
    order = _fields(action, POSTURE).get("order")
    return float(order) if isinstance(order, int) else float("inf")


def _version(header: Mapping[str, Any]) -> int:
    version = header.get("version")
    return version if isinstance(version, int) else 0


def _where(action: bpy.types.Action) -> str:
    return f"pose asset {action.name!r}"


def _asset_tags(action: bpy.types.Action) -> list[str]:
    return [tag.name for tag in action.asset_data.tags] if action.asset_data is not None else []


def _text(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False, ensure_ascii=False)
