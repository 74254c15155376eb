# SPDX-License-Identifier: MIT
"""voxtact: certified collision and distance queries between triangle meshes and CT/MR images.

    import voxtact as vx

    head = vx.read_volume("ch2.nii.gz")            # or an array with affine=, or an image of nibabel, SimpleITK, VTK
    knife = vx.read_mesh("tool.stl")               # or (vertices, faces), or a mesh of trimesh, meshio, VTK
    scene = vx.Scene(head, opacity=[(40, 0), (80, 1)], threshold=0.1)

    scene.touch(knife, poses).touches              # poses: (N,4,4), world_from_object
    scene.touch(knife, poses, margin=2).touches    # is anything opaque within 2 mm?
    found = scene.count(knife, poses)
    found.count, found.triangles, found.contacts
    scene.distance(knife, poses).lower             # mm
    scene.area(knife, poses).lower                 # mm^2
    scene.overlap(knife, poses).lower              # mm^3
    scene.motion(knife, poses).toi_lower           # collision-free from each pose up to this parameter
    scene.ask("area", knife, poses)["pairs"]       # any of questions(), by name; tables
    scene.opacity = [(100, 0), (200, 1)]           # the next query uses the edit
    scene.edit(ball=(x, y, z, r), value=-1000)     # and this one

A sample of the volume is opaque if its opacity reaches the threshold. Answers are certified: no means no contact,
yes is proven by a point, and rounding leaves rare pairs `undecided`. No GPU is needed; ``device=True`` uses a Vulkan
device.

Arrays of voxels are indexed [z, y, x]; points, spacings and voxel indices are x, y, z. The world is LPS (+x left, +y
posterior, +z superior), in millimetres. Matrices are row-major and multiply columns.

Errors raise a `voxtact.Error`, which names the failure, the value and the fix; arguments of a wrong type, such as a
text for a number, raise TypeError.
"""
from ._answer import Answer, Area, Count, Counters, Distance, Overlap, Touch
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
    MissingFileError,
    NotReadyError,
    OutOfMemoryError,
    UnsupportedError,
    VulkanError,
)
from ._files import Points, read_camera, read_opacity, read_points, read_poses, write_png
from ._geometry import overlapping_pairs
from ._labels import Labels, read_label_names, read_labels
from ._library import QuestionInfo, SettingInfo, __version__, questions, settings
from ._mesh import Mesh, read_mesh
from ._motion import Motion, pose_between
from ._picture import Look, View, look, looks, read_colours, view_from
from ._plan import Plan
from ._scene import Scene
from ._track import Tracked, Tracker
from ._volume import Volume, read_volume

__all__ = [
    "LPS_FROM_RAS",
    "Answer",
    "Area",
    "Count",
    "Counters",
    "Device",
    "DeviceInfo",
    "DeviceLostError",
    "Distance",
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
    "MissingFileError",
    "Motion",
    "NotReadyError",
    "OutOfMemoryError",
    "Overlap",
    "Plan",
    "Points",
    "QuestionInfo",
    "Scene",
    "SettingInfo",
    "Touch",
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
    "questions",
    "read_camera",
    "read_colours",
    "read_label_names",
    "read_labels",
    "read_mesh",
    "read_opacity",
    "read_points",
    "read_poses",
    "read_volume",
    "settings",
    "view_from",
    "write_png",
]

# Public names report the package as their module.
for _name in __all__:
    if isinstance(globals()[_name], type) or callable(globals()[_name]):
        globals()[_name].__module__ = "voxtact"
del _name
