# SPDX-License-Identifier: MIT
"""The benchmark of overlaps against VTK: a short run, and its failures."""
import signal
import subprocess
import sys
import time

import pytest

from conftest import ROOT

pytest.importorskip("vtk")
sys.path.insert(0, str(ROOT / "tests" / "bench"))
import overlap_vtk  # noqa: E402


def test_two_poses():
    command = [sys.executable, ROOT / "tests" / "bench" / "overlap_vtk.py", "builtin:head:32", "builtin:ellipsoid:500", "40.5",
               "--number", "2"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert "2 poses, overlap" in done.stdout and "voxtact: " in done.stdout
    for name in overlap_vtk.FILTERS:
        assert f"{name}: " in done.stdout
    assert done.stdout.count("0 exception, 0 crash, 0 time limit") == 2 and done.stdout.count("of 2 results") == 2


def spin():
    while True:
        pass


def test_failures_of_a_child(monkeypatch):
    assert overlap_vtk.in_child(60, lambda: {"mm3": 1})["mm3"] == 1
    assert overlap_vtk.in_child(60, signal.raise_signal, signal.SIGKILL) == {"failed": "crash"}
    assert overlap_vtk.in_child(60, int, "x")["failed"] == "exception"
    assert overlap_vtk.in_child(1, spin) == {"failed": "time limit"}
    monkeypatch.setattr(overlap_vtk, "WAIT", 0.1)
    assert overlap_vtk.in_child(1, time.sleep, 60) == {"failed": "time limit"}
