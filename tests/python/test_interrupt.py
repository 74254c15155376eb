# SPDX-License-Identifier: MIT
"""Ctrl-C ends work within a second, between two poses and in the middle of one, and the scene is there afterwards.

A second of each processor's time for this program: on a machine that is busy with something else it lasts longer.
"""
import subprocess
import sys

import pytest

BEGIN = """
import os, signal, sys, threading, time
import numpy as np
import voxtact as vx
def now():
    return time.process_time() / os.cpu_count()
def press(after):
    def wait():
        time.sleep(after)
        global pressed
        pressed = now()
        os.kill(os.getpid(), signal.SIGINT)
    threading.Thread(target=wait, daemon=True).start()
"""

BATCH = BEGIN + """
scene = vx.Scene("builtin:head:64", opacity=[(40, 0), (80, 1)])
mesh = vx.read_mesh("builtin:scalpel")
poses = np.tile(np.eye(4), (500_000, 1, 1))
poses[:, 2, 3] = np.linspace(-90, 90, len(poses))
begun = threading.Event()
def progress(done, of):
    if not begun.is_set():
        begun.set()
        press(0.05)
question, *more = sys.argv[1].split()
more = {"uncertainty": {"uncertainty": (1, 1)}, "margin": {"margin": 1}}[more[0]] if more else {}
try:
    getattr(scene, question)(mesh, poses, progress=progress, **more)
except KeyboardInterrupt:
    print("interrupted after", now() - pressed)
    print("still there:", len(scene.count(mesh, np.eye(4))))
"""

# One pose that takes seconds at the least: thousands of triangles right across voxels of which every other one is
# opaque, or, for distances, a plate in the middle of a gap, all of it about as near.
ALONE = BEGIN + """
side = 96
if sys.argv[1] in ("count", "area"):
    x, y, z = np.meshgrid(*[np.arange(side)] * 3, indexing="ij")
    voxels = np.where((7 * x + 5 * y + 3 * z) % 4 < 2, 255, 0).astype(np.uint8)
    angle = np.linspace(0, 3, 20_000)
    middle = np.full_like(angle, side / 2)
    c, s = side / 2 * np.cos(angle), side / 2 * np.sin(angle)
    corners = np.stack([np.stack([middle - c, middle - s, 0 * c], 1), np.stack([middle + c, middle + s, 0 * c], 1),
                        np.stack([middle, middle, 0 * c + side - 1], 1)], 1)
    mesh = (corners.reshape(-1, 3), np.arange(3 * len(angle)).reshape(-1, 3))
else:
    voxels = np.full((side, side, side), 255, np.uint8)
    voxels[40:57] = 0
    n = 200 if sys.argv[1] == "motion" else 1000  # as many triangles as keep the fastest machine for a second
    u, v = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
    plate = np.stack([u * 95 / n, v * 95 / n, 48 + 1e-4 * np.sin(0.7 * u) * np.sin(0.9 * v)], -1).reshape(-1, 3)
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    mesh = (plate, np.concatenate([np.stack([first, first + 1, first + n + 2], 1),
                                   np.stack([first, first + n + 2, first + n + 1], 1)]))
mesh = vx.read_mesh(mesh)
scene = vx.Scene(vx.read_volume(voxels, axes="zyx", affine=np.eye(4), space="lps"), opacity=[(120, 0), (135, 1)])
# A quarter of a turn in the plane of the plate, less than a hundredth of a mm beside one side of the gap.
middle = np.eye(4)
middle[:3, 3] = 48, 48, 8.47
turn = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
back = np.eye(4)
back[:2, 3] = -48
poses = np.stack([middle @ back, middle @ turn @ back])
ask = {"count": lambda: scene.count(mesh, np.eye(4)),
       "distance": lambda: scene.distance(mesh, np.eye(4), tolerance=1e-6, max_steps=2**32 - 1),
       "area": lambda: scene.area(mesh, np.eye(4), tolerance=1e-9, max_steps=2**32 - 1),
       "motion": lambda: scene.motion(mesh, poses, resolution=1e-6, max_steps=2**32 - 1)}[sys.argv[1]]
scene.count(mesh, np.diag([1e-9, 1e-9, 1e-9, 1]))  # what is made once
press(0.1)
try:
    ask()
    print("done before it was interrupted")
except KeyboardInterrupt:
    print("interrupted after", now() - pressed)
    print("still there:", len(scene.count(mesh, np.diag([1e-9, 1e-9, 1e-9, 1]))))
"""

PICTURE = BEGIN + """
scene = vx.Scene("builtin:head:32", opacity=[(40, 0), (80, 1)])
scene.picture(size=(64, 64))  # what is made once
press(0.3)
try:
    scene.picture(size=(4096, 16384))
    print("done before it was interrupted")
except KeyboardInterrupt:
    print("interrupted after", now() - pressed)
    print("still there:", len(scene.picture(size=(16, 1))))
"""


def check(script, question=""):
    done = subprocess.run([sys.executable, "-c", script, question], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "still there: 1" in done.stdout, done.stdout
    assert float(done.stdout.split()[2]) < 1, done.stdout


@pytest.mark.parametrize("question", ["touch", "count", "distance", "area", "overlap", "touch margin", "motion", "touch uncertainty"])
def test_ctrl_c_stops_a_long_batch_within_a_second(question):
    check(BATCH, question)


@pytest.mark.parametrize("question", ["count", "distance", "area", "motion"])
def test_ctrl_c_stops_a_long_pose_within_a_second(question):
    check(ALONE, question)


def test_ctrl_c_stops_a_picture_within_a_second(device):
    check(PICTURE)


# A script ends while another thread asks on and on. The C library's own end lasts a little, in which that thread must
# find neither an interpreter that is gone nor a library that is.
LEFT_ALONE = """
import ctypes, sys, threading, time
import numpy as np
import voxtact as vx
libc = ctypes.CDLL(None)
libc.__cxa_atexit(ctypes.cast(libc.usleep, ctypes.c_void_p), ctypes.c_void_p(300_000), None)
scene = vx.Scene("builtin:head:48", opacity=[(40, 0), (80, 1)], threads=1)
mesh = vx.read_mesh("builtin:scalpel:500")
poses = np.tile(np.eye(4), (3000, 1, 1))
poses[:, :3, 3] = np.random.default_rng(1).uniform(-60, 60, (3000, 3))
asks = {"count": lambda: scene.count(mesh, poses), "tells": lambda: scene.count(mesh, poses, progress=lambda *_: None),
        "sleeps": lambda: scene.count(mesh, poses, progress=lambda *_: time.sleep(0.1)),
        "distance": lambda: scene.distance(mesh, poses[:300]), "motion": lambda: scene.motion(mesh, poses[:30])}
begun = threading.Event()
def work():
    while True:
        asks[sys.argv[1]]()
        begun.set()
threading.Thread(target=work, daemon=True).start()
begun.wait()
time.sleep(float(sys.argv[2]))
"""


@pytest.mark.parametrize("what", ["count", "tells", "sleeps", "distance", "motion"])
def test_a_script_ends_while_another_thread_is_in_a_call(what):
    for wait in (0.01, 0.07, 0.13):
        done = subprocess.run([sys.executable, "-c", LEFT_ALONE, what, str(wait)], capture_output=True, text=True,
                              check=False, timeout=120)
        assert (done.returncode, done.stderr) == (0, ""), done.stderr


# The main thread's own last calls are answered, and the child of a fork does not wait for threads that it has not.
LAST_CALLS = """
import atexit, os, sys, threading, time
import numpy as np
def last():
    print("last:", len(scene.count(mesh, np.eye(4))))
atexit.register(last)
import voxtact as vx
scene = vx.Scene("builtin:head:48", opacity=[(40, 0), (80, 1)], threads=1)
mesh = vx.read_mesh("builtin:scalpel:500")
poses = np.tile(np.eye(4), (30_000, 1, 1))
threading.Thread(target=lambda: scene.count(mesh, poses), daemon=True).start()
time.sleep(0.05)
sys.stdout.flush()
child = os.fork()
if child == 0:
    sys.exit(0)
print("child:", os.waitpid(child, 0)[1])
"""


def test_the_last_calls_of_a_program_are_answered():
    done = subprocess.run([sys.executable, "-c", LAST_CALLS], capture_output=True, text=True, check=False, timeout=120)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert done.stdout.split("\n")[:3] == ["last: 1", "child: 0", "last: 1"], done.stdout


# Python waits for threads that are no daemons before it ends, and their calls are made to their end.
WAITED_FOR = """
import threading, time
import numpy as np
import voxtact as vx
scene = vx.Scene("builtin:head:48", opacity=[(40, 0), (80, 1)], threads=1)
mesh = vx.read_mesh("builtin:scalpel:500")
begun = threading.Event()
def told(done, of):
    begun.set()
    time.sleep(0.05)
def work():
    answer = scene.count(mesh, np.tile(np.eye(4), (20_000, 1, 1)), progress=told)
    print("answered:", len(answer), "after the end:", not threading.main_thread().is_alive())
threading.Thread(target=work).start()
begun.wait()
"""


def test_calls_of_threads_that_are_no_daemons_are_made_to_their_end():
    done = subprocess.run([sys.executable, "-c", WAITED_FOR], capture_output=True, text=True, check=False, timeout=120)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert done.stdout == "answered: 20000 after the end: True\n", done.stdout
