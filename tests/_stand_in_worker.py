"""A stand-in worker without Keymark: it answers as its jobs' names ask, and logs the jobs.

Usage: _stand_in_worker.py LOG. A name's last part up to a dash says what happens; else the take converts.
"""

import json
import os
import signal
import sys
from pathlib import Path
from typing import Any

log = Path(sys.argv[1])


def say(answer: str, /, **said: Any) -> None:
    """Write a message."""
    print(json.dumps({answer: said}), flush=True)


def done(result: str, error: str | None = None, kind: str | None = None, memory: int = 1000) -> None:
    """Write the message that the job is done."""
    say("done", result=result, seconds=0.25, error=error, kind=kind, memory_bytes=memory)


def work(job: dict[str, Any]) -> None:
    """Do what the take's name asks for."""
    name, place = job["take"]["name"], job["take"]["path"]
    told = {"take": name, "process": os.getpid(), "again": job["again"], "nearest": job["take"]["overrides"]}
    with log.open("ab", buffering=0) as file:  # in one piece: another worker may write as well
        file.write(json.dumps(told).encode() + b"\n")
    times = log.read_text(encoding="utf-8").count(json.dumps(name))
    say("step", stage="Working", fraction=0.5)
    what = name.split("/")[-1].split("-")[0]
    if what == "crash" or (what == "stumble" and times == 1):
        os._exit(9)
    elif what == "killed":
        os.kill(os.getpid(), signal.SIGKILL)
    elif what == "hang":
        sys.stdin.read()
    elif what == "interrupt":
        os.kill(os.getppid(), signal.SIGINT)
        sys.stdin.read()
    elif what == "busy" and times < 3:
        done("busy", "another process is at work there")
    elif what == "busy":
        done("unchanged")
    elif what == "wrong":
        done("failed", f"{place}: the camera is upside down", "input")
    elif what == "grown":
        done("converted", memory=2**40)
    else:
        done("converted")


print("Blender 9.9 says good morning")
if log.name == "broken.log":
    sys.exit("the module cv9 is missing")
say("step", stage="", fraction=0.0)
for line in sys.stdin:
    work(json.loads(line))
