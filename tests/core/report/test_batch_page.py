"""The page of a batch: its elements are the template's for any names and texts of takes."""

import base64
import hashlib
import re
from itertools import product
from pathlib import Path
from urllib.parse import unquote

import pytest
from _command_line import RECORD, Page, converted, failed, waiting
from hypothesis import given, settings
from hypothesis import strategies as st
from keymark.core.report.batch_page import (
    LONGEST,
    STYLE,
    Verdict,
    duration,
    percent,
    sections,
    summary_page,
    verdict,
    visible,
)
from keymark.core.shoot.outcomes import Outcome, Status
from keymark.core.take.conversion_record import ConversionRecord
from keymark.core.take.evidence import UsedEvidence, UsedKeypoints

OUTPUT = Path("results").absolute()
LETTERS = st.characters(exclude_categories=(), exclude_characters="/")
TEXTS = st.one_of(
    st.text(LETTERS, min_size=1, max_size=30),
    st.sampled_from(
        ["</script><script>alert(1)</script>", "\u202egpj.exe", "\" onerror='x'", "<!--", "]]>", "&lt;"]
    ),
)
NAMES = TEXTS.filter(lambda text: text not in (".", "..") and "\0" not in text)


def page(*outcomes: Outcome) -> Page:
    return Page(summary_page("shoot", outcomes, OUTPUT))


def hostile(name: str, text: str) -> tuple[Outcome, Outcome]:
    """A converted and a failed take with a text in every field."""
    files = {f"{name}.json": "", f"report/{name}.png": "", "report/overlay.png": ""}
    evidence = UsedEvidence((text,), (UsedKeypoints(text, ("nose",), 1.0),))
    record = ConversionRecord(
        **{
            **vars(RECORD),
            "evidence": evidence,
            "take": text,
            "library": text,
            "method": text,
            "notes": (text,),
            "files": files,
        }
    )
    return (
        Outcome(f"a/{name}", OUTPUT / "a" / name, Status.CONVERTED, record),
        Outcome(f"b/{name}", OUTPUT / "b" / name, Status.FAILED, None, text),
    )


@settings(max_examples=60, deadline=None)
@given(NAMES, TEXTS, TEXTS)
def test_takes_can_say_anything_and_change_nothing_but_text(name: str, text: str, title: str) -> None:
    found = Page(summary_page(title, hostile(name, text), OUTPUT))
    assert found.shape() == page(*hostile("x", "y")).shape()
    assert found.all("h1")[0].text == visible(title)
    names = [element.text for element in found.all("th") if element.attributes.get("scope") == "row"]
    assert [said.removesuffix("failed").removesuffix("converted") for said in names] == [
        f"b/{visible(name)}",
        f"a/{visible(name)}",
    ]
    errors = [element.text for element in found.all("p") if element.attributes.get("class") == "error"]
    assert errors == [visible(text)]
    assert visible(text) in [element.text for element in found.all("li")]
    texts = [element.text for element in found.all("bdi")]
    assert texts.count(visible(text)) >= 3 and visible(f"{name}.json") in texts
    for element in found.elements:
        for link in (element.attributes.get("href"), element.attributes.get("src")):
            assert link is None or re.fullmatch(r"[A-Za-z0-9_.~%/-]+", link), link


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("walk über 動作 حركة", "walk über 動作 حركة"),
        ("gpj\u202eexe", "gpj\\u202eexe"),
        ("two\nlines\x1b[2J", "two\\nlines\\x1b[2J"),
        ("no\udcffletter", "no\\udcffletter"),
        ("x" * 2 * LONGEST, "x" * LONGEST + " ..."),
    ],
)
def test_what_cannot_be_seen_is_spelt_out(text: str, shown: str) -> None:
    assert visible(text) == shown and shown.encode("utf-8")


def test_links_lead_to_the_files(tmp_path: Path) -> None:
    name = "day 1/50% #2?x=1&y;\"'\\ ż:\u202e"
    folder = tmp_path / name
    for file in RECORD.files:
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).touch()
    outcome = Outcome(name, folder, Status.CONVERTED, RECORD)
    found = Page(summary_page("shoot", [outcome], tmp_path))
    links = [a.attributes["href"] for a in found.all("a")] + [i.attributes["src"] for i in found.all("img")]
    files = {tmp_path / unquote(link) for link in links}
    assert {folder, *(folder / file for file in RECORD.files)} == files
    assert all(file.exists() for file in files)


def test_the_page_allows_its_own_style_and_nothing_else() -> None:
    found = page(converted(OUTPUT, "walk"))
    policy = found.all("meta")[1].attributes["content"]
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules["default-src"] == rules["base-uri"] == rules["form-action"] == "'none'"
    (style,) = found.all("style")
    digest = base64.b64encode(hashlib.sha256(style.text.encode()).digest()).decode()
    assert rules["style-src"] == f"'sha256-{digest}'" and not found.all("script")
    attributes = {name for element in found.elements for name in element.attributes}
    assert "style" not in attributes and not any(name.startswith("on") for name in attributes)
    assert "//" not in re.sub(r"sha256-\S+", "", found.markup)


def test_everyone_can_read_the_page() -> None:
    found = page(converted(OUTPUT, "walk"), failed(OUTPUT, "fall", "no clip"), waiting(OUTPUT, "jump"))
    assert found.all("html")[0].attributes["lang"] == "en"
    assert {th.attributes["scope"] for th in found.all("th")} == {"col", "row", "rowgroup"}
    (image,) = found.all("img")
    assert image.attributes["alt"] and image.attributes["loading"] == "lazy"
    roles = {"table": "table", "tr": "row", "td": "cell", "tbody": "rowgroup", "thead": "rowgroup"}
    for element in found.elements:  # a narrow window shows them as blocks, which would take their meaning
        assert element.attributes.get("role") == roles.get(element.tag) or element.tag not in roles


LIGHT, DARK = (dict(re.findall(r"--(\w+):(#\w{6});", line)) for line in STYLE.splitlines()[:2])
"""The colors of day and night, by the names that the style has for them."""


@pytest.mark.parametrize("colors", [LIGHT, DARK], ids=["light", "dark"])
def test_words_stand_out_from_what_is_below_them(colors: dict[str, str]) -> None:
    def luminance(color: str) -> float:
        shares = [int(color[index : index + 2], 16) / 255 for index in (1, 3, 5)]
        linear = [share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4 for share in shares]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    def contrast(one: str, other: str) -> float:
        low, high = sorted((luminance(colors[one]), luminance(colors[other])))
        return (high + 0.05) / (low + 0.05)

    assert set(LIGHT) == set(DARK) and LIGHT != DARK
    words = ("ink", "soft", "link", "failed", "poor", "fair", "good")
    for word, ground in product(words, ("paper", "card")):
        assert contrast(word, ground) >= 4.5, (word, ground)
    assert contrast("ink", "wash") >= 4.5
    assert min(contrast(bar, "track") for bar in ("poor", "fair", "good")) >= 3.0


@pytest.mark.parametrize(
    ("confidence", "weakest", "expected"),
    [
        (0.75, 0.5, Verdict.GOOD),
        (0.95, 0.49, Verdict.FAIR),
        (0.7499, 0.7, Verdict.FAIR),
        (0.5, 0.1, Verdict.FAIR),
        (0.4999, 0.4, Verdict.POOR),
        (None, None, Verdict.UNJUDGED),
    ],
)
def test_confidence_in_a_word(confidence: float | None, weakest: float | None, expected: Verdict) -> None:
    outcome = converted(OUTPUT, "walk", confidence=confidence, weakest=weakest)
    assert verdict(outcome) is expected
    warned = converted(OUTPUT, "walk", confidence=confidence, weakest=weakest, warnings=("Legs are off",))
    assert verdict(warned) is Verdict.POOR and "Legs are off" in page(warned).rows()[0].text
    (row,) = page(outcome).rows()
    assert expected.value in row.text
    if confidence is not None:
        assert percent(confidence) in row.text and (percent(confidence) == "75\u00a0%") == (
            confidence == 0.75
        )


def test_takes_that_need_a_person_come_first() -> None:
    outcomes = [
        converted(OUTPUT, "a good"),
        waiting(OUTPUT, "a waits"),
        converted(OUTPUT, "b fair", confidence=0.7),
        converted(OUTPUT, "a fair", confidence=0.6),
        converted(OUTPUT, "c poor", confidence=0.2),
        failed(OUTPUT, "z failed", "no clip"),
        converted(OUTPUT, "m unjudged", confidence=None, weakest=None, method="interpolation"),
    ]
    order = [outcome.take for those in sections(outcomes).values() for outcome in those]
    assert order == ["z failed", "c poor", "a fair", "b fair", "m unjudged", "a good", "a waits"]
    found = page(*outcomes)
    assert [row.text.startswith(name) for row, name in zip(found.rows(), order, strict=True)] == [True] * 7


def test_more_rows_than_a_browser_shows_are_left_to_programs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("keymark.core.report.batch_page.MOST_ROWS", 3)
    fair = [converted(OUTPUT, f"fair {number}", confidence=0.6) for number in range(4)]
    found = page(*fair, failed(OUTPUT, "z", "no clip"), converted(OUTPUT, "good"))
    assert [row.text[:6].strip() for row in found.rows()] == ["zfaile", "fair 0", "fair 1"]
    headings = [th.text for th in found.all("th") if th.attributes["scope"] == "rowgroup"]
    assert "2 of them are in summary.jsonl alone" in headings[1] and "1 of them" in headings[2]
    assert found.all("dd")[0].text == "6"


def test_the_head_counts_what_was_converted_now_or_before() -> None:
    found = page(
        converted(OUTPUT, "a"),
        Outcome("b", OUTPUT / "b", Status.UNCHANGED, RECORD),
        failed(OUTPUT, "c", "no clip", RECORD),
        waiting(OUTPUT, "d"),
    )
    figures = dict(zip((dt.text for dt in found.all("dt")), (dd.text for dd in found.all("dd")), strict=True))
    assert figures == {
        "takes": "4",
        "converted": "1",
        "unchanged": "1",
        "failed": "1",
        "waiting": "1",
        "frames": "240",
        "footage": "8.0 s",
    }
    assert sum("earlier result" in row.text for row in found.rows()) == 1
    assert len(found.all("img")) == 2


def test_what_a_take_was_made_from_is_said() -> None:
    (row,) = page(converted(OUTPUT, "walk", matched=(60,), library="walking")).rows()
    assert "2 posed and 1 found keyframes, library walking, method map" in row.text
    doubted = {"matched": (1, 60, 120), "library": "composed", "doubtful": (60,)}
    (row,) = page(converted(OUTPUT, "walk", **doubted)).rows()
    assert "3 found keyframes (1 doubtful), all libraries, method map" in row.text
    assert "frame 87, then 31" in row.text and "120 frames, 4.0 s at 30 frames a second" in row.text
    (row,) = page(converted(OUTPUT, "walk", keyframes=(), weak_frames=(), notes=())).rows()
    assert "no keyframes, method map" in row.text and "Worth" not in row.text


def test_a_row_tells_what_the_motion_was_held_against() -> None:
    (row,) = page(converted(OUTPUT, "walk")).rows()
    assert "2 markers, 2 keypoints (keypoints: a detector); 3 posed keyframes" in row.text
    two = tuple(UsedKeypoints(f"source {n}", ("nose",), 1.0) for n in range(2))
    (row,) = page(converted(OUTPUT, "walk", evidence=UsedEvidence((), two, True, True))).rows()
    assert "2 keypoints, depth hints, contours (keypoints: source 0, source 1)" in row.text
    (row,) = page(converted(OUTPUT, "walk", evidence=None)).rows()
    assert "second; 3 posed keyframes" in row.text


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(0.0, "0.0 s"), (59.94, "59.9 s"), (59.96, "1 min 0 s"), (3599.6, "1 h 0 min"), (7830.0, "2 h 10 min")],
)
def test_times_are_said_as_people_do(seconds: float, said: str) -> None:
    assert duration(seconds) == said
