#!/bin/sh
# SPDX-License-Identifier: MIT
# The program.
here=$(dirname "$(readlink -f "$0")")
. "$here/libexec/environment.sh"
exec "$here/libexec/voxtact" "$@"
