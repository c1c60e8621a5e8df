"""What is said of one take, by its own file and by the shoots it belongs to, each field from the nearest.

A take is a folder that holds `take.json`; or, where a `shoot.json` above describes it, a mere video or a
folder of images, beside which `NAME.take.json` and `NAME.keyframes.json` may say more.
"""

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from stat import S_ISDIR, S_ISREG
from typing import Any

from ..errors import InputError
from ..files.fields import Fields
from ..files.inherited_fields import InheritedFields
from ..files.json_file import read_json
from ..files.safe_path import check_symlinks, safe_path
from ..footage.clips.image_sequence import is_image
from .conversion_settings import NOTHING_CHOSEN, ConversionSettings, read_settings
from .shoot_file import NAME, shoot_fields, shoot_files, whole_way

OWN = "take.json"
KEYFRAMES = "keyframes.json"
CLIP_VALID = "a path inside the take's folder, as in clip.mp4"


@dataclass(frozen=True, eq=False)
class Description:
    """One take as it is described; the fields are not checked yet but for those named here."""

    place: Path
    """The take: a folder, or the clip itself."""
    name: str
    """What people call it."""
    folder: Path
    """What paths in it are relative to."""
    file: Path
    """The nearest file that describes it; sentences name it where a field is missing."""
    files: tuple[Path, ...]
    """All files that describe it, the farthest first."""
    clip: Path
    keyframes: Path
    """Where its keyframes are, if it has some."""
    fields: Fields
    settings: ConversionSettings
    inherits: bool
    """Whether any of it comes from a shoot; then the clip itself may tell its rate and size."""


def describe(place: Path, nearest: Mapping[str, Any] | None = None, said_in: str = "") -> Description:
    """Gather what is said of a take.

    Args:
        place: A folder with `take.json`, a video, or a folder of images.
        nearest: Fields that count before all others, as a line of a list has them; their paths are relative
            to the take's folder.
        said_in: Where these stand, for sentences.

    Raises:
        InputError: There is no such take, nothing describes it, or a file is unusable.
    """
    own = _own_file(place)
    folder, whole = own.parent, own.name == OWN
    shared = shoot_files(folder)
    if not os.path.isfile(own) and not whole and not shared:
        raise InputError(
            f"{place}: nothing describes this clip; {own.name} beside it, or {NAME} there or in a folder "
            "above, must say what camera, actor and markers it shows"
        )
    fields = InheritedFields()
    folders: dict[str, Path] = {}
    for file, values in shared.items():
        fields = fields.overridden_by(shoot_fields(file, values), str(file))
        folders[str(file)] = file.parent
    files = [*shared]
    if os.path.isfile(own) or whole:
        fields = fields.overridden_by(read_json(own), str(own))
        folders[str(own)] = folder
        files.append(own)
    if nearest:
        fields = fields.overridden_by(nearest, said_in)
        folders[said_in] = folder
    described = Fields(fields, str(files[-1]))
    clip = place
    if whole:
        clip = (
            safe_path(described, "clip", folder, CLIP_VALID) if described.has("clip") else folder / "clip.mp4"
        )
    settings = read_settings(described, folders)
    keyframes = settings.keyframes or (folder / KEYFRAMES if whole else beside(place, KEYFRAMES))
    used = [*files, clip, keyframes, *_linked_images(clip)]
    if settings.library is not None and settings.library.endswith(".json"):
        used.append(Path(settings.library))
    check_symlinks(used, [files[0].parent if shared else folder, folder])
    return Description(
        place=place,
        name=whole_way(place).name if whole else clip_name(place),
        folder=folder,
        file=files[-1],
        files=tuple(files),
        clip=clip,
        keyframes=keyframes,
        fields=described,
        settings=settings,
        inherits=bool(shared),
    )


def chosen_settings(
    description: Description, farther: ConversionSettings = NOTHING_CHOSEN
) -> ConversionSettings:
    """How a take is to be converted: keyframes that it has are used beside a library.

    Args:
        description: The take's.
        farther: What counts where the take and its shoots say nothing.
    """
    settings = description.settings.over(farther)
    if settings.library is not None and settings.keyframes is None and os.path.exists(description.keyframes):
        return replace(settings, keyframes=description.keyframes)
    return settings


def _own_file(place: Path) -> Path:
    """A take's own file, whether it is there or not."""
    try:
        kind = place.stat().st_mode
        images = S_ISDIR(kind) and not (place / OWN).exists() and any(map(is_image, place.iterdir()))
    except FileNotFoundError as error:
        raise InputError(f"{place}: no such folder; a take is a folder that holds {OWN}") from error
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(
            f"{place}: cannot be read ({reason}); a take is a folder that holds {OWN}"
        ) from error
    if not S_ISDIR(kind) and not S_ISREG(kind):
        raise InputError(f"{place}: is a device, a pipe or a socket; a take is a folder that holds {OWN}")
    return place / OWN if S_ISDIR(kind) and not images else beside(place, OWN)


def _linked_images(clip: Path) -> list[Path]:
    """The images of a folder that are links."""
    try:
        with os.scandir(clip) as entries:
            return [Path(entry.path) for entry in entries if entry.is_symlink()]
    except (OSError, ValueError):  # no folder, or none that can be read, which whoever opens the clip says
        return []


def beside(place: Path, ending: str) -> Path:
    """The file that says more of a mere clip: `NAME.take.json` or `NAME.keyframes.json`."""
    return place.with_name(f"{clip_name(place)}.{ending}")


def clip_name(place: Path) -> str:
    """What people call a mere clip: its name without an ending, or that of its folder of images."""
    return whole_way(place).name if place.is_dir() else place.stem
