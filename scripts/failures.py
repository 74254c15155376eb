#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Says of each test that failed why, from the JUnit file that ctest wrote: what a reader of the end of a long log needs.

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
        parts += now
    return parts or output[-MOST_LINES:]


def main(path):
    failed = [case for case in xml.etree.ElementTree.parse(path).iter("testcase") if case.get("status") == "fail"]
    for case in failed[:MOST_ENTRIES]:
        failure = case.find("failure")
        print(f"\n== {case.get('name')}: {'' if failure is None else failure.get('message', '')}")
        lines = failed_parts((case.findtext("system-out") or "").splitlines())
        for line in lines[:MOST_LINES]:
            print(f"   {line[:400]}")
        if len(lines) > MOST_LINES:
            print(f"   ({len(lines) - MOST_LINES} lines more)")
    if len(failed) > MOST_ENTRIES:
        print(f"\n({len(failed) - MOST_ENTRIES} more failed)")


if __name__ == "__main__":
    main(sys.argv[1])
