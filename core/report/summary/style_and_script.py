"""The style and the script of a batch's page, which is one file and holds both.

Words never stand on any color of `style.css` but paper, card and wash. The script searches and sorts the
rows; the page is complete without it.
"""

from pathlib import Path

FOLDER = Path(__file__).parent

STYLE = (FOLDER / "style.css").read_text(encoding="utf-8")
SCRIPT = "\n" + (FOLDER / "script.js").read_text(encoding="utf-8")
