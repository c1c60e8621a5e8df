"""The page of a batch in a real browser: nothing is blocked, pictures load, search and order work."""

import base64
import hashlib
import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _command_line import converted, failed, waiting
from keymark.core.report.canvas import write_png
from keymark.core.report.summary.page import summary_page

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
BROWSER = next((found for found in map(shutil.which, BROWSERS) if found), None)
TAKES = 40
WIDTH = 400
NAME = "day 1/50% #2? <b>\"ż\" & 'co'"
PROBE = """
for (const image of document.images) image.loading = "eager";
addEventListener("load", () => {
  const rows = () => Array.from(document.querySelectorAll("tr[id^=take-]")).filter((row) => row.offsetParent);
  const names = () => rows().map((row) => row.querySelector("bdi").textContent);
  const find = document.getElementById("find"), order = document.getElementById("order");
  const seen = {all: names(), shown: !document.getElementById("tools").hidden};
  seen.images = Array.from(document.images).map((image) => image.naturalWidth);
  find.value = "DECODER cut";
  find.dispatchEvent(new Event("input"));
  seen.found = names();
  seen.count = document.getElementById("found").textContent;
  find.value = "";
  for (const by of ["name", "confidence", "need"]) {
    order.value = by;
    order.dispatchEvent(new Event("change"));
    seen[by] = names();
  }
  const style = getComputedStyle(document.querySelector(".error"));
  seen.styled = style.borderLeftWidth;
  seen.wide = document.documentElement.scrollWidth - innerWidth;
  const answer = document.createElement("pre");
  answer.id = "answer";
  answer.textContent = JSON.stringify(seen);
  document.body.append(answer);
});
"""
"""A script that inspects the page, in a copy whose policy allows it."""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page with a probe in it, and a picture for every take that converted."""
    output = tmp_path_factory.mktemp("browser") / "results #1"
    good = [converted(output, f"day 2/clip {n:02d}", confidence=0.55 + 0.01 * n) for n in range(TAKES)]
    other = [
        converted(output, NAME, confidence=0.1, notes=("x" * 300,)),
        failed(output, "day 3/" + "long" * 40, "clip.mp4: the decoder stopped, the file may be cut off"),
        failed(output, "day 3/<script>throw 1</script>", "clip.mp4: <img src=x onerror=alert(1)>"),
        waiting(output, "day 4/\u202egpj.exe"),
    ]
    picture = np.full((90, WIDTH, 3), 128, dtype=np.uint8)
    for outcome in (*good, other[0]):
        (outcome.folder / "report").mkdir(parents=True)
        write_png(str(outcome.folder / "report" / "overlay.png"), picture)
    text = summary_page("autumn", [*good, *other], output)
    digest = base64.b64encode(hashlib.sha256(PROBE.encode()).digest()).decode()
    text = text.replace("script-src ", f"script-src 'sha256-{digest}' ", 1)
    text = text.replace("</body>", f"<script>{PROBE}</script></body>")
    file = output / "summary.html"
    file.write_text(text, encoding="utf-8", newline="\n")
    return file


def look(page: Path, profile: Path, width: int) -> dict[str, Any]:
    """Open the page in a window of a width and return the probe's findings; fail on any warning."""
    assert BROWSER is not None
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run"]
    options += [f"--user-data-dir={profile}", f"--window-size={width},900"]
    options += ["--enable-logging=stderr", "--disable-background-networking", "--dump-dom"]
    done = subprocess.run(
        [BROWSER, *options, page.as_uri()], capture_output=True, text=True, encoding="utf-8", timeout=120
    )
    complaints = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    assert complaints == []
    found = re.search('<pre id="answer">(.*?)</pre>', done.stdout, re.DOTALL)
    assert found, done.stderr
    return dict(json.loads(html.unescape(found[1])))


@pytest.mark.skipif(BROWSER is None, reason="no Chromium is installed")
def test_a_browser_shows_everything_and_searches_and_sorts(page: Path, tmp_path: Path) -> None:
    seen = look(page, tmp_path, 1400)
    assert len(seen["all"]) == TAKES + 4 and seen["shown"] and seen["styled"] == "3px" and seen["wide"] <= 0
    assert seen["images"] == [WIDTH] * (TAKES + 1)
    assert seen["all"][2] == NAME and seen["all"][-1] == "day 4/\\u202egpj.exe"
    assert seen["found"] == ["day 3/" + "long" * 40] and seen["count"] == f"1 of {TAKES + 4}"
    assert seen["name"] == sorted(seen["name"]) and set(seen["name"]) == set(seen["all"])
    assert seen["confidence"][3] == NAME and seen["confidence"][4:] == [
        f"day 2/clip {n:02d}" for n in range(TAKES)
    ]
    assert seen["need"] == seen["all"]


@pytest.mark.skipif(BROWSER is None, reason="no Chromium is installed")
def test_a_narrow_window_needs_no_scrolling_sideways(page: Path, tmp_path: Path) -> None:
    seen = look(page, tmp_path, 500)
    assert seen["wide"] <= 0 and len(seen["all"]) == TAKES + 4
