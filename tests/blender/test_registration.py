"""Registering and unregistering the extension."""

import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import get_type_hints

import bpy
import keymark
import pytest
from keymark import operators


def traces() -> list[str]:
    """Keymark's classes, operators, properties and menu entries in Blender."""
    classes = [name for name in dir(bpy.types) if name.startswith("KEYMARK_")]
    operator_names = [name for name in dir(bpy.ops.keymark)]
    properties = [
        f"{owner.__name__}.{name}"
        for owner in (bpy.types.Scene, bpy.types.WindowManager)
        for name in ("keymark", "keymark_progress")
        if hasattr(owner, name)
    ]
    drawn = getattr(bpy.types.TOPBAR_MT_file_import.draw, "_draw_funcs", [])
    menus = [function.__module__ for function in drawn if function.__module__.startswith("keymark")]
    return classes + operator_names + properties + menus


def test_everything_is_there_and_gone_again_twice() -> None:
    assert traces() == []
    for _ in range(2):
        keymark.register()
        there = traces()
        assert "reconstruct" in there
        assert "KEYMARK_PT_main" in there
        assert "Scene.keymark" in there
        assert "keymark.operators.takes.open_take" in there
        keymark.unregister()
        assert traces() == []


def test_annotations_of_registered_classes_can_be_evaluated(registered: None) -> None:
    names = [name for name in dir(bpy.types) if name.startswith("KEYMARK_")]
    assert len(names) > 80
    for name in names:
        assert isinstance(get_type_hints(getattr(bpy.types, name)), dict), name


@pytest.mark.parametrize("index", [1, 7, len(list(operators.modules()))])
def test_a_module_that_fails_takes_back_those_before_it(monkeypatch: pytest.MonkeyPatch, index: int) -> None:
    broken = ModuleType("keymark.operators.broken")

    def register() -> None:
        raise RuntimeError("broken on purpose")

    broken.register = register
    monkeypatch.setitem(sys.modules, "keymark.operators.broken", broken)
    names = list(operators.modules())
    names.insert(index, "broken")
    monkeypatch.setattr(operators, "modules", lambda: names)
    with pytest.raises(RuntimeError, match="broken on purpose"):
        keymark.register()
    assert traces() == []


def test_registering_imports_no_library_that_may_be_missing(repository: Path) -> None:
    script = f"""
import sys
sys.path.insert(0, {str(repository / "tests")!r})
class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in ("scipy", "cv2"):
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Missing())
from _boot import load_package
load_package()
import bpy, keymark
keymark.register()
try:
    bpy.ops.keymark.build_actor()
except RuntimeError as error:
    print("SAID", error)
keymark.unregister()
"""
    # A Blender with its own binary runs scripts itself; the wheel is a module of its Python.
    real = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1", "--python-expr"]
    command = real if bpy.app.binary_path else [sys.executable, "-c"]
    done = subprocess.run([*command, script], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    said = [line for line in done.stdout.splitlines() if line.startswith("SAID")]
    assert len(said) == 1
    assert "needs the Python library cv2" in said[0]


@pytest.mark.usefixtures("registered")
def test_every_operator_has_a_tooltip_and_the_usual_options() -> None:
    for name in dir(bpy.ops.keymark):
        kind = getattr(bpy.ops.keymark, name).get_rna_type()
        assert len(kind.description) > 10
        assert "REGISTER" in getattr(bpy.ops.keymark, name).bl_options


def test_the_command_comes_and_goes() -> None:
    from keymark.operators.cli import blender_command

    keymark.register()
    assert len(blender_command._registered) == 1
    keymark.unregister()
    assert blender_command._registered == []
