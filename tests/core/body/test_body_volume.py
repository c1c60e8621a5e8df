"""The body's volume, its soles and its standing posture, held against geometry worked out by hand."""

import numpy as np
import pytest
from keymark.core.body.actor import SHARES_OF_STATURE, Actor
from keymark.core.body.body_volume import (
    HEAD_OVERSHOOT,
    HEEL_BEHIND,
    MARKER_SEGMENTS,
    Piece,
    PieceStack,
    body_pieces,
    hip_height_m,
    lower_sole_m,
    marker_parts,
    ring_quads,
    segment_piece,
    sole_heights_m,
    sole_offsets,
    sole_places,
    standing_height_m,
    standing_posture,
)
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body, Extremities, extremity_names, segment_ends, segment_turn
from keymark.core.body.posture import Posture
from keymark.core.body.rotations import exponential

BODY = Body(Actor.from_stature(1.8))
PIECE = Piece(
    "thigh.L", 0, np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 3.0]),
    np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([[0.4, 0.2], [0.3, 0.1]]),
)  # fmt: skip


def test_average_proportions_are_those_of_the_sources() -> None:
    expected = {
        **{"upper_arm.L": 0.156, "forearm.R": 0.155, "hand.L": 0.108, "thigh.R": 0.238, "shin.L": 0.248},
        **{"foot.R": 0.110, "shoulder_width": 0.220, "hip_width": 0.115, "trunk": 0.285, "neck_head": 0.135},
    }
    assert {name: SHARES_OF_STATURE[name] for name in expected} == expected
    assert BODY.actor.segments_m == {name: share * 1.8 for name, share in SHARES_OF_STATURE.items()}


def test_rings_close_a_tapered_ellipsoid() -> None:
    rings = PIECE.rings(sides=200, cap=60, shaft=4)
    assert rings.shape == (2 * 60 + 4 + 1, 200, 3)
    a, b, c, d = rings.reshape(-1, 3)[ring_quads(len(rings), 200)].reshape(-1, 4, 3).swapaxes(0, 1)
    tetrahedra = np.einsum("ni,ni->n", a, np.cross(b, c)) + np.einsum("ni,ni->n", a, np.cross(c, d))
    shaft = np.pi * 2.0 * (0.4 * 0.2 + 0.5 * (0.4 * -0.1 + 0.2 * -0.1) + 0.01 / 3.0)
    caps = 2.0 / 3.0 * np.pi * (0.4 * 0.2 * 0.2 + 0.3 * 0.1 * 0.1)
    assert tetrahedra.sum() / 6.0 == pytest.approx(shaft + caps, rel=2e-3)
    np.testing.assert_allclose(rings[0].mean(axis=0), (0.0, 0.0, 0.8), atol=1e-9)
    np.testing.assert_allclose(rings[-1].mean(axis=0), (0.0, 0.0, 3.1), atol=1e-9)
    assert np.ptp(rings[60], axis=0) == pytest.approx((0.8, 0.4, 0.0))


def test_a_piece_is_cut_and_changed() -> None:
    half = PIECE.cut(0.5, 2.0)
    np.testing.assert_allclose([half.start, half.end], [[0, 0, 2], [0, 0, 5]])
    np.testing.assert_allclose(half.half_widths, [[0.35, 0.15], [0.2, 0.02]])
    moved = PIECE.changed(np.array([0.1, 0.0, -1.0]), 1.5)
    np.testing.assert_allclose([moved.start, moved.end], [[0.1, 0, 0], [0.1, 0, 2]])
    np.testing.assert_allclose(moved.half_widths, [[0.6, 0.3], [0.45, 0.15]])


def test_pieces_lie_along_segments_and_across() -> None:
    pieces = {piece.segment: piece for piece in body_pieces(BODY)}
    assert set(MARKER_SEGMENTS) == {"trunk", *pieces} and len(pieces) == 15
    assert marker_parts("trunk") == ("pelvis", "chest") and marker_parts("shin.L") == ("shin.L",)
    for piece in pieces.values():
        axis = (piece.end - piece.start) / np.linalg.norm(piece.end - piece.start)
        frame = np.stack([piece.lateral, piece.sagittal, axis])
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
        np.testing.assert_allclose(np.cross(axis, piece.lateral), piece.sagittal, atol=1e-12)
    thigh, forearm = pieces["thigh.R"], segment_piece(BODY, "forearm.L")
    assert np.linalg.norm(thigh.end - thigh.start) == pytest.approx(BODY.actor.segments_m["thigh.R"])
    np.testing.assert_allclose(thigh.half_widths, 1.8 * np.array([[0.052, 0.052], [0.034, 0.036]]))
    np.testing.assert_allclose(thigh.lateral, (1.0, 0.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(forearm.lateral, (0.0, 1.0, 0.0), atol=1e-12)
    head = pieces["head"]
    assert np.linalg.norm(head.end - head.start) == pytest.approx(HEAD_OVERSHOOT * 0.135 * 1.8, rel=0.05)


def test_stacked_pieces_move_with_their_joints() -> None:
    stack = PieceStack.of(body_pieces(BODY))
    pose = BODY.pose(Posture.rest(HUMAN, (2,)).plus(np.random.default_rng(5).normal(0.0, 0.6, (2, 34))))
    for number, name in enumerate(stack.segments):
        if name != "head":
            np.testing.assert_allclose(
                stack.place(pose, stack.end)[:, number], BODY.segment_ends(pose, name)[1]
            )
    turned = stack.turn(pose, stack.end - stack.start)
    np.testing.assert_allclose(turned, stack.place(pose, stack.end) - stack.place(pose, stack.start))


def test_soles_reach_from_behind_the_ankle_to_the_tip() -> None:
    offsets = sole_offsets(BODY)
    foot = BODY.actor.segments_m["foot.L"]
    assert offsets[:, 0, 1] == pytest.approx([HEEL_BEHIND * foot] * 2)
    np.testing.assert_allclose(offsets[:, 0, [0, 2]], offsets[:, 1, [0, 2]])
    assert np.linalg.norm(offsets[:, 1], axis=-1) == pytest.approx([foot] * 2, rel=0.05)
    pose = BODY.pose(Posture.rest(HUMAN).plus(np.random.default_rng(6).normal(0.0, 0.5, 34)))
    places = sole_places(BODY, pose)
    for side, name in enumerate(("foot.L", "foot.R")):
        np.testing.assert_allclose(places[side, 1], BODY.segment_ends(pose, name)[1], atol=1e-12)
    turn = exponential(np.array([0.4, 0.1, -0.3]))
    above = segment_turn(BODY, pose, Extremities({}), "foot.L")
    start, end = segment_ends(BODY, pose, Extremities({"foot.L": turn}), "foot.L")
    np.testing.assert_allclose(end, start + above @ turn @ offsets[0, 1])
    assert set(extremity_names(HUMAN)) == {"hand.L", "hand.R", "foot.L", "foot.R"}


def test_a_standing_body_is_as_tall_as_its_parts_and_rests_on_the_ground() -> None:
    lengths = BODY.actor.segments_m
    legs = hip_height_m(BODY)
    assert legs == pytest.approx(lengths["thigh.L"] + lengths["shin.L"], rel=0.12)
    assert standing_height_m(BODY) == pytest.approx(legs + lengths["trunk"] + 1.4 * lengths["neck_head"])
    assert standing_height_m(BODY) == pytest.approx(1.8, rel=0.03)
    posture = standing_posture(BODY, np.array([1.0, 2.0, 0.5]), heading_rad=np.pi / 2, arms_lowered_rad=1.0)
    pose = BODY.pose(posture)
    assert lower_sole_m(BODY, posture) == pytest.approx(0.5, abs=1e-9)
    assert sole_heights_m(BODY, pose) == pytest.approx([0.5, 0.5], abs=1e-9)
    points = dict(zip(HUMAN.point_names, BODY.points(pose), strict=True))
    hips = (points["hip.L"] + points["hip.R"]) / 2.0
    np.testing.assert_allclose(hips, (1.0, 2.0, 0.5 + legs), atol=1e-9)
    np.testing.assert_allclose(points["hip.L"] - hips, (0.0, lengths["hip_width"] / 2.0, 0.0), atol=1e-9)
    arm = points["elbow.R"] - points["shoulder.R"]
    np.testing.assert_allclose(arm / lengths["upper_arm.R"], (0.0, -np.cos(1.0), -np.sin(1.0)), atol=1e-9)
