# SPDX-License-Identifier: MIT
# %% [markdown]
# # Contacts for 3D Slicer and ParaView
#
# The contacts of a pose as points that ParaView shows (`contacts.vtp`), and the oriented box around them as a region of
# interest in Slicer's markups (`contacts.mrk.json`). Both are LPS, millimetres, as voxtact has them.

# %%
import base64
import json

import numpy as np

import voxtact as vx

scene = vx.Scene("builtin:head:128", opacity=[(40, 0), (80, 1)])
knife = vx.read_mesh("builtin:scalpel")
pose = np.array([[0.8, 0, 0.6, 20], [0, 1, 0, -5], [-0.6, 0, 0.8, 45], [0, 0, 0, 1.0]])
contacts = scene.count(knife, pose, contacts=True).contacts
print(f"{len(contacts)} contacts")

# %% [markdown]
# The box: the axes in which the contacts vary most and least, and how far they reach along each.


# %%
def oriented_box(points):
    """Centre, axes as columns (right-handed), and lengths."""
    _, axes = np.linalg.eigh(np.cov(points.T))
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    along = points @ axes
    lo, hi = along.min(axis=0), along.max(axis=0)
    return axes @ ((lo + hi) / 2), axes, hi - lo


def write_markups(path, points, centre, axes, lengths):
    fiducials = [{"id": str(number + 1), "label": f"contact {number}", "position": point.tolist(),
                  "positionStatus": "defined"} for number, point in enumerate(points)]
    markups = [
        {"type": "Fiducial", "coordinateSystem": "LPS", "coordinateUnits": "mm", "controlPoints": fiducials},
        {"type": "ROI", "coordinateSystem": "LPS", "coordinateUnits": "mm", "roiType": "Box", "center": centre.tolist(),
         "orientation": axes.ravel().tolist(), "size": lengths.tolist(), "insideOut": False,
         "controlPoints": [{"id": "1", "position": centre.tolist(), "positionStatus": "defined"}]},
    ]
    schema = ("https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
              "markups-schema-v1.0.3.json#")
    with open(path, "w") as file:
        json.dump({"@schema": schema, "markups": markups}, file, indent=1)


def write_points(path, contacts):
    """VTK's XML: base64 of a length in bytes, and of the numbers."""
    types = {"f8": "Float64", "i8": "Int64", "i4": "Int32"}

    def array(name, numbers):
        numbers = np.ascontiguousarray(numbers)
        content = np.uint64(numbers.nbytes).tobytes() + numbers.tobytes()
        columns = numbers.shape[1] if numbers.ndim == 2 else 1
        return (f'<DataArray type="{types[numbers.dtype.str[1:]]}" Name="{name}" NumberOfComponents="{columns}" '
                f'format="binary">{base64.b64encode(content).decode()}</DataArray>')

    count = len(contacts)
    data = "".join(array(name, contacts[name]) for name in ("normal", "depth", "value", "opacity", "label"))
    data += array("triangle", contacts["triangle"].astype(np.int64))
    with open(path, "w") as file:
        file.write('<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>'
                   f'<Piece NumberOfPoints="{count}" NumberOfVerts="{count}" NumberOfLines="0" NumberOfStrips="0" '
                   f'NumberOfPolys="0"><PointData Normals="normal">{data}</PointData>'
                   f'<Points>{array("Points", contacts["position"])}</Points>'
                   f'<Verts>{array("connectivity", np.arange(count))}{array("offsets", np.arange(1, count + 1))}</Verts>'
                   "</Piece></PolyData></VTKFile>")


# %%
centre, axes, lengths = oriented_box(contacts["position"])
print(f"a box of {' x '.join(f'{length:.1f}' for length in lengths)} mm around {centre.round(1).tolist()}")
write_markups("contacts.mrk.json", contacts["position"][::50], centre, axes, lengths)
write_points("contacts.vtp", contacts)
assert (np.abs((contacts["position"] - centre) @ axes) <= lengths / 2 + 1e-6).all()
