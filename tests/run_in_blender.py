"""Runs pytest inside a Blender and ends it with pytest's exit code.

Usage: blender -b --factory-startup --python-exit-code 1 --python tests/run_in_blender.py -- [pytest ...]

A Blender that lacks pytest or the project's libraries finds them in the folder that KEYMARK_TEST_LIBRARIES
names; tools/test_in_blender.py fills one.
"""

import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def main(arguments: list[str]) -> int:
    """Run pytest from the repository's root; return its exit code."""
    libraries = os.environ.get("KEYMARK_TEST_LIBRARIES")
    if libraries:
        sys.path.insert(0, libraries)
    os.chdir(ROOT)
    import pytest

    return int(pytest.main(["-p", "no:cacheprovider", *arguments]))


if __name__ == "__main__":
    after = sys.argv.index("--") + 1 if "--" in sys.argv else len(sys.argv)
    code = main(sys.argv[after:])
    sys.stdout.flush()
    if code:  # SystemExit(0) would be the same as going on, and Blender then ends with 0 by itself
        raise SystemExit(code)
