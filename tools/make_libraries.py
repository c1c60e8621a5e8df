"""Write the shipped keyframe libraries into presets/keyframes, and with --sheet their contact sheets.

Usage: make_libraries.py [NAME ...] [--sheet FOLDER], with the Python of the development environment; by
default all libraries. tools/libraries composes them; equal sources give equal files.
"""

import argparse
import sys
from pathlib import Path

import cv2

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "tests"), str(Path(__file__).resolve().parent)]
from _boot import load_package  # noqa: E402

load_package()

from keymark.core.prior.library import write_library  # noqa: E402
from keymark.core.report.mannequin import library_sheet  # noqa: E402
from libraries.catalogue import NAMES, composed  # noqa: E402

FOLDER = ROOT / "presets" / "keyframes"


def main(arguments: list[str]) -> int:
    """Write the libraries named."""
    parser = argparse.ArgumentParser(description="Write the shipped keyframe libraries.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(NAMES)}; by default all")
    parser.add_argument("--sheet", type=Path, metavar="FOLDER", help="draw a contact sheet of each there")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.names if name not in NAMES]
    if unknown:
        parser.error(f"there is no library {unknown[0]}; there are {', '.join(NAMES)}")
    for folder in (FOLDER, options.sheet or FOLDER):
        folder.mkdir(parents=True, exist_ok=True)
    for name in options.names or NAMES:
        library = composed(name)
        write_library(FOLDER / f"{name}.json", library)
        print(f"{name}: {library.size}")
        if options.sheet:
            cv2.imwrite(str(options.sheet / f"{name}.png"), library_sheet(library))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
