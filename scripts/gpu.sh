#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Everything that a GPU should be asked, in eight minutes at most: what it is, whether its arithmetic and its answers are
# the host's, and how fast it is. Each step has its own time limit; one that fails or hangs is reported, and the rest goes
# on. Usage: gpu.sh OUT   (a folder for JSON files; VOXTACT and VOXTACT_GPU_TESTS name the programs, VOXTACT_GPU_LIMIT the
# most seconds of a step)
# Exit status: 0 all steps are done; 1 some are not; 2 unusable arguments.
set -uo pipefail

program=${VOXTACT:?VOXTACT names the program}
tests=${VOXTACT_GPU_TESTS:?VOXTACT_GPU_TESTS names the tests of the device}
if [ $# -ne 1 ] || [[ $1 == -* ]]; then
    printf 'usage: gpu OUT   (a folder, which is made)\n' >&2
    exit 2
fi
out=$1
mkdir -p "$out" || exit 2
if [ -n "$(ls -A "$out")" ]; then
    printf 'gpu: %s is not empty; name a new folder\n' "$out" >&2
    exit 2
fi
log=$out/log.txt
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
begun=$SECONDS
started=$(date -u +%Y-%m-%dT%H:%M:%SZ)
steps=() # JSON objects
# Asked once: where the GPU hangs, its tool may, too.
version=$(timeout -k 2 5 "$program" --version)
machine=""
command -v nvidia-smi >/dev/null && machine=$(timeout -k 2 8 nvidia-smi \
    --query-gpu=name,driver_version,vbios_version,clocks.max.sm,clocks.max.mem,power.limit --format=csv,noheader 2>&1)
failed=0

# quoted TEXT: as a JSON string.
quoted() {
    local text
    text=$(printf '%s' "$1" | tr -d '\000-\010\013-\037' | tr '\t\n' '  ')
    text=${text//\\/\\\\}
    printf '"%s"' "${text//\"/\\\"}" | iconv -c -f UTF-8 -t UTF-8 # a dying driver's last line may be anything
}

# What is known so far; written after every step, so that a machine that dies leaves it.
write_summary() {
    local list devices=null
    list=$(printf ',\n  %s' "${steps[@]}")
    [ -s "$out/devices.json" ] && devices=$(cat "$out/devices.json")
    {
        printf '{\n "voxtact": %s,\n "started": %s,\n "seconds": %d,\n "kernel": %s,\n' \
            "$(quoted "$version")" "$(quoted "$started")" "$((SECONDS - begun))" "$(quoted "$(uname -sr)")"
        printf ' "nvidia_smi": %s,\n "all_done": %s,\n' "$(quoted "$machine")" "$([ $failed -eq 0 ] && echo true || echo false)"
        printf ' "steps": [\n%s\n ],\n "devices": %s\n}\n' "${list:2}" "$devices"
    } >"$work/gpu.json"
    mv "$work/gpu.json" "$out/gpu.json"
}

# How a command ended that ran under timeout.
status_text() {
    case $1 in
    0) echo "done" ;;
    124 | 137) echo "timed out" ;;
    *) if [ "$1" -gt 128 ]; then echo "died of signal $(($1 - 128))"; else echo "failed with exit status $1"; fi ;;
    esac
}

# step NAME FILE LIMIT COMMAND...: a line of progress, its output in the log, its result in FILE.
step() {
    local name=$1 file=$2 limit=$3 from=$SECONDS code said
    shift 3
    [ "$limit" -le "${VOXTACT_GPU_LIMIT:-$limit}" ] || limit=$VOXTACT_GPU_LIMIT
    printf -- '-- %s (at most %d s) ... ' "$name" "$limit"
    printf '\n== %s\n' "$name" >>"$log"
    STEP_SECONDS=$limit timeout -k 3 "$limit" "$@" >"$work/said" 2>&1
    code=$?
    cat "$work/said" >>"$log"
    said=$(grep -v '^[[:space:]]*$' "$work/said" | tail -n 1)
    [ $code -eq 0 ] || failed=1
    printf '%s, %d s\n' "$(status_text $code)" "$((SECONDS - from))"
    [ $code -eq 0 ] || printf '   %s\n' "$said"
    steps+=("{\"name\": $(quoted "$name"), \"status\": $(quoted "$(status_text $code)"), \"seconds\": $((SECONDS - from)), \
\"file\": $([ -s "$out/$file" ] && quoted "$file" || echo null), \"last_line\": $(quoted "$said")}")
    write_summary
}

# suite NAME SECONDS: the status that it ends with, after what it says.
run_suite() {
    local arguments=(--require-device --gtest_brief=1 "--gtest_filter=$1.*:*/$1.*" "--gtest_output=json:$work/suite.json")
    local code
    rm -f "$work/suite.json"
    timeout -k 2 "$2" "$tests" "${arguments[@]}"
    code=$?
    if [ $code -gt 128 ] && [ $code -ne 137 ]; then
        printf '%s: %s; once more without the validation layer\n' "$1" "$(status_text $code)"
        timeout -k 2 "$2" "$tests" --no-validation "${arguments[@]}"
        code=$?
        [ $code -ne 0 ] || code=201
    fi
    # A suite that was renamed has no tests, and they do not fail.
    [ $code -ne 0 ] || ! grep -m 1 '"tests":' "$work/suite.json" | grep -q ': 0,\?$' || code=200
    return $code
}

# suites FILE SUITE...: each in a process of its own with a share of what is left of STEP_SECONDS, so that one that hangs
# or dies does not take the others along. FILE has what is known after each.
suites() {
    local file=$1 end=$((SECONDS + STEP_SECONDS - 8)) suite left share code status bad=0 first=1 result
    shift
    printf '{"suites": [' >"$work/suites.json"
    while [ $# -gt 0 ]; do
        suite=$1
        left=$((end - SECONDS))
        share=$((6 * left / ($# + 5)))
        printf '%s\n' "$suite"
        rm -f "$work/suite.json"
        status="not run"
        if [ $left -gt 0 ]; then
            run_suite "$suite" "$((share > 2 ? share : 2))"
            code=$?
            case $code in
            200) status="has no tests" ;;
            77) status="skipped" ;;
            201) status="done, without the validation layer" ;;
            *) status=$(status_text $code) ;;
            esac
        fi
        if [ "$status" != done ]; then
            bad=1
            printf '%s: %s\n' "$suite" "$status"
        fi
        result=null
        [ ! -s "$work/suite.json" ] || result=$(cat "$work/suite.json")
        [ $first -eq 1 ] || printf ',' >>"$work/suites.json"
        first=0
        printf '\n{"suite": "%s", "status": "%s", "result": %s}' "$suite" "$status" "$result" >>"$work/suites.json"
        { cat "$work/suites.json" && printf ']}\n'; } >"$work/whole.json"
        mv "$work/whole.json" "$out/$file"
        shift
    done
    return $bad
}
# A step is a command of its own, which needs them.
export -f suites run_suite status_text
export work out tests

# The device that the tests and measurements take is the program's default one: the first discrete GPU, a CPU last.
step devices devices.json 40 "$program" devices --format json --output "$out/devices.json"
on_cpu=0
tr -d '\n' <"$out/devices.json" | grep -o '{[^{}]*}' | grep '"default": *1' | grep -q '"type": *"cpu"' && on_cpu=1

agreement=(AgreementTest HostAgreementTest CertifiedTest AnalyticTest ProjectionsTest OutputsTest RandomPosesTest
    EditTest ValueTest TableUpdateTest BricksTest DrillTest LocalizeTest QueuesTest CountersTest RoundsTest DrawSizeTest
    RecordedOutputsTest ProjectionOutputsTest CGpuTest DevicePosesTest StagedTest)
latency=(--time-limit 25)
certified=(--number 256 --repetitions 5)
paper=(--time-limit 40)
batches=(--time-limit 25)
limits=(40 175 40 60 60 40) # with that of the devices, and three seconds for each that must be killed, eight minutes
if [ $on_cpu -eq 1 ]; then
    printf '%s\n' "   no GPU: a driver on the processor is asked less"
    agreement=(AnalyticTest ValueTest EditTest TableUpdateTest BricksTest)
    latency=(--mesh builtin:scalpel:1000 --number 500 --time-limit 6)
    certified=(--mesh builtin:scalpel:1000 --number 16 --repetitions 1)
    paper=(--scale 8 --time-limit 8 --size 128x128 --number 2)
    batches=(--mesh builtin:scalpel:1000 --number 1000 --time-limit 10)
    limits=(85 98 70 60 60 40)
fi

step "gate: arithmetic and counting" gate.json "${limits[0]}" \
    bash -c 'suites "$@"' suites gate.json ArithmeticTest MethodsTest
step "agreement with the host" agreement.json "${limits[1]}" \
    bash -c 'suites "$@"' suites agreement.json "${agreement[@]}"
step "latency of one pair" latency.json "${limits[2]}" \
    "$program" bench --latency "${latency[@]}" --format json --output "$out/latency.json"
step "certified answers" certified.json "${limits[3]}" \
    "$program" bench --certified "${certified[@]}" --format json --output "$out/certified.json"
step "the paper's tables" paper.json "${limits[4]}" \
    "$program" bench --paper --no-sweeps "${paper[@]}" --format json --output "$out/paper.json"
step "batches" batches.json "${limits[5]}" \
    "$program" bench --batches "${batches[@]}" --format json --output "$out/batches.json"

printf '%s\n' "$out/gpu.json has what was done, in $((SECONDS - begun)) s"
exit $failed
