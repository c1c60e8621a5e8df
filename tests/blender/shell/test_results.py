"""The cache of results: by the key that a take holds, in memory, in a folder, or known to be absent."""

from dataclasses import replace
from pathlib import Path

import bpy
import keymark
import pytest
from keymark.core.files.digest import ArrayCache
from keymark.core.markers.reading import Reading
from keymark.core.progress import run
from keymark.core.take.read_footage import read_footage
from keymark.core.take.take import Take
from keymark.operators.shell import results
from keymark.operators.shell.takes import add_take

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def loads(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[str]:
    keys: list[str] = []

    class Counting(ArrayCache):
        def load(self, key: str):  # noqa: ANN202
            keys.append(key)
            return super().load(key)

    monkeypatch.setattr(results, "_store", lambda: Counting(tmp_path / "results"))
    return keys


@pytest.fixture
def reading(tiny_take: Take) -> Reading:
    return run(read_footage(tiny_take))


def test_a_reading_is_found_in_memory_and_then_on_disk(loads: list[str], reading: Reading) -> None:
    take = add_take(bpy.context.scene, "Walk")
    assert results.reading_of(take) is None and loads == []
    results.keep_reading(take, reading)
    assert results.reading_of(take) is reading
    results.clear_cache()
    again = results.reading_of(take)
    assert again is not None and again.key == reading.key and again is results.reading_of(take)
    assert loads.count(reading.key) == 1


def test_what_is_nowhere_is_looked_for_once(loads: list[str]) -> None:
    take = add_take(bpy.context.scene, "Walk")
    take.reading_key = "reading-1-2"
    assert [results.reading_of(take) for _ in range(5)] == [None] * 5
    assert loads == ["reading-1-2"]


def test_two_takes_and_a_key_that_goes_back_have_their_own(loads: list[str], reading: Reading) -> None:
    scene = bpy.context.scene
    results.keep_reading(add_take(scene, "Walk"), reading)
    other = replace(reading, key="reading-other-1")
    results.keep_reading(add_take(scene, "Run"), other)
    walk, running = scene.keymark.takes
    assert results.reading_of(walk) is reading and results.reading_of(running) is other
    running.reading_key = reading.key
    assert results.reading_of(running) is reading


def test_a_file_of_something_else_counts_as_absent(loads: list[str], reading: Reading) -> None:
    take = add_take(bpy.context.scene, "Walk")
    results.keep_reading(take, reading)
    results._store().save(reading.key, {"x": reading.tracks.time_s})
    results.clear_cache()
    assert results.reading_of(take) is None
    folder = results._store().folder
    for file in folder.iterdir():
        file.unlink()
    folder.rmdir()
    folder.write_text("in the way")
    results.keep_reading(take, replace(reading, key="reading-3-4"))
    assert results.reading_of(take) is not None


def test_results_lie_in_the_extensions_own_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    asked: list[str] = []

    def extension_path_user(package: str, *, path: str = "", create: bool = False) -> str:
        asked.append(package)
        return str(tmp_path / path)

    monkeypatch.setattr(bpy.utils, "extension_path_user", extension_path_user)
    assert results._store().folder == tmp_path / "results"
    assert asked == [keymark.__name__]
