"""Locks that end with their process; files written atomically under them, and arrays cached by key."""

import errno
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from _faults import Killed, faulty_calls, tree
from keymark.core.errors import BusyError, ConversionError
from keymark.core.files import file_lock as module
from keymark.core.files.digest import ArrayCache
from keymark.core.files.file_lock import file_lock, hidden_prefix
from keymark.core.files.json_file import write_atomically, write_json

HOLD = """
import fcntl, os, sys
descriptor = os.open(sys.argv[1], os.O_RDWR | os.O_CREAT)
fcntl.flock(descriptor, fcntl.LOCK_EX)
print("held", flush=True)
sys.stdin.read()
"""


@pytest.mark.skipif(os.name == "nt", reason="uses the other kind of lock")
def test_a_lock_dies_with_its_process(tmp_path: Path) -> None:
    file = tmp_path / "a.lock"
    words = [sys.executable, "-c", HOLD, str(file)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as other:
        assert other.stdout is not None and other.stdout.readline() == b"held\n"
        with pytest.raises(BusyError, match="occupied"), file_lock(file, "occupied"):
            pass
        other.kill()
    assert file.exists()
    with file_lock(file, "occupied"):
        pass
    assert os.listdir(tmp_path) == []


@pytest.mark.skipif(os.name == "nt", reason="uses the other kind of lock")
def test_where_there_are_no_locks_work_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(number: int) -> None:
        def lock(_descriptor: int, _wait: bool) -> None:
            raise OSError(number, os.strerror(number))

        monkeypatch.setattr(module, "_flock", lock)

    fail(errno.ENOLCK)
    with file_lock(tmp_path / "a.lock", "occupied"):
        pass
    fail(errno.EIO)
    with pytest.raises(OSError, match="error"), file_lock(tmp_path / "a.lock", "occupied"):
        pass


def test_hidden_prefixes_are_short_and_different() -> None:
    names = [hidden_prefix(name) for name in ("a", "b", "n" * 255, "舞者", os.fsdecode(b"\xff"))]
    assert len(set(names)) == len(names) and all(len(name.encode()) == len(names[0]) < 40 for name in names)


def test_who_writes_the_same_file_waits(tmp_path: Path) -> None:
    inside, order = threading.Event(), []

    def first(beside: Path) -> None:
        inside.set()
        thread.start()
        order.append("first begins")
        beside.write_text("first", encoding="utf-8")
        order.append("first ends")

    def second() -> None:
        inside.wait()
        write_atomically(
            tmp_path / "a.txt", lambda beside: (order.append("second"), beside.write_text("second"))
        )

    thread = threading.Thread(target=second)
    write_atomically(tmp_path / "a.txt", first)
    thread.join()
    assert order == ["first begins", "first ends", "second"]
    assert tree(tmp_path) == {"a.txt": b"second"}


def test_a_file_written_by_a_process_that_dies_is_the_old_one_or_the_new(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    write_json(path, {"a": 0})
    old = path.read_bytes()
    with faulty_calls() as calls:
        write_json(path, {"a": 1})
    new, seen = path.read_bytes(), set()
    for at in range(1, calls.count + 1):
        path.write_bytes(old)
        with pytest.raises(Killed), faulty_calls(at):
            write_json(path, {"a": 1})
        seen.add(path.read_bytes())
        write_json(path, {"a": 2})
        assert os.listdir(tmp_path) == ["a.json"]
    assert seen == {old, new}


def test_a_file_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old", encoding="utf-8")

    def fail(beside: Path) -> None:
        beside.write_text("half", encoding="utf-8")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with pytest.raises(ConversionError, match="No space left"):
        write_atomically(tmp_path / "a.txt", fail)
    assert tree(tmp_path) == {"a.txt": b"old"}


@pytest.mark.parametrize("call", ["open", "stat", "fstat", "unlink", "close"])
def test_an_interruption_leaves_no_lock(call: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real, interrupted = getattr(os, call), []

    def interrupt(*words: object, **more: object) -> object:
        result = real(*words, **more)
        if not interrupted:
            interrupted.append(call)
            raise KeyboardInterrupt
        return result

    with monkeypatch.context() as patched:
        patched.setattr(os, call, interrupt)
        with pytest.raises(KeyboardInterrupt), file_lock(tmp_path / "a.lock", "occupied"):
            pass
    assert interrupted and os.listdir(tmp_path) == []
    with file_lock(tmp_path / "a.lock", "occupied"):
        assert os.listdir(tmp_path) == ["a.lock"]


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
