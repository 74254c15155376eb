# SPDX-License-Identifier: MIT
"""The window as a person uses it: on an X server of its own, by keys and the pointer, under validation. What keys.py,
pointer.py, files.py, meshes.py and soak.py have in common.

Steps wait for what they lead to, as long as a slow machine may need. Where nothing tells (a hand that drags, a key that
may be lost) they sleep, and try again.
"""
import csv
import json
import os
import pathlib
import re
import shutil
import struct
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
        self.frames = tempfile.TemporaryDirectory()
        self.process = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp",
                                         "-fbdir", self.frames.name],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        number = self.process.stdout.readline().strip()
        # What the window keeps from run to run is not that of the user who runs the tests.
        self.kept = tempfile.TemporaryDirectory()
        self.environment = {**os.environ, "DISPLAY": f":{number}", "XDG_STATE_HOME": self.kept.name}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.kept.cleanup()
        self.frames.cleanup()

    def pixels(self):
        """What is on the screen now: the three channels of a pixel, by its place."""
        data = (pathlib.Path(self.frames.name) / "Xvfb_screen0").read_bytes()  # a dump of xwd
        header = struct.unpack(">25I", data[:100])
        begin, line, colours = header[0], header[12], header[19]

        def pixel(x, y):
            at = begin + 12 * colours + y * line + 4 * x
            return data[at:at + 3]
        return pixel


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
        self.until("no field for a path", lambda s: s["field"] is None)
        self.press(keys)
        self.fill(path)
        self.enter()

    def fill(self, path):
        """Types a path into the field for one, once it has the keyboard."""
        self.until("a field for a path", lambda s: s["field"] is not None)
        self.tool("type", "--delay", "30", str(path))
        self.until(f"{path} in the field", lambda s: s["field"] == str(path))

    def next_field(self):
        """On to the field below, by a key that is lost where it comes and goes within a frame."""
        before = self.state()["field"]
        deadline = time.monotonic() + PATIENCE
        while self.state()["field"] in (None, before):
            if time.monotonic() > deadline:
                fail(f"not within {PATIENCE} s: the field below; the last state: {self.state()}")
            self.hold(0.2, "Tab")
            again = time.monotonic() + PATIENCE / 12
            while self.state()["field"] in (None, before) and time.monotonic() < again:
                time.sleep(0.05)

    def enter(self):
        self.hold(0.4, "Return")

    def hold(self, seconds, *keys):
        """Keys at once, long enough for a slow frame to see them. Those that repeat do so after 0.27 s."""
        for key in keys:
            self.tool("keydown", key)
        time.sleep(seconds)
        for key in reversed(keys):
            self.tool("keyup", key)

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
    """The state's answer is that of its command; where it has a distance and an area, these are the host's."""
    row = answer_of(program, state["command"])
    for name in ("touch", "count", "exact", "method", "projection"):
        column = "count_exact" if name == "exact" else name
        if row[column] != str(state[name]):
            fail(f"{name}: the window says {state[name]}, its command {row[column]}: {state['command']}")
    if "labels" in state and labels_text(state) != row["labels"]:
        fail(f"labels: the window says {labels_text(state)}, its command {row['labels']}: {state['command']}")
    for what in ("distance", "area", "overlap"):
        if not state[what]:
            continue
        word = "('[^']*'|[^ ]+)"
        command = re.sub(f" --label-counts --labels {word}( --label-names {word})?", "", state["command"])
        command = re.sub(f" --projection .*| --tf-domain={word}| --tf-size {word}", "", command)
        row = answer_of(program, command.replace("voxtact count", f"voxtact {what}"))
        for name, column in (("lo", "lower"), ("hi", "upper")):
            said, is_so = float(state[what][name]), float(row[column])
            if said != is_so and abs(said - is_so) > 1e-6 * is_so:
                fail(f"{what} {name}: the window says {said}, its command {is_so}: {command}")


def labels_text(state):
    return ";".join(f"{one['name'] or one['label']}:{one['count']}" for one in state["labels"])


def poses(folder, *heights):
    path = pathlib.Path(folder) / "poses.txt"
    path.write_text("".join(f"1 0 0 3 0 1 0 -8 0 0 1 {height} 0 0 0 1\n" for height in heights))
    return str(path)


SCENE = ["--volume", "builtin:head:30", "--mesh", "builtin:scalpel:300", "--preset", "mr"]
HEIGHT = 11  # of a pose's numbers, row by row


def make(program, folder, kind, source, name):
    path = f"{folder}/{name}"
    subprocess.run([program, "make", kind, source, path], check=True, capture_output=True, timeout=PATIENCE)
    return path


def counted(state):
    return state["methods"] and all(one["touch"] is not None or one["refused"] for one in state["methods"])


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
