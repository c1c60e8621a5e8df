"""Character files of many kinds, good and bad, and a finished motion, for the commands on characters."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from _armatures import build_character
from _characters import plain_character
from _synthetic_take import write_synthetic_take
from keymark.core.retarget.character import Character, CharacterBone
from keymark.operators.cli.main import main

FRAMES = 12


@pytest.fixture(scope="session")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The result of a conversion; tests must not change it."""
    folder = tmp_path_factory.mktemp("result")
    take = write_synthetic_take(folder / "takes" / "small", FRAMES)
    words = ["convert", str(take), "--output", str(folder / "out" / "small"), "--method", "interpolation"]
    assert main([*words, "--no-report", "--quiet"]) == 0
    return folder / "out" / "small"


@pytest.fixture(scope="session")
def cast(tmp_path_factory: pytest.TempPathFactory, result: Path) -> Path:
    """A folder of character files: good ones, and one for each way of being none."""
    folder = tmp_path_factory.mktemp("cast")
    plain = plain_character(root="root")
    _save(folder / "anna.blend", lambda: _anna(plain))
    _save(folder / "two.blend", lambda: [_anna(plain), _named(build_character(plain), "Ben")])
    _save(folder / "none.blend", lambda: bpy.data.objects.new("Table", None))
    _save(folder / "horse.blend", lambda: build_character(_horse()))
    half = plain_character(without=("thigh", "shin", "foot", "toe"))
    _save(folder / "half.blend", lambda: build_character(half))
    _save(folder / "flat.blend", lambda: _scaled(build_character(plain), (1.0, 0.0, 1.0)))
    _save(folder / "nan.blend", lambda: _scaled(build_character(plain), (float("nan"),) * 3))
    _save(folder / "stiff.blend", lambda: _stiff(build_character(plain)))
    shutil.copyfile(result / "motion.blend", folder / "motion.blend")
    (folder / "damaged.blend").write_bytes((folder / "anna.blend").read_bytes()[:3000])
    (folder / "damaged.glb").write_bytes(b"no model")
    return folder


def _save(file: Path, build: Callable[[], object]) -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    build()
    for one in bpy.data.objects:
        if not one.users_scene:
            bpy.context.scene.collection.objects.link(one)
    bpy.ops.wm.save_as_mainfile(filepath=str(file), compress=False)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def _anna(character: Character) -> bpy.types.Object:
    armature = _named(build_character(character), "Anna")
    mesh = bpy.data.meshes.new("Anna body")
    mesh.from_pydata([(0, 0, 1), (0.1, 0, 1), (0, 0.1, 1.3)], [], [(0, 1, 2)])
    skin = bpy.data.objects.new("Anna body", mesh)
    bpy.context.scene.collection.objects.link(skin)
    skin.vertex_groups.new(name="hips").add([0, 1, 2], 1.0, "REPLACE")
    skin.modifiers.new("Armature", "ARMATURE").object = armature
    return armature


def _named(armature: bpy.types.Object, name: str) -> bpy.types.Object:
    armature.name = name
    return armature


def _stiff(armature: bpy.types.Object) -> bpy.types.Object:
    """An armature whose thighs cannot go where they are keyed."""
    for side in "LR":
        limit = armature.pose.bones[f"thigh.{side}"].constraints.new("LIMIT_ROTATION")
        limit.use_limit_x = True
        limit.min_x = limit.max_x = 1.0
        limit.owner_space = "LOCAL"
    return armature


def _scaled(armature: bpy.types.Object, scale: tuple[float, ...]) -> bpy.types.Object:
    armature.scale = scale
    return armature


def _horse() -> Character:
    """Four legs below a level trunk, a neck and a head."""
    chains = {
        "spine": [(0, 0.6, 1.2), (0, 0.2, 1.25), (0, -0.2, 1.25), (0, -0.6, 1.3)],
        "neck": [(0, -0.6, 1.3), (0, -0.8, 1.6), (0, -0.95, 1.85), (0, -1.2, 1.75)],
    }
    for side, sign in (("L", 1.0), ("R", -1.0)):
        for leg, y in (("front", -0.55), ("hind", 0.6)):
            x = 0.15 * sign
            places = [(x, y, 1.1), (x, y - 0.02, 0.7), (x, y + 0.03, 0.35), (x, y, 0.08), (x, y - 0.1, 0.02)]
            chains[f"{leg}.{side}"] = places
    parents = {"neck": "spine.2", "front": "spine.2", "hind": "spine.0"}
    plain = plain_character().bones[0]
    bones: list[CharacterBone] = []
    index: dict[str, int] = {}
    for chain, places in chains.items():
        for number, (head, tail) in enumerate(zip(places, places[1:], strict=False)):
            above = f"{chain}.{number - 1}" if number else parents.get(chain.partition(".")[0], "")
            rest = np.array(plain.rest)
            rest[:3, 3] = head
            name = f"{chain}.{number}"
            index[name] = len(bones)
            bones.append(
                replace(plain, name=name, parent=index.get(above, -1), rest=rest, tail=np.array(tail))
            )
    return Character("Horse", tuple(bones))
