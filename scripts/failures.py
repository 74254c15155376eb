#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Says of each test that failed, or was not run because of another, why, from the JUnit file that ctest wrote: what a
reader of the end of a long log needs.

    failures.py FILE
"""

import re
import sys
import xml.etree.ElementTree

MOST_LINES = 40  # of one entry of ctest
MOST_ENTRIES = 10
# Google Test prints RUN and one of the others about what a test of it prints.
RUN = re.compile(r"\[ RUN      \] ")
END = re.compile(r"\[ *(OK|FAILED|SKIPPED) *\] \S+.* \(\d+ ms\)$")


def failed_parts(output):
    """Of Google Test's output what its failed tests print, or without any, the last lines of all."""
    parts, now = [], []
    for line in output:
        if RUN.match(line):
            now = []
        now.append(line)
        end = END.match(line)
        if end:
            if end[1] == "FAILED":
                parts += now
            now = []
    if now and RUN.match(now[0]):  # it ended in the middle of a test
        parts += now[:1] + now[1:][-MOST_LINES // 2 :]
    return parts or output[-MOST_LINES:]


def without_middle(lines):
    """Where it began, and how it ended."""
    left_out = len(lines) - MOST_LINES
    if left_out <= 0:
        return lines
    half = MOST_LINES // 2
    return [*lines[:half], f"({left_out} lines are left out)", *lines[-half:]]


def reason_of(case):
    """Why it failed, or was not run where that was not meant; None where it is fine."""
    if case.get("status") == "fail":
        return f"failed after {float(case.get('time', 0)):.1f} s"  # which shows a timeout
    if case.get("status") == "notrun":
        skipped = case.find("skipped")
        message = "" if skipped is None else skipped.get("message", "")
        return None if message.startswith("SKIP_") else f"not run: {message}"
    return None


def main(path):
    cases = xml.etree.ElementTree.parse(path).iter("testcase")
    failed = [(case, reason) for case in cases if (reason := reason_of(case)) is not None]
    for case, reason in failed[:MOST_ENTRIES]:
        print(f"\n== {case.get('name')}: {reason}")
        for line in without_middle(failed_parts((case.findtext("system-out") or "").splitlines())):
            print(f"   {line[:400]}")
    if len(failed) > MOST_ENTRIES:
        print(f"\n({len(failed) - MOST_ENTRIES} more failed)")


if __name__ == "__main__":
    main(sys.argv[1])
