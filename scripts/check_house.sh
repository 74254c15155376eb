#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The arrows between the parts of the source: what each folder of src/ may include of the others, that public headers
# include only the standard library, vulkan_core.h and each other, and that no part has two types of one name.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

allowed() {
    case "$1" in
    core) echo "core" ;;
    gpu) echo "core gpu" ;;
    detect) echo "core gpu detect" ;;
    render) echo "core gpu render" ;;
    io) echo "core io" ;;
    cpu) echo "core cpu" ;;
    oracle) echo "core oracle" ;;
    device) echo "core gpu detect device" ;;
    samples) echo "core samples" ;;
    lab) echo "core gpu detect render io cpu samples oracle device lab" ;;
    view) echo "core gpu detect render io cpu samples oracle device view" ;;
    c) echo "c" ;;
    python) echo "python" ;;
    app) echo "core gpu detect render io cpu samples oracle device lab view app" ;;
    *) return 1 ;;
    esac
}

parts="core gpu detect render io cpu samples oracle device lab view c python app"
wrong=0
complain() {
    printf '%s\n' "$1" >&2
    wrong=1
}

for folder in src/*/; do
    part=$(basename "$folder")
    if ! may=$(allowed "$part"); then
        complain "$folder: not a part of the house; add its arrows here and in the manual"
        continue
    fi
    while IFS=: read -r file line text; do
        target=$(sed -n 's/.*#include *"\(\.\.\/\)*\([a-z_]*\)\/.*/\2/p' <<<"$text")
        case " $parts " in *" $target "*) ;; *) continue ;; esac
        case " $may " in *" $target "*) ;; *) complain "$file:$line: $part must not include $target" ;; esac
    done < <(grep -rnE '#include *"' "$folder" --include='*.h' --include='*.cpp')
done

# No Vulkan in the parts that promise to do without.
while IFS= read -r hit; do
    complain "$hit: no Vulkan here"
done < <(grep -rnE '#include *[<"](vulkan/|volk)' src/core src/io src/cpu src/samples src/oracle src/view/model 2>/dev/null | cut -d: -f1,2)

while IFS=: read -r file line text; do
    case "$text" in
    *'<stddef.h>' | *'<stdint.h>' | *'<string.h>')
        # C's own, in C's own headers.
        case "$file" in include/voxtact/voxtact*.h) ;; *) complain "$file:$line: a header of C's" ;; esac
        ;;
    *'"voxtact/'* | *'<vulkan/vulkan_core.h>'*) ;;
    *)
        # Standard headers have neither a folder nor an ending.
        grep -qE '#include *<[a-z_0-9]+>' <<<"$text" ||
            complain "$file:$line: public headers include only the standard library, vulkan_core.h and each other"
        ;;
    esac
done < <(grep -rnE '#include' include)

# A name stands for one thing: two types of a part that have one name, in headers that no file includes together, are
# found by no compiler, and by the linker only if they are unlucky.
type_name='^(template <.*> *)?(class|struct|enum class) +([A-Z][A-Za-z0-9]+)( final)?( *:[^:].*)? *\{.*$'
for folder in src/*/; do
    while IFS= read -r name; do
        complain "$folder: two types are called $name"
    done < <(grep -rhE "$type_name" "$folder" --include='*.h' | sed -E "s/$type_name/\3/" | sort | uniq -d)
done

exit "$wrong"
