"""`keymark library blend` and `read`: between library files and Blender's pose assets."""

import argparse

from .....core.errors import InputError
from .....core.library.registry import find_library
from .....core.library.texts import checked_identifier
from ...blender_silence import blender_silence
from ...console import arguments_console
from ...library_search_path import library_folders
from ...usage import refuse_existing, require_blender
from .library_summary import library_summary
from .new_library_file import write_new_library


def blend_command(arguments: argparse.Namespace) -> None:
    """Write a library's postures as pose assets, with their catalog, into the folder of an asset library."""
    require_blender("pose assets need")
    with arguments_console(arguments) as console:
        library = find_library(arguments.library, library_folders())
        file = arguments.output / f"{checked_identifier(library.identifier, 'the identifier')}.blend"
        refuse_existing(file, arguments.replace)
        console.stage("Writing Blender's files")
        with blender_silence(arguments.debug):
            from ....bridge.assets.catalogs import NAME
            from ....bridge.library.library_blend import write_library_blend

            write_library_blend(file, library)
        files = [str(file), str(arguments.output / NAME)]
        text = f"{library.title}: {len(library.postures)} pose assets\n" + "\n".join(f"  {f}" for f in files)
        console.finish({**library_summary(library), "files": files}, text)


def read_command(arguments: argparse.Namespace) -> None:
    """Write the library of a .blend's pose assets as a library file.

    Raises:
        InputError: The .blend holds no library, or more than one.
    """
    require_blender("pose assets need")
    refuse_existing(arguments.output, arguments.replace)
    with arguments_console(arguments) as console:
        console.stage("Reading the pose assets")
        with blender_silence(arguments.debug):
            from ....bridge.library.library_blend import read_library_blend

            found = read_library_blend(arguments.file)
        chosen = [one for one in found if arguments.identifier in (None, one.identifier)]
        if len(chosen) != 1:
            names = ", ".join(one.identifier for one in found)
            raise InputError(f"{arguments.file}: holds the libraries {names}; name one with --identifier")
        write_new_library(console, arguments, chosen[0])
