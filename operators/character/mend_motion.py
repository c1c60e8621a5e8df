"""Motions from elsewhere: loaded from a file, and mended without footage."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.types import Context, Event, Operator, Scene

from ...core.errors import InputError
from ...core.progress import Job
from ...core.progress import run as run_job
from ...core.take.conversion_settings import CharacterFile
from ...core.take.reference import REFERENCE_ENDINGS, read_reference
from ..actor.take_actor import leave_mode, select_alone
from ..bridge.motions.action_names import action_names
from ..shell import need
from ..shell.base_operator import BaseOperator, browse, chosen_file, warn
from ..shell.fields import HIDDEN, SKIP_SAVE, Choice, File, Switch, Text
from ..shell.job_operator import JobOperator
from .characters import with_map
from .map_properties import map_of
from .recognition import map_folders

if TYPE_CHECKING:
    from ..bridge.motions.mend_action import MendedAction

SAME = "A new Action on the armature itself; fingers, face and toes move as before"
ONTO = (
    ("ARMATURE", "Same Armature", SAME),
    ("ACTOR", "Actor", "A new Keymark actor, whose Action any character can be given in this step"),
)
FILTER = "*.bvh;*.fbx;*.glb;*.gltf;*.vrm;*.usd;*.usda;*.usdc;*.usdz;*.blend;*.csv;*.npy;*.trc;*.c3d;*.json"


def animated(context: Context, _state: object) -> str | None:
    """The active object is an armature with an Action."""
    active = context.view_layer.objects.active
    if active is None or active.type != "ARMATURE":
        return "Select the armature whose motion is to be mended first, or load a motion"
    data = active.animation_data
    moving = data is not None and data.action is not None
    return None if moving else f"'{active.name}' has no Action; choose the one that moves it first"


def _actions(operator: Operator, context: Context, _typed: str) -> list[str]:
    chosen, space = Path(operator.filepath), context.space_data
    if isinstance(space, bpy.types.SpaceFileBrowser) and space.params is not None:
        chosen = Path(space.params.directory.decode()) / space.params.filename
    return action_names(chosen)


class KEYMARK_OT_load_motion(BaseOperator, bpy.types.Operator):
    """Load a motion that another program made: an animated armature, or points by name"""

    bl_label = "Load Motion"
    requirements = (need.bones_editable, need.idle)

    filepath: File("The motion's file", "File")
    object: Text("Armature", "Its armature, ROOT or subject, where the file has several", options=SKIP_SAVE)
    action: Text(
        "Action",
        "Name of its Action, where the armature has several; those of the file are listed",
        options=SKIP_SAVE,
        search=_actions,
    )
    filter_glob: Text(default=FILTER, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        return browse(self, context)

    def run(self, context: Context) -> None:
        from ...core.mend.mend_motion import MendOptions, mend_motion
        from ..bridge.motions.import_motion import load_motion
        from ..bridge.motions.mend_action import add_actor

        path, scene = chosen_file(self, "a motion, such as a .bvh or .fbx"), context.scene
        leave_mode(context)
        if path.suffix.lower() in REFERENCE_ENDINGS:
            reference = read_reference(path, self.object or None)
            rate = reference.fps or scene.render.fps / scene.render.fps_base
            mended = run_job(mend_motion(reference.points_m, rate, MendOptions()))
            loaded = add_actor(scene, mended.motion, path.stem, scene.frame_start)
            notes = (*reference.notes, *mended.notes)
        else:
            file = CharacterFile(path, self.object or None)
            loaded, notes = load_motion(file, scene, map_folders(), self.action or None)
        for note in notes:
            warn(self, note)
        select_alone(context, loaded)
        self.report({"INFO"}, f"'{loaded.name}' moves as {path.name} says")


class KEYMARK_OT_mend_motion(JobOperator, bpy.types.Operator):
    """Mend the active armature's motion: jitter, sliding feet, exchanged sides; frames you posed stay"""

    bl_label = "Mend Motion"
    requirements = (animated, need.idle)

    onto: Choice("Onto", "What is to move so", items=ONTO)
    posed: Text(
        "Posed Frames",
        "Frames that you posed, with commas between them, as in 12, 40, 88; those in which you "
        "set keys on a loaded motion are known",
    )
    plant_feet: Switch("Plant Feet", "Hold resting feet still; the hips go as the feet say", default=True)
    floor: Switch("On the Floor", "Bring the height on which the feet stand to zero", default=True)

    def start(self, scene: Scene) -> "Job[tuple[int, MendedAction]]":
        from ...core.mend.mend_motion import named_frames
        from ..bridge.motions.mend_action import mend_action
        from ..bridge.motions.read_poses import motion_map

        active = bpy.context.view_layer.objects.active
        frames = named_frames(self.posed, "Posed Frames")
        known = with_map(active)
        if known is not None:
            character_map = map_of(known.character_map)
        else:
            character_map = motion_map(active, map_folders()).character_map
        found = yield from mend_action(active, character_map, frames, self.plant_feet, self.floor)
        return active.session_uid, found

    def finish(self, scene: Scene, result: "tuple[int, MendedAction]") -> None:
        from ..bridge.motions.mend_action import add_actor, write_mended

        uid, found = result
        armature = next((one for one in bpy.data.objects if one.session_uid == uid), None)
        if armature is None:
            raise InputError("the armature was removed while the job ran; nothing was changed")
        if self.onto == "ACTOR":
            actor = add_actor(scene, found.mended.motion, f"{armature.name} Actor")
            name = actor.animation_data.action.name
            select_alone(bpy.context, actor)
        else:
            name = write_mended(armature, found).name
        for note in found.mended.notes:
            warn(self, note)
        posed = f", {len(found.posed)} posed" if found.posed else ""
        self.report({"INFO"}, f"'{name}' has the mended motion, {len(found.frames)} frames{posed}")
