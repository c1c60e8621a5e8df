"""What files say of a take: its own, and every `shoot.json` above, whose fields it inherits."""

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from stat import S_ISDIR, S_ISREG
from typing import Any

from ..errors import InputError, shown
from ..files.fields import COMMENT_PREFIX, Fields, InheritedFields
from ..files.json_file import read_json
from ..files.kinds import safe_path
from ..files.paths import absolute_path, check_symlinks
from ..files.records import check_version, declared
from ..prior.texts import EVERY_LIBRARY
from ..video.image_sequence import is_image
from .conversion_settings import NO_SETTINGS, ConversionSettings, read_settings, with_auto_as_library
from .evidence import KEYPOINTS

SHOOT_FILE = "shoot.json"
SCHEMA_VERSION = 1
LARGEST_BYTES = 2**20
SHARED_FIELDS = ("fps", "frame_start", "camera", "markers", "ignored_regions", "actor")
ASSUMED = "(assumed)"
"""Location of fields that nobody has said, for sentences."""
FILE_FIELDS = ("$schema", "schema_version", "root")
"""Fields about the file itself; editors read the first."""
KEYFRAMES = "keyframes"
"""Field of `take.json` that may say `EVERY_LIBRARY` here, and nothing else."""
SETTING_FIELDS = tuple(name for name in declared(ConversionSettings) if name != KEYFRAMES)
KNOWN_FIELDS = (*FILE_FIELDS, *SHARED_FIELDS, KEYFRAMES, *SETTING_FIELDS)


def shoot_fields(path: Path, values: dict[str, Any]) -> dict[str, Any]:
    """The fields of one `shoot.json` that takes inherit; their values are checked where a take uses them."""
    fields = Fields(values, str(path))
    fields.refuse_others([*KNOWN_FIELDS, *(name for name in values if name.startswith(COMMENT_PREFIX))])
    if fields.has("schema_version"):
        check_version(fields, SCHEMA_VERSION)
    if not isinstance(values.get("root", False), bool):
        raise InputError(f"{path}: root is {shown(values['root'])}; it must be true or false")
    if values.get(KEYFRAMES) not in (None, EVERY_LIBRARY):
        raise InputError(
            f"{path}: keyframes is {shown(values[KEYFRAMES])}; for all takes below it must be "
            f"{EVERY_LIBRARY}, which finds keyframes with all libraries: a keyframe file is a take's own"
        )
    return {name: value for name, value in values.items() if name not in FILE_FIELDS}


def find_shoot_files(folder: Path) -> dict[Path, dict[str, Any]]:
    """Every `shoot.json` that takes in a folder inherit from, with all its fields, the farthest first.

    They are searched in the folder and all its parents, up to one that says `"root": true`. A broken link or
    a folder of that name is an error: what it was to say is not left out in silence.
    """
    found: dict[Path, dict[str, Any]] = {}
    start = absolute_path(folder)
    for parent in (start, *start.parents):
        file = parent / SHOOT_FILE
        if os.path.lexists(file):
            found[file] = read_json(file, LARGEST_BYTES)
            if found[file].get("root") is True:
                break
    return dict(reversed(found.items()))


TAKE_FILE = "take.json"
KEYFRAME_FILE = "keyframes.json"
KEYPOINT_FILE = "keypoints.json"
CLIP_FILE = "clip.mp4"
CLIP_VALID = "a path inside the take's folder, as in clip.mp4"


@dataclass(frozen=True, eq=False)
class Description:
    """The description of one take; of its fields only those named here are checked yet."""

    path: Path
    """The take: a folder, or a bare clip."""
    name: str
    folder: Path
    """The folder that the take's own paths are relative to."""
    file: Path
    """The nearest file that describes it; sentences name it where a field is missing."""
    files: tuple[Path, ...]
    """All files that describe it, the farthest first."""
    clip: Path
    keyframes: Path
    """The keyframe file, which may not exist."""
    keypoints: tuple[Path, ...]
    """Files or folders of keypoints: those that are named, else `keypoints.json` or `NAME.keypoints.json`
    where that is there (`keypoints_beside`)."""
    fields: Fields
    settings: ConversionSettings
    inherits: bool
    """Whether a `shoot.json` describes it, or it is a bare clip; then rate and size may come from the clip
    itself."""

    def file_called(self, name: Path) -> Path:
        """The take's own file of a name that every take has: in its folder, or beside its bare clip."""
        return _own_name(self.folder, self.clip if self.path == self.clip else None, name)


def describe(
    path: Path, overrides: Mapping[str, Any] | None = None, overrides_location: str = ""
) -> Description:
    """Merge all files that describe a take.

    Args:
        path: A folder with `take.json`, a video, or a folder of images.
        overrides: Fields that override all files, as in a line of a list; their paths are relative to the
            take's folder.
        overrides_location: Location of these fields, for sentences.
    """
    own_file = _own_file(path)
    folder, is_folder = own_file.parent, own_file.name == TAKE_FILE
    shared = find_shoot_files(folder)
    if not os.path.isfile(own_file) and not is_folder and not shared and not overrides:
        raise InputError(
            f"{path}: nothing describes this clip; {own_file.name} beside it, or {SHOOT_FILE} there "
            "or in a folder above, must say what camera and actor it shows, and which markers if any"
        )
    files = [*shared]
    layers = [(str(file), file.parent, shoot_fields(file, values)) for file, values in shared.items()]
    if os.path.isfile(own_file) or is_folder:
        files.append(own_file)
        layers.append((str(own_file), folder, read_json(own_file)))
    if overrides:
        layers.append((overrides_location, folder, dict(overrides)))
    inherited = InheritedFields()
    for location, _, values in layers:
        inherited = inherited.overridden_by(with_auto_as_library(values, inherited, location), location)
    fields = Fields(inherited, str(files[-1] if files else path))
    settings = read_settings(fields, {location: base for location, base, _ in layers})
    if is_folder:
        clip = safe_path(fields, "clip", folder, CLIP_VALID) if fields.has("clip") else folder / CLIP_FILE
        keyframes = settings.keyframes or folder / KEYFRAME_FILE
    else:
        clip = path
        keyframes = settings.keyframes or sidecar_file(path, KEYFRAME_FILE)
    bare = None if is_folder else path

    def own(name: str, file: Path) -> Path:
        """The take's own file where a `shoot.json` says a name that every take has."""
        said_in = Path(fields.source_of(name))
        return _own_name(folder, bare, file.relative_to(said_in.parent)) if said_in in shared else file

    if settings.keypoints is not None:
        settings = replace(settings, keypoints=tuple(own("keypoints", file) for file in settings.keypoints))
    if settings.reference is not None:
        settings = replace(settings, reference=own("reference", settings.reference))
    usual = _own_name(folder, bare, Path(KEYPOINT_FILE)) if is_folder else keypoints_beside(path)
    keypoints = settings.keypoints or ((usual,) if usual is not None and os.path.lexists(usual) else ())
    used = [*files, clip, keyframes, *keypoints, *filter(None, [settings.reference, settings.network])]
    used += [link for within in (clip, *keypoints) for link in _links(within)]
    if settings.library is not None and settings.library.endswith(".json"):
        used.append(Path(settings.library))
    if settings.character is not None:
        map_file = settings.character.map_file
        used += [settings.character.file, *([] if map_file is None else [map_file])]
    check_symlinks(used, [files[0].parent if shared else folder, folder])
    return Description(
        path=path,
        name=absolute_path(path).name if is_folder else clip_name(path),
        folder=folder,
        file=files[-1] if files else path,
        files=tuple(files),
        clip=clip,
        keyframes=keyframes,
        keypoints=keypoints,
        fields=fields,
        settings=settings,
        inherits=bool(shared) or not files,
    )


def keypoints_beside(clip: Path) -> Path | None:
    """The file of a bare clip's keypoints: `NAME.keypoints.json`, or `keypoints.json` of the only clip there.

    None where there is none.
    """
    own = sidecar_file(clip, KEYPOINT_FILE)
    if os.path.lexists(own):
        return own
    plain = clip.with_name(KEYPOINT_FILE)
    if not os.path.lexists(plain):
        return None
    alike = (file for file in clip.parent.iterdir() if file.suffix.lower() == clip.suffix.lower())
    return plain if all(file.name == clip.name for file in alike) else None


def effective_settings(
    description: Description, defaults: ConversionSettings = NO_SETTINGS
) -> ConversionSettings:
    """The settings of a take's conversion; beside a library its own keyframes are used where it has some."""
    settings = description.settings.with_defaults(defaults)
    if description.settings.keypoints is None and defaults.keypoints is not None:
        settings = replace(
            settings, keypoints=tuple(description.file_called(file) for file in defaults.keypoints)
        )
    if settings.library is not None and settings.keyframes is None and os.path.exists(description.keyframes):
        return replace(settings, keyframes=description.keyframes)
    return settings


def keypoint_files(description: Description, settings: ConversionSettings) -> tuple[Path, ...]:
    """The files or folders of keypoints that a conversion reads; none where their evidence is left aside."""
    if settings.evidence is not None and KEYPOINTS not in settings.evidence:
        return ()
    return description.keypoints if settings.keypoints is None else settings.keypoints


def _own_name(folder: Path, clip: Path | None, name: Path) -> Path:
    """A file of a name that every take has: `clip` is None where the take is a folder."""
    return folder / name if clip is None else folder / name.parent / sidecar_file(clip, name.name).name


def _own_file(path: Path) -> Path:
    try:
        kind = path.stat().st_mode
        images = S_ISDIR(kind) and not (path / TAKE_FILE).exists() and any(map(is_image, path.iterdir()))
    except FileNotFoundError as error:
        raise InputError(f"{path}: no such folder; a take is a folder that holds {TAKE_FILE}") from error
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(
            f"{path}: cannot be read ({reason}); a take is a folder that holds {TAKE_FILE}"
        ) from error
    if not S_ISDIR(kind) and not S_ISREG(kind):
        raise InputError(
            f"{path}: is a device, a pipe or a socket; a take is a folder that holds {TAKE_FILE}"
        )
    return path / TAKE_FILE if S_ISDIR(kind) and not images else sidecar_file(path, TAKE_FILE)


def _links(folder: Path) -> list[Path]:
    try:
        with os.scandir(folder) as entries:
            return [Path(entry.path) for entry in entries if entry.is_symlink()]
    except (OSError, ValueError):  # no readable folder, as opening it will say
        return []


def sidecar_file(clip: Path, ending: str) -> Path:
    """The file beside a bare clip that adds to its description, as `NAME.take.json`."""
    return clip.with_name(f"{clip_name(clip)}.{ending}")


def clip_name(clip: Path) -> str:
    """The name of a bare clip: that of the video without its ending, or of the folder of images."""
    return absolute_path(clip).name if clip.is_dir() else clip.stem
