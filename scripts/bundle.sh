#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes a folder, and a tarball of it, that runs on another Linux of the same architecture: the program, its tests, the
# shared libraries that they need, data of the tests, licences. What stays outside: the C library, the Vulkan loader and
# its drivers.
# Usage: bundle.sh BUILD OUT   (BUILD: a finished build folder; OUT: where the folder and the tarball come to lie)
set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
build=$(cd "${1:?usage: bundle.sh BUILD OUT}" && pwd)
out=${2:?usage: bundle.sh BUILD OUT}
most_bytes=$((64 << 20))

fail() {
    printf 'bundle: %s\n' "$*" >&2
    exit 1
}

for tool in patchelf objdump strip dpkg-query; do
    command -v "$tool" >/dev/null || fail "$tool is missing; third_party/packages-test.txt has its package"
done

# Those that need no file of the checkout and no compiler. The tier io is not here: it compares with ITK.
tests=(unit cpu lab c gpu faults)
layer=libVkLayer_khronos_validation.so
layer_manifest=/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json
head=/usr/share/mricron/templates/ch2.nii.gz
# Packages of which something is compiled in.
compiled_in=(libcli11-dev libglm-dev libgtest-dev libimgui-dev libstb-dev libvulkan-dev libvulkan-volk-dev libxxhash-dev nlohmann-json3-dev
    fonts-dejavu-core)

version=$("$build/voxtact" --version | sed -n '1s/^voxtact \([^ ]*\).*/\1/p')
name=voxtact-$version-$(uname -m)
mkdir -p "$out"
folder=$(cd "$out" && pwd)/$name
rm -rf "$folder"
mkdir -p "$folder"/{libexec,lib/base,share/data,share/licences,share/vulkan/explicit_layer.d}

# -- programs
for program in voxtact voxtact-view voxtact-bench; do
    install -m 755 "$build/$program" "$folder/libexec/"
done
for tier in "${tests[@]}"; do
    program=$build/tests/$tier/voxtact_${tier}_tests
    [ -x "$program" ] || fail "$program is missing; './run bundle' builds it"
    install -m 755 "$program" "$folder/libexec/"
done
install -m 755 "$root/scripts/gpu.sh" "$folder/libexec/gpu.sh"
install -m 644 "$root/scripts/bundle/environment.sh" "$folder/libexec/environment.sh"
for launcher in voxtact gpu tests; do
    install -m 755 "$root/scripts/bundle/$launcher.sh" "$folder/$launcher"
done

# -- libraries: all that the programs load, but the C library's own. Those in lib/base are taken only where the system
# has none or older ones: drivers are loaded into the same process and may need newer ones.
# shellcheck source=scripts/bundle/libraries.sh
. "$root/scripts/bundle/libraries.sh"
of_the_base='^(libstdc\+\+|libgcc_s|libz)\.so'
declare -A packages=()

# owner FILE: the package that a file of the system came with.
owner() {
    local found
    found=$(dpkg-query -S "$1" 2>/dev/null || dpkg-query -S "$(readlink -f "$1")" 2>/dev/null ||
        dpkg-query -S "/usr$1" 2>/dev/null) || return 1
    found=${found%%:*}
    printf '%s\n' "${found%%,*}"
}

# take_library FILE NAME
take_library() {
    local place=lib
    [[ $2 =~ $of_the_base ]] && place=lib/base
    [ -e "$folder/$place/$2" ] || install -m 644 "$(readlink -f "$1")" "$folder/$place/$2"
    local from
    from=$(owner "$1") || fail "$1 came with no package: its licence is not known"
    packages[$from]=1
}

[ -e "$layer_manifest" ] || fail "$layer_manifest is missing; it comes with Debian's package vulkan-validationlayers"
# To the end of the list: a reader that leaves early ends ldconfig by a signal, now and then.
layer_path=$(ldconfig -p | awk -v name="$layer" '$1 == name && !found { print $NF; found = 1 }')
[ -n "$layer_path" ] || fail "$layer is missing; it comes with Debian's package vulkan-validationlayers"
take_library "$layer_path" "$layer"
sed "s|\"library_path\": *\"[^\"]*\"|\"library_path\": \"../../../lib/$layer\"|" "$layer_manifest" \
    >"$folder/share/vulkan/explicit_layer.d/${layer_manifest##*/}"
while read -r library path; do
    [[ $library =~ $of_the_system ]] || take_library "$path" "$library"
done < <(ldd "$folder"/libexec/voxtact* "$layer_path" | awk '$2 == "=>" { print $1, $3 }' | sort -u)

strip --strip-unneeded "$folder"/libexec/voxtact* "$folder"/lib/*.so* "$folder"/lib/base/*.so*
patchelf --set-rpath "\$ORIGIN/../lib" "$folder"/libexec/voxtact*
patchelf --set-rpath "\$ORIGIN" "$folder"/lib/*.so*
patchelf --remove-rpath "$folder"/lib/base/*.so*

# -- data and licences
[ -r "$head" ] || fail "$head is missing; it comes with Debian's package mricron-data"
install -m 644 "$head" "$root/docs/demo/head.tf" "$root/docs/demo/poses.txt" "$folder/share/data/"
packages[$(owner "$head")]=1
for package in "${compiled_in[@]}"; do
    dpkg-query -W "$package" >/dev/null 2>&1 && packages[$package]=1
done
for package in "${!packages[@]}"; do
    [ -r "/usr/share/doc/$package/copyright" ] || fail "/usr/share/doc/$package/copyright is missing"
    cp -L "/usr/share/doc/$package/copyright" "$folder/share/licences/$package.txt"
done
install -m 644 "$root/LICENSE" "$folder/share/licences/voxtact.txt"
# What those files refer to instead of having it in them.
mkdir -p "$folder/share/licences/common"
while IFS= read -r text; do
    [ ! -r "$text" ] || cp -L "$text" "$folder/share/licences/common/"
done < <(grep -rhoE '/usr/share/common-licenses/[A-Za-z0-9.+-]*[A-Za-z0-9]' "$folder/share/licences" | sort -u)

# -- what it needs
# newest_glibc FILE...: the newest version of a symbol of the C library that is used.
newest_glibc() {
    objdump -T "$@" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -n 1 | cut -d_ -f2
}
glibc=$(newest_glibc "$folder"/libexec/voxtact* "$folder"/lib/*.so*)
base_glibc=$(newest_glibc "$folder"/lib/base/*.so*)
sed -e "s/@VERSION@/$version/g" -e "s/@GLIBC@/$glibc/g" -e "s/@BASE_GLIBC@/$base_glibc/g" -e "s/@ARCHITECTURE@/$(uname -m)/g" \
    "$root/scripts/bundle/README.txt" >"$folder/README.txt"

"$root/scripts/bundle/check.sh" "$folder"
tar -C "${folder%/*}" --owner=0 --group=0 --sort=name -czf "$folder.tar.gz" "$name"
bytes=$(stat -c %s "$folder.tar.gz")
[ "$bytes" -lt "$most_bytes" ] || fail "$folder.tar.gz has $bytes bytes, more than $most_bytes"
printf '%s\n' "$folder.tar.gz: $((bytes >> 20)) MiB, needs glibc $glibc"
