"""A network of somebody's own that looks beside Keymark's; the add-on's preferences remember its file."""

from dataclasses import dataclass
from os import W_OK, X_OK, access
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.types import AddonPreferences, Context, Event, Operator, PropertyGroup, Scene, UILayout

from ...core.detect.detector_formats import is_one_frame
from ...core.detect.keypoints import People
from ...core.errors import InputError
from ...core.files.json_file import read_json_value
from ...core.progress import Job, run
from ..bridge.scene_evidence import read_keypoint_file
from ..shell import need
from ..shell.base_operator import BaseOperator, browse, chosen_path, operator, remove_active, warn
from ..shell.fields import HIDDEN, SKIP_SAVE, File, Switch, Text
from ..shell.job_operator import JobOperator
from ..shell.results import EXTENSION, reading_of
from ..shell.takes import active_take, footage_of, redraw_footage, take_by_identifier
from .evidence import add_keypoint_file, clear_readings, keypoint_path, scene_evidence

if TYPE_CHECKING:
    from ...core.detect.families.network import Network


class KEYMARK_AP_preferences(bpy.types.AddonPreferences):
    """What holds for every file."""

    bl_idname = EXTENSION

    network: Text(
        "Network",
        "A network's file (.onnx) that looks for points of the body beside Keymark's own, as InstantHMR's "
        "or RTMPose's; empty for Keymark's own alone",
        subtype="FILE_PATH",
    )

    def draw(self, context: Context) -> None:
        self.layout.use_property_split = True
        draw_network(self.layout)


def _preferences() -> AddonPreferences | None:
    """Keymark's; None where it is not installed as an add-on."""
    addon = bpy.context.preferences.addons.get(EXTENSION)
    return None if addon is None else addon.preferences


def draw_network(layout: UILayout) -> None:
    """Draw whose network looks, where that can be remembered."""
    preferences = _preferences()
    if preferences is not None:
        layout.prop(preferences, "network", placeholder="Keymark's Own")


def chosen_network() -> "Network | None":
    """The network that is chosen in the preferences; None for Keymark's own alone."""
    from ...core.detect.families.table import open_network

    preferences = _preferences()
    if preferences is None or not preferences.network:
        return None
    return open_network(Path(bpy.path.abspath(preferences.network)))


# --- Files of keypoints of a take: loaded, removed, and made by Keymark's own network


class KEYMARK_OT_load_keypoints(BaseOperator, bpy.types.Operator):
    """Load points of the body that a detector has found in this clip: a file, or a folder with one a frame"""

    bl_label = "Load Keypoints"
    requirements = (need.footage, need.idle)

    filepath: File(
        "Keypoints of this clip: Keymark's own file or a detector's; where that writes a file a "
        "frame, the folder or any file in it"
    )
    replace: Switch(
        "Replace",
        "Let it take the place of the chosen file, as of one that was moved",
        default=False,
        options=SKIP_SAVE,
    )
    filter_glob: Text(default="*.json", options=HIDDEN)
    filter_folder: Switch(default=True, options=HIDDEN)

    def invoke(self, context: Context, event: Event) -> set[str]:
        if self.filepath:
            return self.execute(context)
        clip = active_take(context.scene).clip
        return browse(self, context, str(Path(bpy.path.abspath(clip.filepath)).parent))

    def run(self, context: Context) -> None:
        """Read the keypoints and hold them against the clip, and only then add them to the take."""
        from ...core.detect.keypoint_file import LARGEST_BYTES
        from ..bridge.take_from_scene import clip_frames

        take, path = active_take(context.scene), chosen_path(self)
        source = footage_of(context.scene, take)
        if not path.name:
            raise InputError(
                "filepath is empty; name the file of keypoints, or the folder with a file a frame"
            )
        if not path.is_dir() and is_one_frame(read_json_value(path, LARGEST_BYTES)):
            path = path.parent
        frames = run(clip_frames(source, scene_evidence(take), reading_of(take)))
        size = source.clip.size[0], source.clip.size[1]
        people = read_keypoint_file(path, len(frames), size, source.rate, source.first_frame)
        follow_file(take, path, self.replace)
        for note in people.notes:
            warn(self, note)
        loaded = f"Loaded {len(people.names)} points of {people.source}"
        seen = sum(len(frame.pixel) > 0 for frame in people.frames)
        self.report({"INFO"}, f"{loaded}, in {seen} of {len(people.frames)} frames")


def follow_file(take: PropertyGroup, path: Path, replace: bool = False) -> None:
    """Let a take follow the keypoints in a file, with `replace` in place of the chosen one's."""
    add_keypoint_file(take, path, replace)
    take.follow.use_keypoints = True
    clear_readings()
    redraw_footage(bpy.context)


@operator("Remove Keypoints", need.keypoint_files, need.idle)
def remove_keypoints(operator: Operator, context: Context, take: PropertyGroup) -> None:
    """Remove the chosen keypoints from the take; their file stays on disk"""
    remove_active(active_take(context.scene).follow, "files", "active_file")
    redraw_footage(context)


KEYPOINT_FILE = "keypoints.json"


@dataclass(frozen=True, eq=False)
class Detected:
    """Result of the job."""

    take: str  # The take's identifier
    output: Path  # The file to write
    people: People
    fps: float
    frame_start: int


def keep_detected(scene: Scene, found: Detected) -> str:
    """Write the keypoints beside the clip and let the take follow them; returns a sentence on them."""
    from ...core.detect.keypoint_file import write_keypoints

    take, people = take_by_identifier(scene, found.take), found.people
    write_keypoints(found.output, people, found.frame_start, found.fps)
    follow_file(take, found.output)
    seen = f"Somebody is seen in {people.seen_frames} of {len(people.frames)} frames"
    notes = "".join(f"; {note}" for note in people.notes)
    return f"{seen}; the keypoints are in {found.output.name}{notes}"


class KEYMARK_OT_detect_keypoints(JobOperator, bpy.types.Operator):
    """Find points of the body of everybody in the whole clip"""

    bl_label = "Detect Keypoints"
    requirements = (need.footage, need.idle)

    def start(self, scene: Scene) -> Job[Detected]:
        """Find everybody in the active take's clip."""
        from ...core.detect.closer_look import CloserLook
        from ...core.detect.pose_network import PoseNetwork
        from ...core.detect.pose_tracking import find_people
        from ...core.take.read_footage import open_footage

        take = active_take(scene)
        identifier, source = take.identifier, footage_of(scene, take)
        output, first = keypoint_output(take, source.path), source.first_frame
        clip = open_footage(source.path, source.rate, (source.clip.size[0], source.clip.size[1]))
        closer = CloserLook(chosen_network(), bool(take.follow.use_hands))
        people = yield from find_people(clip, PoseNetwork(), closer)
        return Detected(identifier, output, people, clip.fps, first)

    def finish(self, scene: Scene, result: Detected) -> None:
        self.report({"INFO"}, keep_detected(scene, result))


def keypoint_output(take: PropertyGroup, clip: Path) -> Path:
    """The file that the keypoints go into: beside the clip, where nothing else lies."""
    from ...core.take.description import sidecar_file

    wanted = sidecar_file(clip, KEYPOINT_FILE)
    if not access(wanted.parent, W_OK | X_OK):
        raise InputError(f"{wanted.parent}: cannot be written; the keypoints belong beside the clip")
    known = {keypoint_path(entry) for entry in take.follow.files}
    names = [wanted, *(sidecar_file(clip, f"keypoints{number}.json") for number in range(2, 1000))]
    return next((name for name in names if name in known or not name.exists()), wanted)
