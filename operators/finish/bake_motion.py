"""The final Action: baked, marked as an asset, and exported."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.types import Action, Context, Event, Object, Operator, OperatorProperties, PropertyGroup, Scene

from ...core.errors import InputError
from ...core.files.fields import listed
from ...core.progress import Job
from ...core.progress import run as run_job
from ..bridge.actions import assign_action
from ..bridge.actor_bones import moved_by
from ..bridge.asset_catalogs import catalog_file, ensure_catalog
from ..bridge.export_formats import FORMATS, export_motion
from ..bridge.rig import absence_note, motion_frames, shown_motion
from ..shell import need
from ..shell.base_operator import BaseOperator, operator, warn, warn_if_outdated
from ..shell.fields import HIDDEN, Choice, Switch, Text
from ..shell.job_operator import JobOperator
from ..shell.notes import give_notices
from ..shell.take_state import TakeState, digest_of
from ..shell.takes import active_take, actor_of, refresh_asset_browsers, take_by_identifier

if TYPE_CHECKING:
    from ..bridge.finish_motion import Finished


def mark_motion_asset(
    context: Context,
    take: PropertyGroup,
    action: Action,
    pictured: Action | None,
    actor: Object | None = None,
) -> None:
    """Mark an Action as an asset of the take's details and catalog, pictured as the actor performs one."""
    from ...core.report.mannequin import posture_picture
    from ..bridge.assets import AssetDetails, mark_asset

    settings, performer = take.finish, actor or take.armature
    picture = None
    if pictured is not None and performer is not None:
        motion = shown_motion(context.scene, performer, pictured, most_frames=3)
        picture = posture_picture(motion.body, motion.posture[len(motion.time_s) // 2])
    catalog = ensure_catalog(catalog_file(), settings.catalog) if settings.catalog.strip() else ""
    tags = [tag.strip() for tag in settings.tags.split(",") if tag.strip()]
    details = AssetDetails(catalog, tags, settings.author, settings.license, settings.description)
    mark_asset(action, details, picture)
    refresh_asset_browsers(context)


@dataclass(frozen=True, eq=False)
class FinishedTake:
    """A finished motion of a take."""

    take: str  # The take's identifier
    made_from: str  # Digest of the motion
    finished: "Finished"


def bake(scene: Scene) -> Job[FinishedTake]:
    """Finish the motion of the active take; the scene stays as it is."""
    from ..bridge.finish_motion import FinishOptions, finish_motion

    take = active_take(scene)
    settings, identifier, made_from = take.finish, take.identifier, digest_of(take.motion_action)
    options = FinishOptions(
        tolerance_m=settings.tolerance_mm / 1000.0 if settings.keys == "TOLERANCE" else None,
        whole_pose=settings.shared == "WHOLE_POSE",
        stray_m=settings.stray_mm / 1000.0 if settings.plant_feet else None,
    )
    frame_s = scene.render.fps_base / scene.render.fps
    job = finish_motion(take.armature, take.motion_action, take.keyframe_action, options, frame_s)
    del take, settings  # Blender may move them while the job runs
    return FinishedTake(identifier, made_from, (yield from job))


def keep_baked(operator: Operator, scene: Scene, result: FinishedTake) -> str:
    """Write the final Action; returns a sentence on it."""
    take, finished = take_by_identifier(scene, result.take), result.finished
    settings, armature_object = take.finish, actor_of(take)
    if take.motion_action is None:
        raise InputError("the motion has been deleted meanwhile; nothing was changed")
    if settings.action is None:
        settings.action = bpy.data.actions.new(f"{armature_object.name} Final")
    settings.action.use_fake_user = True
    settings.keys_after = finished.write(armature_object, take.motion_action, settings.action)
    settings.keys_before, settings.made_from = finished.keys_before, result.made_from
    settings.furthest_mm, settings.rests = 1000.0 * finished.furthest_m, len(finished.contacts)
    assign_action(armature_object, settings.action)
    scene.frame_set(scene.frame_current, subframe=scene.frame_subframe)
    give_notices(take, "finish", "bake", [warn(operator, note) for note in finished.notes])
    return (
        f"Baked {settings.keys_after} keys of {settings.keys_before} into '{settings.action.name}', "
        f"at most {settings.furthest_mm:.1f} mm off"
    )


class KEYMARK_OT_bake_motion(JobOperator, bpy.types.Operator):
    """Make the final Action, anew: your corrected motion with few keys, its resting feet standing still"""

    bl_label = "Bake Final Action"
    requirements = (need.actor, need.motion, need.idle)

    def start(self, scene: Scene) -> Job[FinishedTake]:
        return bake(scene)

    def finish(self, scene: Scene, result: FinishedTake) -> None:
        self.report({"INFO"}, keep_baked(self, scene, result))


@operator("Mark Asset", need.actor, need.motion, need.idle)
def mark_asset(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Mark the motion, the final Action if there is one, as an asset with catalog, tags and picture"""
    action = take.finish.action or take.motion_action
    mark_motion_asset(context, take, action, action)
    warn_if_outdated(operator, take)
    operator.report({"INFO"}, f"'{action.name}' is an asset now; save the .blend to keep it")


performance = need.of_take(lambda state: state.performers, "Reconstruct the motion first")


class KEYMARK_OT_export_motion(BaseOperator, bpy.types.Operator):
    """Write somebody's motion for another program; the actor's is baked first where that is due"""

    bl_label = "Export Motion"
    bl_options = {"REGISTER"}

    format: Choice(
        "Format",
        "Format of the file",
        items=[(kind, listed.name, listed.description) for kind, listed in FORMATS.items()],
        default="BVH",
    )
    who: Text("Who", "Name of the armature whose motion is written; the panel's choice where empty")
    bake: Switch("Bake", "Bake the final Action first where there is none of the motion", default=True)
    filepath: Text("File", "File to write", subtype="FILE_PATH")
    filter_glob: Text(default=";".join(f"*{listed.suffix}" for listed in FORMATS.values()), options=HIDDEN)

    requirements = (performance, need.idle)

    @classmethod
    def description(cls, context: Context, properties: OperatorProperties) -> str:
        chosen = FORMATS[properties.format]
        return chosen.missing() or chosen.description

    def invoke(self, context: Context, event: Event) -> set[str]:
        take, self.who = active_take(context.scene), ""
        folder, name = "//" if bpy.data.filepath else "", f"{take.name} {take.finish.who}"
        self.filepath = bpy.path.abspath(folder + bpy.path.clean_name(name) + FORMATS[self.format].suffix)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def draw(self, context: Context) -> None:
        take, of_actor = active_take(context.scene), FORMATS[self.format].of_actor
        draw_who(self.layout, take, of_actor)
        if not of_actor and take.armature is not None and take.finish.who == take.armature.name:
            self.layout.prop(self, "bake")

    def check(self, context: Context) -> bool:
        path = bpy.path.ensure_ext(self.filepath, FORMATS[self.format].suffix)
        changed = path != self.filepath
        self.filepath = path
        return changed

    def run(self, context: Context) -> None:
        if not self.filepath:
            raise InputError("no file is named to export to; give filepath")
        chosen, scene = FORMATS[self.format], context.scene
        missing = chosen.missing()
        if missing:
            raise InputError(f"{chosen.name} cannot be written: {missing}")
        take = active_take(scene)
        performing = {each.name: (each, action) for each, action in TakeState(take).performers}
        actors = [take.armature.name] if chosen.of_actor and take.armature is not None else []
        name = next(iter([*actors, self.who or take.finish.who]))
        if name not in performing:
            raise InputError(f"'{name}' performs nothing; valid is {listed(performing)}")
        who, action = performing[name]
        path = Path(bpy.path.ensure_ext(bpy.path.abspath(self.filepath), chosen.suffix))
        if who == take.armature:
            if self.bake and not chosen.of_actor and TakeState(take).newest[0] == "MOTION":
                keep_baked(self, scene, run_job(bake(scene)))
                if not bpy.app.background:
                    bpy.ops.ed.undo_push(message="Bake Final Action")
            action = take.finish.action or take.motion_action
            frames = motion_frames(who, action)
            export_motion(scene, who, action, (int(frames[0]), int(frames[-1])), chosen, path)
            warn_if_outdated(self, take)
            away = absence_note(who, take.motion_action, scene.render.fps / scene.render.fps_base)
            if away:
                warn(self, away)
        else:
            span = int(action.frame_range[0]), int(action.frame_range[1])
            export_motion(scene, who, action, span, chosen, path, moved_by(scene, who))
            state = TakeState(take)
            if any(state.of_earlier(result) for result in state.results if result.action == action):
                warn(self, f"'{who.name}' performs an earlier motion; retarget again for the newest")
        self.report({"INFO"}, f"Wrote what '{who.name}' performs: {path}")


def draw_who(layout: bpy.types.UILayout, take: PropertyGroup, of_actor: bool = False) -> None:
    """Draw the choice of whose motion is exported; of a format that holds the actor's alone, that it does."""
    row = layout.row()
    row.use_property_split, row.use_property_decorate = True, False
    if of_actor:
        row.label(text="The performer's own motion", icon="INFO")
    else:
        row.prop(take.finish, "who")
