"""The stages of *Animate*: each does what its step's own operators do, and keeps its result in the scene."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.types import Context, Object, Operator, PropertyGroup, Scene

from ...core.camera.camera import Lens
from ...core.errors import InputError
from ...core.files.fields import listed
from ...core.files.json_file import write_atomically
from ...core.progress import Job, Progress, stretch
from ...core.take.conversion_settings import CharacterFile
from ..actor.take_actor import size_actor
from ..bridge.actor_bones import moved_by
from ..bridge.character.import_character import import_character
from ..bridge.footage import still_camera
from ..bridge.footage_camera import set_still_pose
from ..character.add_character import add_rigify_character
from ..character.characters import add_character
from ..character.retarget import keep_retargeted, retarget_take
from ..finish.bake_motion import bake, keep_baked
from ..follow.evidence import keypoint_path
from ..follow.load_keypoints import Detected, follow_file, keep_detected, keypoint_output
from ..footage.found_camera import is_found, write_fit
from ..footage.load_footage import lens_is_guess, load_into_take
from ..keyframes.pose_all import keep_poses
from ..keyframes.scene_session import SceneSession, read_session
from ..library.registry import named_libraries
from ..reconstruct.reconstruct import PreviewedJob, judge, keep_motion
from ..shell.take_state import TakeState
from ..shell.takes import active_take, footage_of, take_by_identifier
from . import FILE, NOTHING, RIGIFY

if TYPE_CHECKING:
    from ...core.detect.families.network import Network
    from ...core.session.session import Session

SEEN_SHARES = np.linspace(0.0, 1.0, 9)
"""Moments of the clip at which nothing may stand before the performer."""
MOST_HIDDEN = 1000
DETECTED = 0.62
"""Share of the job after which everybody is seen, at most, where that is all done again."""
VIEWED = 0.96
"""Share of the job at which all is made, and the performer is to be seen."""


def animate(
    operator: PreviewedJob,
    scene: Scene,
    stature_m: float,
    character: str,
    file: str,
    turns: bool = True,
    network: "Network | None" = None,
) -> Job[list[str]]:
    """Go from the active take's clip all the way; each stage's result is in the scene once it is complete.

    `turns`: a picture that is on its side or upside down is turned; `network` looks beside Keymark's own.

    Returns:
        A line on each stage.
    """
    from ...core.session.see import PictureTurnedError, require_upright
    from ...core.session.stages import reach
    from ...core.video.header import can_turn
    from ..reconstruct.live_preview import LivePreview

    take = active_take(scene)
    take.stature = stature_m
    lines: list[str] = []
    started = yield from stretch(_clip_session(scene, take, character, file, network), 0.0, 0.02)
    clip = footage_of(scene, take).path
    turns = turns and can_turn(clip)

    def keep(stage: str, session: "Session") -> Job[object] | None:
        if turns:
            require_upright(stage, session)
        made = replace(started, session=session)
        if stage == "reconstruct":
            return _keep_motion(operator, scene, made, lines)
        if stage in KEPT and session.made[stage] is not None:
            lines.append(KEPT[stage](operator, scene, made))
        if stage == "pose":
            found = active_take(scene)
            if found.live_preview:
                operator.preview = LivePreview(scene, found.armature, made.frames)
        return None

    try:
        yield from stretch(reach(started.session, "retarget", None, keep), 0.02, VIEWED)
    except PictureTurnedError as turned:
        turns = False
        lines.append(f"The picture is turned by {turned.turn_deg} degrees clockwise: people are upright so")
        load_into_take(bpy.context, turned_copy(clip, turned.turn_deg), False)
        again = _clip_session(scene, active_take(scene), character, file, network)
        started = yield from stretch(again, DETECTED, DETECTED)
        yield from stretch(reach(started.session, "retarget", None, keep), DETECTED, VIEWED)
    yield from stretch(_hide_what_stands_before(bpy.context, active_take(scene)), VIEWED, 1.0)
    scene.frame_set(scene.frame_start)
    overlays = scene.keymark.overlays
    overlays.only_character = bool(TakeState(active_take(scene)).results)
    for evidence in ("observed", "predicted", "keypoints"):  # whoever doubts shows it
        setattr(overlays, f"show_{evidence}", False)
    return lines


def turned_copy(clip: Path, turn_deg: int) -> Path:
    """A copy beside an MP4 or QuickTime clip that is shown turned clockwise; nothing is coded anew."""
    from ...core.video.header import write_turned

    copy = clip.with_name(f"{clip.stem}.turned{turn_deg}{clip.suffix}")
    write_atomically(copy, lambda beside: write_turned(clip, turn_deg, beside))
    return copy


def _clip_session(
    scene: Scene, take: PropertyGroup, character: str, file: str, network: "Network | None"
) -> Job[SceneSession]:
    """What is known of a clip: its performer's height, its keypoints if there are any, and about its lens."""
    from ...core.session.described import lens_of

    footage, matching = footage_of(scene, take), take.matching
    size = (footage.clip.size[0], footage.clip.size[1])
    lens, camera = lens_of(footage.path, size), still_camera(footage)
    if lens_is_guess(take):
        camera = lens.put(size)
    else:
        lens = Lens(camera.lens_mm, camera.sensor_width_mm, "as it is set", True)

    def retarget(_session: "Session") -> Job[object]:
        yield Progress("Opening the character", 0.0)
        _add_character(bpy.context, character, file)
        return (yield from stretch(retarget_take(scene), 0.1, 1.0))

    bridge: dict[str, Callable[[Session], Job[object]]] = {"finish": lambda _session: bake(scene)}
    if character != NOTHING:
        bridge["retarget"] = retarget
    return read_session(
        scene,
        take,
        camera=camera,
        detects=not TakeState(take).has_keypoints,
        network=None if TakeState(take).has_keypoints else network,
        open_lens=lens,
        floor_open=True,
        libraries=named_libraries(matching.library_name),
        floor_m=float(matching.floor_height) if matching.floor == "HEIGHT" else None,
        bridge=bridge,
    )


def _keep_keypoints(_operator: Operator, scene: Scene, made: SceneSession) -> str:
    from ...core.session.session import Sight

    inputs, take = made.session.inputs, take_by_identifier(scene, made.take)
    if not inputs.detects:
        return f"The keypoints are read from {listed(keypoint_path(one).name for one in take.follow.files)}"
    (people,) = made.session[Sight].people
    output = keypoint_output(take, footage_of(scene, take).path)
    return keep_detected(scene, Detected(made.take, output, people, inputs.take.fps, inputs.take.frame_start))


def _keep_place(_operator: Operator, scene: Scene, made: SceneSession) -> str:
    """Put camera and actor where they are; a camera that nothing tells stays as it was put."""
    from ...core.session.place import camera_in_words
    from ...core.session.session import Placed

    placed, take = made.session[Placed], take_by_identifier(scene, made.take)
    camera, found = placed.seen.take.camera, placed.camera
    assert found is not None
    words = camera_in_words(found)
    if found.lens.is_known and lens_is_guess(take):
        take.camera.data.lens *= found.lens.lens_mm / take.guessed_lens_mm
        take.guessed_lens_mm = 0.0
    if found.fit is None or not is_found(found.fit):
        take.camera_findings = f"Camera {words}"
    else:
        write_fit(take, found.fit)
    set_still_pose(take.camera, camera)
    size_actor(bpy.context, take, placed.seen.take.body)
    return f"Camera: {words}"


def _keep_poses(_operator: Operator, scene: Scene, made: SceneSession) -> str:
    """Key the poses; a camera that was seen to turn turns from now on, and the floor is where they stand."""
    from ...core.session.session import Posed
    from ...core.take.steady_camera import followed_camera
    from ..bridge.result_files import set_pose

    sentence, _ = keep_poses(scene, made)
    take, posed = take_by_identifier(scene, made.take), made.session[Posed]
    if posed.floor_m is not None:
        take.matching.floor, take.matching.floor_height = "HEIGHT", posed.floor_m
    set_pose(take.camera, followed_camera(posed.seen.take, posed.seen.reading), made.frames)
    return sentence


def _keep_motion(operator: PreviewedJob, scene: Scene, made: SceneSession, lines: list[str]) -> Job[None]:
    judged = yield from judge(made)
    operator.unwatch()  # the motion takes the place of its preview
    lines.append(keep_motion(operator, scene, made, judged))


KEPT = {
    "see": _keep_keypoints,
    "place": _keep_place,
    "pose": _keep_poses,
    "finish": lambda operator, scene, made: keep_baked(operator, scene, made.session.made["finish"]),
    "retarget": lambda operator, scene, made: keep_retargeted(operator, scene, made.session.made["retarget"]),
}
"""How the result of a stage is written into the scene; each returns a sentence on it."""


def follow_found_file(take: PropertyGroup, clip: Path) -> None:
    """Let a take follow the keypoints that lie beside its clip, where there are some."""
    from ...core.take.description import keypoints_beside

    file = keypoints_beside(clip)
    if file is not None and not TakeState(take).has_keypoints:
        follow_file(take, file)


def _add_character(context: Context, character: str, file: str) -> None:
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


def _opened(context: Context, file: str) -> Object:
    """The armature of a character's file, with all that belongs to it in the scene."""
    own = bpy.data.scenes.new("Character")
    try:
        imported = import_character(CharacterFile.parse(bpy.path.abspath(file)), own)
        imported.armature.data.display_type = "STICK"  # octahedra of long bones would hide the mesh
        for collection in list(own.collection.children):
            context.scene.collection.children.link(collection)
    finally:
        bpy.data.scenes.remove(own)
    return imported.armature


def _hide_what_stands_before(context: Context, take: PropertyGroup) -> Job[None]:
    """Hide, in the view layer, objects of others between the camera and the performer; Alt H shows them."""
    scene, layer = context.scene, context.view_layer
    actor = take.armature
    performers = filter(None, [actor, *(character.armature for character in take.characters)])
    own = {each for root in performers for each in (root, *moved_by(scene, root))}
    for share in SEEN_SHARES:
        yield Progress("Clearing the view", float(share))
        scene.frame_set(round(scene.frame_start + share * (scene.frame_end - scene.frame_start)))
        eye = take.camera.matrix_world.translation
        for bone in actor.pose.bones:
            target = actor.matrix_world @ bone.head
            for _ in range(MOST_HIDDEN):
                away = target - eye
                hit = scene.ray_cast(
                    context.evaluated_depsgraph_get(), eye, away.normalized(), distance=away.length
                )
                before = hit[4].original if hit[0] and hit[4] is not None else None
                if before is None or before in own or before.hide_get(view_layer=layer):
                    break
                before.hide_set(True, view_layer=layer)
                layer.update()
