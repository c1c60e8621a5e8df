"""A network of one's own, chosen in the dialog of *Animate*, and the motion that is made with what it sees.

Usage: blender-screen --factory-startup --addons MODULE --enable-event-simulate --python network_session.py
       -- CLIP FOLDER NETWORK
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import bpy  # noqa: E402
import steps_first  # noqa: E402
from driver import Camera, Steps, drive, expect, turns  # noqa: E402
from person import EXTENSION, Person, keymark  # noqa: E402
from steps_prepare import choose_file  # noqa: E402

FIELD = 0.6, 94.0
"""Where the field is: as a share of the settings' width, and below their top [px]."""


def session(clip: Path, folder: Path, network: Path, camera: Camera) -> Steps[None]:
    """Its file written into the field, and the performer's armature follows its points, too."""
    example = Path(sys.modules[EXTENSION].__file__).parent / "presets" / "demo" / "greeting"
    person = Person(example, folder, camera, hurried=True)
    bpy.context.preferences.addons.new().module = EXTENSION  # as where it is installed for good
    preferences = bpy.context.preferences.addons[EXTENSION].preferences
    yield from steps_first.sidebar(person)

    def answer() -> Steps[None]:
        yield from person.hands.click_button("keymark.animate")
        yield from turns(20)
        operator = person.hands.area("FILE_BROWSER").spaces.active.active_operator
        operator.character = keymark("operators.animate").NOTHING
        region = person.hands.region("FILE_BROWSER", "TOOL_PROPS")
        across, below_px = FIELD
        yield from person.hands.click(region.x + across * region.width, region.y + region.height - below_px)
        yield from person.hands.press("A", ctrl=True)
        yield from person.hands.write(str(network))
        yield from person.hands.press("RET")
        written = preferences.network
        expect(written == str(network), f"the field has '{written}'")
        yield from person.look("dialog")

    yield from choose_file(person, answer, clip, "RET")
    yield from turns(10)
    yield from person.wait_for_job()
    expect(person.take.motion_action is not None, "there is no motion")
    (entry,) = person.take.follow.files
    file = keymark("operators.follow.evidence").keypoint_path(entry)
    second = keymark("core.files.json_file").read_json(file)["second"]
    expect(second["detector"] == "RTMPose, 17 points, 256 x 192", f"beside looked {second}")
    yield from person.look("animated")


if __name__ == "__main__":
    clip_name, folder_name, network_name = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(clip_name), Path(folder_name), Path(network_name), taking), taking)
