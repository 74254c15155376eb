#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The window as a person uses it: on an X server of its own, by keys, under validation.

  window.py PROGRAM keys      the instrument is moved into the head, back and through a list; each answer is compared
                              with that of the command that the window copies; the window is resized and closed
  window.py PROGRAM handles   the instrument is dragged by its handles
  window.py PROGRAM methods   the device's ways to answer, each compared in the same way
  window.py PROGRAM labels    what is touched by its labels, on the host and on the device
  window.py PROGRAM drill     holes at the tip, on the host and on the device, and undo
  window.py PROGRAM files     other files are opened while the window is there, good ones and bad ones
  window.py PROGRAM loading   a volume is loaded while the instrument moves, and one is cancelled
  window.py PROGRAM coarser   a volume that is too large is shown as a coarser copy
  window.py PROGRAM session   a session whose files are gone, and the files that were opened last
  window.py PROGRAM lost      the surface and the device are lost (a layer in the folder VOXTACT_FAULT_LAYERS says so)
  window.py PROGRAM screenshot   pictures of any size
  window.py PROGRAM soak      random input for ten seconds; with a number behind it, for so many
  window.py PROGRAM refusals  no display, and what cannot be shown

Nothing sleeps for a fixed time but the hand that drags, which tries again: each step is waited for, at most so long as
a slow machine may need.
Exit status: 0 passed, 1 failed.
"""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

PATIENCE = 240  # s, for a single step
SIZE = "640x480"


def fail(text):
    raise AssertionError(text)


class Server:
    """An X server without a screen, on a display that is free."""

    def __init__(self):
        for program in ("Xvfb", "xdotool"):
            if shutil.which(program) is None:
                fail(f"{program} is not installed")
        self.process = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp"],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        number = self.process.stdout.readline().strip()
        # What the window keeps from run to run is not that of whoever runs the tests.
        self.kept = tempfile.TemporaryDirectory()
        self.environment = {**os.environ, "DISPLAY": f":{number}", "XDG_STATE_HOME": self.kept.name}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.kept.cleanup()


class Window:
    def __init__(self, program, server, folder, arguments, environment=None, validate=True):
        self.server, self.program = server, program
        self.state_path = pathlib.Path(folder) / "state.json"
        self.state_path.unlink(missing_ok=True)
        self.process = subprocess.Popen(
            [program, "view", "--size", SIZE, *(["--validate"] if validate else []), "--report-state",
             str(self.state_path), *arguments],
            env={**server.environment, **(environment or {})}, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.id = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def state(self):
        try:
            return json.loads(self.state_path.read_text())
        except FileNotFoundError:
            return None

    def until(self, what, true_of):
        """The state, when that is true of it."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            state = self.state()
            try:
                if state is not None and true_of(state):
                    return state
            except KeyError:
                pass  # what only an answer has is not there before the first of a scene
            if self.process.poll() is not None:
                fail(f"the window ended ({self.process.returncode}) before {what}: {self.process.stderr.read()}")
            time.sleep(0.02)
        fail(f"not within {PATIENCE} s: {what}; the last state: {self.state()}")

    def tool(self, *arguments):
        return subprocess.run(["xdotool", *arguments], env=self.server.environment, check=True, capture_output=True,
                              text=True, timeout=PATIENCE).stdout

    def press(self, *keys):
        if self.id is None:
            self.id = self.tool("search", "--sync", "--onlyvisible", "--name", "^voxtact$").split()[0]
            self.tool("windowfocus", "--sync", self.id)
        self.tool("key", *keys)

    def open(self, path):
        self.dialog("ctrl+o", path)

    def save_session(self, path):
        self.dialog("ctrl+s", path)
        deadline = time.monotonic() + PATIENCE
        while not pathlib.Path(path).exists() and time.monotonic() < deadline:
            time.sleep(0.05)

    def type(self, text):
        self.tool("type", "--delay", "30", text)
        time.sleep(1)

    def dialog(self, keys, path):
        """A dialog that asks for a path, which those keys open."""
        self.press(keys)
        time.sleep(1)  # until the dialog has the keyboard, which nothing tells
        self.type(str(path))
        self.enter()

    def enter(self):
        # Long enough for a slow frame to see it.
        self.tool("keydown", "Return")
        time.sleep(0.4)
        self.tool("keyup", "Return")

    def end(self):
        """The exit status is 0 only where validation had nothing to say."""
        out, err = self.process.communicate(timeout=PATIENCE)
        if (self.process.returncode, out, err) != (0, "", ""):
            fail(f"the window ended with {self.process.returncode}: {out}{err}")


def answer_of(program, command):
    """The row of a command."""
    environment = {**os.environ, "PATH": f"{pathlib.Path(program).parent}:{os.environ['PATH']}"}
    ran = subprocess.run(["sh", "-c", command + " --format csv"], env=environment, capture_output=True, text=True,
                         timeout=PATIENCE)
    if ran.returncode != 0:
        fail(f"{command}: {ran.stderr}")
    row, = csv.DictReader(ran.stdout.splitlines())
    return row


def compare(program, state):
    """The state's answer is that of its command; where it has a clearance, that is the host's."""
    row = answer_of(program, state["command"])
    for name in ("hit", "count", "exact", "method", "projection"):
        if row[name] != str(state[name]):
            fail(f"{name}: the window says {state[name]}, its command {row[name]}: {state['command']}")
    if "labels" in state and labels_text(state) != row["labels"]:
        fail(f"labels: the window says {labels_text(state)}, its command {row['labels']}: {state['command']}")
    if not state["clearance"]:
        return
    command = re.sub("--projection .*", "--projection conservative --count cpu --clearance", state["command"])
    row = answer_of(program, command)
    for name in ("lo", "hi"):
        said, is_so = float(state["clearance"][name]), float(row["clearance_" + name])
        if said != is_so and abs(said - is_so) > 1e-6 * is_so:
            fail(f"clearance {name}: the window says {said}, its command {is_so}: {command}")


def labels_text(state):
    return ";".join(f"{one['name'] or one['label']}:{one['count']}" for one in state["labels"])


def poses(folder, *heights):
    path = pathlib.Path(folder) / "poses.txt"
    path.write_text("".join(f"1 0 0 3 0 1 0 -8 0 0 1 {height} 0 0 0 1\n" for height in heights))
    return str(path)


SCENE = ["--volume", "builtin:head:32", "--mesh", "builtin:scalpel:300", "--preset", "mr"]
HEIGHT = 11  # of a pose's numbers, row by row


def keys(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 130, 40)]) as window:
        state = window.until("the first answer", lambda s: s["settled"])
        assert (state["hit"], state["pose"][HEIGHT], state["method"]) == (0, 130, "cpu"), state
        compare(program, state)
        state = window.until("the first clearance", lambda s: s["clearance"])
        assert state["clearance"]["lo"] > 0 and len(state["clearance"]["volume"]) == 3, state
        compare(program, state)
        height = 130
        while state["hit"] == 0 and height > 0:
            height -= 10
            window.press("shift+Next")
            state = window.until(f"a pose {height} mm high", lambda s: s["pose"][HEIGHT] == height)
        assert state["hit"] == 1 and state["count"] > 0 and state["triangles"] > 0, state
        compare(program, state)
        # Many at once: none is lost.
        window.press("Prior", "Prior", "Prior", "Next")
        state = window.until("three up and one down", lambda s: abs(s["pose"][HEIGHT] - height - 2) < 1e-9)
        compare(program, state)
        # Nudges that follow each other are one command.
        window.press("ctrl+z")
        state = window.until("the first pose again", lambda s: s["pose"][HEIGHT] == 130)
        assert state["hit"] == 0, state
        window.press("ctrl+y")
        window.until("what was undone", lambda s: abs(s["pose"][HEIGHT] - height - 2) < 1e-9)
        window.press("bracketright")
        state = window.until("the second pose of the list", lambda s: s["pose"][HEIGHT] == 40 and s["hit"] == 1)
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
        for method, projection in (("compute", "conservative"), ("query", "view"), ("atomic", "dominant-axis")):
            with Window(program, server, folder, [*SCENE, "--poses", poses(folder, 60), "--count", method,
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


def counted(state):
    return state["methods"] and all(one["hit"] is not None or one["refused"] for one in state["methods"])


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
                by_projection.setdefault(one["projection"], []).append((one["hit"], one["count"], one["triangles"]))
        assert len(by_projection) >= 3, by_projection
        assert all(len(said) >= 2 and len(set(said)) == 1 for said in by_projection.values()), by_projection
        assert all(one["hit"] == 1 for one in state["methods"]), state["methods"]
        live = next(one for one in state["methods"] if one["method"] == "cpu" and one["projection"] == "conservative")
        assert (live["hit"], live["count"]) == (state["hit"], state["count"]), state
        window.press("Next")
        state = window.until("the counts of the next pose", lambda s: counted(s) and s["pose"][HEIGHT] == 59)
        assert state["methods"][-1]["count"] == state["count"], state
        window.press("k")
        window.until("none of them", lambda s: s["methods"] is None)
        window.press("ctrl+q")
        window.end()


def labels(program, folder):
    # Any image of whole numbers is a label map; its values are the labels.
    subprocess.run([program, "make", "volume", "builtin:head:32", f"{folder}/atlas.nii"], check=True,
                   capture_output=True, timeout=PATIENCE)
    with Server() as server:
        for device in (["--device", "cpu"], ["--count", "compute"]):
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
        for device in (["--device", "cpu"], ["--count", "compute"]):
            with Window(program, server, folder, [*scene, *device, "--poses", poses(folder, 60)]) as window:
                state = window.until("the answer before", lambda s: s["settled"])
                whole = state["count"]
                window.press("x")
                state = window.until("a hole at the tip", lambda s: s["holes"] == 1 and s["settled"])
                assert 0 < state["count"] < whole, (whole, state)
                assert state["command"].startswith("# of the volume as it was read, without the hole"), state
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


def files(program, folder):
    for kind, source, name in (("mesh", "builtin:scalpel:600", "tool.stl"), ("volume", "builtin:ct:32", "ct.nii")):
        subprocess.run([program, "make", kind, source, f"{folder}/{name}"], check=True, capture_output=True,
                       timeout=PATIENCE)
    pathlib.Path(folder, "curve.json").write_text('{"points": [[10, 0], [100, 1]]}')
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 130, 60)]) as window:
        window.until("the first answer", lambda s: s["settled"])
        pathlib.Path(folder, "other.txt").write_text("1 0 0 3 0 1 0 -8 0 0 1 55 0 0 0 1\n")
        window.open(f"{folder}/other.txt")
        state = window.until("the opened pose", lambda s: s["pose"][HEIGHT] == 55 and s["hit"] == 1)
        window.open(f"{folder}/curve.json")
        state = window.until("the opened curve", lambda s: s["points"] == [[10, 0], [100, 1]])
        compare(program, state)
        window.open(f"{folder}/tool.stl")
        state = window.until("the opened mesh", lambda s: "/tool.stl" in s["command"] and s["settled"])
        assert state["points"] == [[10, 0], [100, 1]] and state["pose"][HEIGHT] == 55, state
        compare(program, state)
        window.open(f"{folder}/nowhere.nii")
        state = window.until("an error", lambda s: "nowhere.nii" in s["error"])
        window.press("Return")
        window.until("the window going on", lambda s: s["error"] == "")
        window.press("Next")
        state = window.until("an answer after the error", lambda s: s["pose"][HEIGHT] == 54 and s["settled"])
        compare(program, state)
        window.open(f"{folder}/ct.nii")
        state = window.until("the opened volume", lambda s: "/ct.nii" in s["command"] and s["settled"])
        assert "/tool.stl" in state["command"] and state["pose"][HEIGHT] == 54, state
        compare(program, state)
        window.press("ctrl+q")
        window.end()


def make(program, folder, kind, source, name):
    path = f"{folder}/{name}"
    subprocess.run([program, "make", kind, source, path], check=True, capture_output=True, timeout=PATIENCE)
    return path


def loading(program, folder):
    large = make(program, folder, "volume", "builtin:ct:128", "large.nii.gz")
    larger = make(program, folder, "volume", "builtin:ct:160", "larger.nii.gz")
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 130)]) as window:
        window.until("the first answer", lambda s: s["settled"] and s["loaded"])
        window.open(large)
        # Seen while it is loaded, or there already: a busy machine may look too late.
        begun = window.until("the loading", lambda s: s["loading"] or "/large.nii.gz" in s["command"])
        # What is shown goes on meanwhile, and what is done with it is not lost.
        window.press("Next")
        state = window.until("the volume and the pose", lambda s: "/large.nii.gz" in s["command"] and s["settled"]
                             and s["loading"] is None and s["pose"][HEIGHT] == 129)
        compare(program, state)
        if begun["loading"]:
            print(f"while it was loaded: frame {begun['frame']} to {state['frame']}")
        window.open(larger)
        window.until("the next loading", lambda s: s["loading"] or "/larger.nii.gz" in s["command"])
        window.press("Escape")
        state = window.until("one of the two", lambda s: s["loading"] is None and s["settled"])
        if "cancelled" in state["status"]:  # else it was there sooner than the key
            assert "/large.nii.gz" in state["command"], state
        window.open(f"{folder}/nowhere.nii")
        window.until("the error", lambda s: "nowhere.nii" in s["error"] and s["loading"] is None)
        window.press("Return")
        window.until("the window going on", lambda s: s["error"] == "")
        pathlib.Path(folder, "broken.json").write_text('{"points": [[10, 0], [5, 1]]}')
        before = window.state()["points"]
        window.open(f"{folder}/broken.json")
        state = window.until("the error of the curve", lambda s: "broken.json" in s["error"])
        assert state["points"] == before, state
        window.press("Return")
        window.until("the window going on", lambda s: s["error"] == "")
        window.press("ctrl+q")
        window.end()


def coarser(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--volume-side", "20",
                                                             "--poses", poses(folder, 60)]) as window:
        state = window.until("the question", lambda s: s["question"])
        assert "32 x 32 x 32 voxels" in state["question"]["text"], state
        assert "coarser by 2" in state["question"]["text"], state
        window.press("Return")
        state = window.until("the coarser copy", lambda s: s["settled"])
        assert state["coarser"] == 2 and state["hit"] == 1 and state["count"] > 0, state
        assert "coarser by 2" in state["command"].splitlines()[0], state
        # The same answer as of a file that holds the copy: 16 voxels a side of twice the spacing.
        large = make(program, folder, "volume", "builtin:head:96", "large.nii")
        window.open(large)
        state = window.until("the next question", lambda s: s["question"])
        assert "coarser by 5" in state["question"]["text"], state
        window.press("Escape")
        state = window.until("what was shown before", lambda s: s["question"] is None)
        assert state["coarser"] == 2, state
        window.open(large)
        window.until("the question again", lambda s: s["question"])
        window.press("Return")
        state = window.until("the other copy", lambda s: s["coarser"] == 5 and s["settled"])
        assert "/large.nii" in state["command"] and state["hit"] == 1, state
        window.press("ctrl+q")
        window.end()


def session(program, folder):
    volume = make(program, folder, "volume", "builtin:ct:32", "ct.nii")
    tool = make(program, folder, "mesh", "builtin:scalpel:600", "tool.stl")
    with Server() as server:
        with Window(program, server, folder, ["--volume", volume, "--mesh", tool, "--device", "cpu", "--poses",
                                              poses(folder, 60)]) as window:
            window.until("the first answer", lambda s: s["settled"])
            window.press("x")
            state = window.until("a hole", lambda s: s["holes"] == 1 and s["settled"])
            window.press("Next", "t")
            state = window.until("another pose", lambda s: s["pose"][HEIGHT] == 59 and s["settled"])
            window.save_session(f"{folder}/session.json")
            window.press("ctrl+q")
            window.end()
        saved = json.loads(pathlib.Path(folder, "session.json").read_text())
        assert saved["holes"] and saved["shown"]["handle_axes"] == "view", saved
        with Window(program, server, folder, ["--session", f"{folder}/session.json"]) as window:
            again = window.until("the session", lambda s: s["settled"])
            for name in ("count", "hit", "pose", "holes", "points"):
                assert again[name] == state[name], (name, again, state)
            window.press("ctrl+q")
            window.end()
        # Its files are elsewhere now.
        moved = pathlib.Path(folder, "moved")
        moved.mkdir()
        for name in ("ct.nii", "tool.stl"):
            pathlib.Path(folder, name).rename(moved / name)
        with Window(program, server, folder, ["--session", f"{folder}/session.json"]) as window:
            asked = window.until("the question", lambda s: s["question"])["question"]
            assert [file["name"] for file in asked["files"]] == ["volume", "mesh"], asked
            window.press("Return")  # they are not where the fields still say
            window.until("the question again", lambda s: s["question"])
            time.sleep(1)
            window.type(str(moved / "ct.nii"))
            window.press("Tab")
            time.sleep(1)
            window.type(str(moved / "tool.stl"))
            window.press("Return")
            again = window.until("the session with its files", lambda s: s["settled"])
            assert again["count"] == state["count"] and "moved/ct.nii" in again["command"], again
            window.press("ctrl+q")
            window.end()
        recent = json.loads(pathlib.Path(server.kept.name, "voxtact", "recent.json").read_text())
        assert recent[0] == f"{folder}/session.json", recent
        # A list that cannot be read is none.
        pathlib.Path(server.kept.name, "voxtact", "recent.json").write_text("{")
        with Window(program, server, folder, [*SCENE, "--device", "cpu"]) as window:
            window.until("the first answer", lambda s: s["settled"])
            window.press("ctrl+q")
            window.end()


def lost(program, folder):
    layers = os.environ.get("VOXTACT_FAULT_LAYERS", "")
    if not layers:
        fail("VOXTACT_FAULT_LAYERS names no folder with the layer")
    fault = pathlib.Path(folder, "fault")
    faults = {"VK_ADD_LAYER_PATH": layers, "VK_INSTANCE_LAYERS": "VK_LAYER_VOXTACT_fault", "VOXTACT_FAULT": str(fault)}

    def lose(window, what):
        (fault.parent / "fault.new").write_text(what)
        (fault.parent / "fault.new").rename(fault)
        window.press("Next")
        deadline = time.monotonic() + PATIENCE
        while fault.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        assert not fault.exists(), f"{what}: nothing was to fail"

    with Server() as server:
        with Window(program, server, folder, [*SCENE, "--count", "compute", "--poses", poses(folder, 60)],
                    faults) as window:
            first = window.until("the first answer", lambda s: s["settled"])
            assert first["method"] == "compute", first
            lose(window, "surface")
            state = window.until("a new surface", lambda s: "surface" in s["status"] and s["settled"])
            assert state["pose"][HEIGHT] == 59 and state["method"] == "compute", state
            window.press("x")
            window.until("a hole", lambda s: s["holes"] == 1 and s["settled"])
            lose(window, "lost")
            window.until("the question", lambda s: s["question"])
            window.press("Return")
            state = window.until("the host's answer", lambda s: s["settled"] and s["method"] == "cpu")
            assert state["pose"][HEIGHT] == 58 and state["points"] == first["points"] and state["holes"] == 1, state
            window.press("ctrl+z", "ctrl+z")
            window.press("Next")
            state = window.until("the next answer", lambda s: s["pose"][HEIGHT] == 57 and s["settled"])
            window.press("ctrl+q")
            window.end()
        # The same twice in a moment: it ends, and what was shown is kept.
        with Window(program, server, folder, [*SCENE, "--count", "compute", "--poses", poses(folder, 60)],
                    faults) as window:
            window.until("the first answer", lambda s: s["settled"])
            lose(window, "lost")
            fault.write_text("lost")
            window.process.wait(timeout=PATIENCE)
            said = window.process.stderr.read()
            assert window.process.returncode == 1 and "rescued-session.json" in said, said
        kept = json.loads(pathlib.Path(server.kept.name, "voxtact", "rescued-session.json").read_text())
        assert kept["instrument"]["pose"][HEIGHT] == 59, kept


def png_size(path):
    head = pathlib.Path(path).read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n", head
    return int.from_bytes(head[16:20], "big"), int.from_bytes(head[20:24], "big")


def screenshot(program, folder):
    with Server() as server, Window(program, server, folder, [*SCENE, "--device", "cpu", "--poses",
                                                             poses(folder, 60)]) as window:
        state = window.until("the first answer", lambda s: s["settled"])
        window.dialog("ctrl+p", f"{folder}/window.png")
        state = window.until("a picture", lambda s: s["status"].startswith("the picture is in"))
        assert png_size(f"{folder}/window.png") == tuple(int(side) for side in state["picture"][2:]), state
        window.dialog("ctrl+p", f"{folder}/nowhere/large.png")
        window.until("the error", lambda s: "nowhere/large.png" in s["error"])
        window.press("Return")
        window.until("the window going on", lambda s: s["error"] == "")
        window.press("ctrl+q")
        window.end()


def memory(process):
    """Resident, MB."""
    for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    return fail("no VmRSS")


SOAK_KEYS = ("Left Right Up Down Prior Next i o w s a d q e bracketleft bracketright space 1 2 3 4 5 6 f g h t x c "
             "k m v shift+Next shift+Prior ctrl+z ctrl+z ctrl+y Escape F1 F1").split()


def soak_step(random, width, height):
    """Arguments of xdotool for something that a person might do."""
    def place():
        return ["mousemove", str(random.randrange(width)), str(random.randrange(30, height))]
    kind = random.randrange(10)
    if kind < 4:
        return ["key", *random.choices(SOAK_KEYS, k=random.randrange(1, 6))]
    button = random.choice("1113")
    if kind < 8:
        return [*place(), "mousedown", button, "sleep", "0.05", *place(), "sleep", "0.05", *place(), "mouseup", button]
    if kind < 9:
        return [*place(), "click", "--repeat", str(random.randrange(1, 6)), random.choice("45")]
    return [*place(), "click", "--repeat", "2", "--delay", "30", "1"]


def soak(program, folder, seconds=10):
    import random as source
    seed = int(os.environ.get("VOXTACT_SOAK_SEED", time.time_ns() % 1000000))
    random = source.Random(seed)
    print(f"seed {seed}", flush=True)
    sizes = ((640, 480), (900, 700), (700, 720))
    with Server() as server, Window(program, server, folder, [*SCENE, "--count", "compute", "--poses",
                                                             poses(folder, 130, 90, 60, 40, 20)]) as window:
        window.until("the first answer", lambda s: s["settled"])
        # What is compiled once is not counted as growth.
        window.press("k")
        window.until("the counts of all methods", counted)
        window.press("k")
        began, size, steps, resident, frames = time.monotonic(), sizes[0], 0, [], []
        while time.monotonic() - began < seconds:
            if window.process.poll() is not None:
                fail(f"the window ended with {window.process.returncode}: {window.process.stderr.read()}")
            if steps % 60 == 59:
                size = random.choice(sizes)
                window.tool("windowsize", window.id, str(size[0]), str(size[1]))
            window.tool(*soak_step(random, *size))
            steps += 1
            if steps % 5 == 0:
                resident.append(memory(window.process))
                frames.append(window.state()["frame_ms"])
        window.tool("key", "Escape", "Escape", "Escape")
        last = window.state()
        middle, end = resident[len(resident) // 3:2 * len(resident) // 3], resident[2 * len(resident) // 3:]
        growth = sorted(end)[len(end) // 2] - sorted(middle)[len(middle) // 2]
        frames.sort()
        print(f"{steps} steps in {seconds} s, {last['frame']} frames, {last['answers']} answers; a frame takes "
              f"{frames[len(frames) // 2]:.0f} ms (median of medians; most {frames[-1]:.0f}); resident "
              f"{resident[0]:.0f} MB at first, {max(resident):.0f} at most, {resident[-1]:.0f} at last, "
              f"{growth:+.1f} from the middle third to the last")
        # Images of other sizes, and what undo keeps.
        assert growth < 24, resident
        window.press("ctrl+q")
        window.end()


def refused(program, status, text, arguments, environment):
    ran = subprocess.run([program, "view", *arguments], env=environment, capture_output=True, text=True,
                         timeout=PATIENCE)
    lines = ran.stderr.splitlines()
    if ran.returncode != status or len(lines) != 1 or text not in lines[0] or ran.stdout:
        fail(f"{arguments}: status {ran.returncode} and {ran.stderr!r}, not {status} and a line with {text!r}")


def refusals(program, folder):
    without = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    refused(program, 1, "there is no display to open a window on", [*SCENE], without)
    session = pathlib.Path(folder) / "session.json"
    session.write_text('{"voxtact_session": 1, "volume": "builtin:head:16", "mesh": "builtin:scalpel:300"}')
    refused(program, 1, "transfer_function: ", ["--session", str(session)], without)
    refused(program, 2, "--session", ["--session", str(session), "--threshold", "0.2"], without)
    refused(program, 2, "--volume: the window shows one", ["--volume", "builtin:head", "--volume", "builtin:ct"],
            without)
    refused(program, 2, "--count query", ["--count", "query", "--projection", "conservative"], without)
    refused(program, 1, "nowhere.nii", ["--labels", "nowhere.nii"], without)
    refused(program, 2, "--labels is not given", ["--label-names", "nowhere.txt"], without)
    refused(program, 1, "nowhere.nii", ["--volume", "nowhere.nii"], without)
    session.write_text('{"voxtact_session": 1, "volume": "nowhere.nii", "mesh": "builtin:scalpel:300", '
                       '"transfer_function": {"points": [[0, 0], [1, 1]]}}')
    refused(program, 1, "nowhere.nii", ["--session", str(session)], without)
    with Server() as server:
        # With a number of frames there may be nobody to ask.
        for arguments in (["--session", str(session)], ["--volume", "nowhere.nii"]):
            refused(program, 1, "nowhere.nii", [*arguments, "--frames", "2"], server.environment)
        refused(program, 1, "--volume-side", [*SCENE, "--volume-side", "8", "--frames", "2"], server.environment)
        no_driver = {**server.environment, "VK_DRIVER_FILES": "/nowhere", "VK_ICD_FILENAMES": "/nowhere"}
        refused(program, 1, "Vulkan", [*SCENE], no_driver)


def main(arguments, checks, usage, timed=None):
    """Runs the check that is named. `timed`: the one that takes a number of seconds, too."""
    seconds = len(arguments) == 3 and arguments[1] == timed and arguments[2].isdigit()
    if not (len(arguments) == 2 or seconds) or arguments[1] not in checks:
        print(usage, file=sys.stderr)
        return 2
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        checks[arguments[1]](arguments[0], folder, *(int(number) for number in arguments[2:]))
    print(f"{arguments[1]}: passed in {time.monotonic() - begun:.1f} s")
    return 0


if __name__ == "__main__":
    CHECKS = {"keys": keys, "handles": handles, "methods": methods, "labels": labels, "drill": drill, "files": files,
              "loading": loading, "coarser": coarser, "session": session, "lost": lost, "screenshot": screenshot,
              "soak": soak, "refusals": refusals}
    sys.exit(main(sys.argv[1:], CHECKS, __doc__, "soak"))
