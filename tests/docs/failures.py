# SPDX-License-Identifier: MIT
"""What ./run test prints at its end of the tests that failed (scripts/failures.py)."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def said_of(*cases, more=""):
    """Each: its name, whether it failed, what it printed. `more` test cases as XML."""
    text = "".join(
        f'<testcase name="{name}" time="2.5" status="{"fail" if failed else "run"}">'
        + ('<failure message=""/>' if failed else "")
        + f"<system-out>{out}</system-out></testcase>"
        for name, failed, out in cases
    )
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "tests.xml")
        path.write_text(f"<testsuite>{text}{more}</testsuite>", encoding="utf-8")
        ran = subprocess.run(
            [sys.executable, ROOT / "scripts/failures.py", path], capture_output=True, text=True, check=True
        )
    return ran.stdout


GOOD = "[ RUN      ] A.Good\ngood\n[       OK ] A.Good (2 ms)\n"
BAD = "[ RUN      ] A.Bad\nVOXTACT_TEST_SEED=7\na.cpp:3: Failure\n[  FAILED  ] A.Bad (5 ms)\n"


class Failures(unittest.TestCase):
    def test_says_what_failed_tests_print(self):
        said = said_of(("one", False, "[ RUN      ] B.Fine\n"), ("two", True, GOOD + BAD + GOOD + "\n1 FAILED TEST\n"))
        for text in ("== two: failed after 2.5 s", "VOXTACT_TEST_SEED=7", "a.cpp:3: Failure"):
            self.assertIn(text, said)
        for text in ("one", "good", "1 FAILED TEST"):
            self.assertNotIn(text, said)

    def test_says_where_a_program_ended_early(self):
        many = "".join(f"line {i}\n" for i in range(200))
        said = said_of(("two", True, GOOD + "[ RUN      ] A.Crash\n" + many + "the last words\n"))
        self.assertIn("A.Crash", said)
        self.assertIn("the last words", said)
        self.assertNotIn("good", said)

    def test_says_how_a_long_test_failed(self):
        many = "".join(f"line {i}\n" for i in range(200))
        said = said_of(("two", True, BAD.replace("a.cpp", many + "a.cpp")))
        for text in ("VOXTACT_TEST_SEED=7", "a.cpp:3: Failure", "lines are left out"):
            self.assertIn(text, said)

    def test_says_what_was_not_run(self):
        def not_run(name, why):
            return f'<testcase name="{name}" status="notrun"><skipped message="{why}"/></testcase>'

        said = said_of(more=not_run("gone", "Unable to find executable") + not_run("skipped", "SKIP_RETURN_CODE=77"))
        self.assertIn("== gone: not run: Unable to find executable", said)
        self.assertNotIn("skipped", said)

    def test_says_the_end_of_what_others_print(self):
        said = said_of(("two", True, "\n".join(f"line {i}" for i in range(200))))
        self.assertIn("line 199", said)
        self.assertNotIn("line 100", said)

    def test_ends_somewhere(self):
        long = BAD.replace("a.cpp", "a.cpp: Failure\n" * 500)
        said = said_of(*((f"case {i}", True, long) for i in range(30)))
        self.assertLess(len(said.splitlines()), 600)
        self.assertIn("more failed", said)


if __name__ == "__main__":
    unittest.main()
