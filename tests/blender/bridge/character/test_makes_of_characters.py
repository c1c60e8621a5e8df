"""Characters of many makes keep to the motion and to the floor, by what Blender shows of their meshes."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
import pytest
from _armatures import build_character, retargeted
from _characters import plain_character, plain_map
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.errors import InputError
from keymark.core.retarget.character import Character
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.retarget.recognition.recognize import recognize
from keymark.core.take.conversion_settings import CharacterFile, RetargetOptions, RootMotion
from keymark.operators.bridge.character.import_character import import_character, skins
from keymark.operators.bridge.character.read_character import read_character
from keymark.operators.bridge.character.retarget import Retargeted

FAILING = Path(__file__).resolve().parents[5] / "shared" / "failing"
Made = tuple[bpy.types.Object, CharacterMap]


def performed(
    character: bpy.types.Object, known: CharacterMap, source: SegmentMotion, **options: object
) -> Retargeted:
    return retargeted(character, known, source, RetargetOptions(**options))  # type: ignore[arg-type]


def lowest_mm(character: bpy.types.Object, made: Retargeted) -> np.ndarray:
    """(F,) height of the lowest vertex of all meshes of a character, as Blender shows them."""
    found = []
    for frame in made.keys.frames:
        bpy.context.scene.frame_set(int(frame))
        graph = bpy.context.evaluated_depsgraph_get()
        heights = []
        for mesh_object in skins(character):
            shown = mesh_object.evaluated_get(graph)
            heights += [(shown.matrix_world @ vertex.co).z for vertex in shown.data.vertices]
        found.append(1000.0 * min(heights))
    return np.array(found)


def shoe(side: str, low: float) -> np.ndarray:
    """(N, 3) corners of a shoe around ankle and toes."""
    x = 0.1 if side == "L" else -0.1
    return np.array(
        [[x + dx, y, z] for dx in (-0.04, 0.04) for y in (0.09, 0.0, -0.11, -0.2) for z in (low, 0.06)]
    )


def add_part(name: str, points: np.ndarray) -> bpy.types.Object:
    """A mesh of loose vertices in the scene."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], [])
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def carried(part: bpy.types.Object, parent: bpy.types.Object, bone: str = "") -> None:
    """Hang an object on a bone, or on an object, where it is."""
    part.parent, part.parent_type, part.parent_bone = parent, "BONE" if bone else "OBJECT", bone
    bpy.context.view_layer.update()
    part.matrix_parent_inverse = (part.matrix_world).inverted()
    bpy.context.view_layer.update()


def rigid(nested: bool) -> Made:
    """Shoes of which each is a mesh on a bone, with soles 6 cm below the ankles; or on an object on it."""
    made = plain_character(without=("toe",))
    character = build_character(made)
    for side in "LR":
        part = add_part(f"Shoe {side}", shoe(side, 0.02))
        holder = part
        if nested:
            holder = bpy.data.objects.new(f"Holder {side}", None)
            bpy.context.scene.collection.objects.link(holder)
            carried(part, holder)
        carried(holder, character, f"foot.{side}")
    return character, plain_map(made)


def constrained() -> Made:
    """Shoes that a constraint hangs on the feet."""
    made = plain_character(without=("toe",))
    character = build_character(made)
    for side in "LR":
        part = add_part(f"Shoe {side}", shoe(side, 0.02))
        tie = part.constraints.new("CHILD_OF")
        tie.target, tie.subtarget = character, f"foot.{side}"
        tie.inverse_matrix = (character.matrix_world @ character.pose.bones[f"foot.{side}"].matrix).inverted()
    bpy.context.view_layer.update()
    return character, plain_map(made)


def soft(change: str = "") -> Made:
    """Shoes whose heels the shins move along; `subdivided`, or made 8 mm thicker by a shape key."""
    made = plain_character()
    character = build_character(made)
    for side in "LR":
        points = shoe(side, -0.02)
        part = add_part(f"Skin {side}", points)
        groups = {part_: part.vertex_groups.new(name=f"{part_}.{side}") for part_ in ("shin", "foot", "toe")}
        for index, (_, y, _) in enumerate(points):
            shares = {"shin": 0.4, "foot": 0.6} if y > 0.05 else {"toe": 1.0} if y < -0.15 else {"foot": 1.0}
            for name, share in shares.items():
                groups[name].add([index], share, "REPLACE")
        part.parent = character
        part.modifiers.new("Armature", "ARMATURE").object = character
        if change == "subdivided":
            part.modifiers.new("Subdivision", "SUBSURF").levels = 1
        if change == "thicker":
            part.shape_key_add(name="Basis")
            key = part.shape_key_add(name="Thick soles")
            for index, point in enumerate(points):
                key.data[index].co.z -= 0.008 * (point[2] < 0.0)
            key.value = 1.0
    bpy.context.view_layer.update()
    return character, plain_map(made)


@pytest.mark.parametrize(
    "make",
    [
        lambda: rigid(False),
        lambda: rigid(True),
        constrained,
        soft,
        lambda: soft("subdivided"),
        lambda: soft("thicker"),
    ],
    ids=["parts", "parts on parts", "constraints", "skin", "subdivided skin", "skin with a shape key"],
)
def test_soles_of_all_meshes_stand_on_the_floor(make: Callable[[], Made], source: SegmentMotion) -> None:
    character, known = make()
    made = performed(character, known, source)
    low = lowest_mm(character, made)
    depth = made.quality.penetration_mm
    assert depth is not None and depth == pytest.approx(max(-low.min(), 0.0), abs=0.05)
    assert depth < 2.0 and abs(np.median(low)) < 6.0
    assert not [note for note in made.notes if "below the floor" in note]


def test_where_a_foot_is_below_the_floor_is_said(source: SegmentMotion) -> None:
    character, known = soft()
    made = performed(character, known, source, plant_feet=False)
    low = lowest_mm(character, made)
    assert made.quality.penetration_mm == pytest.approx(-low.min(), abs=0.05)
    deepest = f"up to {-low.min():.3g} mm below the floor, in frames"
    assert -low.min() > 5.0 and any(deepest in note for note in made.notes)


def connected(lowest: str) -> Made:
    """Hips that are connected to a root on the floor, through one more bone where that is `middle`."""
    made = plain_character(root="root")
    bones = list(made.bones)
    head = made.bone("hips").head
    bones[0] = replace(bones[0], rest=np.eye(4), tail=head)
    if lowest == "middle":
        half = np.eye(4)
        half[:3, 3] = 0.5 * head
        bones[0] = replace(bones[0], tail=0.5 * head)
        bones.insert(1, replace(bones[0], name="middle", parent=0, rest=half, tail=head, connected=True))
        bones[2:] = [replace(bone, parent=bone.parent + 1) for bone in bones[2:]]
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])  # along its length
    for number, bone in enumerate(bones):
        rest = bone.rest.copy()
        if bone.name in ("root", "middle"):
            rest[:3, :3] = turn
        bones[number] = replace(bone, rest=rest, connected=bone.connected or bone.name == "hips")
    character = build_character(Character("Connected", tuple(bones)))
    assert character.data.bones["hips"].use_connect
    return character, replace(plain_map(made), root="root")


@pytest.mark.parametrize("lowest", ["root", "middle"])
@pytest.mark.parametrize("root_motion", list(RootMotion))
def test_the_root_carries_hips_that_are_connected_to_it(
    source: SegmentMotion, lowest: str, root_motion: RootMotion
) -> None:
    character, known = connected(lowest)
    made = performed(character, known, source, root_motion=root_motion, tolerance_mm=0.0)
    worst = 0.0
    for index, frame in enumerate(made.keys.frames):
        bpy.context.scene.frame_set(int(frame))
        for bone, poses in made.motion.poses.items():
            shown = np.array(character.pose.bones[bone].matrix)[:3, 3]
            worst = max(worst, float(np.linalg.norm(shown - poses[index, :3, 3])))
        root = np.array(character.pose.bones["root"].matrix)
        assert root[2, 1] > 0.999  # upright as at rest
    assert worst < 1e-4 and made.notes == ()
    few = performed(character, known, source, root_motion=root_motion)
    assert few.quality.keys < 0.5 * made.quality.keys
    assert few.quality.legs_deg is not None and few.quality.legs_deg < 3.0


def test_hips_that_nothing_can_carry_are_refused(source: SegmentMotion) -> None:
    character, known = plain_character(), plain_map(plain_character())
    held = build_character(character)
    for index in range(3):
        held.pose.bones["hips"].driver_add("location", index).driver.expression = "0.0"
    with pytest.raises(InputError, match="'hips' of 'Character' does not move with its own location"):
        performed(held, known, source)


@pytest.mark.parametrize("stature_m", [0.02, 20.0])
def test_directions_and_keys_are_the_same_at_any_size(source: SegmentMotion, stature_m: float) -> None:
    usual = plain_character(arms_down_deg=40.0)
    size = stature_m / 1.72
    bones = []
    for bone in usual.bones:
        rest = bone.rest.copy()
        rest[:3, 3] *= size
        bones.append(replace(bone, rest=rest, tail=size * bone.tail))
    known = plain_map(usual)
    one = performed(build_character(usual), known, source).quality
    other = performed(build_character(Character("Other", tuple(bones))), known, source).quality
    for name in ("arms_deg", "arms_worst_deg", "legs_deg", "legs_worst_deg"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), abs=0.3)
    assert other.keys == pytest.approx(one.keys, rel=0.05)
    assert other.penetration_mm is not None and other.penetration_mm < 2.0 * size


# --- The files beside the project


def imported(name: str) -> Made:
    """The character of a folder beside the project."""
    folder = FAILING / name
    if not folder.exists():
        pytest.skip("no files beside the project")
    file = next(one for one in sorted(folder.iterdir()) if one.suffix in (".blend", ".glb"))
    found = import_character(CharacterFile(file), bpy.context.scene).armature
    return found, recognize(read_character(found)).character_map


@pytest.mark.parametrize(
    "name",
    [
        *("11-hips-connected-to-a-root", "12-feet-without-a-parent", "13-rigid-parts"),
        *("turn4_mmd_legs_by_ik", "turn4_character_on_a_moving_platform"),
    ],
)
def test_characters_that_once_failed_perform(source: SegmentMotion, name: str) -> None:
    character, known = imported(name)
    made = performed(character, known, source)
    quality = made.quality
    assert quality.arms_worst_deg is not None and quality.arms_worst_deg < 8.0
    assert quality.legs_worst_deg is not None and quality.legs_worst_deg < 12.0
    assert not [note for note in made.notes if "below" in note or "off its place" in note]
    if "mmd" in name:  # whose mesh shows its targets, too
        return
    low = lowest_mm(character, made)
    assert low.min() > -2.0 and abs(np.median(low)) < 3.0
    assert quality.penetration_mm == pytest.approx(max(-low.min(), 0.0), abs=0.05)
