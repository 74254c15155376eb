#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Several meshes in the window, on an X server of its own, by keys, under validation.

  meshes.py PROGRAM host      two meshes, each moved, hidden and removed, a third one opened, and a session of them; every
                              answer is compared with that of the command that the window has for that mesh
  meshes.py PROGRAM device    the same by the device, but for the session

Exit status: 0 passed, 1 failed.
"""
import pathlib
import sys

from window import HEIGHT, SCENE, Server, Window, compare, main, make, poses


def compare_all(program, state):
    """Each mesh's answer is that of its command, and what is said beside the list is that of the chosen one."""
    for mesh in state["meshes"]:
        compare(program, mesh)
    chosen = state["meshes"][state["chosen"]]
    for name in ("touch", "count", "pose", "triangles", "contacts", "command"):
        assert state[name] == chosen[name], (name, state)


def heights(state):
    return [mesh["pose"][HEIGHT] for mesh in state["meshes"]]


def settled(state):
    return state["settled"] and all(mesh["touch"] is not None for mesh in state["meshes"])


def measured(state):
    return settled(state) and all(mesh["distance"] for mesh in state["meshes"])


def steps(program, folder, window):
    """What host and device answer: the last state."""
    state = window.until("the first answers", measured)
    assert [mesh["mesh"] for mesh in state["meshes"]] == ["builtin:scalpel:300", "builtin:ellipsoid:300"], state
    assert state["chosen"] == 0 and heights(state) == [130, 130], state
    compare_all(program, state)
    # Each is moved by itself.
    window.press("shift+Next")
    window.until("the first one lower", lambda s: heights(s) == [120, 130])
    window.press("m")
    window.until("the choice of the other", lambda s: s["chosen"] == 1)
    window.press(*["shift+Next"] * 7)
    state = window.until("the second one in the head", lambda s: heights(s) == [120, 60] and measured(s))
    hits = [mesh["touch"] for mesh in state["meshes"]]
    assert hits == [0, 1] and state["touch"] == 1 and state["triangles"] > 0, state
    compare_all(program, state)
    # One that is not shown is answered for.
    window.press("v")
    state = window.until("one that is hidden", lambda s: not s["meshes"][1]["shown"] and measured(s))
    compare_all(program, state)
    # Undo goes through both, each of which was a command.
    window.press("ctrl+z", "ctrl+z")
    window.until("the second one where it was", lambda s: heights(s) == [120, 130] and s["meshes"][1]["shown"])
    window.press("ctrl+z")
    window.until("the first one where it was", lambda s: heights(s) == [130, 130])
    window.press("ctrl+y", "ctrl+y")
    window.until("both again", lambda s: heights(s) == [120, 60])
    # A third one, where the chosen one is.
    window.open(make(program, folder, "mesh", "builtin:scalpel:600", "tool.stl"))
    state = window.until("the opened mesh", lambda s: len(s["meshes"]) == 3 and measured(s))
    assert state["chosen"] == 2 and state["meshes"][2]["mesh"].endswith("/tool.stl"), state
    assert state["pose"] == state["meshes"][1]["pose"] or state["pose"] == state["meshes"][0]["pose"], state
    compare_all(program, state)
    window.press("m", "Delete")
    state = window.until("the first one removed", lambda s: len(s["meshes"]) == 2 and measured(s))
    assert state["meshes"][0]["mesh"] == "builtin:ellipsoid:300" and state["chosen"] == 0, state
    compare_all(program, state)
    window.press("ctrl+z")
    state = window.until("it again", lambda s: len(s["meshes"]) == 3 and measured(s))
    compare_all(program, state)
    return state


def scene(folder, *arguments):
    return [*SCENE, "--mesh", "builtin:ellipsoid:300", *arguments, "--poses", poses(folder, 130)]


def host(program, folder):
    with Server() as server:
        with Window(program, server, folder, scene(folder, "--device", "cpu")) as window:
            state = steps(program, folder, window)
            window.save_session(f"{folder}/session.json")
            window.press("ctrl+q")
            window.end()
        with Window(program, server, folder, ["--session", f"{folder}/session.json", "--device", "cpu"]) as window:
            again = window.until("the session", measured)
            for name in ("mesh", "shown", "pose", "touch", "count"):
                assert [one[name] for one in again["meshes"]] == [one[name] for one in state["meshes"]], (name, again)
            assert again["chosen"] == state["chosen"], again
            window.press("ctrl+q")
            window.end()
        # One of three is gone: only that one is asked for.
        pathlib.Path(folder, "tool.stl").rename(f"{folder}/moved.stl")
        with Window(program, server, folder, ["--session", f"{folder}/session.json", "--device", "cpu"]) as window:
            asked = window.until("the question", lambda s: s["question"])["question"]
            assert [file["name"] for file in asked["files"]] == ["mesh 3"], asked


def device(program, folder):
    with Server() as server, Window(program, server, folder, scene(folder, "--method", "compute")) as window:
        state = steps(program, folder, window)
        assert state["device"] != "host", state
        window.press("ctrl+q")
        window.end()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], {"host": host, "device": device}, __doc__))
