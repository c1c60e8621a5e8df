"""From a take on disk to the scene; `bridge/take_from_scene` goes the other way."""

from dataclasses import dataclass
from pathlib import Path

from bpy.types import Context, Operator

from ...core.arrays import Array
from ...core.markers.reading import clip_times
from ...core.progress import run
from ...core.take.description import KEYFRAME_FILE, describe
from ...core.take.evidence import EVIDENCE
from ...core.take.read_footage import check_frame_count, open_clip, rate_note
from ...core.take.take import Take
from ...core.take.take_file import read_described
from ..actor.take_actor import new_actor
from ..bridge.actions import assign_action
from ..bridge.keyframes import write_keyframes
from ..bridge.motions.import_motion import armature_reference
from ..bridge.result_files import show_footage, stored_path
from ..follow.evidence import add_keypoint_file
from ..follow.marker_search import set_marker_color
from ..follow.properties import add_ignored_regions
from ..footage.load_footage import hide_startup_cube, look_through_camera, show_range
from ..keyframes.found_result import add_candidate, add_match
from ..shell.base_operator import warn
from ..shell.keyed_frames import new_keyframe_action
from ..shell.notes import give_notices
from ..shell.takes import add_take


@dataclass(frozen=True, eq=False)
class OpenedTake:
    """A take read from disk, checked against its clip."""

    take: Take
    time_s: Array  # (F,) time of each frame [s]
    kinds: tuple[str, ...]  # The kinds of evidence that it is held against; it may have more
    notes: tuple[str, ...]  # Sentences to report
    hands: bool  # whether hands are looked at


def read_for_scene(folder: Path, keyframe_file: str = KEYFRAME_FILE) -> OpenedTake:
    """Read a take, checked against its clip; InputError if either is unusable, but for usual keyframes."""
    usual = keyframe_file == KEYFRAME_FILE
    description = describe(folder)
    keyframes = None if usual else folder / keyframe_file
    take = read_described(
        description, keyframes, keyframes_required=not usual, whole=True, read_armature=armature_reference
    )
    clip = open_clip(take)
    time_s = run(clip_times(clip))
    check_frame_count(take, len(time_s))
    rate = rate_note(take, clip)
    notes = (*take.notes, *(note for people in take.keypoints for note in people.notes))
    kinds = description.settings.evidence or EVIDENCE
    hands = description.settings.hands is not False
    return OpenedTake(take, time_s, kinds, (*notes, *([rate] if rate else [])), hands)


def open_in_scene(operator: Operator, context: Context, opened: OpenedTake) -> None:
    """Add a take to the scene, show its footage and range, and report its notes.

    Raises:
        InputError: Blender cannot read the clip; the scene is unchanged.
    """
    take, scene = opened.take, context.scene
    camera_object, frames = show_footage(
        scene, take.camera, take.clip, take.fps, take.frame_start, opened.time_s
    )
    settings = add_take(scene, take.name)
    settings.camera, settings.clip = camera_object, scene.active_clip
    armature_object = new_actor(context, settings, take.body)
    settings.stature = take.body.actor.stature_m
    settings.follow.use_hands = opened.hands
    for style in take.markers:
        marker = settings.markers.add()
        marker.name, marker.segment = style.name, style.segment
        set_marker_color(marker, style.color_srgb)
    add_ignored_regions(settings, take.ignored_regions)
    for people in take.keypoints:
        if people.file:
            add_keypoint_file(settings, Path(people.file))
    if take.reference is not None:
        settings.follow.reference = stored_path(Path(take.reference.file))
    for kind in EVIDENCE:
        setattr(settings.follow, f"use_{kind}", kind in opened.kinds)
    if take.keyframes:
        action = settings.keyframe_action = new_keyframe_action(armature_object)
        write_keyframes(armature_object, action, take.keyframes, frames)
        assign_action(armature_object, action)
    for keyframe in take.keyframes:
        if keyframe.matched is not None:
            matched = keyframe.matched
            match = add_match(settings, float(frames[keyframe.index]), matched.library)
            add_candidate(match, keyframe.posture, matched.posture, matched.mirrored, matched.confidence)
    scene.frame_set(scene.frame_start)
    hide_startup_cube(context)
    look_through_camera(context, settings)
    show_range(context)
    give_notices(settings, "footage", "files", [warn(operator, note) for note in opened.notes])
    operator.report({"INFO"}, f"Opened {take.name} with {len(take.keyframes)} keyframes")
