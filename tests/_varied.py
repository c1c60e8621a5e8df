"""Characters of many shapes with the truth beside them: bodies, poses, skeletons, things worn, spaces."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from _body_plan import SIDES, WORN, Builder, Plan
from keymark.core.arrays import Array
from keymark.core.retarget.character import Character, CharacterBone


@dataclass(frozen=True, eq=False)
class Varied:
    """A character, and the bones that play its roles."""

    character: Character
    truth: Mapping[str, tuple[str, ...]]
    ahead: Array
    """(3,) direction in which it faces, in the armature's space."""


def varied_plan(seed: int) -> Plan:
    """A plan drawn at random; the same for the same seed."""
    rng = np.random.default_rng(seed)
    kind = rng.choice(["adult", "child", "cartoon"], p=[0.6, 0.15, 0.25])
    plan = Plan()
    if kind == "adult":
        plan.leg, plan.trunk = rng.uniform(0.48, 0.54), rng.uniform(0.26, 0.31)
        plan.arm, plan.head = rng.uniform(0.27, 0.33), rng.uniform(0.1, 0.14)
    elif kind == "child":
        plan.leg, plan.trunk = rng.uniform(0.4, 0.46), rng.uniform(0.28, 0.32)
        plan.arm, plan.head = rng.uniform(0.24, 0.29), rng.uniform(0.16, 0.2)
    else:
        plan.leg, plan.trunk = rng.uniform(0.25, 0.45), rng.uniform(0.2, 0.35)
        plan.arm, plan.head = rng.uniform(0.2, 0.4), rng.uniform(0.15, 0.4)
        plan.shoulder_width = rng.uniform(0.06, 0.16)
        plan.hip_width = rng.uniform(0.03, 0.08)
    if kind != "cartoon":
        plan.shoulder_width = rng.uniform(0.085, 0.12)
        plan.hip_width = rng.uniform(0.045, 0.06)
    plan.height = float(rng.uniform(0.5, 2.6))
    plan.neck = float(rng.uniform(0.03, 0.08))
    plan.foot, plan.ankle = float(rng.uniform(0.06, 0.11)), float(rng.uniform(0.03, 0.07))
    plan.knee, plan.elbow = float(rng.uniform(0.46, 0.54)), float(rng.uniform(0.47, 0.56))
    plan.arms_down_deg = float(rng.choice([rng.uniform(-5, 5), rng.uniform(25, 60), rng.uniform(70, 88)]))
    plan.elbow_bend_deg = float(rng.choice([rng.uniform(0, 10), rng.uniform(10, 60)], p=[0.7, 0.3]))
    plan.knee_bend_deg = float(rng.uniform(0, 10))
    plan.legs_apart_deg = float(rng.choice([rng.uniform(0, 4), rng.uniform(4, 15)]))
    plan.spines, plan.necks = (
        int(rng.integers(1, 7)),
        int(rng.choice([0, 1, 2, 3], p=[0.07, 0.6, 0.25, 0.08])),
    )
    plan.shoulders, plan.toes = bool(rng.random() < 0.8), bool(rng.random() < 0.75)
    plan.hands = bool(rng.random() < 0.95)
    plan.fingers, plan.finger_bones = (
        int(rng.choice([0, 2, 3, 5], p=[0.3, 0.1, 0.1, 0.5])),
        int(rng.integers(1, 5)),
    )
    plan.head_end, plan.toe_end = bool(rng.random() < 0.35), bool(rng.random() < 0.35)
    plan.root = rng.choice([None, "ground", "center"], p=[0.45, 0.4, 0.15])
    plan.twists = rng.choice([None, "beside", "inside"], p=[0.6, 0.25, 0.15])
    plan.feet_on = str(rng.choice(["shin", "root"], p=[0.92, 0.08]))
    if plan.feet_on == "root":
        plan.root = "ground"
    plan.clavicles_on_neck = bool(plan.shoulders and plan.necks and rng.random() < 0.07)
    plan.thigh_holders = bool(rng.random() < 0.1)
    plan.worn = tuple(thing for thing in WORN if rng.random() < 0.18)
    plan.tails = str(rng.choice(["good", "aside", "far"], p=[0.65, 0.25, 0.1]))
    plan.noise = float(rng.choice([0.0, 0.002, 0.006]))
    plan.yaw_deg = float(rng.choice([0.0, 180.0, 90.0, rng.uniform(-180, 180)], p=[0.5, 0.15, 0.1, 0.25]))
    plan.y_up = bool(rng.random() < 0.25)
    plan.scale = float(rng.choice([1.0, 0.01, 100.0], p=[0.6, 0.25, 0.15]))
    plan.shuffled = bool(rng.random() < 0.5)
    return plan


def build(plan: Plan, seed: int = 0) -> Varied:
    """The character of a plan."""
    rng = np.random.default_rng([seed, 1])
    made = Builder()
    truth = _trunk(made, plan)
    for side, sign in SIDES.items():
        _leg(made, plan, side, sign, truth)
        _arm(made, plan, side, sign, truth)
    for thing in plan.worn:
        WORN[thing](made, plan, truth, rng)
    return _finished(made, plan, truth, rng)


def varied(seed: int) -> Varied:
    """A character drawn at random; the same for the same seed."""
    return build(varied_plan(seed), seed)


def _trunk(made: Builder, plan: Plan) -> dict[str, tuple[str, ...]]:
    H = plan.height
    hip, shoulder = plan.leg * H, (plan.leg + plan.trunk) * H
    parent = None
    if plan.root is not None:
        parent = made.add("root", None, np.zeros(3), np.array([0.0, 0.2 * H, 0.0]))
        if plan.root == "center":
            parent = made.add(
                "center", parent, np.array([0.0, 0.0, hip]), np.array([0.0, 0.0, hip + 0.1 * H])
            )
    waist = hip + 0.03 * H
    neck_base = shoulder + 0.025 * H
    skull = neck_base + plan.neck * H
    levels = np.linspace(waist + 0.02 * H, neck_base, plan.spines + 1)
    bend = 0.012 * H * np.sin(np.linspace(0, np.pi, plan.spines + 1))
    points = np.stack([np.zeros(plan.spines + 1), bend, levels], axis=1)
    made.add("hips", parent, np.array([0.0, 0.0, waist]), points[0])
    spine = made.chain("spine", "hips", points)
    necks = np.stack(
        [
            np.zeros(plan.necks + 1),
            -0.1 * np.linspace(0, plan.neck * H, plan.necks + 1),
            np.linspace(neck_base, skull, plan.necks + 1),
        ],
        axis=1,
    )
    top = np.array([0.0, -0.1 * plan.neck * H, skull + plan.head * H])
    last = spine[-1]
    neck = made.chain("neck", last, necks) if plan.necks else []
    head = made.add("head", neck[-1] if neck else last, necks[-1], top)
    if plan.head_end:
        made.add("head_end", head, top, top + [0, 0, 0.05 * H])
    found = {"hips": ("hips",), "spine": tuple(spine), "head": (head,)}
    return {**found, **({"neck": tuple(neck)} if neck else {})}


def _leg(made: Builder, plan: Plan, side: str, sign: float, truth: dict[str, tuple[str, ...]]) -> None:
    H = plan.height
    apart, bend = np.radians(plan.legs_apart_deg), np.radians(plan.knee_bend_deg)
    hip = np.array([plan.hip_width * H, 0.0, plan.leg * H])
    length = (plan.leg - plan.ankle) * H
    down = np.array([np.sin(apart), 0.0, -np.cos(apart)])
    knee = hip + length * plan.knee * (np.cos(bend) * down + np.sin(bend) * np.array([0.0, -1.0, 0.0]))
    ankle = hip + length * down
    toe = np.array([ankle[0] + 0.01 * H, ankle[1] - plan.foot * H, 0.012 * H])
    tip = toe + [0.0, -0.04 * H, 0.0]
    hip, knee, ankle, toe, tip = (point * [sign, 1.0, 1.0] for point in (hip, knee, ankle, toe, tip))
    above = "hips"
    if plan.thigh_holders:
        above = made.add(f"holder.{side}", above, made.heads[made.names.index("hips")], hip)
    thigh = made.add(f"thigh.{side}", above, hip, knee)
    shin_on = _twisted(made, plan, f"thigh_twist.{side}", thigh, hip, knee)
    shin = made.add(f"shin.{side}", shin_on, knee, ankle)
    foot_on = _twisted(made, plan, f"shin_twist.{side}", shin, knee, ankle)
    foot = made.add(f"foot.{side}", "root" if plan.feet_on == "root" else foot_on, ankle, toe)
    parts = {"thigh": thigh, "shin": shin, "foot": foot}
    if plan.toes:
        parts["toe"] = made.add(f"toe.{side}", foot, toe, tip)
        if plan.toe_end:
            made.add(f"toe_end.{side}", parts["toe"], tip, tip + (tip - toe) * 0.5)
    truth |= {f"{part}.{side}": (bone,) for part, bone in parts.items()}


def _twisted(made: Builder, plan: Plan, name: str, bone: str, head: Array, tail: Array) -> str:
    """Twist bones of a bone; what the next bone hangs on."""
    middle = 0.5 * (head + tail)
    if plan.twists == "beside":
        made.add(name, bone, middle, tail)
    elif plan.twists == "inside":
        return made.add(name, bone, middle, tail)
    return bone


def _arm(made: Builder, plan: Plan, side: str, sign: float, truth: dict[str, tuple[str, ...]]) -> None:
    H = plan.height
    down, bend = np.radians(plan.arms_down_deg), np.radians(plan.elbow_bend_deg)
    out = np.array([np.cos(down), 0.0, -np.sin(down)])
    ahead = np.array([0.0, -1.0, 0.0])
    start = np.array([plan.shoulder_width * H, 0.005 * H, (plan.leg + plan.trunk) * H])
    elbow = start + plan.elbow * plan.arm * H * (np.cos(0.3 * bend) * out - 0.3 * np.sin(bend) * ahead)
    along = np.cos(0.7 * bend) * out + np.sin(0.7 * bend) * ahead
    wrist = elbow + (1.0 - plan.elbow) * plan.arm * H * along
    knuckles = wrist + 0.05 * H * along
    spread = ahead - along * float(ahead @ along)
    spread /= max(float(np.linalg.norm(spread)), 1e-9)
    mirror = np.array([sign, 1.0, 1.0])
    above = truth["neck"][0] if plan.clavicles_on_neck else truth["spine"][-1]
    parts = {}
    if plan.shoulders:
        base = np.array([0.015 * H, 0.0, start[2] + 0.01 * H])
        above = parts["shoulder"] = made.add(f"shoulder.{side}", above, base * mirror, start * mirror)
    upper = parts["upper_arm"] = made.add(f"upper_arm.{side}", above, start * mirror, elbow * mirror)
    on = _twisted(made, plan, f"upper_arm_twist.{side}", upper, start * mirror, elbow * mirror)
    fore = parts["forearm"] = made.add(f"forearm.{side}", on, elbow * mirror, wrist * mirror)
    on = _twisted(made, plan, f"forearm_twist.{side}", fore, elbow * mirror, wrist * mirror)
    if plan.hands:
        hand = parts["hand"] = made.add(f"hand.{side}", on, wrist * mirror, knuckles * mirror)
        for finger in range(plan.fingers):
            aside = (finger - 0.5 * (plan.fingers - 1)) * 0.012 * H * spread
            steps = np.linspace(0.0, 0.05 * H, plan.finger_bones + 1)[:, None]
            made.chain(f"finger{finger}.{side}", hand, (knuckles + aside + steps * along) * mirror)
    truth |= {f"{part}.{side}": (bone,) for part, bone in parts.items()}


def _finished(
    made: Builder, plan: Plan, truth: Mapping[str, tuple[str, ...]], rng: np.random.Generator
) -> Varied:
    heads, tails = np.array(made.heads), np.array(made.tails)
    heads = heads + rng.normal(0.0, plan.noise, heads.shape)
    if plan.tails == "aside":
        tails = heads + [0.1 * plan.height, 0.0, 0.0]
    elif plan.tails == "far":
        tails = heads + (tails - heads) * 100.0
    yaw = np.radians(plan.yaw_deg)
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    if plan.y_up:
        turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]) @ turn
    heads, tails = heads @ turn.T / plan.scale, tails @ turn.T / plan.scale
    order = _shuffled(made.parents, rng) if plan.shuffled else list(range(len(made.names)))
    place = {bone: row for row, bone in enumerate(order)}
    bones = []
    for bone in order:
        rest = np.eye(4)
        rest[:3, 3] = heads[bone]
        name = plan.names.get(made.names[bone], made.names[bone])
        bones.append(CharacterBone(name, place.get(made.parents[bone], -1), rest, tails[bone]))
    named = {role: tuple(plan.names.get(name, name) for name in those) for role, those in truth.items()}
    return Varied(Character("Varied", tuple(bones), plan.scale), named, turn @ [0.0, -1.0, 0.0])


def _shuffled(parents: list[int], rng: np.random.Generator) -> list[int]:
    """A random order with parents before children."""
    open_bones = [bone for bone, parent in enumerate(parents) if parent < 0]
    order = []
    while open_bones:
        bone = open_bones.pop(int(rng.integers(len(open_bones))))
        order.append(bone)
        open_bones += [child for child, parent in enumerate(parents) if parent == bone]
    return order


def nameless(varied_character: Varied) -> Varied:
    """The same with bones called `bone_000` and so on."""
    names = {bone.name: f"bone_{n:03}" for n, bone in enumerate(varied_character.character.bones)}
    bones = tuple(replace(bone, name=names[bone.name]) for bone in varied_character.character.bones)
    truth = {role: tuple(names[name] for name in those) for role, those in varied_character.truth.items()}
    character = replace(varied_character.character, bones=bones)
    return replace(varied_character, character=character, truth=truth)
