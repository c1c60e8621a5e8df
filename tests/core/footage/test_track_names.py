"""Names of motion tracks, as people give them."""

import pytest
from keymark.core.footage.keypoints.keypoints import BODY_POINTS
from keymark.core.footage.keypoints.layouts import named_point


@pytest.mark.parametrize(
    ("name", "point"),
    [
        ("wrist.L", "wrist.L"),
        ("Left Wrist", "wrist.L"),
        ("l_wrist", "wrist.L"),
        ("wrist_l.001", "wrist.L"),
        ("LWrist", "wrist.L"),
        ("rightKnee", "knee.R"),
        ("R-ANKLE", "ankle.R"),
        ("RIGHT_ELBOW_2", "elbow.R"),
        ("hips", "pelvis"),
        ("hip.R", "hip.R"),
        ("Big Toe Left", "toe.L"),
        ("small_toe.L", "small_toe.L"),
        ("Head", "head"),
        ("top of head", "crown"),
    ],
)
def test_a_name_tells_the_point(name: str, point: str) -> None:
    assert named_point(name) == point


@pytest.mark.parametrize(
    "name", ["Track", "Track.001", "", "L", "12", "wrist", "left right wrist", "head.L", "Marker L", "lamp.L"]
)
def test_other_names_tell_none(name: str) -> None:
    assert named_point(name) is None


def test_every_point_is_told_by_its_own_name() -> None:
    assert [point for point in BODY_POINTS if named_point(point) != point] == []
    titles = {
        point: point.replace("_", " ").replace(".L", " Left").replace(".R", " Right") for point in BODY_POINTS
    }
    assert [point for point, title in titles.items() if named_point(title.title()) != point] == []
