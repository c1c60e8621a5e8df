"""The stages of *Animate*: each does what its step's own operators do, and keeps its result in the scene."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Vector

from ...core.errors import InputError
from ...core.files.fields import listed
from ...core.progress import Job, Progress, stretch
from ...core.take.character_settings import CharacterFile
from ..actor.take_actor import size_actor
from ..bridge.camera_placement import still_camera
from ..bridge.footage_camera import set_still_pose
from ..character.add_character import add_rigify_character
from ..character.characters import add_character
from ..character.retarget import keep_retargeted, retarget_take
from ..finish.bake_motion import bake, keep_baked
from ..follow.camera_from_lines import standing_performer
from ..follow.evidence import has_keypoints, keypoint_path
from ..follow.load_keypoints import detect, follow_file, keep_detected
from ..footage.found_camera import is_found, write_fit
from ..footage.take_footage import lens_is_guess
from ..keyframes.pose_all import find_poses, keep_poses
from ..reconstruct.reconstruct import keep_reconstruction, reconstruct_take
from ..shell.takes import active_take, footage_of
from . import FILE, NOTHING, RIGIFY

if TYPE_CHECKING:
    pass

SEEN_SHARES = np.linspace(0.0, 1.0, 9)
"""Moments of the clip at which nothing may stand before the performer."""
MOST_HIDDEN = 1000


def animate(
    operator: bpy.types.Operator, scene: bpy.types.Scene, stature_m: float, character: str, file: str
) -> "Job[list[str]]":
    """Go from the active take's clip all the way; each stage's result is in the scene once it is complete.

    Returns:
        A line on each stage.
    """
    said: list[str] = []
    context = bpy.context
    take = active_take(scene)
    take.stature = stature_m
    if has_keypoints(take):
        said.append(
            f"The keypoints are read from {listed(keypoint_path(one).name for one in take.follow.files)}"
        )
    else:
        found = yield from stretch(detect(scene), 0.0, 0.4)
        said.append(keep_detected(scene, found))
    yield Progress("Placing the camera", 0.4)
    said.append(_place_camera(active_take(scene), stature_m))
    said.append(_build_actor(context, active_take(scene), stature_m))
    matching = active_take(scene).matching
    floor_m = float(matching.floor_height) if matching.floor == "HEIGHT" else None
    poses = yield from stretch(find_poses(scene, "", floor_m), 0.4, 0.7)
    said.append(keep_poses(scene, poses)[0])
    result = yield from stretch(reconstruct_take(scene, lambda _preview: None), 0.7, 0.88)
    said.append(keep_reconstruction(operator, scene, result))
    finished = yield from stretch(bake(scene), 0.88, 0.92)
    said.append(keep_baked(operator, scene, finished))
    if character != NOTHING:
        yield Progress("Opening the character", 0.92)
        _add_character(context, character, file)
        retargeted = yield from stretch(retarget_take(scene), 0.93, 1.0)
        said.append(keep_retargeted(operator, scene, retargeted))
    _hide_what_stands_before(context, active_take(scene))
    scene.frame_set(scene.frame_start)
    return said


def follow_found_file(take: bpy.types.PropertyGroup, clip: Path) -> None:
    """Let a take follow the keypoints that lie beside its clip, where there are some."""
    from ...core.take.description import keypoints_beside

    file = keypoints_beside(clip)
    if file is not None and not has_keypoints(take):
        follow_file(take, file)


def _place_camera(take: bpy.types.PropertyGroup, stature_m: float) -> str:
    """Find the camera by the performer; it stays as it was put where they do not tell it."""
    from ...core.session.lens import lens_of
    from ...core.session.place import FoundCamera, camera_by_performer, camera_in_words

    source = footage_of(take.id_data, take)
    lens = lens_of(source.path, (source.clip.size[0], source.clip.size[1]))
    if lens.is_known and lens_is_guess(take):
        source.camera.data.lens *= lens.lens_mm / take.guessed_lens_mm
        take.guessed_lens_mm = 0.0
    uprights = standing_performer(take, stature_m)
    camera, fit = camera_by_performer(still_camera(source), not lens_is_guess(take), uprights)
    said = camera_in_words(FoundCamera(fit, lens, len(uprights)))
    if fit is None or not is_found(fit):
        take.camera_findings = f"Camera {said}"
        return take.camera_findings
    write_fit(take, fit)
    set_still_pose(source.camera, camera)
    take.matching.floor, take.matching.floor_height = "HEIGHT", 0.0
    return f"Camera: {said}"


def _build_actor(context: bpy.types.Context, take: bpy.types.PropertyGroup, stature_m: float) -> str:
    from ...core.body.actor import Actor
    from ...core.body.kinematics import Body

    size_actor(context, take, Body(Actor.from_stature(stature_m)))
    return f"The actor is {stature_m:.2f} m tall, of average proportions"


def _add_character(context: bpy.types.Context, character: str, file: str) -> None:
    take = active_take(context.scene)
    if character == RIGIFY:
        add_rigify_character(context)
        return
    armature = _opened(context, file) if character == FILE else bpy.data.objects.get(character)
    if armature is None:
        raise InputError(f"'{character}' is gone from the scene; add another character in the step Character")
    known = [index for index, each in enumerate(take.characters) if each.armature == armature]
    if known:
        take.active_character = known[0]
    else:
        add_character(take, armature)


def _opened(context: bpy.types.Context, file: str) -> bpy.types.Object:
    """The armature of a character's file, with all that belongs to it in the scene."""
    from ..bridge.character.import_character import import_character

    own = bpy.data.scenes.new("Character")
    try:
        imported = import_character(CharacterFile.parse(bpy.path.abspath(file)), own)
        imported.armature.data.display_type = "STICK"  # octahedra of long bones would hide the mesh
        for collection in list(own.collection.children):
            context.scene.collection.children.link(collection)
    finally:
        bpy.data.scenes.remove(own)
    return imported.armature


def _hide_what_stands_before(context: bpy.types.Context, take: bpy.types.PropertyGroup) -> None:
    """Hide, in the view layer, objects of others between the camera and the performer; Alt H shows them."""
    scene, layer = context.scene, context.view_layer
    own = set(_of_performers(take))
    actor = take.armature
    for share in SEEN_SHARES:
        scene.frame_set(round(scene.frame_start + share * (scene.frame_end - scene.frame_start)))
        eye = take.camera.matrix_world.translation
        for bone in actor.pose.bones:
            target = actor.matrix_world @ bone.head
            for _ in range(MOST_HIDDEN):
                before = _first_between(context, eye, target)
                if before is None or before in own or before.hide_get(view_layer=layer):
                    break
                before.hide_set(True, view_layer=layer)
                layer.update()


def _first_between(context: bpy.types.Context, eye: Vector, target: Vector) -> bpy.types.Object | None:
    away = target - eye
    graph = context.evaluated_depsgraph_get()
    hit, _, _, _, found, _ = context.scene.ray_cast(graph, eye, away.normalized(), distance=away.length)
    return found.original if hit and found is not None else None


def _of_performers(take: bpy.types.PropertyGroup) -> Iterator[bpy.types.Object]:
    """The actor and the characters with what they move."""
    roots = [take.armature, *(character.armature for character in take.characters)]
    for root in filter(None, roots):
        yield root
        yield from root.children_recursive
        for each in take.id_data.objects:
            if any(getattr(modifier, "object", None) == root for modifier in each.modifiers):
                yield each
