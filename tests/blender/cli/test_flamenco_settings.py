"""The settings of the Flamenco job type as properties of Blender, as Flamenco's add-on makes them."""

import json
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import pytest

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(NODE is None, reason="there is no Node, in which the job type is read")

KINDS = {
    "bool": bpy.props.BoolProperty,
    "string": bpy.props.StringProperty,
    "int32": bpy.props.IntProperty,
    "float": bpy.props.FloatProperty,
}


@pytest.fixture
def settings(repository: Path) -> list[dict[str, Any]]:
    script = repository / "presets" / "flamenco" / "keymark_convert.js"
    source = f"{script.read_text(encoding='utf-8')}\nprocess.stdout.write(JSON.stringify(JOB_TYPE.settings));"
    done = subprocess.run([str(NODE), "-e", source], capture_output=True, text=True, check=True)
    return list(json.loads(done.stdout))


@pytest.fixture
def group(settings: list[dict[str, Any]]) -> Iterator[Any]:
    made = {}
    for setting in settings:
        given = {name: setting[name] for name in ("description", "default") if name in setting}
        given |= setting.get("propargs", {})
        kind = KINDS[setting["type"]]
        if "choices" in setting:
            kind, given["items"] = bpy.props.EnumProperty, [(name, name, "") for name in setting["choices"]]
        elif "subtype" in setting:
            given["subtype"] = setting["subtype"].upper()
        made[setting["key"]] = kind(name=setting.get("label", setting["key"]), options=set(), **given)
    settings_type = type("FarmSettings", (bpy.types.PropertyGroup,), {"__annotations__": made})
    bpy.utils.register_class(settings_type)
    bpy.types.Scene.farm_settings = bpy.props.PointerProperty(type=settings_type)
    yield bpy.context.scene.farm_settings
    del bpy.types.Scene.farm_settings
    bpy.utils.unregister_class(settings_type)


def test_blender_takes_every_setting(group: Any, settings: list[dict[str, Any]]) -> None:
    for setting in settings:
        assert getattr(group, setting["key"]) == setting.get("default", "")
    group.tasks = -5
    assert group.tasks == 0
    group.method, group.library = "ekf", "walking"
    with pytest.raises(TypeError):
        group.library = "nobody's"
