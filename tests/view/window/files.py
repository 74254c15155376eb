#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Files that come, go and cannot be shown, and what else the window of window.py survives.

  files.py PROGRAM files     other files are opened while the window is there, good ones and bad ones
  files.py PROGRAM loading   a volume is loaded while the instrument moves, and one is cancelled
  files.py PROGRAM coarser   a volume that is too large is shown as a coarser copy
  files.py PROGRAM session   a session whose files are gone, and the files that were opened last
  files.py PROGRAM notes     what strikes in what is shown is said in the window
  files.py PROGRAM lost      the surface and the device are lost (a layer in the folder VOXTACT_FAULT_LAYERS says so)
  files.py PROGRAM refusals  no display, and what cannot be shown

Exit status: 0 passed, 1 failed.
"""
import json
import os
import pathlib
import subprocess
import sys
import time

from window import HEIGHT, PATIENCE, SCENE, Server, Window, compare, counted, fail, main, make, poses


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
        state = window.until("the opened pose", lambda s: s["pose"][HEIGHT] == 55 and s["touch"] == 1)
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
        assert "30 x 30 x 30 voxels" in state["question"]["text"], state
        assert "coarser by 2" in state["question"]["text"], state
        window.press("Return")
        state = window.until("the coarser copy", lambda s: s["settled"])
        assert state["coarser"] == 2 and state["touch"] == 1 and state["count"] > 0, state
        assert "coarser by 2" in state["command"].splitlines()[0], state
        # The same answer as of a file that holds the copy: 15 voxels per side of twice the spacing.
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
        assert "/large.nii" in state["command"] and state["touch"] == 1, state
        window.press("ctrl+q")
        window.end()


def notes(program, folder):
    """What strikes in what is shown is in the window, not on standard error alone."""
    metres = pathlib.Path(folder, "tool.obj")
    metres.write_text("v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0.05 0 0\nf 1 2 3\nf 1 2 4\n")
    pathlib.Path(folder, "curve.json").write_text('{"points": [[10, 0], [100, 1]]}')
    scene = ["--volume", "builtin:head:30", "--mesh", "builtin:scalpel:300", "--preset", "ct-lung", "--device", "cpu"]
    preset, empty, size = "--preset ct-lung expects Hounsfield units", "none of its values, 0 to 255", "--mesh-scale 1000"

    def said(*parts):
        return lambda s: len(s["notes"]) == len(parts) and all(part in note for part, note in zip(parts, s["notes"]))

    with Server() as server, Window(program, server, folder, scene) as window:
        window.until("the notes of the preset", said(preset, empty))
        window.open(metres)
        window.until("that of the mesh", said(preset, empty, size))
        # They are of the document as it stands.
        window.open(f"{folder}/curve.json")
        window.until("those of the preset gone with its curve", said(size))
        window.press("Delete")
        window.until("that of the mesh gone with it", said())
        window.press("ctrl+z", "ctrl+z")
        window.until("all of them again", said(preset, empty, size))
        window.open(metres)
        window.until("a second one of that mesh", said(preset, empty, size, size))
        window.press("ctrl+q")
        out, err = window.process.communicate(timeout=PATIENCE)
        lines = err.splitlines()  # each once, with those of the reader and the device
        assert window.process.returncode == 0 and out == "" and len(lines) == len(set(lines)) == 5, err
        assert sum("triangles have no area" in line for line in lines) == 1, err
    image, ras = pathlib.Path(folder, "image.nrrd"), pathlib.Path(folder, "ras.obj")
    image.write_bytes(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 16 16 16\nspace: left-posterior-superior\n"
                      b"space directions: (10,0,0) (0,10,0) (0,0,10)\nspace origin: (45,45,5)\nencoding: raw\n\n"
                      + bytes(2048) + b"\xff" * 2048)
    ras.write_text("v -100 -100 50\nv -120 -100 50\nv -100 -120 50\nv -100 -100 70\nf 1 2 3\nf 1 2 4\n")
    with Server() as server, Window(program, server, folder, ["--volume", image, "--mesh", ras, "--device", "cpu",
                                                             "--opacity", "100:0,200:1"]) as window:
        window.until("the other reading", said("100 % of its box would be inside with --mesh-space ras"))
        window.press("Next")
        window.until("no offer for a mesh that moved", said())
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
            for name in ("count", "touch", "pose", "holes", "points"):
                assert again[name] == state[name], (name, again, state)
            # Over one that is there it is asked first; a key that is held is no answer.
            window.press("Next")
            window.until("a pose of its own", lambda s: s["pose"][HEIGHT] == 58 and s["settled"])
            window.press("ctrl+s")
            window.fill(f"{folder}/session.json")
            window.hold(1.5, "Return")
            window.until("the dialog going on", lambda s: s["field"] == f"{folder}/session.json")
            assert json.loads(pathlib.Path(folder, "session.json").read_text()) == saved
            window.enter()
            window.until("the session that is replaced", lambda s: "saved the session as" in s["status"])
            replaced = json.loads(pathlib.Path(folder, "session.json").read_text())
            assert replaced != saved, replaced
            window.press("Prior")  # as it was, and again without a question
            window.until("the pose as before", lambda s: s["pose"][HEIGHT] == 59 and s["settled"])
            window.dialog("ctrl+s", f"{folder}/session.json")
            window.until("no dialog", lambda s: s["field"] is None)
            assert json.loads(pathlib.Path(folder, "session.json").read_text())["instrument"] == saved["instrument"]
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
            window.fill(moved / "ct.nii")
            window.next_field()
            window.fill(moved / "nowhere.stl")
            window.press("Return")
            window.until("the question for what is still missing",
                         lambda s: s["question"] and [file["name"] for file in s["question"]["files"]] == ["mesh"]
                         and s["field"] is not None)
            window.fill(moved / "tool.stl")
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
        with Window(program, server, folder, [*SCENE, "--method", "compute", "--poses", poses(folder, 60)],
                    faults) as window:
            first = window.until("the first answer", lambda s: s["settled"])
            assert first["method"] == "compute", first
            lose(window, "surface")
            # The frame that fails may be the one before the key is seen.
            state = window.until("a new surface", lambda s: "surface" in s["status"] and s["pose"][HEIGHT] == 59
                                 and s["settled"])
            assert state["method"] == "compute", state
            window.press("x")
            window.until("a hole", lambda s: s["holes"] == 1 and s["settled"])
            lose(window, "lost")
            window.until("the question", lambda s: s["question"])
            window.press("Return")
            state = window.until("the host's answer", lambda s: s["settled"] and s["method"] == "cpu")
            height = state["pose"][HEIGHT]
            assert height in (58, 59) and state["points"] == first["points"] and state["holes"] == 1, state
            window.press("ctrl+z", "ctrl+z")
            window.press("Next")
            window.until("the next answer", lambda s: s["pose"][HEIGHT] == height - 1 and s["settled"])
            window.press("ctrl+q")
            window.end()
        # While all methods are compared, which may be the first to hear of it.
        with Window(program, server, folder, [*SCENE, "--method", "compute", "--poses", poses(folder, 60)],
                    faults) as window:
            window.until("the first answer", lambda s: s["settled"])
            window.press("k")
            window.until("the first counts", lambda s: any(one["touch"] is not None for one in s["methods"] or []))
            lose(window, "lost")
            window.until("the question", lambda s: s["question"])
            window.press("Return")
            state = window.until("the host's answer", lambda s: s["settled"] and s["method"] == "cpu")
            assert state["pose"][HEIGHT] in (59, 60) and state["touch"] == 1, state
            state = window.until("the counts again", counted)
            assert not any(one["refused"] for one in state["methods"]), state["methods"]
            window.press("ctrl+q")
            window.end()
        # The same again before the question is answered: it ends, and what was shown is kept.
        with Window(program, server, folder, [*SCENE, "--method", "compute", "--poses", poses(folder, 60)],
                    faults) as window:
            window.until("the first answer", lambda s: s["settled"])
            lose(window, "lost")
            fault.write_text("lost")
            window.process.wait(timeout=PATIENCE)
            said = window.process.stderr.read()
            assert window.process.returncode == 1 and "rescued-session.json" in said, said
        kept = json.loads(pathlib.Path(server.kept.name, "voxtact", "rescued-session.json").read_text())
        assert kept["instrument"]["pose"][HEIGHT] in (59, 60), kept


def refused(program, status, text, arguments, environment):
    ran = subprocess.run([program, "view", *arguments], env=environment, capture_output=True, text=True,
                         timeout=PATIENCE)
    lines = ran.stderr.splitlines()
    if ran.returncode != status or len(lines) != 1 or text not in lines[0] or ran.stdout:
        fail(f"{arguments}: status {ran.returncode} and {ran.stderr!r}, not {status} and a line with {text!r}")


def refusals(program, folder):
    without = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    refused(program, 1, "no display for a window", [*SCENE], without)
    session = pathlib.Path(folder) / "session.json"
    session.write_text('{"voxtact_session": 1, "volume": "builtin:head:18", "mesh": "builtin:scalpel:300"}')
    refused(program, 1, "transfer_function: ", ["--session", str(session)], without)
    refused(program, 2, "--session", ["--session", str(session), "--opacity-threshold", "0.2"], without)
    refused(program, 2, "--volume: the window shows only one", ["--volume", "builtin:head", "--volume", "builtin:ct"],
            without)
    named = make(program, folder, "volume", "builtin:ct:16", "named.nii")
    session.write_text(json.dumps({"voxtact_session": 1, "volume": "named.nii", "mesh": "builtin:scalpel:300",
                                   "transfer_function": {"points": [[0, 0], [1, 1]]}}))
    for output in (session, named):
        before = pathlib.Path(output).read_bytes()
        refused(program, 2, f"'{output}' is the file that --session reads",
                ["--session", str(session), "--report-state", str(output)], without)
        assert pathlib.Path(output).read_bytes() == before, output
    refused(program, 2, "'-' is not a file", [*SCENE, "--report-state", "-"], without)
    refused(program, 2, "a window needs 640x480 to", [*SCENE, "--size", "640x470"], without)
    refused(program, 2, "--method query", ["--method", "query", "--projection", "certified"], without)
    refused(program, 1, "nowhere.nii", ["--labels", "nowhere.nii"], without)
    refused(program, 2, "--label-names: it needs a label map", ["--label-names", "nowhere.txt"], without)
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


if __name__ == "__main__":
    CHECKS = {"files": files, "loading": loading, "coarser": coarser, "session": session, "notes": notes,
              "lost": lost, "refusals": refusals}
    sys.exit(main(sys.argv[1:], CHECKS, __doc__))
