# SPDX-License-Identifier: MIT
# %% [markdown]
# # Which regions does it touch? 100,000 random poses
#
# A small probe at random places in a head, and how often each structure of a label map is touched. With Debian's
# mricron-data these are the regions of an atlas; else the tissues of a builtin head.
#
# `regions.py 5000` takes fewer poses.

# %%
import pathlib
import sys
import time

import numpy as np

import voxtact as vx

number = int(sys.argv[1]) if len(sys.argv) > 1 and sys.argv[1].isdigit() else 100_000
ATLAS = pathlib.Path("/usr/share/mricron/templates")
if (ATLAS / "aal.nii.gz").exists():
    labels = vx.read_labels(ATLAS / "aal.nii.gz", names=ATLAS / "aal.nii.txt")
    scene = vx.Scene(ATLAS / "ch2.nii.gz", opacity=[(40, 0), (80, 1)], labels=labels)
else:
    labels = vx.read_labels("builtin:head:64", names={90: "skin", 120: "brain"})
    scene = vx.Scene("builtin:head:64", opacity=[(40, 0), (80, 1)], labels=labels)
print(scene, labels)

# %%
ball = vx.read_mesh("builtin:ellipsoid:320")
probe = vx.read_mesh((ball.vertices * (3 / 40), ball.faces))  # half axes of 1.5, 2.3 and 3 mm
generator = np.random.default_rng(1)
size = np.array(scene.volume.shape[::-1])
places = scene.volume.world_from_index @ np.vstack([generator.uniform(0, size[:, None] - 1, (3, number)), np.ones(number)])
poses = np.tile(np.eye(4), (number, 1, 1))
poses[:, :3, 3] = places[:3].T

# %%
progress = None
if sys.stderr.isatty():
    from tqdm import tqdm as progress
begin = time.perf_counter()
answer = scene.count(probe, poses, labels=True, progress=progress)
seconds = time.perf_counter() - begin
print(f"{answer}: {number / seconds:,.0f} poses per second")

# %% [markdown]
# A row of `answer.labels` says how many fragments of a pose are in a label. So poses per label are rows per label.

# %%
values, poses_of_label = np.unique(answer.labels["label"][answer.labels["label"] != 0], return_counts=True)
order = np.argsort(-poses_of_label)
for label, touching in zip(values[order][:12], poses_of_label[order]):
    name = labels.names.get(int(label), f"label {label}")
    print(f"{name:20} {100 * touching / number:6.2f} %  {'#' * int(60 * touching / poses_of_label.max())}")
assert answer.touches.sum() == len(np.unique(answer.labels["pair"]))
