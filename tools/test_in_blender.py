"""Run the tests inside a real Blender, adding the libraries it lacks.

Usage: test_in_blender.py BLENDER [pytest arguments]. Blender from blender.org brings numpy but neither pytest
nor scipy and OpenCV. The missing ones are installed for that Blender's Python into a folder of its own below
.cache/; Blender itself is not changed.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from package.wheels import pins

ROOT = Path(__file__).resolve().parent.parent
MODULES = {
    "c3d": "c3d",
    "cv2": "opencv-python-headless",
    "hypothesis": "hypothesis",
    "imageio_ffmpeg": "imageio-ffmpeg",
    "jsonschema": "jsonschema",
    "onnxruntime": "onnxruntime",
    "pytest": "pytest",
    "scipy": "scipy",
    "threadpoolctl": "threadpoolctl",
}
QUESTION = f"""
import importlib.util, json, sys
missing = [name for name in {sorted(MODULES)!r} if importlib.util.find_spec(name) is None]
print("ANSWER" + json.dumps(["%d.%d" % sys.version_info[:2], missing]))
"""


def ask(blender: str) -> tuple[str, list[str]]:
    """The version of a Blender's Python, and the names in MODULES that it lacks."""
    command = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python-expr", QUESTION]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    for line in done.stdout.splitlines():
        if line.startswith("ANSWER"):
            version, missing = json.loads(line.removeprefix("ANSWER"))
            return version, missing
    raise SystemExit(f"{blender} ran no Python (exit status {done.returncode}): {done.stderr.strip()[-500:]}")


def install(version: str, missing: list[str]) -> Path:
    """Install the missing modules for that Python version into a folder below .cache/, and return it."""
    requirements = pins(version)
    wanted = [requirements[MODULES[name]] for name in missing]
    folder = ROOT / ".cache" / f"blender-python-{version}"
    record = folder / "installed.json"
    if record.is_file() and json.loads(record.read_text()) == wanted:
        return folder
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--upgrade"]
    pip += ["--target", str(folder), "--python-version", version, "--only-binary=:all:"]
    alone = [line for line in wanted if line.startswith(("c3d", "scipy", "opencv", "onnxruntime"))]
    others = [line for line in wanted if line not in alone]
    if alone:  # of what they depend on they need numpy alone, which must stay Blender's own
        subprocess.run([*pip, "--no-deps", *alone], check=True)
    if others:
        subprocess.run([*pip, *others], check=True)
    record.write_text(json.dumps(wanted))
    return folder


def main(arguments: list[str]) -> int:
    """Run the tests; return pytest's exit code."""
    blender, *for_pytest = arguments
    version, missing = ask(blender)
    with tempfile.TemporaryDirectory() as user:
        environment = {**os.environ, "BLENDER_USER_RESOURCES": user}
        if missing:
            environment["KEYMARK_TEST_LIBRARIES"] = str(install(version, missing))
        script = str(ROOT / "tests" / "run_in_blender.py")
        command = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", script]
        done = subprocess.run(
            [*command, "--", *for_pytest], cwd=ROOT, env=environment, stdin=subprocess.DEVNULL
        )
    return done.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
