# SPDX-License-Identifier: MIT
# Read by the launchers, which have set `here`: finds out whether the system's own C++ runtime will do.
# shellcheck shell=sh disable=SC2154
voxtact_starts() {
    "$here/libexec/voxtact" --version >/dev/null 2>&1
}
if ! voxtact_starts; then
    LD_LIBRARY_PATH=$here/lib/base${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
    export LD_LIBRARY_PATH
    if ! voxtact_starts; then
        printf '%s\n' "voxtact: this bundle does not run here: $("$here/libexec/voxtact" --version 2>&1 | head -n 1);" \
            "README.txt says what it needs" >&2
        exit 1
    fi
fi
