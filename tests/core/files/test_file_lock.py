"""Locks that end with their process, and single files that are written atomically under them."""

import errno
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from _faults import Killed, faulty_calls, tree
from keymark.core.errors import BusyError, ConversionError
from keymark.core.files import file_lock as module
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
