"""Commands on characters as processes of their own: clean streams, their exit status, and an end."""

import json
import os
import subprocess
import sys
from pathlib import Path

import bpy
import pytest
from _character_glb import write_glb
from _characters import plain_character

pytestmark = pytest.mark.skipif(bool(bpy.app.binary_path), reason="a Blender program's own Python has no bpy")
PATIENCE_S = 120.0


@pytest.mark.parametrize("name", ["anna.glb", "damaged.glb"])
def test_a_process_that_reads_gltf_ends(tmp_path: Path, repository: Path, name: str) -> None:
    (tmp_path / "links").mkdir()
    (tmp_path / "links" / "keymark").symlink_to(repository, target_is_directory=True)
    write_glb(plain_character(), tmp_path / "anna.glb")
    (tmp_path / "damaged.glb").write_bytes(b"no model")
    done = subprocess.run(
        [sys.executable, "-m", "keymark", "character", str(tmp_path / name), "--json"],
        env={**os.environ, "PYTHONPATH": str(tmp_path / "links")},
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
    )
    if name == "anna.glb":
        assert done.returncode == 0 and done.stderr == ""
        assert json.loads(done.stdout)["map"]["roles"]["hips"]["bones"] == ["hips"]
    else:
        assert done.returncode == 2 and done.stdout == "" and len(done.stderr.splitlines()) == 1
