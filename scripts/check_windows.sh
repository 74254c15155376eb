#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The libraries that need no other than Vulkan's headers and glm (voxtact::voxtact, voxtact::render, voxtact::samples)
# compile and link for Windows, as DLLs that export what the headers declare. Nothing of it is run.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."
folder=build/windows
headers=$PWD/$folder/headers

# This system's own headers are not for Windows, but these two are for every system.
mkdir -p "$headers"
for name in vulkan vk_video glm; do
    ln -sfn "/usr/include/$name" "$headers/$name"
done
cat >"$headers/glmConfig.cmake" <<'END'
add_library(glm::glm INTERFACE IMPORTED)
set_target_properties(glm::glm PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_CURRENT_LIST_DIR}")
END

[ -f "$folder/build.ninja" ] || cmake -S . -B "$folder" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/mingw-w64.cmake" \
    -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON -DVOXTACT_BUILD_CPU=OFF -DVOXTACT_BUILD_IO=OFF \
    -DVOXTACT_VULKAN_INCLUDE_DIR="$headers" -Dglm_DIR="$headers" >"$folder/configure.log" 2>&1 || {
    cat "$folder/configure.log" >&2
    exit 1
}
cmake --build "$folder" >"$folder/build.log" 2>&1 || {
    grep -m 20 -E 'error|undefined' "$folder/build.log" >&2 || tail -n 20 "$folder/build.log" >&2
    exit 1
}
for name in voxtact voxtact_render voxtact_samples; do
    library=$(find "$folder" -name "lib$name*.dll" -print -quit)
    [ -n "$library" ] || {
        printf 'check_windows: there is no DLL of %s\n' "$name" >&2
        exit 1
    }
    # Where nothing says what is exported, all is.
    strange=$(x86_64-w64-mingw32-objdump -p "$library" | sed -n '/Ordinal\/Name/,$s/^\t\[ *[0-9]*\] //p' |
        grep -v '^_ZNK\?7voxtact\|^_ZTV\?[IS]\?N\?7voxtact' | head -n 5 || true)
    [ -z "$strange" ] || {
        printf 'check_windows: %s exports what is not of voxtact:\n%s\n' "$library" "$strange" >&2
        exit 1
    }
done
printf 'windows: compiles\n'
