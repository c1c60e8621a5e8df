"""A detector for tests, run as a program of its own: works, or fails in the way that its first word says.

Usage: _fake_detector.py HOW CLIP OUTPUT WIDTH HEIGHT FRAMES
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

POINTS = 17
"""Of the layout coco17."""
LONG_S = 300.0
"""Longer than any test runs."""


def content(width: int, height: int, frames: int) -> dict:
    """A person who drifts to the right in every frame but the second."""
    people: list[list[list[float]] | None] = [
        [[0.3 * width + point + frame, 0.2 * height + 2.0 * point, 0.9] for point in range(POINTS)]
        for frame in range(frames)
    ]
    people[1] = None
    return {"layout": "coco17", "size": [width, height], "frames": people}


def main(how: str, clip: str, output: str, width: str, height: str, frames: str) -> int:
    """Do what is wanted; returns the exit status."""
    right = content(int(width), int(height), int(frames))
    file = Path(output)
    if how == "fail":
        print("a warning", file=sys.stderr)
        print("the network has \x1b[31mno weights", file=sys.stderr)
        return 3
    if how == "hang":
        subprocess.Popen([sys.executable, "-c", f"import time; time.sleep({LONG_S})"])
        Path(clip).with_name("started").write_text(str(os.getpid()))
        print("waiting for a model", flush=True)
        time.sleep(LONG_S)
    if how == "stubborn":
        import signal

        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        time.sleep(LONG_S)
    if how == "flood":
        while True:
            print("x" * 10_000)
    if how == "nothing":
        return 0
    if how == "huge":
        with open("video.avi", "wb") as big:
            big.truncate(5 * 2**30)  # sparse: it takes no room
        time.sleep(LONG_S)
    if how == "garbage":
        file.write_bytes(b"\x00\xff not json")
        return 0
    if how == "short":
        right["frames"] = right["frames"][:2]
    if how == "turned":
        right["size"] = right["size"][::-1]
    if how == "nobody":
        right["frames"] = [None] * int(frames)
    if how == "killed":
        os.kill(os.getpid(), 9)
    if how == "escape":
        outside = Path(clip).with_name("outside.json")
        outside.write_text(json.dumps(right))
        file.symlink_to(outside)
        return 0
    if how == "beside":
        Path(clip).with_name("drawn.avi").write_bytes(b"drawn")
    if how == "overwrite":
        Path(clip).write_bytes(b"no clip")
    if how == "leave":  # a child that outlives its parent
        child = subprocess.Popen([sys.executable, "-c", f"import time; time.sleep({LONG_S})"])
        Path(clip).with_name("started").write_text(str(child.pid))
    if how == "folder":
        (file.parent / "poses").mkdir()
        file = file.parent / "poses" / "result.json"
    if how == "folders":
        for name in ("first", "second"):
            (file.parent / name).mkdir()
            (file.parent / name / "result.json").write_text(json.dumps(right))
        return 0
    for frame in range(int(frames)):
        print(f"frame {frame + 1}/{frames}", flush=True)
    file.write_text(json.dumps(right))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
