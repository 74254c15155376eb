#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Random input for the window of window.py.

  soak.py PROGRAM soak [SECONDS]   for ten seconds, or for so many; VOXTACT_SOAK_SEED is the seed, or it is random

Exit status: 0 passed, 1 failed.
"""
import os
import pathlib
import sys
import time

from window import SCENE, Server, Window, counted, fail, main, poses


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
    with Server() as server, Window(program, server, folder, [*SCENE, "--method", "compute", "--poses",
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


if __name__ == "__main__":
    CHECKS = {"soak": soak}
    sys.exit(main(sys.argv[1:], CHECKS, __doc__, "soak"))
