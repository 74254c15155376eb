# SPDX-License-Identifier: MIT
"""voxtact: does this mesh, at this pose, touch what is visible of this volume? How much of it, where, and how near?

    import voxtact as vx

    head = vx.read_volume("ch2.nii.gz")            # or an array with affine=, or an image of nibabel, SimpleITK, VTK
    knife = vx.read_mesh("tool.stl")               # or (vertices, faces), or a mesh of trimesh, meshio, VTK
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], threshold=0.1)

    answer = scene.detect(knife, poses)            # (N,4,4), world_from_object
    answer.hit, answer.count, answer.triangles, answer.contacts
    scene.clearance(knife, poses).lo               # mm
    scene.area(knife, poses).lo                    # mm^2
    scene.motion(knife, poses).free_until          # on the way from pose to pose
    scene.opacity = [(100, 0), (200, 1)]           # the next answer has seen it
    scene.edit(ball=(x, y, z, r), value=-1000)     # so it has this

A sample of the volume is opaque where its opacity reaches the threshold. The default answer is certified: *no* means no
contact, *yes* comes with a point that proves it, and the rare pair that rounding leaves open is `possible`. No GPU is
needed; ``device=True`` takes a Vulkan one.

Arrays of voxels are indexed [z, y, x]; points, spacings and voxel numbers are x, y, z. The world is LPS (+x left, +y
posterior, +z superior), in millimetres. Matrices are written row by row and multiply columns.

Everything that is refused raises a `voxtact.Error`, which says what, why and what to do; a thing of another kind than
the argument is, such as a text for a number, a TypeError.
"""
from ._answer import Answer, Area, Clearance, Counters
from ._core import __version__
from ._common import LPS_FROM_RAS
from ._device import Device, DeviceInfo, MethodReport, devices
from ._errors import (
    DeviceLostError,
    Error,
    FileError,
    FormatError,
    InternalError,
    InvalidArgumentError,
    LimitExceededError,
    NotReadyError,
    OutOfMemoryError,
    UnsupportedError,
    VulkanError,
)
from ._files import Points, read_camera, read_opacity, read_points, read_poses, write_png
from ._geometry import overlapping_pairs
from ._labels import Labels, read_label_names, read_labels
from ._mesh import Mesh, read_mesh
from ._motion import Motion, pose_between
from ._picture import Look, look, looks, read_colours
from ._plan import Plan
from ._scene import Scene
from ._track import Tracked, Tracker
from ._view import View, view_from
from ._volume import Volume, read_volume

__all__ = [
    "LPS_FROM_RAS",
    "Answer",
    "Area",
    "Clearance",
    "Counters",
    "Device",
    "DeviceInfo",
    "DeviceLostError",
    "Error",
    "FileError",
    "FormatError",
    "InternalError",
    "InvalidArgumentError",
    "Labels",
    "LimitExceededError",
    "Look",
    "Mesh",
    "MethodReport",
    "Motion",
    "NotReadyError",
    "OutOfMemoryError",
    "Plan",
    "Points",
    "Scene",
    "Tracked",
    "Tracker",
    "UnsupportedError",
    "View",
    "Volume",
    "VulkanError",
    "__version__",
    "devices",
    "look",
    "looks",
    "overlapping_pairs",
    "pose_between",
    "read_camera",
    "read_colours",
    "read_label_names",
    "read_labels",
    "read_mesh",
    "read_opacity",
    "read_points",
    "read_poses",
    "read_volume",
    "view_from",
    "write_png",
]

# Where its users have them from.
for _name in __all__:
    if isinstance(globals()[_name], type) or callable(globals()[_name]):
        globals()[_name].__module__ = "voxtact"
del _name
