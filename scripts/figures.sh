#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Draws the paper's figures 2, 3 and 5 again (Volume-Surface Collision Detection), from builtins that stand for its files.
# Usage: figures.sh PROGRAM FOLDER. The figures of its figure 6 are in the tables of `voxtact bench --paper --report`.
set -euo pipefail
program=$(readlink -f "${1:?usage: figures.sh PROGRAM FOLDER}")
mkdir -p "${2:?usage: figures.sh PROGRAM FOLDER}"
cd "$2"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# A pose at which the mesh touches the volume: the first of some random ones.
touching() {
    local volume=$1 mesh=$2 opacity=$3
    "$program" make poses --volume "$volume" --mesh "$mesh" --number 40 --seed 5 --force --output "$work/poses.txt"
    "$program" count --volume "$volume" --mesh "$mesh" --opacity "$opacity" --poses "$work/poses.txt" --format csv \
        --force --output "$work/answers.csv"
    awk -F, '!/^#/ && $4 == 1 && $5 > most { most = $5; pose = $1 } END { print pose + 0 }' "$work/answers.csv"
}

draw() {
    local picture=$1
    shift
    "$program" render --size 512x512 --no-annotate --force --output "$picture" "$@"
    printf '%s/%s\n' "$PWD" "$picture"
}

# v1 and v2, s1 and s2, with transfer functions that make the skin and the vessels visible.
head=builtin:head:256 vessels=builtin:vessels:256
instrument=builtin:scalpel:3068 body=builtin:ellipsoid:49998
declare -A volumes=([v1]=$head [v2]=$vessels) meshes=([s1]=$instrument [s2]=$body)
declare -A opacities=([v1]="40:0,80:1" [v2]="40:0,80:1")

# Figure 5: the four scenes.
for v in v1 v2; do
    for s in s1 s2; do
        pose=$(touching "${volumes[$v]}" "${meshes[$s]}" "${opacities[$v]}")
        draw "figure-5-$v$s.png" --volume "${volumes[$v]}" --mesh "${meshes[$s]}" --opacity "${opacities[$v]}" \
            --poses "$work/poses.txt" --pose "$pose" --show contacts
        if [ "$v$s" = v1s1 ]; then
            # Figure 2: discarded fragments in blue, the opacity of the others in gray.
            draw figure-2.png --volume "${volumes[$v]}" --mesh "${meshes[$s]}" --opacity "${opacities[$v]}" \
                --poses "$work/poses.txt" --pose "$pose" --show discarded
        fi
    done
done

# Figure 3: a plate in the middle of the head. From the front it is edge-on and covers no pixel, so that nothing
# survives; from the left it is seen whole.
cat >"$work/plate.obj" <<PLATE
v 0 -60 -60
v 0 60 -60
v 0 60 60
v 0 -60 60
f 1 2 3
f 1 3 4
PLATE
for view in front left; do
    draw "figure-3-$view.png" --volume "$head" --mesh "$work/plate.obj" --opacity "40:0,80:1" --view "$view" --show contacts
done
