# SPDX-License-Identifier: MIT
"""Everything public with arguments of any kind: never a crash, and always an exception that says what is wrong.

VOXTACT_TEST_SEED chooses the arguments, VOXTACT_TEST_CALLS how many calls there are.
"""
import os
import pathlib
import subprocess
import sys

import pytest

CALLS = int(os.environ.get("VOXTACT_TEST_CALLS", 6000))
SEED = int(os.environ.get("VOXTACT_TEST_SEED", 1))


@pytest.mark.parametrize("which", range(2))
def test_arguments_of_any_kind(tmp_path, which):
    seed = SEED + which
    log, folder = tmp_path / "last_call", tmp_path / "files"
    folder.mkdir()
    child = pathlib.Path(__file__).with_name("fuzz_child.py")
    done = subprocess.run([sys.executable, child, str(seed), str(CALLS // 2), log, folder], capture_output=True, text=True, timeout=600,
                          cwd=folder)
    assert done.returncode == 0, f"seed {seed}\n{done.stdout}\n{done.stderr[-3000:]}\nlast: {log.read_text()}"
    print(f"seed {seed}: {done.stdout}")
    assert "0 bad" in done.stdout
