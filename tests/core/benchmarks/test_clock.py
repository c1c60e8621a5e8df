"""Wrong or adjusted clocks: file times are never compared with the clock."""

import os
from pathlib import Path

import pytest
from _faults import tree
from _synthetic_take import write_synthetic_take
from keymark.core.take.conversion_settings import ConversionSettings
from keymark.core.take.description import describe
from keymark.operators.cli.console import Console
from keymark.operators.cli.conversion.convert_take import convert_if_changed

FAST = ConversionSettings(method="interpolation", pictures=False)


@pytest.mark.usefixtures("no_blender")
def test_file_times_do_not_matter(tmp_path: Path) -> None:
    take = write_synthetic_take(tmp_path / "take", 8, 4)
    out = tmp_path / "out"
    console = Console(quiet=True, as_json=False)
    assert convert_if_changed(describe(take), out, console, FAST) is not None
    before = tree(out)
    for moment in (1, 4_000_000_000):
        for number, file in enumerate(sorted([*take.rglob("*"), *out.rglob("*")])):
            os.utime(file, (moment + number, moment - number if moment > 10**6 else moment))
        assert convert_if_changed(describe(take), out, console, FAST) is None
        assert tree(out) == before
    with (take / "keyframes.json").open("a", encoding="utf-8") as file:
        file.write("\n")
    os.utime(take / "keyframes.json", (1, 1))
    assert convert_if_changed(describe(take), out, console, FAST) is not None
