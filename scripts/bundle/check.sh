#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Whether a bundle has all that it needs: no library is missing, and no path leads out of it.
# Usage: check.sh FOLDER
set -euo pipefail
folder=$(cd "${1:?usage: check.sh FOLDER}" && pwd)
wrong=0
complain() {
    printf 'bundle: %s\n' "$*" >&2
    wrong=1
}

# shellcheck source=scripts/bundle/libraries.sh
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/libraries.sh"

files=0
while IFS= read -r file; do
    dynamic=$(readelf -dW "$file" 2>/dev/null) || continue
    case $dynamic in *'Dynamic section'*) ;; *) continue ;; esac
    files=$((files + 1))
    short=${file#"$folder"/}
    while IFS= read -r path; do
        IFS=: read -ra entries <<<"$path:"
        for entry in "${entries[@]}"; do
            case $entry in
            "\$ORIGIN" | "\$ORIGIN/"*) ;;
            *) complain "$short looks for libraries in '$entry'; \$ORIGIN is what a bundle may name" ;;
            esac
        done
    done < <(sed -n 's/.*(R\(UN\)\?PATH).*\[\(.*\)\]$/\2/p' <<<"$dynamic")
    while IFS= read -r needed; do
        case $needed in
        */*) complain "$short needs '$needed', by its path" ;;
        esac
        [[ $needed =~ $of_the_system || -e $folder/lib/$needed || -e $folder/lib/base/$needed ]] ||
            complain "$short needs $needed, which is not there"
    done < <(sed -n 's/.*(NEEDED).*\[\(.*\)\]$/\1/p' <<<"$dynamic")
done < <(find "$folder" -type f | sort)
[ "$files" -gt 0 ] || complain "no program is in $folder"

while IFS= read -r link; do
    case $(readlink "$link") in /*) complain "${link#"$folder"/} is a link to an absolute path" ;; esac
done < <(find "$folder" -type l)
while IFS= read -r manifest; do
    library=$(sed -n 's/.*"library_path": *"\([^"]*\)".*/\1/p' "$manifest")
    case $library in
    ../*) [ -e "${manifest%/*}/$library" ] || complain "${manifest#"$folder"/} names $library, which is not there" ;;
    *) complain "${manifest#"$folder"/} names '$library'; a path that begins with .. is what a bundle may name" ;;
    esac
done < <(find "$folder/share/vulkan" -name '*.json' 2>/dev/null)
[ -s "$folder/share/licences/voxtact.txt" ] || complain "share/licences/voxtact.txt is not there"
exit "$wrong"
