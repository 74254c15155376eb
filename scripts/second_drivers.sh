#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Second opinions: the tests of agreement on other software drivers than the one that is installed, which are fetched
# through apt and unpacked into build/drivers, not installed: lavapipe of a newer Mesa, from Debian 12's backports, and
# SwiftShader, from Debian's package of Chromium.
# SwiftShader promises no rounding to nearest, and so there is no `certified` on it.
# Usage: second_drivers.sh TESTS [FILTER]   (TESTS: the program voxtact_gpu_tests; FILTER: GoogleTest's, for both)
# Exit status: 0 all pass; 1 something failed on one of them; 77 nothing could be fetched.
set -uo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." || exit 1
tests=${1:?usage: second_drivers.sh TESTS [FILTER]}
asked=${2:-}
of_mesa=(ArithmeticTest.\* MethodsTest.\* AgreementTest.\* HostAgreementTest.\* CertifiedTest.\* AnalyticTest.\*
    ProjectionsTest.\* RandomPosesTest.\* EditTest.\* ValueTest.\* TableUpdateTest.\*)
of_swiftshader=(AgreementTest.\*-\*.ItemsOfOneBatchKeepTheirNames:\*.QueriesCountRightInLongSubmissions
    ArithmeticTest.\* ValueTest.\* EditTest.\* TableUpdateTest.\* AnalyticTest.\*)
drivers=build/drivers
mkdir -p "$drivers"

# fetch PACKAGE SUITE FOLDER: unpacks a package of a suite of the Debian that this machine's apt knows, once.
fetch() {
    local package=$1 suite=$2 folder=$drivers/$3 mirror apt
    [ ! -e "$folder/.done" ] || return 0
    mirror=$(apt-get indextargets --format "\$(REPO_URI) \$(RELEASE)" 'Created-By: Packages' |
        awk '$2 == "bookworm" { print $1; exit }')
    [ -n "$mirror" ] || return 1
    rm -rf "$folder" && mkdir -p "$folder/apt/lists/partial" "$folder/apt/archives/partial" || return 1
    apt=(-o "Dir::Etc::SourceList=$PWD/$folder/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null
        -o "Dir::State::Lists=$PWD/$folder/apt/lists" -o "Dir::Cache=$PWD/$folder/apt")
    if [ "$suite" = installed ]; then
        apt=()
    else
        printf 'deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] %s %s main\n' "$mirror" "$suite" \
            >"$folder/apt/sources.list"
        apt-get "${apt[@]}" -qq update || return 1
    fi
    (cd "$folder" && apt-get "${apt[@]}" -qq download "$package" && dpkg -x "$package"_*.deb . && rm -f ./*.deb) || return 1
    rm -rf "$folder/apt"
    touch "$folder/.done"
}

# manifest FOLDER LIBRARY: a driver's file for the loader.
manifest() {
    local library
    library=$(find "$PWD/$drivers/$1" -name "$2" -type f -print -quit)
    [ -n "$library" ] || return 1
    printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "%s", "api_version": "1.3.0"}}\n' "$library" \
        >"$drivers/$1.json"
}

ran=0
failed=()
# opinion FOLDER FILTER...: each in a process of its own.
opinion() {
    local filter name=$1 report
    shift
    [ -z "$asked" ] || set -- "$asked"
    for filter in "$@"; do
        report=$drivers/$name-${filter%%.*}.log
        if VK_DRIVER_FILES=$PWD/$drivers/$name.json timeout -k 5 1200 "$tests" --require-device --gtest_brief=1 \
            "--gtest_filter=$filter" >"$report" 2>&1; then
            printf '%-12s %-20s passed\n' "$name" "${filter%%.*}"
        else
            printf '%-12s %-20s FAILED with %d: %s\n' "$name" "${filter%%.*}" $? "$report"
            failed+=("$name/${filter%%.*}")
        fi
    done
    ran=$((ran + 1))
}

if fetch mesa-vulkan-drivers bookworm-backports mesa && manifest mesa 'libvulkan_lvp.so'; then
    opinion mesa "${of_mesa[@]}"
else
    printf '%s\n' "second_drivers: the newer Mesa could not be fetched" >&2
fi
if fetch chromium-common installed swiftshader && manifest swiftshader 'libvk_swiftshader.so'; then
    opinion swiftshader "${of_swiftshader[@]}"
else
    printf '%s\n' "second_drivers: SwiftShader could not be fetched" >&2
fi
[ $ran -gt 0 ] || exit 77
printf 'second_drivers: %d of 2 drivers were asked\n' "$ran"
if [ ${#failed[@]} -gt 0 ]; then
    printf 'second_drivers: failed: %s\n' "${failed[*]}" >&2
    exit 1
fi
