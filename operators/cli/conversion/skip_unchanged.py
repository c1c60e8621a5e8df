"""Conversion of a take, skipped where its whole result is there already: why a batch skips a take."""

from pathlib import Path

from ....core.pipeline.result import Conversion
from ....core.take.conversion_record import is_up_to_date
from ....core.take.conversion_settings import ConversionSettings
from ....core.take.description import Description
from ..console import Console
from .convert_take import convert_prepared, prepared_conversion


def convert_if_changed(
    description: Description,
    output: Path,
    console: Console,
    settings: ConversionSettings,
    debug: bool = False,
) -> Conversion | None:
    """Convert a take as `convert_take` does, unless `output` holds the whole result of the same input.

    The input is the same where its digest is the one in the result's record: Keymark's version, footage,
    description, keyframes, libraries and settings (`core/take/conversion_digest`). The result is whole where
    every file of the record is there. Times of files do not count.

    Returns:
        What was made; None where the take was skipped.
    """
    with prepared_conversion(description, output, console, settings) as prepared:
        if is_up_to_date(output, prepared.digest):
            return None
        return convert_prepared(prepared, console, debug)
