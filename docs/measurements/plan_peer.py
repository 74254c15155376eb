#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What people do to find straight paths that keep clear of labels, beside voxtact, in one run.

voxtact    voxtact plan: one row for each entry
distance   a Euclidean distance transform of the voxels with the labels (scipy), sampled trilinearly every STEP mm along
           all that a needle's axis covers on its way, as far as it is in the image; safe is what stays farther than
           margin and radius

usage: plan_peer.py VOXTACT VOLUME LABELS TARGET(x,y,z, LPS) AVOID(1,2,...) MARGIN ENTRIES [STEP] [-- options of plan]

Prints a table. CPU seconds are of the program's or this process' own.
"""

import csv
import os
import resource
import subprocess
import sys
import tempfile
import time

import nibabel
import numpy
import scipy
import scipy.ndimage

RADIUS = 1.0  # mm: builtin:needle is 2 mm thick
LENGTH = 200.0  # mm: and as long


def voxtact(program, volume, labels, target, avoid, margin, entries, more):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "rows.csv")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        begin = time.perf_counter()
        subprocess.run([program, "plan", "--volume", volume, "--labels", labels, f"--target={target}", "--avoid", avoid,
                        "--margin", str(margin), "--entries", str(entries), "--mesh", "builtin:needle", "--timing",
                        "--output", path, "--format", "csv", *more], check=True)
        wall = time.perf_counter() - begin
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        with open(path, newline="") as file:
            lines = file.readlines()
    print("voxtact says", lines[-1].strip())
    return list(csv.DictReader(line for line in lines if not line.startswith("#"))), cpu, wall


def distance(labels, target, avoid, rows, step):
    """The least sampled distance of each path's axis, mm: from behind the tip at the target to the other end at the entry."""
    image = nibabel.load(labels)
    begin = time.process_time()
    wanted = numpy.isin(numpy.asanyarray(image.dataobj), [int(one) for one in avoid.split(",")])
    far = scipy.ndimage.distance_transform_edt(~wanted, sampling=image.header.get_zooms()[:3]).astype(numpy.float32)
    built = time.process_time() - begin
    index = numpy.linalg.inv(numpy.diag([-1, -1, 1, 1]) @ image.affine)  # from LPS
    goal = numpy.array([float(one) for one in target.split(",")])
    last = numpy.array(far.shape) - 1
    begin = time.process_time()
    least = numpy.empty(len(rows))
    for number, row in enumerate(rows):
        entry = numpy.array([float(row["x"]), float(row["y"]), float(row["z"])])
        length = float(row["length"])
        end = length + LENGTH - RADIUS
        count = max(int(numpy.ceil((end - RADIUS) / step)), 1)
        points = goal + numpy.linspace(RADIUS, end, count + 1)[:, None] * ((entry - goal) / length)
        at = points @ index[:3, :3].T + index[:3, 3]
        at = at[numpy.all((at >= 0) & (at <= last), axis=1)]
        least[number] = scipy.ndimage.map_coordinates(far, at.T, order=1).min() if len(at) else numpy.inf
    return least, built, time.process_time() - begin


def main():
    arguments = sys.argv[1:]
    more = arguments[arguments.index("--") + 1:] if "--" in arguments else []
    arguments = arguments[:arguments.index("--")] if "--" in arguments else arguments
    program, volume, labels, target, avoid, margin, entries = arguments[:7]
    step = float(arguments[7]) if len(arguments) > 7 else 0.5
    margin = float(margin)
    rows, cpu, wall = voxtact(program, volume, labels, target, avoid, margin, entries, more)
    least, built, sampled = distance(labels, target, avoid, rows, step)
    verdict = numpy.array([int(row["safe"]) for row in rows])
    says = least - RADIUS > margin
    deepest = [float(row["clearance_hi"]) for row, yes in zip(rows, says) if yes and row["safe"] == "0"]
    print(f"{len(rows)} paths, scipy {scipy.__version__}, a sample every {step} mm")
    print(f"voxtact: {cpu:.1f} s of CPU ({wall:.1f} s wall), safe {numpy.sum(verdict == 1)}, "
          f"unsafe {numpy.sum(verdict == 0)}, possible {numpy.sum(verdict == 2)}")
    print(f"distance transform: {built:.1f} s of CPU to build, {sampled:.1f} s to sample, safe {numpy.sum(says)}; of these "
          f"{numpy.sum(says & (verdict == 0))} are certainly not, the worst has "
          f"{min(deepest, default=float('nan')):.2f} mm; of those it calls unsafe "
          f"{numpy.sum(~says & (verdict == 1))} certainly are safe")


main()
