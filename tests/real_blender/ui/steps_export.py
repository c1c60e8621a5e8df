"""A character with Mixamo's bones: what its FBX file shows, read back by Blender, is what the scene shows."""

import bpy
import numpy as np
from _boot import load_package
from driver import Steps, expect
from person import Person
from steps_prepare import choose_file

load_package()  # what builds characters is of the tree that is tested

from _armatures import build_character  # noqa: E402
from _characters import convention_names, plain_character  # noqa: E402

MOST_DEG = 1.0
LEAST_DEG = 10.0
"""What some bone turns at least; of a character that stands still, nothing would be seen."""
LOOKED_AT = 12  # frames, from the first to the last
UPRIGHT = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def add_mixamo(person: Person) -> None:
    """The rig as it comes out of Mixamo's files: in centimeters, Y up, turned and scaled as an object."""
    rig = build_character(plain_character(names=convention_names("Mixamo"), scale=0.01, turn=UPRIGHT))
    rig.name, rig.rotation_euler.x = "Mixamo", np.pi / 2.0
    bpy.context.view_layer.update()
    bpy.ops.keymark.add_character(armature=rig.name)
    added = person.take.characters[-1]
    expect(added.armature == rig and not added.problem, f"the rig was not recognized: {added.problem}")


def exported(person: Person) -> Steps[None]:
    """FBX by its button with the character as Who, into another scene; bones and joints are compared."""
    rig, scene, file = person.take.characters[-1].armature, person.scene, person.folder / "mixamo.fbx"
    expect(person.take.finish.who == rig.name, f"Who is {person.take.finish.who}")
    file.unlink(missing_ok=True)

    def ask() -> Steps[None]:
        yield from person.hands.click_button("keymark.export_motion", "format='FBX'")

    yield from choose_file(person, ask, file, "RET")
    frames = np.unique(np.linspace(scene.frame_start, scene.frame_end, LOOKED_AT).round().astype(int))
    wanted = _shown(rig, scene, frames)
    window, other = person.hands.window, bpy.data.scenes.new("Read Back")
    other.render.fps, other.render.fps_base = scene.render.fps, scene.render.fps_base
    window.scene = other
    with bpy.context.temp_override(window=window, scene=other, view_layer=other.view_layers[0]):
        bpy.ops.import_scene.fbx(filepath=str(file), anim_offset=0.0)
    made = [each for each in other.objects if each.type == "ARMATURE"]
    expect(len(made) == 1 and set(made[0].pose.bones.keys()) == set(rig.pose.bones.keys()), "other bones")
    found = _shown(made[0], other, frames, rig.pose.bones.keys())
    yield from person.look("read_back")
    window.scene = scene
    (turned, aimed), (turned_back, aimed_back) = wanted, found
    since_first = [each @ np.swapaxes(each[:1], -1, -2) for each in (turned, turned_back)]
    turns_deg = _angle_deg(np.einsum("fbij,fbij->fb", *since_first) / 2.0 - 0.5)  # rest poses cancel
    aims_deg = _angle_deg(np.einsum("fbi,fbi->fb", aimed, aimed_back))
    moved_deg = _angle_deg(np.einsum("fbi,bi->fb", aimed, aimed[0]))
    worst = max(turns_deg.max(), aims_deg.max())
    print(f"FBX: {turns_deg.max():.3f} and {aims_deg.max():.3f} degrees off, {moved_deg.max():.0f} moved")
    expect(moved_deg.max() > LEAST_DEG, f"bones move by {moved_deg.max():.1f} degrees only")
    expect(worst < MOST_DEG, f"what is read back is {worst:.2f} degrees off")


def _shown(
    rig: bpy.types.Object, scene: bpy.types.Scene, frames: np.ndarray, names: list[str] | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Rotations (F, B, 3, 3) of bones in the world, and directions (F, J, 3) from joint to joint."""
    turned, aimed = [], []
    names = list(names or rig.pose.bones.keys())
    for frame in frames:
        scene.frame_set(int(frame))
        bones = [rig.pose.bones[name] for name in names]
        worlds = [rig.matrix_world @ bone.matrix for bone in bones]
        turned.append([np.array(world.to_quaternion().to_matrix()) for world in worlds])
        pairs = [(bone.parent, bone) for bone in bones if bone.parent is not None]
        aims = [rig.matrix_world @ bone.head - rig.matrix_world @ above.head for above, bone in pairs]
        aimed.append([np.array(aim.normalized()) for aim in aims])
    return np.array(turned), np.array(aimed)


def _angle_deg(cosine: np.ndarray) -> np.ndarray:
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
