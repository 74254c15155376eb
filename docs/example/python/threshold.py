# SPDX-License-Identifier: MIT
# %% [markdown]
# # A threshold swept live
#
# Nothing is made of the volume beforehand, so what counts as opaque can change between two answers: here 60 times, as
# a slider would. Each answer is about the new threshold.

# %%
import time

import numpy as np

import voxtact as vx

scene = vx.Scene("builtin:ct:128", opacity=[(0, 0), (1, 1)])
knife = vx.read_mesh("builtin:scalpel")
generator = np.random.default_rng(2)
poses = np.tile(np.eye(4), (64, 1, 1))
poses[:, :3, 3] = generator.uniform(-80, 80, (64, 3))

# %%
values = np.linspace(-900, 1800, 60)
touching, seconds = [], []
for value in values:
    begin = time.perf_counter()
    scene.opacity = [(value - 1, 0), (value + 1, 1)]
    touching.append(int(scene.touch(knife, poses).touches.sum()))
    seconds.append(time.perf_counter() - begin)
for value, hits in list(zip(values, touching))[::6]:
    print(f"opaque from {value:6.0f} HU on: {hits:2} of {len(poses)} poses touch")
print(f"a change and its {len(poses)} answers take {1000 * np.median(seconds):.1f} ms")
assert touching == sorted(touching, reverse=True), "what is opaque only shrinks"
assert touching[0] > touching[-1]

# %% [markdown]
# Carving works the same way: a ball of air, and the next answer has seen it.

# %%
scene.opacity = [(-1, 0), (1, 1)]
pose = poses[int(np.argmax(scene.touch(knife, poses).touches))]
print("before:", scene.count(knife, pose))
for z in np.arange(0, 151, 5.0):  # along the scalpel
    scene.edit(ball=(*(pose @ [0, -3, z, 1])[:3], 30), value=-1000)
print("after: ", scene.count(knife, pose))
assert not scene.count(knife, pose).touches[0]
