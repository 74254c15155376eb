# SPDX-License-Identifier: MIT
"""What ./run refuses, with exit status 2 and before it does anything."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(*arguments):
    """Of a copy that has nothing beside it: what is not refused fails soon."""
    with tempfile.TemporaryDirectory() as folder:
        script = shutil.copy(ROOT / "run", folder)
        return subprocess.run(["bash", script, *arguments], capture_output=True, text=True, timeout=60, check=False)


class RunArguments(unittest.TestCase):
    def test_what_a_command_does_not_take(self):
        for command in ("demo", "view", "bundle", "wheel", "docs", "figures", "format", "help"):
            for argument in ("extra", "--check"):
                with self.subTest(command=command, argument=argument):
                    ran = run(command, argument)
                    self.assertEqual(ran.returncode, 2, ran.stderr)
                    self.assertEqual(ran.stderr, f"./run: {command} takes no arguments: {argument}\n")

    def test_lint_takes_deep_alone(self):
        for arguments in (["--bogus"], ["--deep", "more"]):
            self.assertEqual(run("lint", *arguments).returncode, 2)

    def test_gpu_takes_a_folder(self):
        for arguments in ([], ["-x"], ["a", "b"], [""]):
            with self.subTest(arguments=arguments):
                ran = run("gpu", *arguments)
                self.assertEqual(ran.returncode, 2, ran.stderr)
                self.assertIn("usage: ./run gpu OUT", ran.stderr)

    def test_unknown_commands(self):
        self.assertEqual(run("nosuch").returncode, 2)

    def test_help_helps(self):
        for arguments in ([], ["help"], ["--help"]):
            ran = run(*arguments)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            self.assertIn("usage: ./run COMMAND", ran.stdout)


if __name__ == "__main__":
    unittest.main()
