"""The takes that benchmarks measure: those beside the repository, made ones, and the demonstration."""

import importlib.util
import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NAMED_PLACES = "KEYMARK_TAKES"
"""Environment variable of further folders of takes, separated as in PATH."""
OUTPUT = ROOT / "out" / "bench"
GIVEN_PLACES = (ROOT.parent / "shared" / "takes", ROOT / "presets" / "demo")
"""Folders of the takes with which methods are developed and tuned."""
PLAIN_PLACE = ROOT.parent / "shared" / "plain_takes"
"""Folder of takes whose performers wear no markers."""
GROUPS = ("given", "studio")
"""Names of the takes in those folders, and of all others."""


def load_project() -> None:
    """Make this source tree importable as `keymark`, whether or not another is installed."""
    sys.path.insert(0, str(ROOT / "tests"))
    spec = importlib.util.spec_from_file_location("_boot", ROOT / "tests" / "_boot.py")
    if spec is None or spec.loader is None:
        raise RuntimeError("tests/_boot.py is missing")
    boot = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(boot)
    boot.load_package()


def take_names(plain: bool = False) -> dict[str, Path]:
    """Folders of takes with truth by the name in tables; the demonstration's begins with `demo`.

    Takes without markers, which not every method can use, come on request.
    """
    named = [Path(place) for place in os.environ.get(NAMED_PLACES, "").split(os.pathsep) if place]
    found: dict[str, Path] = {}
    for place in (GIVEN_PLACES[0], ROOT / "out" / "takes", *named, PLAIN_PLACE, GIVEN_PLACES[1]):
        for truth in sorted(place.glob("*/truth.json")):
            name = truth.parent.name
            if plain or has_markers(truth.parent):
                found[f"demo/{name}" if place.name == "demo" else name] = truth.parent
    if not found:
        raise SystemExit("no take with truth was found, not even the demonstration's")
    return found


def has_markers(folder: Path) -> bool:
    """Whether a take's own file tells of markers; where it has none, a shoot may."""
    file = folder / "take.json"
    return not file.is_file() or "markers" in json.loads(file.read_text(encoding="utf-8"))


def chosen_takes(wanted: Sequence[str], plain: bool = False) -> dict[str, Path]:
    """Folders of the takes given by name, as in tables, or by folder; all takes found if none is given."""
    if not wanted:
        return take_names(plain)
    chosen: dict[str, Path] = {}
    for name in wanted:
        if (Path(name) / "truth.json").is_file():
            chosen[Path(name).resolve().name] = Path(name)
        elif name in (known := take_names(plain)):
            chosen[name] = known[name]
        else:
            print(
                f"{name} is neither a folder with truth.json nor one of {', '.join(known)}", file=sys.stderr
            )
            raise SystemExit(2)
    return chosen


def group_of(folder: Path) -> str:
    """The group of a take; means over both groups together would hide the effect of tuning."""
    return GROUPS[0] if folder.resolve().parent in GIVEN_PLACES else GROUPS[1]


def write_results(name: str, markdown: str, json_text: str) -> None:
    """Print a table and write it, with the same numbers as JSON, into out/bench."""
    OUTPUT.mkdir(parents=True, exist_ok=True)
    (OUTPUT / f"{name}.md").write_text(markdown + "\n", encoding="utf-8")
    (OUTPUT / f"{name}.json").write_text(json_text + "\n", encoding="utf-8")
    print(markdown)
    print(f"\nWritten to {OUTPUT / name}.md and .json")
