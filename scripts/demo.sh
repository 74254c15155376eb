#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Does a scalpel touch the visible part of a real MR head, how deep, and which regions of the brain? And a picture.
# Usage: demo.sh PROGRAM (a path from the root of the checkout)
# Exit status 3 when the two counting methods disagree.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."
program=${1:?usage: demo.sh PROGRAM}
volume=/usr/share/mricron/templates/ch2.nii.gz
mesh=builtin:scalpel:3068
poses=docs/demo/poses.txt
labels=/usr/share/mricron/templates/aal.nii.gz
contacts=build/demo/contacts.ply
scene=build/demo/scene.png

for file in "$volume" "$labels"; do
    [ -r "$file" ] || {
        printf '%s\n' "./run demo: $file is not there; it comes with Debian's package mricron-data" >&2
        exit 1
    }
done
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

count=("$program" count --volume "$volume" --mesh "$mesh" --poses "$poses" --transfer-function docs/demo/head.tf)
for method in query atomic; do
    "${count[@]}" --method "$method" --timing --batch 1 --format csv --output "$out/$method.csv"
done
"${count[@]}" --method query --format json --output "$out/device.json"
rm -rf "${contacts%/*}"
mkdir -p "${contacts%/*}"
certified=("${count[@]}" --labels "$labels" --label-counts --contacts "$contacts")
"${certified[@]}" --format csv --output "$out/certified.csv"
device=$(sed -n 's/^"device": "\(.*\)",$/\1/p' "$out/device.json")
driver=$(sed -n 's/^"driver": "\(.*\)",$/\1/p' "$out/device.json")

printf '\nDoes a scalpel (%s, 3068 triangles) touch the visible part of an MR head?\n' "$mesh"
printf '  head    %s, visible where its opacity under docs/demo/head.tf reaches 0.1\n' "$volume"
printf '  device  %s; driver %s\n\n' "$device" "$driver"

# The poses' names, then query's rows, then atomic's: one table.
awk '
    BEGIN { poses = method = differ = 0; word[0] = "no"; word[1] = "yes"; word[2] = "undecided" }
    FILENAME ~ /poses.txt$/ {
        if (/^# [a-z]+: /) { name = $2; sub(/:$/, "", name); text = $0; sub(/^# [a-z]+: /, "", text) }
        else if (NF == 16 && $1 !~ /^#/) { names[poses] = name; texts[poses++] = text }
        next
    }
    FNR == 1 { method++; split($0, header, ","); next }
    /^#/ { next }
    {
        split($0, field, ",")
        for (i in header) row[header[i]] = field[i]
        p = row["pose"]; touch[p] = row["touch"]
        count[method, p] = row["count"]; gpu[method, p] = row["gpu_ms"]; wall[method, p] = row["wall_ms"]
    }
    END {
        cells = "%-9s %-5s %9s %9s  %-5s  %15s %15s"
        printf cells "\n", "pose", "touch", "query", "atomic", "agree", "query ms", "atomic ms"
        printf cells "\n", "", "", "fragments", "fragments", "", "GPU / wall", "GPU / wall"
        for (p = 0; p < poses; p++) {
            same = count[1, p] == count[2, p] && count[1, p] != ""
            if (!same) differ = 1
            printf cells "   %s\n", names[p], word[touch[p]], count[1, p], count[2, p], same ? "yes" : "NO",
                sprintf("%.2f / %.2f", gpu[1, p], wall[1, p]), sprintf("%.2f / %.2f", gpu[2, p], wall[2, p]), texts[p]
        }
        exit differ ? 3 : 0
    }' "$poses" "$out/query.csv" "$out/atomic.csv" && status=0 || status=$?

cat <<TEXT

What it says:
  touch      at least one fragment of the scalpel lies in an opaque sample of the head
  fragments  how many do: pixels of a 512x512 view from above, counted by an occlusion query, and by atomicAdd
  agree      the two ways to count give the same number; if not, this command ends with exit status 3
  ms         time on the device, and from recording to the result on the host, each pose submitted alone. The first
             has no warm-up: the driver may compile its shaders in it

The command that was run, once for each method (other poses, volumes and meshes: $program count --help):

  ${count[*]} \\
      --method query --timing --batch 1
TEXT

method=$(awk -F, 'NR == 2 { print $7 }' "$out/certified.csv")
cat <<TEXT

Which regions of the brain does it touch, and how deep? Now certified: every voxel that the scalpel passes through is
decided with bounds on all rounding, so that no contact is missed between the pixels of a view.

TEXT
awk '
    BEGIN {
        poses = 0; word[0] = "no"; word[1] = "yes"; word[2] = "undecided"
        cells = "%-9s %-9s %-16s %s\n"
        printf cells, "pose", "touches", "deepest contact", "brain regions"
    }
    FILENAME ~ /poses.txt$/ {
        if (/^# [a-z]+: /) { name = $2; sub(/:$/, "", name) }
        else if (NF == 16 && $1 !~ /^#/) names[poses++] = name
        next
    }
    FNR == 1 { columns = split($0, header, ","); next }
    {
        split($0, field, ",")
        for (i = 1; i <= columns; i++) row[header[i]] = field[i]
        depth = row["depth"] == "" ? "-" : row["depth"] >= 10 ? "10 mm or more" : sprintf("%.1f mm", row["depth"])
        regions = row["labels"]
        if (regions == "") regions = "-"
        else if (regions ~ /^0:/) regions = "none: not yet in the brain"
        else { gsub(/:/, " (", regions); gsub(/;/, "), ", regions); regions = regions ")" }
        printf cells, names[row["pose"]], word[row["touch"]], depth, regions
    }' "$poses" "$out/certified.csv"

cat <<TEXT

What it says:
  touches          no is certain, and so is yes; undecided: so close that rounding decides
  deepest contact  from a contact along the normal of the tissue to where the head ends; it is followed for 10 mm
  brain regions    of the atlas AAL ($labels), each with its number of contacts

Every contact, with its place in mm, normal, depth and region: $contacts, points coloured by depth
(MeshLab and ParaView open it). The command that was run, with the counting method $method:

  ${certified[*]}
TEXT

# The pose with the most fragments, by query.
pose=$(awk -F, '
    /^#/ { next }
    !columns { columns = split($0, header, ","); next }
    {
        for (i = 1; i <= columns; i++) row[header[i]] = $i
        if (row["count"] + 0 > most) { most = row["count"] + 0; best = row["pose"] }
    }
    END { print best + 0 }' "$out/query.csv")
render=("$program" render --volume "$volume" --preset mr --transfer-function docs/demo/head.tf --mesh "$mesh"
    --poses "$poses" --pose "$pose" --show contacts --azimuth 20 --elevation 40 --background ffffff --size 800x800
    --output "$scene")
"${render[@]}"
cat <<TEXT

A picture of it: $scene. Red is what touches, in the pose that touches most; it shines through the skin.
Where a part of the blade inside the head is not red, the image is dark (bone, fluid), and not opaque. The command:

  ${render[*]}
TEXT

# How much of the blade is in the brain.
overlap=("$program" overlap --volume "$volume" --transfer-function docs/demo/head.tf --mesh "$mesh" --poses "$poses"
    --labels "$labels" --in all --tolerance 10 --format csv)
"${overlap[@]}" --quiet >"$out/overlap.csv"
printf '\n%s\n\n' "How many mm^3 of the blade are in the regions of the brain, in the pose that touches most?"
awk -F, -v best="$pose" '
    NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    $at["pose"] == best && $at["lower"] > 0 {
        printf "  %-24s %8.0f to %.0f\n", $at["label_name"], $at["lower"], $at["upper"]
    }' "$out/overlap.csv"
printf '\n%s\n\n  %s\n' "The command:" "${overlap[*]}"

# Which way in.
plan=("$program" plan --volume "$volume" --transfer-function docs/demo/head.tf --labels "$labels" --target Thalamus_L
    --avoid Insula_L,Hippocampus_L,Caudate_L,Putamen_L --margin 2 --mesh builtin:needle:2:200 --summary
    --surface build/demo/entries.ply --heat-map build/demo/entries.nii.gz --picture build/demo/path.png
    --report build/demo/paths.html --output build/demo/paths.csv --format csv)
"${plan[@]}" 2>"$out/summary" || {
    cat "$out/summary" >&2
    exit 1
}
printf '\n%s\n\n' "Which straight paths of a needle to the left thalamus keep 2 mm from insula, hippocampus, caudate and putamen?"
sed 's/^voxtact: summary: /  /' "$out/summary"
cat <<TEXT

A page with maps and the safest paths: build/demo/paths.html; a picture of the best one: build/demo/path.png; all paths:
build/demo/paths.csv; the entries in colours: build/demo/entries.ply; a map to lay over the head, of how many mm are kept
from each: build/demo/entries.nii.gz. The command:

  ${plan[*]}
TEXT
[ "$status" -eq 0 ] || printf '\n%s\n' "query and atomic disagree" >&2
exit "$status"
