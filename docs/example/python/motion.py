# SPDX-License-Identifier: MIT
# %% [markdown]
# # On the way: steering a tool past a head
#
# A planner gives poses. Whether each of them is free says nothing about what is in between; here the ways between them
# are checked, without samples, and then how far the tool may be off.

# %%
import numpy as np

import voxtact as vx

head = vx.read_volume("builtin:head:128")
scene = vx.Scene(head, opacity=[(40, 0), (80, 1)])
knife = vx.read_mesh("builtin:scalpel")


def around(radius, step):
    """Upright poses on a circle round the head, `step` degrees apart, with the cutting edge towards it."""
    angle = np.radians(np.arange(0, 360 + step / 2, step))
    poses = np.tile(np.eye(4), (len(angle), 1, 1))
    poses[:, 0, 0] = poses[:, 1, 1] = np.cos(angle)
    poses[:, 1, 0], poses[:, 0, 1] = np.sin(angle), -np.sin(angle)
    poses[:, 0, 3], poses[:, 1, 3] = radius * np.cos(angle), radius * np.sin(angle)
    poses[:, 2, 3] = -20
    return poses


# %% [markdown]
# Few poses, all of them free, and the straight ways between them cut through the head.

# %%
poses = around(95.0, 60)
at_the_poses = scene.touch(knife, poses).touches
slerp = scene.motion(knife, poses, interpolation="slerp")
screw = scene.motion(knife, poses)
print(f"{int(at_the_poses.sum())} of {len(poses)} poses touch; of {len(slerp)} straight ways {int(slerp.touches.sum())} do, "
      f"of ways that turn about an axis {int(screw.touches.sum())}")
assert slerp.touches.sum() > at_the_poses.sum()

# %% [markdown]
# The first touch on the way, and the pose at which it is; `pose_between` is any pose of it.

# %%
first = int(np.argmax(slerp.touches))
touch = slerp.impacts[first]
print(f"way {first} is free until {slerp.toi_lower[first]:.4f} and touches at {touch['at']:.4f}, "
      f"at {np.round(touch['position'], 2)}")
before = vx.pose_between(poses[first], poses[first + 1], slerp.toi_lower[first], interpolation="slerp", mesh=knife)
print(f"{scene.distance(knife, before).upper[0]:.3f} mm are left at the end of what is free")
assert scene.count(knife, touch["world_from_object"]).touches[0]

# %% [markdown]
# How far may the tracked tool be off, at the poses that are free?

# %%
free = poses[~at_the_poses]
for distance, angle in ((2, 2), (6, 4), (10, 6), (15, 8)):
    answer = scene.touch(knife, free, uncertainty=(distance, angle))
    safe = ~answer.touches & ~answer.undecided
    print(f"off by {distance} mm and {angle} degrees: {int(safe.sum())} of {len(free)} are safe")

# %%
from matplotlib import pyplot

figure, axes = pyplot.subplots(figsize=(7, 3))
slerp.plot(axes)
figure.savefig("motion.png", dpi=120)
