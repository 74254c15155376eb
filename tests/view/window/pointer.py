#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The window by its pointer, as window.py is by keys: on an X server of its own, under validation.

  pointer.py PROGRAM cube     the picture is turned by the cube of the patient's sides
  pointer.py PROGRAM cancel   pictures that take long are cancelled, by a key and by leaving
  pointer.py PROGRAM turning  how long frames take while a head is turned; with a number behind it, for so many seconds
  pointer.py PROGRAM click    a click turns nothing by the way to it, and a double click is one
  pointer.py PROGRAM edges    a coarse picture is one to its edges, whatever was there before
  pointer.py PROGRAM chart    the curve's chart is zoomed, and a point is dragged there

Exit status: 0 passed, 1 failed.
"""
import math
import os
import pathlib
import sys
import time

from window import PATIENCE, SCENE, Server, Window, compare, main, poses


def drag(window, x, y, right, down):
    """As a hand does: slow frames see each step."""
    for step in (("mousemove", str(x), str(y)), ("mousedown", "1"), ("mousemove", str(x + right), str(y + down)),
                 ("mouseup", "1")):
        window.tool(*step)
        time.sleep(0.3)


def until(window, act, what, true_of):
    """The state when that is true of it, after `act`. What a frame has missed is done again, so late that it is not done
    twice on a busy machine."""
    for _ in range(4):
        act()
        deadline = time.monotonic() + PATIENCE / 4
        while time.monotonic() < deadline:
            state = window.state()
            if true_of(state):
                return state
            time.sleep(0.05)
    raise AssertionError(f"four times, and not {what}: {window.state()}")


def at_rest(window, name):
    """The value of `name` in the state, once it has not changed for a second: each click of a wheel is a frame."""
    value, since = window.state()[name], time.monotonic()
    deadline = since + PATIENCE
    while time.monotonic() < min(since + 1, deadline):
        time.sleep(0.05)
        if window.state()[name] != value:
            value, since = window.state()[name], time.monotonic()
    return value


def cube(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 60)]) as window:
        window.until("the first answer", lambda s: s["settled"])
        sides = {"L": (90, 0), "A": (0, 0), "S": (180, 90)}
        for side, seen in sides.items():
            window.press("1")
            state = window.until("the front", lambda s: (s["azimuth"], s["elevation"]) == (0, 0) and s["settled"])
            x, y, half = state["cube"]
            # A drag on the cube turns the picture, by which three sides are seen.
            state = until(window, lambda x=x, y=y: drag(window, round(x), round(y), -24, 24), "three sides",
                          lambda s: 10 < s["azimuth"] < 80 and 10 < s["elevation"] < 80 and s["settled"])
            azimuth, elevation = math.radians(state["azimuth"]), math.radians(state["elevation"])
            right, up = {"L": (math.cos(azimuth), -math.sin(azimuth) * math.sin(elevation)),
                         "A": (-math.sin(azimuth), -math.cos(azimuth) * math.sin(elevation)),
                         "S": (0, math.cos(elevation))}[side]
            at = round(x + half * right), round(y - half * up)
            until(window, lambda at=at: drag(window, *at, 0, 0), f"side {side}",
                  lambda s, seen=seen: (s["azimuth"], s["elevation"]) == seen and s["settled"])
        window.press("ctrl+q")
        window.end()


def chart(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 60)]) as window:
        state = window.until("the first answer", lambda s: s["settled"])
        x, y, width, height = state["chart"]
        points = state["points"]
        number, (value, opacity) = 2, points[2]
        low, high = state["chart_range"]
        pointer = round(x + (value - low) / (high - low) * width)

        def scroll(button):
            window.tool("mousemove", str(pointer), str(round(y + height * 0.9)))
            window.tool("click", "--repeat", "3", "--delay", "100", button)
        for _ in range(3):
            until(window, lambda: scroll("4"), "nearer",
                  lambda s, before=high - low: s["chart_range"][1] - s["chart_range"][0] < before)
            low, high = at_rest(window, "chart_range")
        assert low < value < high < points[3][0], (low, high, points)
        # Dragged there, it goes where the pointer goes: the value of a place is that of the zoomed axis.
        at = round(x + (value - low) / (high - low) * width), round(y + (1 - opacity) * height)
        expected = low + (at[0] + 10 - x) / width * (high - low)
        state = until(window, lambda: drag(window, *at, 10, 0), f"the point at {expected}",
                      lambda s: abs(s["points"][number][0] - expected) < 2 * (high - low) / width and s["settled"])
        assert len(state["points"]) == len(points), state
        compare(program, state)
        until(window, lambda: scroll("5"), "all values", lambda s: s["chart_range"] == [0, 255])
        window.press("ctrl+q")
        window.end()


def click(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 60)]) as window:
        state = window.until("the first answer", lambda s: s["settled"])
        window.press("Next")
        x, y, width, height = (round(length) for length in state["picture"])
        seen = state["azimuth"], state["elevation"]
        at = x + 40, y + height - 40
        for way in (30, 60, 90):
            window.tool("mousemove", str(at[0] + way), str(at[1] - way))
            time.sleep(0.3)
            window.tool("mousemove", str(at[0]), str(at[1]), "mousedown", "1")
            time.sleep(0.3)
            window.tool("mouseup", "1")
            time.sleep(0.5)  # no double click with the next one
            state = window.until("rest", lambda s: s["settled"])
            assert (state["azimuth"], state["elevation"]) == seen and state["picture"][2] == width, (way, seen, state)
        # The drag is played at once: whatever a frame sees of it, all of it turns the picture.
        window.tool("mousemove", str(at[0]), str(at[1]), "mousedown", "1", "mousemove", str(at[0] + 50), str(at[1]),
                    "mouseup", "1")
        window.until("a picture that is turned", lambda s: s["azimuth"] != seen[0] and s["settled"])
        time.sleep(0.5)
        window.tool("mousemove", str(at[0] + 90), str(at[1] - 90))
        time.sleep(0.3)
        window.tool("mousemove", str(at[0]), str(at[1]), "click", "1", "click", "1")
        window.until("a larger picture", lambda s: s["picture"][3] > height and s["settled"])
        window.press("ctrl+q")
        window.end()


def edges(program, folder):
    with Server() as server, Window(program, server, folder, ["--device", "cpu"]) as window:
        before = window.until("the first answer", lambda s: s["settled"])["picture"]
        window.press("Next")
        window.tool("windowsize", window.id, "1000", "740")
        state = window.until("a picture of that size", lambda s: s["picture"][2] > before[2] and s["settled"])
        x, y, width, height = (round(length) for length in state["picture"])
        right, low = x + width - 1, y + height - 1
        # Bright to the edges first.
        window.tool("mousemove", str(x + width // 2), str(y + height * 2 // 3))
        window.tool("click", "--repeat", "12", "--delay", "60", "4")
        window.until("a picture of the head from near", lambda s: s["settled"])
        window.press("f")
        window.tool("mousemove", str(x + 40), str(low - 60), "mousedown", "1")
        for step in range(12):
            window.tool("mousemove_relative", "--", "6", "-3")
            time.sleep(0.08)
            pixel = server.pixels()
            # The background changes little from there on; the bar of millimetres and the cube lie elsewhere.
            pairs = [(pixel(right, row), pixel(right - 22, row)) for row in range(y + height // 4, low - 45)]
            pairs += [(pixel(column, low), pixel(column, low - 22)) for column in range(x + 2, x + width // 5)]
            worst = max(abs(a - b) for one, other in pairs for a, b in zip(one, other))
            assert worst <= 10, (step, worst)
        window.tool("mouseup", "1")
        window.press("ctrl+q")
        window.end()


def save_picture(window, folder, name, width):
    """Asks for a picture that is so large that it takes long; the state when it is being made."""
    for _ in range(3):  # a key that comes and goes within a frame is lost: then a size is taken for the name
        window.press("ctrl+p")
        window.fill(f"{folder}/{name}")
        window.hold(0.2, "Tab")
        for side in (width, width):
            window.hold(0.2, "ctrl", "a")
            window.type(str(side))
            window.hold(0.2, "Tab")
        time.sleep(1)
        window.enter()
        window.until("a picture that is being made", lambda s: s["saving"] is not None or s["error"])
        time.sleep(0.5)
        state = window.state()
        if state["saving"] is not None:
            return state
        assert "the ending must be .png" in (state["error"] or ""), state
        window.hold(0.4, "Return")
    raise AssertionError(("no picture is being made", window.state()))


def cancel(program, folder):
    def files():
        return sorted(path.name for path in pathlib.Path(folder).iterdir() if "state" not in path.name)

    with Server() as server:
        with Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses", poses(folder, 60)]) as window:
            window.until("the first answer", lambda s: s["settled"])
            before = files()
            save_picture(window, folder, "large.png", 9000)
            window.tool("key", "Escape")
            state = window.until("the end of it", lambda s: s["saving"] is None)
            assert "no picture was written" in state["status"] and files() == before, (state, files())
            # Quitting waits for none.
            begun = time.monotonic()
            save_picture(window, folder, "large.png", 9000)
            asked = time.monotonic()
            window.press("ctrl+q")
            window.end()
            print(f"asked for in {asked - begun:.1f} s, and left in {time.monotonic() - asked:.1f} s")
            assert files() == before, files()


def turning(program, folder, seconds=3):
    """How long frames take while the real or the builtin head is turned in a picture of 512 x 512."""
    head = "/usr/share/mricron/templates/ch2.nii.gz"
    volume = head if pathlib.Path(head).exists() else "builtin:head:128"
    scene = ["--volume", volume, "--mesh", "builtin:scalpel", "--preset", "mr", "--device", "cpu"]
    with Server() as server, Window(program, server, folder, scene, validate=False) as window:
        window.until("the first answer", lambda s: s["settled"])
        window.press("Next")
        window.tool("windowsize", window.id, "908", "744")
        state = window.until("a picture of that size", lambda s: s["picture"][2:] == [512, 512] and s["settled"])
        x, y, width, height = state["picture"]
        window.tool("mousemove", str(round(x + 60)), str(round(y + height - 60)), "mousedown", "1")
        # Sixty steps per second, to and fro.
        steps = [("mousemove_relative", "--", "4" if i // 80 % 2 == 0 else "-4", "0", "sleep", "0.0167")
                 for i in range(round(seconds * 60))]
        load = os.getloadavg()[0]
        begun = time.monotonic()
        window.tool(*(word for step in steps for word in step))
        turned = time.monotonic() - begun
        window.tool("mouseup", "1")
        state = window.until("the fine picture", lambda s: s["azimuth"] != state["azimuth"] and s["settled"])
        rest = time.monotonic() - begun - turned
        # From the last frame backwards: the fine picture's, and then those of the turn.
        times, back = [], 0.0
        for took in reversed(state["frame_times"]):
            if rest < back < rest + turned:
                times.append(took)
            back += took / 1000
        times.sort()
        assert len(times) > 2 * seconds, (len(times), turned)
        median, late = times[len(times) // 2], times[len(times) * 95 // 100]
        print(f"{volume}: {len(times)} frames in {turned:.1f} s of turning, {len(times) / turned:.1f} a second; a frame "
              f"takes {median:.0f} ms (median), {late:.0f} ms (95th percentile); {os.cpu_count()} processors, load "
              f"{load:.1f} before")
        window.press("ctrl+q")
        window.end()


if __name__ == "__main__":
    CHECKS = {"cube": cube, "chart": chart, "click": click, "edges": edges, "cancel": cancel, "turning": turning}
    sys.exit(main(sys.argv[1:], CHECKS, __doc__, "turning"))
