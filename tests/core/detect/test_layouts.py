"""Layouts show the points that detectors mean, and names of tracks those that people mean."""

import json
from pathlib import Path

import pytest
from keymark.core.body.human import HUMAN
from keymark.core.detect.keypoints import BODY_POINTS, mirrored_point
from keymark.core.detect.layouts import LAYOUTS, OWN, layout_of, named_point

SPOTS = {
    "coco17": {0: "nose", 3: "ear.L", 6: "shoulder.R", 9: "wrist.L", 11: "hip.L", 16: "ankle.R"},
    "coco18": {1: "neck", 2: "shoulder.R", 7: "wrist.L", 8: "hip.R", 13: "ankle.L", 14: "eye.R", 17: "ear.L"},
    "body25": {
        8: "pelvis",
        9: "hip.R",
        14: "ankle.L",
        15: "eye.R",
        19: "toe.L",
        21: "heel.L",
        23: "small_toe.R",
    },
    "halpe26": {17: "crown", 18: "neck", 19: "pelvis", 20: "toe.L", 23: "small_toe.R", 25: "heel.R"},
    "blazepose33": {
        2: "eye.L",
        5: "eye.R",
        8: "ear.R",
        17: "pinky.L",
        20: "index.R",
        22: "thumb.R",
        31: "toe.L",
    },
    "wholebody133": {16: "ankle.R", 19: "heel.L", 20: "toe.R", 93: "thumb.L", 117: "index.R", 129: "pinky.R"},
    "halpe136": {17: "crown", 99: "index.L", 132: "pinky.R"},
}
"""A few points of each, from the detectors' own descriptions."""


@pytest.mark.parametrize("name", LAYOUTS)
def test_points_are_those_of_the_detector(name: str) -> None:
    layout = LAYOUTS[name]
    assert {number: layout.points[number] for number in SPOTS[name]} == SPOTS[name]
    assert max(layout.points) < layout.count
    assert len(set(layout.names)) == len(layout.names)
    assert set(layout.names) <= set(BODY_POINTS)
    assert {mirrored_point(point) for point in layout.names} == set(layout.names)
    assert set(HUMAN.point_names) - set(layout.names) == {"head"}  # which no detector shows


def test_layouts_are_told_apart_by_their_number_of_points() -> None:
    assert all(layout_of(layout.count) is layout for layout in LAYOUTS.values())
    assert layout_of(21) is None


def test_the_schema_knows_all_names(repository: Path) -> None:
    path = repository / "presets" / "schemas" / "keypoints.schema.json"
    schema = json.loads(path.read_text(encoding="utf-8"))
    assert tuple(schema["properties"]["layout"]["enum"]) == (*LAYOUTS, OWN)
    assert tuple(schema["$defs"]["names"]["items"]["enum"]) == BODY_POINTS


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
        ("LKNEE", "knee.L"),
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
