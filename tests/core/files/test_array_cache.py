"""Arrays cached in a folder: whole, of bounded size, and absent rather than wrong."""

import os
from pathlib import Path

import numpy as np
import pytest
from keymark.core.errors import ConversionError
from keymark.core.files.digest import ArrayCache
from keymark.core.files.file_lock import file_lock

ARRAYS = {
    "speed": np.array([1.0, np.nan]),
    "seen": np.array([True, False]),
    "names": np.array(["trunk", "ä"]),
}


def test_what_is_saved_is_loaded_alike(tmp_path: Path) -> None:
    cache = ArrayCache(tmp_path / "results")
    cache.save("reading-1a", ARRAYS)
    found = ArrayCache(tmp_path / "results").load("reading-1a")
    assert found is not None and set(found) == set(ARRAYS)
    for name, array in ARRAYS.items():
        assert np.array_equal(found[name], array, equal_nan=name == "speed")
        assert found[name].dtype == array.dtype
    assert cache.load("reading-1b") is None


def test_saving_again_replaces_and_leaves_nothing_beside(tmp_path: Path) -> None:
    cache = ArrayCache(tmp_path)
    cache.save("a", {"x": np.zeros(3)})
    cache.save("a", {"y": np.ones(2)})
    assert list(cache.load("a") or {}) == ["y"]
    assert [path.name for path in tmp_path.iterdir()] == ["a.npz"]


@pytest.mark.parametrize("damage", ["cut", "flipped", "empty", "text"])
def test_a_damaged_file_counts_as_absent(tmp_path: Path, damage: str) -> None:
    cache = ArrayCache(tmp_path)
    cache.save("a", {"x": np.arange(1000.0)})
    file = tmp_path / "a.npz"
    whole = file.read_bytes()
    flipped = whole[:4000] + bytes([whole[4000] ^ 1]) + whole[4001:]
    file.write_bytes({"cut": whole[:-300], "flipped": flipped, "empty": b"", "text": b"{}"}[damage])
    assert cache.load("a") is None
    cache.save("a", {"x": np.zeros(1)})
    assert cache.load("a") is not None


def test_python_objects_are_neither_kept_nor_read(tmp_path: Path) -> None:
    cache = ArrayCache(tmp_path)
    with pytest.raises(ValueError, match="objects"):
        cache.save("a", {"x": np.array([{}], dtype=object)})
    np.savez(tmp_path / "a.npz", x=np.array([{}], dtype=object))
    assert cache.load("a") is None


@pytest.mark.parametrize("key", ["../a", "", "A", "a/b", "a.npz", "-a", "a" * 200])
def test_keys_cannot_leave_the_folder(tmp_path: Path, key: str) -> None:
    np.savez(tmp_path / "a.npz", x=np.zeros(1))
    cache = ArrayCache(tmp_path / "inside")
    assert cache.load(key) is None
    with pytest.raises(ValueError, match="key"):
        cache.save(key, {})


def test_the_least_recently_used_is_evicted_first(tmp_path: Path) -> None:
    cache = ArrayCache(tmp_path, largest_bytes=4000)
    for age, key in enumerate(("c", "b", "a")):
        cache.save(key, {"x": np.zeros(100)})
        os.utime(tmp_path / f"{key}.npz", (1000 + age, 1000 + age))
    assert cache.load("c") is not None
    cache.save("d", {"x": np.zeros(100)})
    left = {path.stem for path in tmp_path.iterdir()}
    assert {"c", "d"} <= left and "b" not in left
    cache.save("e", {"x": np.zeros(1000)})
    assert cache.load("e") is None and cache.load("d") is not None


def test_a_half_written_file_is_removed_unless_its_writer_lives(tmp_path: Path) -> None:
    for name in (".keymark-dead-work", ".keymark-live-work"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a.npz").write_bytes(b"half")
    with file_lock(tmp_path / ".keymark-live.lock", "is being written"):
        ArrayCache(tmp_path).save("a", {"x": np.zeros(1)})
        assert {path.name for path in tmp_path.iterdir()} == {
            ".keymark-live-work",
            ".keymark-live.lock",
            "a.npz",
        }


def test_a_folder_that_cannot_be_written_is_said_so(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ConversionError, match="cannot be written"):
        ArrayCache(tmp_path / "file" / "cache").save("a", {"x": np.zeros(1)})
    assert ArrayCache(tmp_path / "file" / "cache").load("a") is None
