"""A shoot as the command line names it: a folder, a list, or one clip."""

from pathlib import Path

from ..shoot import Shoot, ShootTake
from .find_takes import VIDEOS, find_takes
from .take_list import ENDING, read_take_list
from .take_names import check_names, name_of_way


def open_shoot(path: Path, without: Path | None = None) -> Shoot:
    """Find the takes of a shoot; nothing of them is read yet.

    Args:
        path: A folder of takes or one take, a list of takes (.jsonl), or one video.
        without: A folder that is left out with all in it, as that of the results.

    Raises:
        InputError: There is no such shoot, it cannot be read, it has no take, or two takes of one name.
    """
    if path.suffix.lower() == ENDING and not path.is_dir():
        return read_take_list(path)
    if path.suffix.lower() in VIDEOS and path.is_file():
        takes = (ShootTake(name_of_way(Path(path.stem)), path),)
        check_names(path, takes)
        return Shoot(path, takes)
    return find_takes(path, without)
