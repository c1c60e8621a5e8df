"""Draw all pictures of the docs anew: from screenshots, and from the demonstration.

Usage: draw_pictures.py [--output FOLDER] [--screenshots FOLDER] [NAME ...], with the Python of a virtual
environment that has `bpy`; by default all of tools/pictures/table.py into docs/pictures. Pictures of Blender
are cut from what `make test-ui` took of the screen. NAME is a picture's, or the beginning of several names.
"""

import argparse
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(Path(__file__).resolve().parent)]
from _boot import load_package  # noqa: E402

load_package()

from keymark.core.arrays import Image  # noqa: E402
from pictures.comparison import draw_comparison  # noqa: E402
from pictures.listing import write_featured, write_icon  # noqa: E402
from pictures.moving import draw_moving_picture  # noqa: E402
from pictures.results import Results  # noqa: E402
from pictures.shipped_libraries import draw_libraries  # noqa: E402
from pictures.table import MADE, MOVING, SCREENSHOTS, SHOWN_WIDTH, Screenshot  # noqa: E402
from pictures.writing import read_picture, reduced, write_picture  # noqa: E402


def main(arguments: list[str]) -> int:
    """Draw the pictures that are named."""
    parser = argparse.ArgumentParser(description="Draw the pictures of the docs.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="of a picture, or the beginning of several")
    parser.add_argument("--output", type=Path, default=ROOT / "docs" / "pictures")
    parser.add_argument("--screenshots", type=Path, default=ROOT / "build" / "screenshots")
    chosen = parser.parse_args(arguments)
    names = [name for name in MADE if name.startswith(tuple(chosen.names) or "")]
    if not names:
        parser.error(f"no picture is called {', '.join(chosen.names)}; there are {', '.join(MADE)}")
    taken = [name for name in names if name in SCREENSHOTS]
    for name in taken:  # before the long work: what is missing is said at once
        SCREENSHOTS[name].file(chosen.screenshots)
    chosen.output.mkdir(parents=True, exist_ok=True)
    print(f"{len(names)} pictures into {chosen.output}: {len(taken)} from screenshots of `make test-ui`,")
    print(f"{len(names) - len(taken)} drawn anew (all of them: a quarter of an hour on two idle cores).")
    with tempfile.TemporaryDirectory() as folder:
        makers = _makers(Results(Path(folder)), chosen.screenshots)
        for number, name in enumerate(names, 1):
            print(f"{number:3d} of {len(names)}  {name} ...", end=" ", flush=True)
            makers[name](chosen.output / name)
            print(f"{(chosen.output / name).stat().st_size / 1000.0:.0f} kB", flush=True)
    return 0


def _makers(results: Results, screenshots: Path) -> dict[str, Callable[[Path], None]]:
    """What draws each picture into a file."""
    drawn: dict[str, Callable[[], Image]] = {
        "character.jpg": lambda: read_picture(results.character / "report" / "character.png"),
        "comparison.jpg": draw_comparison,
        "libraries.jpg": draw_libraries,
    }
    makers: dict[str, Callable[[Path], None]] = {
        MOVING: partial(draw_moving_picture, results),
        "listing_icon.png": partial(write_icon, results),
        "listing_featured.jpg": partial(write_featured, results),
    }
    for name, draw in drawn.items():
        makers[name] = partial(_write, draw)
    for name, screenshot in SCREENSHOTS.items():
        makers[name] = partial(_write, partial(_cut, screenshot, screenshots))
    return makers


def _write(draw: Callable[[], Image], path: Path) -> None:
    write_picture(path, draw())


def _cut(screenshot: Screenshot, screenshots: Path) -> Image:
    """The part of a screenshot that is shown."""
    left, top, right, bottom = screenshot.box
    return reduced(read_picture(screenshot.file(screenshots))[top:bottom, left:right], SHOWN_WIDTH)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
