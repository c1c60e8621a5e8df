"""Few keys on a character's controls, FK and IK together, within a tolerance of the character itself.

The body's keys are found first, then those of its legs in FK, then of what follows in IK. Legs are fitted to
the body that its few keys show, so that a resting foot rests however smooth the hips have become. Goals of
limbs that have both are fitted to the very places that the FK keys lead to, so that switching between them
moves nothing.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from types import MappingProxyType

import numpy as np

from ...arrays import Array
from ...keys.key_reduction import reduce_keys
from ...keys.rig import NO_TURN, Rig, RigBone
from ...progress import Part, scaled
from .control_channels import NOTHING, Control, ControlChannels, ControlKind, control_channels
from .control_motion import ChannelValues, ControlMotion, KeyedControl, leg_on_body
from .point_tolerances import CARRIED_SHARE, SWITCH_M, HeldPoint, PointKind, ToleranceRules

AFTER_BODY = (ControlKind.GOAL, ControlKind.TOE, ControlKind.POLE, ControlKind.FINGER)
Toleranced = tuple[Array, Array | Callable[[Array], Array]]
"""A point (3,) in its control's axes [m], and its tolerance (F,), or that from its path (F, 3) in the
armature's."""
Keyed = tuple[dict[int, KeyedControl], dict[int, ControlChannels]]  # by index the keys, and what they show


@dataclass(frozen=True)
class FollowingControls:
    """Controls that hang together and are fitted after what carries them."""

    controls: tuple[int, ...]  # indices among all controls, rising
    carrier: int  # index of the control that carries and turns them; NOTHING for none
    leg: str | None = None  # the leg that they are in FK


def reduce_controls(
    motion: ControlMotion, times: Array, rules: ToleranceRules, of: ChannelValues
) -> Part[tuple[KeyedControl, ...]]:
    """Find few keys for every control of a motion at rising scene frames (F,), at least two."""
    reduction = _Reduction(motion, times, rules, of)
    legs: dict[str, tuple[int, list[int]]] = {}
    for leg, limb in motion.limbs.items():
        if leg.startswith("leg") and limb.in_fk and limb.root_control != NOTHING:
            bones = {point.bone for point in motion.points if point.limb == leg}
            members = [index for bone in bones if (index := motion.fk_control(bone)) is not None]
            legs[leg] = (limb.root_control, members)
    body, following = control_stages(motion.controls, legs)
    keyed: dict[int, KeyedControl] = {}
    shown: dict[int, ControlChannels] = {}
    done = 0.0
    if body:
        # Share of the work that the body's controls are, where others follow.
        done = 0.5 if following else 1.0
        points = {index: reduction.points(index) for index in body}
        for name, limb in motion.limbs.items():  # the roots of the limbs that are fitted after it
            follows = not limb.in_fk or name in {group.leg for group in following}
            if limb.root_control in points and follows:
                root_m = rules.reach_m(motion.joints_m(name), CARRIED_SHARE)
                points[limb.root_control].append((motion.scale * limb.root_place, root_m))
        keyed, shown = yield from scaled(reduction.keys(motion.channels, points), 0.0, done)
    share = (1.0 - done) / max(len(following), 1)
    for group in following:
        more, now = yield from scaled(reduction.following(group, shown), done, done + share)
        keyed |= more
        shown |= now
        done += share
    return tuple(keyed[index] for index in range(len(motion.controls)))


def control_stages(
    controls: Sequence[Control], legs: Mapping[str, tuple[int, Collection[int]]]
) -> tuple[tuple[int, ...], tuple[FollowingControls, ...]]:
    """Indices of the controls that are fitted first, rising, and the others in the order of their fitting.

    `legs` are those in FK: the control that carries each, and the indices of its own.
    """
    above = [{control.space.turner, control.space.carrier} for control in controls]
    later: list[bool] = []
    for control, over in zip(controls, above, strict=True):
        later.append(
            control.plan.kind in AFTER_BODY or any(later[other] for other in over if other != NOTHING)
        )
    chains = []
    for leg, (carrier, members) in legs.items():
        others = [index for index in range(len(controls)) if index not in members and not later[index]]
        carries = any(above[index] & set(members) for index in others)
        if set().union(*(above[index] for index in members)) - set(members) == {carrier} and not carries:
            chains.append(FollowingControls(tuple(sorted(members)), carrier, leg))
    apart = {index for chain in chains for index in chain.controls}
    body = {index for index, late in enumerate(later) if not late} - apart
    # For each control that follows the first of those that it hangs together with.
    group: dict[int, int] = {}
    for index in sorted(set(range(len(controls))) - apart - body):
        near = {group[other] for other in above[index] if other in group}
        group[index] = min(near, default=index)
        group |= {other: group[index] for other, name in group.items() if name in near}
    for name in sorted(set(group.values())):
        members = tuple(index for index in sorted(group) if group[index] == name)
        outside = set().union(*(above[index] for index in members)) - set(members)
        if len(outside) == 1:
            chains.append(FollowingControls(members, outside.pop()))
        else:  # turned by one and carried by another: only the whole rig shows where they are
            body |= set(members)
    return tuple(sorted(body)), tuple(chains)


def control_rig(
    controls: Sequence[Control],
    channels: Sequence[ControlChannels],
    points: Mapping[int, Array],
    scale: float,
) -> tuple[Rig, dict[int, int], dict[int, int]]:
    """The rig of the controls at rising indices, with points (N, 3) fixed to each, from its head [m].

    What turns or carries one of them and is not among them is taken as still: the rig's axes are its axes.
    A control that is moved has a bone for its location, so that it has keys of its own, and another one on it
    that turns and carries: the rows of both are returned by index.
    """
    bones: list[RigBone] = []
    moved: dict[int, int] = {}
    turned: dict[int, int] = {}
    still = np.eye(3)
    for index, own in points.items():
        name, space = controls[index].name, controls[index].space
        parent, turner = (turned.get(other, NOTHING) for other in (space.carrier, space.turner))
        origin = scale * space.origin
        if channels[index].location is not None:
            moved[index] = len(bones)
            none = np.zeros((0, 3))
            bones.append(RigBone(name, parent, NO_TURN, still, still, origin, none, scale * space.axes))
            parent, origin = moved[index], np.zeros(3)
        turned[index] = len(bones)
        mode = NO_TURN if channels[index].rotation is None else controls[index].mode
        turned_by = None if turner == parent else turner
        bones.append(RigBone(name, parent, mode, space.turn, still, origin, own, None, turned_by))
    return Rig(tuple(bones)), moved, turned


@dataclass(frozen=True, eq=False)
class _Reduction:
    """What stays the same while keys are found, first of the body's controls, then of what follows them."""

    motion: ControlMotion
    times: Array
    rules: ToleranceRules
    of: ChannelValues

    def points(
        self, index: int, group: FollowingControls | None = None, carrier: ControlChannels | None = None
    ) -> list[Toleranced]:
        """The points that a control moves, of the body or of a group of others on a carrier."""
        return [
            (place, partial(self._tolerance, group, carrier, point))
            for point, place in self.motion.points_of(index)
        ]

    def keys(
        self,
        channels: Sequence[ControlChannels],
        points: Mapping[int, Sequence[Toleranced]],
        heads: Mapping[int, Array] = MappingProxyType({}),
    ) -> Part[Keyed]:
        """Find the keys of controls by index that hold their points, and their heads within (F,) [m]."""
        motion, times = self.motion, self.times
        places = {
            index: np.array([place for place, _ in points[index]]).reshape(-1, 3) for index in sorted(points)
        }
        rig, moved, turned = control_rig(motion.controls, channels, places, motion.scale)
        values = [np.zeros((len(times), 0))] * len(rig.bones)
        for index, row in turned.items():
            rotation, location = channels[index].rotation, channels[index].location
            if rotation is not None:
                values[row] = self.of(rotation, motion.controls[index].mode)
            if location is not None:
                values[moved[index]] = location
        target = rig.pose(values).points
        allowed = np.full(target.shape[:2], self.rules.body_m)
        for index, row in turned.items():
            start = rig.point_slices[row].start
            for column, (_, tolerance) in enumerate(points[index], start + 1):
                allowed[:, column] = tolerance(target[:, column]) if callable(tolerance) else tolerance
            if index in heads:
                allowed[:, start] = heads[index]
                allowed[:, rig.point_slices[moved.get(index, row)].start] = heads[index]
        reduced = yield from reduce_keys(rig, times, values, allowed, np.zeros(0, dtype=np.intp))
        pose = rig.pose([spline.evaluate(times, 0, len(times) - 1) for spline in reduced.splines])
        keyed, shown = {}, {}
        for index, row in turned.items():
            keyed[index] = KeyedControl(
                motion.controls[index],
                None if rig.bones[row].mode == NO_TURN else reduced.splines[row],
                reduced.splines[moved[index]] if index in moved else None,
            )
            place = pose.points[:, rig.point_slices[row].start] / motion.scale
            shown[index] = replace(channels[index], turn=pose.rotation[row], place=place)
        return keyed, shown

    def following(self, group: FollowingControls, shown: Mapping[int, ControlChannels]) -> Part[Keyed]:
        """Find the keys of controls that hang together; `shown` has the controls fitted before."""
        motion, rules = self.motion, self.rules
        known = {index: shown.get(index, channels) for index, channels in enumerate(motion.channels)}
        carrier = known.get(group.carrier)
        known = {index: channels for index, channels in known.items() if index not in group.controls}
        bones = None
        if group.leg is not None and group.carrier in shown:
            bones = {**motion.bones, **leg_on_body(motion, group.leg, shown[group.carrier])}
        own, heads = {}, {}
        for index in group.controls:
            control = motion.controls[index]
            if bones is None:
                own[control.name] = self._followed(control, shown)
            else:
                own[control.name] = bones[control.plan.bone] @ np.linalg.inv(motion.offsets[control.name])
            if control.plan.kind is ControlKind.POLE:
                limb = str(control.plan.limb)
                distance_m = motion.scale * motion.limbs[limb].pole_distance
                heads[index] = rules.pole_m(motion.joints_m(limb), distance_m)
        channels = motion.channels
        if any(motion.controls[index].plan.kind is not ControlKind.FINGER for index in group.controls):
            channels = control_channels(motion.controls, {**motion.wanted, **own}, motion.size, known)
        points = {index: self.points(index, group, carrier) for index in group.controls}
        keyed, local = yield from self.keys(channels, points, heads)
        if carrier is not None:
            for index, one in local.items():
                place = carrier.place + (carrier.turn @ one.place[..., None])[..., 0]
                local[index] = replace(one, turn=carrier.turn @ one.turn, place=place)
        return keyed, local

    def _followed(self, control: Control, shown: Mapping[int, ControlChannels]) -> Array:
        """(F, 4, 4) the pose of a control that brings hand or foot to where the FK keys have it.

        A resting foot is where it rests: the FK keys are a hair off.
        """
        motion = self.motion
        wanted, fk = motion.wanted[control.name], motion.fk_control(control.plan.bone)
        limb = motion.limbs.get(str(control.plan.limb))
        pole = control.plan.kind is ControlKind.POLE
        if pole or limb is None or not limb.in_fk or fk is None or fk not in shown:
            return wanted
        poses = np.tile(np.eye(4), (len(wanted), 1, 1))
        poses[:, :3, :3], poses[:, :3, 3] = shown[fk].turn, shown[fk].place
        offset = motion.offsets[motion.controls[fk].name] @ np.linalg.inv(motion.offsets[control.name])
        rests = self.rules.resting(control.plan.limb)[:, None, None]
        return np.where(rests, wanted, poses @ offset)

    def _tolerance(
        self,
        group: FollowingControls | None,
        carrier: ControlChannels | None,
        point: HeldPoint,
        path: Array,
    ) -> Array:
        """(F,) tolerance of a point on its path (F, 3) in the axes of what carries its controls [m]."""
        motion, rules = self.motion, self.rules
        if carrier is not None:
            path = motion.scale * carrier.place + (carrier.turn @ path[..., None])[..., 0]
        limb = motion.limbs.get(str(point.limb))
        shows_ik = limb is not None and limb.in_ik
        if group is None or group.leg is not None:
            allowed = rules.of(point, path, not shows_ik, rules.general_m)
            if group is not None:
                share = CARRIED_SHARE if point.kind is PointKind.BODY else 1.0
                allowed = np.minimum(allowed, share * rules.body_m)
            return allowed
        ends_m = SWITCH_M if limb is not None and limb.in_fk else rules.general_m
        allowed = rules.of(point, path, True, ends_m)
        if point.limb is not None and shows_ik and point.kind is PointKind.END:
            allowed = np.minimum(allowed, rules.reach_m(motion.joints_m(point.limb)))
        return allowed
