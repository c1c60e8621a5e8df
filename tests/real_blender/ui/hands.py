"""A person's hands and eyes: mouse, keys, and finding buttons by what they do.

Blender tells scripts nothing of where a panel's buttons are. A person finds them by looking; here the mouse
goes down the region, and the button under it is asked for its Python command, as Ctrl C over a button does.
"""

import bpy
from _panel import offered
from driver import Steps, expect, turns, until

ACROSS = (0.5, 0.75, 0.2, 0.35, 0.9, 0.08)
"""Where across a region buttons are looked for; most span the middle."""
STEP_PX = 16  # Buttons are about 20 px high
NOTCHES = 15
"""Of the wheel, of about 40 px each: nearly all that a sidebar shows, so that nothing is passed over."""
BELOW_TOP_PX = 50  # Where there is a panel in any case
MARGIN_PX = 6  # Beside what panels show, in the sidebar still
PAGES = 10  # More than any sidebar is long


class Hands:
    """Mouse and keyboard of the first window."""

    def __init__(self) -> None:
        self.x = self.y = 0
        self.clicks = 0  # Presses of the left mouse button so far
        self.keys = 0  # Presses of keys so far; written text counts letter by letter
        self._remembered: dict[tuple[str, str, str], tuple[int, int]] = {}
        """Where the mouse last saw what, by area, kind of text and text."""

    @property
    def window(self) -> bpy.types.Window:
        """The window, found anew: after undo or a new file the old one is gone."""
        return bpy.context.window_manager.windows[0]

    def area(self, kind: str) -> bpy.types.Area:
        areas = [area for area in self.window.screen.areas if area.type == kind]
        expect(areas, f"no {kind} on the screen")
        return max(areas, key=lambda area: area.width * area.height)

    def region(self, kind: str, part: str) -> bpy.types.Region:
        """A region of that area: WINDOW, UI (the sidebar), HEADER."""
        return next(region for region in self.area(kind).regions if region.type == part)

    def move(self, x: float, y: float) -> Steps[None]:
        """Move the mouse to a place in the window, y up [px]."""
        self.x, self.y = round(x), round(y)
        for offset in (1, 0):  # the first one only enters a region
            self.window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=self.x + offset, y=self.y)
        yield

    def move_over(self, kind: str) -> Steps[None]:
        """Move the mouse into the middle of an area, so that keys go there."""
        region = self.region(kind, "WINDOW")
        yield from self.move(region.x + 0.45 * region.width, region.y + 0.5 * region.height)

    def press(self, key: str, text: str | None = None, settle: bool = True, **modifiers: bool) -> Steps[None]:
        """Press and release a key or a mouse button where the mouse is.

        Args:
            key: As Blender names it.
            text: What it writes.
            settle: Whether Blender is then given time to draw; not where a job begins that is soon over.
            modifiers: Whether `ctrl`, `shift` or `alt` is held.
        """
        self.clicks += key == "LEFTMOUSE"
        self.keys += key != "LEFTMOUSE"
        for value in ("PRESS", "RELEASE"):
            typed = {"unicode": text} if text is not None and value == "PRESS" else {}
            self.window.event_simulate(type=key, value=value, x=self.x, y=self.y, **typed, **modifiers)
            yield
        if settle:
            yield from turns(2)

    def click(self, x: float, y: float, settle: bool = True, **modifiers: bool) -> Steps[None]:
        yield from self.move(x, y)
        yield from self.press("LEFTMOUSE", settle=settle, **modifiers)

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> Steps[None]:
        yield from self.move(*start)
        self.window.event_simulate(type="LEFTMOUSE", value="PRESS", x=self.x, y=self.y)
        yield from turns(2)
        for share in (0.3, 0.7, 1.0):
            yield from self.move(*(a + share * (b - a) for a, b in zip(start, end, strict=True)))
        self.window.event_simulate(type="LEFTMOUSE", value="RELEASE", x=self.x, y=self.y)
        yield from turns(3)

    def write(self, text: str) -> Steps[None]:
        names = {".": "PERIOD", "-": "MINUS", "/": "SLASH", " ": "SPACE", "_": "MINUS"}
        digits = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
        for letter in text:
            key = digits[int(letter)] if letter.isdigit() else names.get(letter, letter.upper())
            yield from self.press(key, text=letter)

    def undo(self) -> Steps[None]:
        yield from self.move_over("VIEW_3D")
        yield from self.press("Z", ctrl=True)

    def redo(self) -> Steps[None]:
        yield from self.move_over("VIEW_3D")
        yield from self.press("Z", ctrl=True, shift=True)

    def open_sidebar(self, kind: str, tab: str) -> Steps[None]:
        """Show an area's sidebar (N) and click on a tab of it."""
        yield from self.move_over(kind)
        if not self.area(kind).spaces.active.show_region_ui:
            yield from self.press("N")
        yield from until(lambda: self.region(kind, "UI").width > 20, "the sidebar")
        region = self.region(kind, "UI")
        below = 30.0
        while region.active_panel_category != tab:
            expect(below < region.height, f"no tab {tab} in the sidebar of the {kind}")
            yield from self.click(region.x + region.width - 12, region.y + region.height - below)
            below += 20.0
            region = self.region(kind, "UI")

    def find_button(self, command: str, *words: str, kind: str = "VIEW_3D") -> Steps[tuple[int, int]]:
        """Look for the button that calls an operator, scrolling the sidebar where it must be.

        Args:
            command: The operator, as in `keymark.reconstruct`.
            words: What its call must contain, as in `direction='NEXT'`.
            kind: The area whose sidebar it is in.

        Returns:
            Where it is in the window.
        """
        wanted = (f"bpy.ops.{command}(", *words)
        found = yield from self._look(kind, "ui.copy_python_command_button", wanted)
        expect(found is not None, f"no button for {command} {words} in the sidebar of the {kind}")
        return found

    def click_button(
        self, command: str, *words: str, kind: str = "VIEW_3D", settle: bool = True
    ) -> Steps[None]:
        """Find and click the button that calls an operator."""
        place = yield from self.find_button(command, *words, kind=kind)
        yield from self.click(*place, settle=settle)

    def invoke(self, command: str, kind: str = "VIEW_3D", **settings: object) -> Steps[None]:
        """Call an operator as its button would, where that is in a folded panel.

        Where a panel's header is no script can see.
        """
        group, _, name = command.partition(".")
        area, region = self.area(kind), self.region(kind, "WINDOW")
        with bpy.context.temp_override(window=self.window, area=area, region=region):
            getattr(getattr(bpy.ops, group), name)("INVOKE_DEFAULT", True, **settings)
        yield from turns(3)

    def fill(self, field: str, value: str, kind: str = "VIEW_3D") -> Steps[None]:
        """Write a value into the field that shows a property."""
        found = yield from self._look(kind, "ui.copy_data_path_button", (field,))
        expect(found is not None, f"no field {field} in the sidebar of the {kind}")
        yield from self.move(*found)
        yield from self.press("RET")  # over a number, Enter begins to edit it
        yield from self.press("A", ctrl=True)
        yield from self.write(value)
        yield from self.press("RET")

    def _look(self, kind: str, copy: str, wanted: tuple[str, ...]) -> Steps[tuple[int, int] | None]:
        """The same, once the step is open that has it: a person reads the titles."""
        name = wanted[0].removeprefix("bpy.ops.").rstrip("(")
        if name not in offered(kind):
            self._open(name, kind)
            self.area(kind).tag_redraw()
            yield from turns(4)
        return (yield from self._look_around(kind, copy, wanted))

    def _open(self, name: str, kind: str) -> None:
        """Open what shows a control, a step or a kind of evidence; where headers are no script can see."""
        shown = bpy.context.window_manager.keymark_steps
        titles = [each for each in shown.bl_rna.properties.keys() if each not in ("rna_type", "name")]
        inner = ("", "markers", "keypoints", "tracks", "contours")
        for title in (each for each in titles if each not in inner):
            for inside in inner:
                clicks = 0
                for each in filter(None, (title, inside)):
                    clicks += not getattr(shown, each)
                    setattr(shown, each, True)
                if name in offered(kind):
                    self.clicks += clicks
                    return
        expect(False, f"no step shows {name}")

    def _look_around(self, kind: str, copy: str, wanted: tuple[str, ...]) -> Steps[tuple[int, int] | None]:
        """Where in the sidebar the button is whose copied text contains all that is wanted."""
        known = [(place, text[2]) for text, place in self._remembered.items() if text[:2] == (kind, copy)]
        for place, text in known:
            if all(word in text for word in wanted):
                yield from self._leave([other for other, said in known if said != text], kind, copy, wanted)
                if not self._tells(kind, copy, wanted) and (
                    yield from self._is_at(place, kind, copy, wanted)
                ):
                    return place
        # Most buttons span the middle: the whole sidebar is gone through there first.
        for shares in (ACROSS[:1], ACROSS[1:]):
            found = yield from self._search(kind, copy, wanted, shares)
            if found is None:
                yield from self.scroll(kind, "WHEELUPMOUSE", 40)
            for _ in range(PAGES):
                if found is not None:
                    break
                found = yield from self._search(kind, copy, wanted, shares)
                seen = self.showing(kind)
                if found is None:
                    yield from self.scroll(kind, "WHEELDOWNMOUSE", NOTCHES)
                    if self.showing(kind) == seen:
                        break
            if found is not None:
                return found
        return None

    def _search(
        self, kind: str, copy: str, wanted: tuple[str, ...], shares: tuple[float, ...]
    ) -> Steps[tuple[int, int] | None]:
        region = self.region(kind, "UI")
        width = region.width - 25  # the tabs
        been_elsewhere = not self._tells(kind, copy, wanted)
        for share in shares:
            for below in range(30, region.height - 4, STEP_PX):
                place = round(region.x + share * width), region.y + region.height - below
                is_there = yield from self._is_at(place, kind, copy, wanted)
                if is_there and been_elsewhere:
                    return place
                been_elsewhere |= not is_there
        return None

    def _leave(
        self, others: list[tuple[int, int]], kind: str, copy: str, wanted: tuple[str, ...]
    ) -> Steps[None]:
        """Move the mouse over other buttons until none of the wanted kind is told of.

        Where there is no button under the mouse, Blender tells of the one that was under it last.
        """
        for place in others:
            if not self._tells(kind, copy, wanted):
                return
            yield from self.move(*place)

    def _tells(self, kind: str, copy: str, wanted: tuple[str, ...]) -> bool:
        """Whether the button under the mouse, or the one that was last, is a wanted one."""
        text = self._copied(kind, copy)
        return all(word in text for word in wanted)

    def _is_at(self, place: tuple[int, int], kind: str, copy: str, wanted: tuple[str, ...]) -> Steps[bool]:
        yield from self.move(*place)
        text = self._copied(kind, copy)
        if text:
            self._remembered[kind, copy, text] = place
        return all(word in text for word in wanted)

    def _copied(self, kind: str, copy: str) -> str:
        manager = bpy.context.window_manager
        manager.clipboard = ""
        area, region = self.area(kind), self.region(kind, "UI")
        group, _, name = copy.partition(".")
        operator = getattr(getattr(bpy.ops, group), name)
        with bpy.context.temp_override(window=self.window, area=area, region=region):
            if operator.poll():
                operator()
        return str(manager.clipboard)

    def scroll(self, kind: str, wheel: str, notches: int) -> Steps[None]:
        """Turn the wheel over a sidebar, at its margin: over a list it would scroll that.

        Near its top, since below its panels the wheel would zoom the view.
        """
        region = self.region(kind, "UI")
        yield from self.move(region.x + MARGIN_PX, region.y + region.height - BELOW_TOP_PX)
        for _ in range(notches):
            self.window.event_simulate(type=wheel, value="PRESS", x=self.x, y=self.y)
        yield from turns(4)

    def showing(self, kind: str) -> tuple[float, float]:
        """The lower left corner of what a sidebar shows of its panels [px]."""
        x, y = self.region(kind, "UI").view2d.region_to_view(0, 0)
        return round(x), round(y)
