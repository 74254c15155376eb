# SPDX-License-Identifier: MIT
# %% [markdown]
# # A scalpel on a real head, from arrays
#
# The head is an array with a place, the scalpel is vertices and faces: no file has to be written. `ch2.nii.gz` is in
# Debian's package mricron-data; without it a builtin head does.

# %%
import pathlib

import numpy as np

import voxtact as vx

HEAD = pathlib.Path("/usr/share/mricron/templates/ch2.nii.gz")

if HEAD.exists():
    import nibabel

    image = nibabel.load(HEAD)
    # nibabel's arrays are indexed [x, y, z], and its affine takes voxel numbers to RAS.
    head = vx.read_volume(np.asarray(image.dataobj), affine=image.affine, axes="xyz")
else:
    head = vx.read_volume("builtin:head:128")
print(head, *head.notes, sep="\n  ")

# %% [markdown]
# The builtin scalpel is 150 mm long. Its tip is at the origin of its own space, its handle runs along +z.

# %%
builtin = vx.read_mesh("builtin:scalpel")
vertices, faces = np.array(builtin.vertices), np.array(builtin.faces)
knife = vx.read_mesh((vertices, faces))
print(knife)

# %% [markdown]
# What is brighter than 44 is opaque here: opacity reaches the threshold of 0.1 there. The tip is lowered from above
# the head; the world is LPS, millimetres, so +z is up.

# %%
scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], threshold=0.1)
centre = (head.world_from_index @ [*(np.array(head.shape[::-1]) / 2), 1])[:3]
top = centre[2] + head.spacing[2] * head.shape[0] / 2
heights = np.linspace(top, centre[2], 60)
poses = np.tile(np.eye(4), (len(heights), 1, 1))
poses[:, :2, 3] = centre[:2]
poses[:, 2, 3] = heights

answer = scene.count(knife, poses)
print(answer)
first = int(np.argmax(answer.touches))
contacts = answer.contacts[answer.contacts["pair"] == first]
print(f"it first touches with the tip at z = {heights[first]:.2f} mm: {len(contacts)} contacts, "
      f"the deepest {contacts['depth'].max():.3f} mm deep, on triangles {np.unique(contacts['triangle']).tolist()}")
before = scene.distance(knife, poses[first - 1])
print(f"one step before, {before.lower[0]:.3f} to {before.upper[0]:.3f} mm were left")
assert first > 0 and before.lower[0] > 0 and contacts["depth"].max() >= 0
