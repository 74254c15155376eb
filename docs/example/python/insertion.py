# SPDX-License-Identifier: MIT
# %% [markdown]
# # Depth along an insertion, against the certified answer
#
# A needle goes into a head, 0.25 mm at a time. What sampling its vertices in the image says is plotted beside what is
# certain: whether it touches, and how much is left before it does.

# %%
import numpy as np

import voxtact as vx

head = vx.read_volume("builtin:head:128")
scene = vx.Scene(head, opacity=[(40, 0), (80, 1)])


def needle(length=80.0, radius=0.6, sides=12):
    """A cone whose tip is at the origin, along +z: long thin triangles, as CAD makes them."""
    angle = np.arange(sides) * 2 * np.pi / sides
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(sides, length)], axis=1)
    around = np.arange(sides)
    sides_of_cone = np.stack([np.zeros(sides, int), 2 + (around + 1) % sides, 2 + around], axis=1)
    lid = np.stack([np.ones(sides, int), 2 + around, 2 + (around + 1) % sides], axis=1)
    return vx.read_mesh((np.concatenate([[[0, 0, 0], [0, 0, length]], ring]), np.concatenate([sides_of_cone, lid])))


mesh = needle()
# From above, aslant.
turn = np.array([[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]])
way = np.arange(0, 60, 0.25)
poses = np.tile(np.eye(4), (len(way), 1, 1))
poses[:, :3, :3] = turn
poses[:, :3, 3] = np.array([60, 55, 90]) - way[:, None] * turn[:, 2]

# %%
answer = scene.count(mesh, poses, contacts=True)
left = scene.distance(mesh, poses)
depth = np.zeros(len(way))
np.maximum.at(depth, answer.contacts["pair"], answer.contacts["depth"])

# %% [markdown]
# The usual way: look up the nearest voxel of each vertex.

# %%
index_from_world = np.linalg.inv(head.world_from_index)
sampled = []
for pose in poses:
    world = pose[:3, :3] @ mesh.vertices.T + pose[:3, 3:]
    x, y, z = np.rint(index_from_world[:3, :3] @ world + index_from_world[:3, 3:]).astype(int)
    inside = ((0 <= x) & (x < head.shape[2]) & (0 <= y) & (y < head.shape[1]) & (0 <= z) & (z < head.shape[0]))
    sampled.append((head.array[z[inside], y[inside], x[inside]] >= 44).any())
sampled = np.array(sampled)
print(f"certain from {way[np.argmax(answer.touches)]:.2f} mm on; the vertices say so from {way[np.argmax(sampled)]:.2f} mm on")
print(f"of {int(answer.touches.sum())} poses that touch, the vertices miss {int((answer.touches & ~sampled).sum())}")
assert answer.touches.any() and (left.lower[answer.touches] == 0).all() and (left.lower[~answer.touches & ~answer.undecided] > 0).all()

# %%
from matplotlib import pyplot

figure, (upper, lower) = pyplot.subplots(2, 1, sharex=True, figsize=(7, 5))
upper.plot(way, depth, label="deepest contact, mm")
upper.fill_between(way, left.lower, left.upper, color="tab:green", alpha=0.5, label="distance, certified bounds, mm")
upper.legend()
lower.step(way, answer.touches, label="touches: certified")
lower.step(way, sampled * 0.96, label="touches: vertices in voxels")
lower.set_xlabel("way, mm")
lower.legend()
figure.savefig("insertion.png", dpi=120)
