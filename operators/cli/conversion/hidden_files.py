"""Files that Blender writes as deep in the folders as the output, before they are complete."""

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def hidden_files(names: Iterable[str], staging_folder: Path, output: Path) -> Iterator[Mapping[str, Path]]:
    """Give paths to write files to; when the block ends well, they are moved into the staging folder.

    Blender stores paths relative to the folder that it writes in, which must therefore lie as deep as
    `output`: where the staging folder does not, the files are written into `output` under hidden names.

    Args:
        names: Names of the files in the staging folder.
        staging_folder: Where the files are wanted.
        output: The folder of the result, as a real path.
    """
    folder = staging_folder if staging_folder.parent == output.parent else output
    hidden = {name: folder / f"{staging_folder.name}-{name}" for name in names}
    try:
        yield hidden
        for name, file in hidden.items():
            os.replace(file, staging_folder / name)
    finally:
        for file in hidden.values():
            file.unlink(missing_ok=True)
