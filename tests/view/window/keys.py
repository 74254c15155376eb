#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What is shown and asked, by keys and by the instrument's handles, in the window of window.py.

  keys.py PROGRAM keys      the instrument is moved into the head, back and through a list; each answer is compared
                            with that of the command that the window copies; the window is resized and closed
  keys.py PROGRAM handles   the instrument is dragged by its handles
  keys.py PROGRAM methods   the device's ways to answer, each compared in the same way
  keys.py PROGRAM labels    what is touched by its labels, on the host and on the device
  keys.py PROGRAM drill     holes at the tip, on the host and on the device, and undo
  keys.py PROGRAM screenshot   pictures of any size
  keys.py PROGRAM least     the window's least size, on displays of one and two pixels per point

Exit status: 0 passed, 1 failed.
"""
import ctypes
import pathlib
import subprocess
import sys
import time

from window import HEIGHT, PATIENCE, SCENE, Server, Window, compare, counted, main, make, poses


def keys(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 130, 40)]) as window:
        state = window.until("the first answer", lambda s: s["settled"])
        assert (state["touch"], state["pose"][HEIGHT], state["method"]) == (0, 130, "cpu"), state
        compare(program, state)
        state = window.until("the first distance", lambda s: s["distance"])
        assert state["distance"]["lo"] > 0 and len(state["distance"]["volume"]) == 3, state
        compare(program, state)
        state = window.until("the first overlap", lambda s: s["overlap"])
        compare(program, state)
        height = 130
        while state["touch"] == 0 and height > 0:
            height -= 10
            window.press("shift+Next")
            state = window.until(f"a pose {height} mm high", lambda s: s["pose"][HEIGHT] == height)
        assert state["touch"] == 1 and state["count"] > 0 and state["triangles"] > 0, state
        compare(program, state)
        # Many at once: none is lost.
        window.press("Prior", "Prior", "Prior", "Next")
        state = window.until("three up and one down", lambda s: abs(s["pose"][HEIGHT] - height - 2) < 1e-9)
        compare(program, state)
        # Nudges that follow each other closely are one command; those that came later than that are others.
        window.press("ctrl+z")
        state = window.until("the pose before the four", lambda s: abs(s["pose"][HEIGHT] - height - 2) > 1)
        steps = 1
        while state["pose"][HEIGHT] < 130:
            before = state["pose"][HEIGHT]
            window.press("ctrl+z")
            steps += 1
            state = window.until("a pose before", lambda s, before=before: s["pose"][HEIGHT] > before)
        state = window.until("the first pose again", lambda s: s["pose"][HEIGHT] == 130 and s["touch"] == 0)
        window.press(*["ctrl+y"] * steps)
        window.until("what was undone", lambda s: abs(s["pose"][HEIGHT] - height - 2) < 1e-9)
        window.press("bracketright")
        state = window.until("the second pose of the list", lambda s: s["pose"][HEIGHT] == 40 and s["touch"] == 1)
        compare(program, state)
        # Another size: frames go on, and the answer stays.
        before = window.until("the fine picture", lambda s: s["settled"])["frame"]
        window.tool("windowsize", window.id, "800", "560")
        window.press("Left")
        state = window.until("an answer in another size", lambda s: s["pose"][3] == 2 and s["settled"])
        assert state["frame"] > before, state
        compare(program, state)
        # Out of sight for a while.
        window.tool("windowunmap", "--sync", window.id)
        time.sleep(1)
        window.tool("windowmap", "--sync", window.id)
        window.tool("windowfocus", "--sync", window.id)
        window.press("Left")
        state = window.until("an answer in sight again", lambda s: s["pose"][3] == 1 and s["settled"])
        compare(program, state)
        window.press("ctrl+q")
        window.end()


def drag(window, x, y, right, down):
    for step in (("mousemove", str(x), str(y)), ("mousedown", "1"), ("mousemove", str(x + right), str(y + down)),
                 ("mouseup", "1")):
        window.tool(*step)
        time.sleep(0.4)


def handles(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 0)]) as window:
        first = window.until("the first answer", lambda s: s["settled"])
        # From the middle outward: a drag beside the handles turns the picture round the middle, where the instrument
        # nearly is.
        x, y, width, height = (int(number) for number in first["picture"])
        state, offset = first, 16
        while state["pose"] == first["pose"] and offset < min(width, height) / 2:
            drag(window, x + width // 2 + offset, y + height // 2, 3, 12)
            state = window.state()
            offset += 5
        assert state["pose"] != first["pose"], f"no handle up to {offset} points from the middle"
        state = window.until("the answer there", lambda s: s["settled"])
        compare(program, state)
        window.press("ctrl+z")
        window.until("the pose before the drag", lambda s: s["pose"] == first["pose"])
        # A ring: from the front the one of y is a circle round the tip. Beside its radius a drag turns the picture, and
        # the next one looks from the front again.
        state, away = first, 40
        while state["pose"] == first["pose"] and away < 62:
            window.press("1", "f")
            state = window.until("the picture from the front", lambda s: s["settled"])
            drag(window, x + width // 2 + away, y + height // 2 + away, -7, 7)
            state = window.state()
            away += 2
        assert state["pose"] != first["pose"], f"no ring up to {away} points to the lower right of the middle"
        place = [state["pose"][i] - first["pose"][i] for i in (3, 7, 11)]
        turned = [state["pose"][i] - first["pose"][i] for i in (0, 2, 8, 10)]
        assert max(map(abs, place)) < 1e-9 and max(map(abs, turned)) > 0.01, state["pose"]
        state = window.until("the answer after the turn", lambda s: s["settled"])
        compare(program, state)
        window.press("ctrl+z")
        window.until("the pose before the turn", lambda s: s["pose"] == first["pose"])
        window.press("ctrl+q")
        window.end()


def methods(program, folder):
    with Server() as server:
        for method, projection in (("compute", "certified"), ("query", "view"), ("atomic", "dominant-axis")):
            with Window(program, server, folder, [*SCENE, "--poses", poses(folder, 60), "--method", method,
                                                  "--projection", projection]) as window:
                state = window.until(f"the answer of {method}", lambda s: s["settled"])
                assert state["count"] > 0 and state["device"] != "host", state
                compare(program, state)
                window.press("Next")
                state = window.until(f"the next answer of {method}", lambda s: s["pose"][HEIGHT] == 59)
                compare(program, state)
                window.press("ctrl+q")
                window.end()
        counts(program, folder, server)


def counts(program, folder, server):
    """All methods side by side: those of a projection and the filter exact count the same."""
    with Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses", poses(folder, 60)]) as window:
        window.until("the answer", lambda s: s["settled"])
        window.press("k")
        state = window.until("the counts of all methods", counted)
        assert len(state["methods"]) >= 8 and not any(one["refused"] for one in state["methods"]), state["methods"]
        by_projection = {}
        for one in state["methods"]:
            if one["filter"] == "exact" and one["exact"] == 1:
                by_projection.setdefault(one["projection"], []).append((one["touch"], one["count"], one["triangles"]))
        assert len(by_projection) >= 3, by_projection
        assert all(len(said) >= 2 and len(set(said)) == 1 for said in by_projection.values()), by_projection
        assert all(one["touch"] == 1 for one in state["methods"]), state["methods"]
        live = next(one for one in state["methods"] if one["method"] == "cpu" and one["projection"] == "certified")
        assert (live["touch"], live["count"]) == (state["touch"], state["count"]), state
        window.press("Next")
        state = window.until("the counts of the next pose", lambda s: counted(s) and s["pose"][HEIGHT] == 59)
        assert state["methods"][-1]["count"] == state["count"], state
        window.press("k")
        window.until("none of them", lambda s: s["methods"] is None)
        window.press("ctrl+q")
        window.end()


def labels(program, folder):
    # Any image of whole numbers is a label map; its values are the labels.
    subprocess.run([program, "make", "volume", "builtin:head:30", f"{folder}/atlas.nii"], check=True,
                   capture_output=True, timeout=PATIENCE)
    with Server() as server:
        for device in (["--device", "cpu"], ["--method", "compute"]):
            with Window(program, server, folder, [*SCENE, *device, "--poses", poses(folder, 60), "--labels",
                                                  f"{folder}/atlas.nii"]) as window:
                state = window.until("the answer with labels", lambda s: s["settled"])
                assert len(state["labels"]) > 1, state
                compare(program, state)
                touched = state["labels"][0]["label"]
                window.press("ctrl+q")
                window.end()
        names = pathlib.Path(folder) / "names.txt"
        names.write_text(f"{touched} hard_thing\n")
        with Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses", poses(folder, 60), "--labels",
                                              f"{folder}/atlas.nii", "--label-names", str(names)]) as window:
            state = window.until("the answer with names", lambda s: s["settled"])
            assert state["labels"][0]["name"] == "hard_thing", state
            compare(program, state)
            window.press("ctrl+q")
            window.end()


def drill(program, folder):
    # Of voxels that are small beside the holes.
    scene = ["--volume", "builtin:head:96", *SCENE[2:]]
    counts = []
    with Server() as server:
        for device in (["--device", "cpu"], ["--method", "compute"]):
            with Window(program, server, folder, [*scene, *device, "--poses", poses(folder, 60)]) as window:
                state = window.until("the answer before", lambda s: s["settled"])
                whole = state["count"]
                window.press("x")
                state = window.until("a hole at the tip", lambda s: s["holes"] == 1 and s["settled"])
                assert 0 < state["count"] < whole, (whole, state)
                assert state["command"].startswith("# for the volume in the file, without the drilled hole"), state
                counts.append((whole, state["count"]))
                window.press("shift+Next")
                window.until("another pose", lambda s: s["pose"][HEIGHT] == 50)
                window.press("x")
                state = window.until("a second hole", lambda s: s["holes"] == 2 and s["settled"])
                counts[-1] += (state["count"],)
                window.press("ctrl+z", "ctrl+z", "ctrl+z")
                state = window.until("the volume as it was", lambda s: s["holes"] == 0 and s["settled"])
                assert state["count"] == whole and state["pose"][HEIGHT] == 60, state
                compare(program, state)
                window.press("ctrl+y")
                state = window.until("the first hole again", lambda s: s["holes"] == 1 and s["settled"])
                assert state["count"] == counts[-1][1], (counts, state)
                window.press("ctrl+q")
                window.end()
    assert counts[0] == counts[1], f"host and device differ: {counts}"


def png_size(path):
    head = pathlib.Path(path).read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n", head
    return int.from_bytes(head[16:20], "big"), int.from_bytes(head[20:24], "big")


def screenshot(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 60)]) as window:
        state = window.until("the first answer", lambda s: s["settled"])
        window.dialog("ctrl+p", f"{folder}/window.png")
        state = window.until("a picture", lambda s: s["status"].startswith("saved the picture as"))
        assert png_size(f"{folder}/window.png") == tuple(int(side) for side in state["picture"][2:]), state
        window.dialog("ctrl+p", f"{folder}/nowhere/large.png")
        window.until("the error", lambda s: "nowhere/large.png" in s["error"])
        window.press("Return")
        window.until("the window going on", lambda s: s["error"] == "")
        window.press("ctrl+q")
        window.end()


class SizeHints(ctypes.Structure):
    """XSizeHints of Xutil.h, and room for what comes behind these."""
    _fields_ = [("flags", ctypes.c_long), *((name, ctypes.c_int) for name in ("x", "y", "width", "height", "least_width",
                                                                              "least_height")),
                ("more", ctypes.c_int * 20)]


def least(program, folder):
    x11 = ctypes.CDLL("libX11.so.6")
    x11.XOpenDisplay.restype = ctypes.c_void_p
    x11.XDefaultRootWindow.restype = ctypes.c_ulong
    for dots, size in ((96, (640, 480)), (192, (1280, 960))):
        with Server() as server:
            display = ctypes.c_void_p(x11.XOpenDisplay(server.environment["DISPLAY"].encode()))
            resources = f"Xft.dpi:\t{dots}\n".encode()
            manager, string, replace = 23, 31, 0  # RESOURCE_MANAGER, STRING of Xatom.h
            x11.XChangeProperty(display, ctypes.c_ulong(x11.XDefaultRootWindow(display)), ctypes.c_ulong(manager),
                                ctypes.c_ulong(string), 8, replace, resources, len(resources))
            x11.XSync(display, 0)
            with Window(program, server, folder, [*SCENE, "--device", "cpu"]) as window:
                window.until("the first answer", lambda s: s["settled"])
                window.press("Next")
                hints, supplied = SizeHints(), ctypes.c_long()
                assert x11.XGetWMNormalHints(display, ctypes.c_ulong(int(window.id)), ctypes.byref(hints),
                                             ctypes.byref(supplied))
                least_flag = 16  # PMinSize of Xutil.h
                assert hints.flags & least_flag and (hints.least_width, hints.least_height) == size, \
                    (hints.flags, hints.least_width, hints.least_height)
                window.press("ctrl+q")
                window.end()
            x11.XCloseDisplay(display)


if __name__ == "__main__":
    CHECKS = {"keys": keys, "handles": handles, "methods": methods, "labels": labels, "drill": drill,
              "screenshot": screenshot, "least": least}
    sys.exit(main(sys.argv[1:], CHECKS, __doc__))
