# SPDX-License-Identifier: MIT
"""Scenes."""
from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, Literal, NoReturn, Optional, Union
from weakref import WeakSet

import numpy as np
import numpy.typing as npt

from . import _engine as core
from ._answer import Count, Touch
from ._arguments import (
    Method,
    Opacity,
    Poses,
    Progress,
    Projection,
    asked,
    pair,
    pairs_in,
    points,
    told,
    whole,
)
from ._common import array_of, exact_in_float32, listed, not_pickled, number, numbers, whole_number
from ._device import Device, best_device, opened
from ._enclosed import enclosed
from ._errors import Error, InvalidArgumentError
from ._labels import Labels, read_labels
from ._library import lib, standard
from ._measuring import RESOLUTION, Measuring
from ._mesh import Mesh
from ._picture import Clip, Colour, Light, Show, View, picture_options, png
from ._plan import Plan, plan_options
from ._volume import Volume, read_volume


class _OpacityProperty(property):
    """A property whose setter accepts more types than its getter returns."""

    def __get__(self, scene: Any, owner: Optional[type] = None) -> npt.NDArray[np.float64]:
        points: npt.NDArray[np.float64] = super().__get__(scene, owner)
        return points

    def __set__(self, scene: Any, opacity: Opacity) -> None:
        super().__set__(scene, opacity)


_MAX_CONTACTS = 2**20
_SAMPLES_PER_VOXEL = 1
_MAX_DEPTH = 10.0
_NO_MARGIN = 0.0
_TOUCH_STEPS: int = standard("touch", "max_steps")
_PLAIN_TOUCH: tuple[tuple[str, Any], ...] = ()


def _uncertainty_of(given: Any) -> tuple[float, float]:
    both = listed(given, "uncertainty")
    if len(both) != 2:
        raise InvalidArgumentError(f"uncertainty is {given!r}; two numbers are needed: (mm, degrees)")
    return number(both[0], "uncertainty[0]"), number(both[1], "uncertainty[1]")


class Scene(Measuring):
    """A volume and its opaque region, for queries with meshes.

    volume
        a source that `read_volume` accepts without options
    opacity
        points (value, opacity), ascending, in the volume's own units: linear between, constant outside, two with equal
        values make a step. Or text ("40:0,80:1"), or a file. None: from 0 to 1 over the domain
    threshold
        a sample is opaque if its opacity is at least this: 0 to 1
    domain, table_size
        range and number of entries of the opacity table, which projections other than "certified" use. None: 256 over
        0 to 255 for uint8, else 4096 over the volume's values
    labels
        a source that `read_labels` accepts: for labels of contacts, distances, areas and overlaps
    device
        None: the host engine, on all processors. True: the best Vulkan device. Or an index or name of `devices()`, or a
        `Device`. The device counts, tests for touch and renders; the host engine answers all other questions
    threads
        number of threads of the host engine; 0: one per processor

    Poses are (N,4,4) or (4,4), world_from_object, row-major (``pose @ [x, y, z, 1]``), affine; the world is LPS,
    millimetres (`LPS_FROM_RAS` converts from RAS). Queries use all earlier changes.

    Threads can share a scene; calls wait for each other. Queries release the interpreter's lock. A KeyboardInterrupt
    ends a query within a second: on the host also during a pose, on a device between two pieces of about a tenth of a
    second.
    """

    __slots__ = ("_core", "_volume", "_labels", "_device", "_domain", "_table_size", "_closed", "_warned", "_examined", "_last",
                 "__weakref__")

    def __init__(self, volume: Any, opacity: Opacity = None, threshold: float = standard("scene", "opacity_threshold"), *,
                 domain: Optional[tuple[float, float]] = None, table_size: Optional[int] = None,
                 labels: Any = None, device: Union[None, bool, int, str, Device] = None, threads: int = 0) -> None:
        self._volume = read_volume(volume)
        self._labels: Optional[Labels] = None if labels is None else read_labels(labels)
        self._device = opened(device)
        self._domain = None if domain is None else pair(domain, "domain")
        fitting = lib.VXT_DEFAULT_TABLE_SIZE if self._volume.dtype == "uint8" else 4096
        self._table_size = fitting if table_size is None else whole_number(table_size, "table_size", 2, lib.VXT_MAX_TABLE_SIZE)
        self._closed = False
        self._warned = False
        self._examined: WeakSet[Any] = WeakSet()  # meshes whose enclosed regions were looked for
        self._last: Optional[Mesh] = None  # one of them
        self._core = core.Scene(self._volume._core, points(opacity), self._domain, self._table_size, number(threshold, "threshold"),
                                 None if self._labels is None else self._labels._core,
                                 None if self._device is None else self._device._core,
                                 whole_number(threads, "threads", 0, lib.VXT_MAX_THREADS))

    # Properties

    @property
    def volume(self) -> Volume:
        """The volume as given, without edits."""
        return self._volume

    @property
    def labels(self) -> Optional[Labels]:
        """The label map, or None."""
        return self._labels

    @property
    def device(self) -> Optional[Device]:
        """The device of the scene; None: the host."""
        return self._device

    def _opacity(self) -> npt.NDArray[np.float64]:
        return self._core.opacity

    def _set_opacity(self, opacity: Opacity) -> None:
        self._core.set_opacity(points(opacity), self._domain, self._table_size)

    opacity = _OpacityProperty(_opacity, _set_opacity,
                              doc="(N,2): value and opacity. The next query uses what is set.")

    @property
    def domain(self) -> tuple[float, float]:
        """The range of values that the opacity table covers."""
        return self._core.domain

    @property
    def threshold(self) -> float:
        """The opacity at which a sample is opaque. The next query uses a new value."""
        return self._core.threshold

    @threshold.setter
    def threshold(self, threshold: float) -> None:
        self._core.set_threshold(number(threshold, "threshold"))

    # Edits

    def edit(self, *, ball: Optional[npt.ArrayLike] = None, box: Optional[Sequence[int]] = None,
             value: Optional[float] = None, at: Optional[Sequence[int]] = None,
             voxels: Optional[npt.ArrayLike] = None) -> None:
        """Changes voxels; the next query uses them. One of:

        edit(ball=(x, y, z, r), value=v)
            all voxels whose centre is within r mm of a world point (LPS, mm)
        edit(box=(x, y, z, nx, ny, nz), value=v)
            nx * ny * nz voxels from voxel (x, y, z) on
        edit(at=(x, y, z), voxels=array)
            the voxels of an array indexed [z, y, x], from voxel (x, y, z) on

        Refuses values that the voxel type cannot represent, and boxes outside the volume; then nothing changes. Values
        of float32 voxels are rounded.
        """
        if sum(choice is not None for choice in (ball, box, at)) != 1:
            raise InvalidArgumentError("an edit has one of ball=, box= and at=")
        if (at is None) != (voxels is None) or (at is None) != (value is not None):
            raise InvalidArgumentError("ball= and box= come with value=, and at= comes with voxels=")
        if ball is not None:
            place = numbers(ball, "ball")
            if place.shape != (4,):
                raise InvalidArgumentError(f"ball is {ball!r}; four numbers are needed: x, y, z and the radius, mm")
            self._core.set_ball(place[:3], float(place[3]), number(value, "value"))
        elif box is not None:
            corner = whole(box, 6, "box")
            self._core.set_box(corner[:3], corner[3:], number(value, "value"))
        else:
            given = array_of(voxels, "voxels")
            if given.dtype.kind not in "biuf":
                given = numbers(given, "voxels")
            if given.ndim != 3:
                raise InvalidArgumentError(f"voxels have the shape {given.shape}; three dimensions are needed: z, y, x")
            with np.errstate(invalid="ignore", over="ignore"):
                stored = np.ascontiguousarray(given, dtype=self._volume.dtype)
            fit = (stored == given).all() if stored.dtype.kind in "iu" else \
                given.dtype.kind not in "iu" or exact_in_float32(given)
            if not fit:
                raise InvalidArgumentError(f"voxels of {given.dtype} do not all fit the volume's {stored.dtype}")
            self._core.write_box(whole(at, 3, "at"), stored)

    # Questions

    def touch(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *, margin: float = _NO_MARGIN,
              uncertainty: Optional[tuple[float, float]] = None, witness: bool = False, solid: bool = False,
              resolution: float = RESOLUTION, max_steps: int = _TOUCH_STEPS, progress: Progress = None) -> Touch:
        """Decides whether each pose touches: a `Touch` with a row for each pose, in order.

        The mesh is its surface, unless `solid`: an opaque region that a closed mesh encloses without touching it is no
        contact. The first answer without a touch of a mesh warns if its first pose encloses one.

        mesh, poses
            a mesh at poses, (N,4,4) or (4,4); or a list of (mesh, poses) alone
        margin
            mm: decides whether anything opaque is within this distance of the surface
        uncertainty
            (mm, degrees): decides whether the mesh touches at any pose that is rotated by at most these degrees (0 to 180)
            about any axis through the object's origin, and then translated by at most these mm
        witness
            finds a witness point of each yes: `Touch.witness`; not with an uncertainty
        solid
            the inside of the mesh touches, too: an enclosed opaque region is a contact. The mesh must be closed
        resolution
            voxels: minimum size of the pieces of a triangle
        max_steps
            iteration limit per pose, which is then undecided
        progress
            a function of (done, all), a bar of tqdm, or tqdm itself

        A scene on a device answers there, without margin, uncertainty, witness, solid and max_steps; else the host answers.
        Raises InvalidArgumentError for shapes, NaN, and poses that are not affine (naming the first one).
        """
        options = _PLAIN_TOUCH
        if (margin is not _NO_MARGIN or uncertainty is not None or witness or solid or resolution is not RESOLUTION
                or max_steps is not _TOUCH_STEPS):
            distance, angle = (0.0, 0.0) if uncertainty is None else _uncertainty_of(uncertainty)
            if witness and uncertainty is not None:
                raise InvalidArgumentError("a touch has witness= or uncertainty=, not both")
            steps = whole_number(max_steps, "max_steps", 1)
            settings = {"margin": number(margin, "margin") or None, "uncertainty_distance": distance or None,
                        "uncertainty_angle": angle or None, "witness": bool(witness) or None, "solid": bool(solid) or None,
                        "resolution": None if resolution is RESOLUTION else number(resolution, "resolution"),
                        "max_steps": None if steps == _TOUCH_STEPS else steps}
            options = tuple((name, value) for name, value in settings.items() if value is not None)
        meshes, matrices = asked(mesh, poses, self._volume)
        if progress is None:
            tables = self._core.touch(meshes, matrices, options, None)
        else:
            with told(progress, pairs_in(meshes, matrices)) as tell:
                tables = self._core.touch(meshes, matrices, options, tell)
        if mesh is not self._last and not self._warned and not solid and not tables.touches():
            self._warn_of_enclosed(len(tables), mesh, matrices)
        return Touch(tables, None if self._labels is None else self._labels._core, bool(witness))

    def count(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
              triangles: bool = False, contacts: bool = False, bounds: bool = False, labels: bool = False,
              stop_at_first: bool = False, projection: Projection = "certified", method: Optional[Method] = None,
              filter: Optional[Literal["hardware", "exact"]] = None,
              boundary: Literal["auto", "range", "clamp"] = "auto", resolution: float = RESOLUTION,
              samples_per_voxel: int = _SAMPLES_PER_VOXEL, max_depth: float = _MAX_DEPTH, max_contacts: int = _MAX_CONTACTS,
              overestimate: bool = False, counters: bool = False, view: Optional[View] = None,
              progress: Progress = None) -> Count:
        """Counts the passing fragments of each pose, and finds contacts: a `Count` with a row for each pose, in order.

        Only the surface of the mesh counts, as in `touch`.

        mesh, poses
            a mesh at poses, (N,4,4) or (4,4); or a list of (mesh, poses) alone
        triangles, contacts, bounds, labels
            computes these in the same call. Reading another one repeats the query, unless the scene has changed
        stop_at_first
            stops at the first fragment: the count is then 0 or 1. `touch` is faster for the projection "certified"
        projection
            "certified": misses no contact; rounding may leave pairs undecided. "view", "two-view" (camera: `view`; default
            from above) and "dominant-axis" (`samples_per_voxel`, 1 to 16) count pixels
        method, filter, boundary, overestimate
            how a device counts (docs/counting.md). None and "auto": `Device.default_method`. The host engine supports
            "cpu" and "exact"
        resolution
            voxels: minimum size of the pieces of a triangle, for "certified"
        max_depth
            mm: maximum depth of a contact
        max_contacts
            cuts longer lists of contacts arbitrarily; `Count.contacts_found` is their full number
        counters
            counts the work of a device for the projection "certified": `Count.counters`
        progress
            a function of (done, all), a bar of tqdm, or tqdm itself

        Raises InvalidArgumentError for shapes, NaN, and poses that are not affine (naming the first one).
        """
        flags = {"triangles": triangles, "contacts": contacts, "bounds": bounds, "labels": labels, "stop_at_first": stop_at_first,
                 "overestimate": overestimate, "counters": counters}
        options: dict[str, Any] = {name: True for name, is_wanted in flags.items() if is_wanted}
        if projection != "certified":
            options["projection"] = projection
        if method not in (None, "auto"):
            options["method"] = method
        if filter is not None:
            options["filter"] = filter
        if boundary != "auto":
            options["boundary"] = boundary
        # Compared by identity: True equals 1 and 1.0.
        if resolution is not RESOLUTION:
            options["resolution"] = number(resolution, "resolution")
        if samples_per_voxel is not _SAMPLES_PER_VOXEL:
            options["samples_per_voxel"] = whole_number(samples_per_voxel, "samples_per_voxel", 1,
                                                        lib.VXT_MAX_SAMPLES_PER_VOXEL)
        if max_depth is not _MAX_DEPTH:
            options["max_depth"] = number(max_depth, "max_depth")
        if max_contacts is not _MAX_CONTACTS:
            options["max_contacts"] = whole_number(max_contacts, "max_contacts")
        if view is not None:
            if not isinstance(view, tuple) or len(view) != 3:
                raise TypeError(f"view is a {type(view).__name__}; a voxtact.View is needed")
            matrix, width, height = view
            options["view"] = (numbers(matrix, "clip_from_world"), whole_number(width, "width", 1), whole_number(height, "height", 1))
        meshes, matrices = asked(mesh, poses, self._volume)
        if progress is None:
            tables = self._core.count(meshes, matrices, options, None)
        else:
            with told(progress, pairs_in(meshes, matrices)) as tell:
                tables = self._core.count(meshes, matrices, options, tell)
        if not self._warned and not tables.touches():
            self._warn_of_enclosed(len(tables), mesh, matrices)
        return Count(tables, self)

    def _warn_of_enclosed(self, pairs: int, mesh: Any, poses: Any) -> None:
        """Warns once per scene if the first pose of a mesh encloses an opaque region without touching it. Examines each mesh
        once, because that takes milliseconds."""
        if not pairs or not isinstance(mesh, Mesh):
            return
        self._last = mesh
        if mesh._core in self._examined:
            return
        self._examined.add(mesh._core)
        place = enclosed(self._volume, self.opacity, self.threshold, mesh, poses.reshape(-1, 4, 4)[0])
        if place is not None:
            self._warned = True
            warnings.warn(f"{mesh.name} encloses an opaque region at {place.round(2).tolist()}, which its surface does not touch; "
                          "ask touch(solid=True) or overlap() about the inside", stacklevel=3)

    def plan(self, target: npt.ArrayLike, *, avoid: Sequence[Union[int, str]] = (), avoid_opacity: Opacity = None,
             avoid_volume: Any = None, needle: Optional[tuple[float, float]] = None, mesh: Optional[Mesh] = None,
             tip: Optional[npt.ArrayLike] = None, axis: Optional[npt.ArrayLike] = None,
             entries: int = lib.VXT_DEFAULT_ENTRIES, entry_label: Union[None, int, str] = None,
             entry_radius: Optional[float] = None, border_entries: bool = False, margin: float = 0.0,
             max_length: Optional[float] = None, max_angle: Optional[float] = None,
             tolerance: float = standard("plan", "tolerance"), max: float = lib.VXT_DEFAULT_PLAN_MAX,
             max_steps: int = lib.VXT_DEFAULT_PLAN_STEPS, triangle_distances: bool = False) -> Plan:
        """Finds straight paths to a target that avoid obstacles: a `Plan` with a row for each entry.

        An instrument moves straight from an entry to the target, its axis on that line. Its distance from the obstacles
        on the way is certified.

        target
            (3,): end of the tip, LPS, mm
        avoid
            labels that must not be touched, by number or name, opaque or not
        avoid_opacity, avoid_volume
            further obstacle: the opaque region of this volume (None: the scene's) under these points of opacity
        needle
            (diameter, length), mm: round and solid, with round ends; default without a mesh: 2 mm by 200 mm
        mesh, tip, axis
            instead of a needle: a mesh, its tip, and the direction from the tip to its handle, in mesh coordinates
        entries
            minimum number of directions from the target, evenly spread; rounded up to 10 n^2 + 2
        entry_label, entry_radius
            entries lie on the outside of this label, or on a sphere of this radius (mm) around the target; None: on the
            outside of the scene's opaque region
        border_entries
            paths may also begin where the image's border cuts the opaque region or the label, such as the neck in a scan
            of a head
        margin
            mm: minimum distance of a safe path from all obstacles
        max_length, max_angle
            maximum length (mm) and maximum angle to the normal of the entry surface (degrees) of a path
        tolerance, max, max_steps
            mm: stops when upper - lower is at most this; mm: stops when lower reaches this; iteration limit per path
        triangle_distances
            needle only: also bounds the distance of all paths from each triangle: `Plan.triangle_distance`

        The host engine plans, also for scenes on a device. The target may be outside the volume.
        """
        wish = plan_options(self._labels, avoid=avoid, avoid_opacity=avoid_opacity, avoid_volume=avoid_volume, needle=needle, mesh=mesh,
                            tip=tip, axis=axis, entries=entries, entry_label=entry_label, entry_radius=entry_radius,
                            border_entries=border_entries, margin=margin, max_length=max_length, max_angle=max_angle,
                            tolerance=tolerance, max=max, max_steps=max_steps, triangle_distances=triangle_distances)
        avoided = None if avoid_volume is None else read_volume(avoid_volume)._core
        return Plan(self._core.plan(numbers(target, "target"), wish, avoided, points(avoid_opacity),
                                    self.domain if avoided is None else None),
                    self._labels, bool(wish["avoid"]), bool(triangle_distances))

    # Pictures

    def picture(self, mesh: Union[None, Mesh, Sequence[tuple[Mesh, Poses]]] = None, pose: Optional[Poses] = None, *,
                size: tuple[int, int] = (512, 512), view: Union[str, tuple[float, float], View, npt.ArrayLike] = "front",
                preset: Optional[str] = None, colours: Optional[npt.ArrayLike] = None,
                background: Colour = (0.0, 0.0, 0.0), lighting: Light = "soft", clip: Union[Clip, Sequence[Clip]] = (),
                clip_meshes: bool = False, show: Optional[Show] = None, triangles: Optional[npt.ArrayLike] = None,
                through: Optional[float] = None,
                mesh_colours: Optional[Sequence[Colour]] = None) -> npt.NDArray[np.uint8]:
        """Renders the volume under its opacity, with meshes in it: (H,W,4), uint8, the uppermost row first.

        Uses the scene's Vulkan device, else the best one of this machine; UnsupportedError without one. Equals the
        picture of `voxtact render --no-annotate`.

        mesh, pose
            a mesh at a pose (4,4; None: the identity), or at several poses (N,4,4); or a list of (mesh, poses)
            alone
        size
            (width, height), pixels
        view
            "front", "back", "left", "right", "top", "bottom"; or (azimuth, elevation) in degrees, 0 in front of the
            face and 90 at the left ear; or (4,4), clip_from_world; or a `View`, whose size is then the picture's
        preset, colours
            colours of a name in `looks()`; or (N,4), ascending: value, red, green, blue. None: warm white
        background
            red, green and blue, 0 to 1
        lighting
            "soft": from the eye and from above its left, with ambient occlusion; "eye"; "none"
        clip
            up to six cuts of the volume. "left", "right", "front", "back", "top" or "bottom": that side of a plane through
            the middle; ("left", mm): of a plane at that x, y or z. "near" or ("near", mm): the part nearer to the eye
            than this distance in front of the middle. (x, y, z, offset): points with x px + y py + z pz > offset
        clip_meshes
            cuts meshes, too
        show
            red parts of the meshes: "contacts" (None), as the projection "view" counts them; "discarded" also shows the
            other fragments in blue; "triangles": certainly touching triangles, or those in `triangles`; "plain": none
        triangles
            chosen triangles: indices, of one mesh at all its poses; or rows with `pair` and `triangle`, such as
            `Count.triangles` of the same meshes and poses
        through
            0 to 1: visibility of the paint through the volume; None: 0.8, for "discarded" 1
        mesh_colours
            (red, green, blue) per mesh; None: gray, then other colours
        """
        if isinstance(view, View):
            size, view = (view.width, view.height), view.clip_from_world
        meshes, matrices = None, None
        if mesh is not None:
            meshes, matrices = asked(mesh, np.eye(4) if pose is None and isinstance(mesh, Mesh) else pose, self._volume)
        elif pose is not None:
            raise InvalidArgumentError("pose is about a mesh, and there is none")
        count = 0 if meshes is None else 1 if matrices is not None else len(meshes)
        if show == "triangles" and triangles is None:
            triangles = () if mesh is None else self.count(mesh, matrices, triangles=True).triangles
        options = picture_options(0 if meshes is None else pairs_in(meshes, matrices), count, size=whole(size, 2, "size"),
                                  view=view, preset=preset, colours=colours, background=background, lighting=lighting,
                                  show=show, through=through, triangles=triangles, mesh_colours=mesh_colours, clip=clip,
                                  clip_meshes=clip_meshes)
        device = self._device if self._device is not None or self._closed else best_device()
        return self._core.picture(meshes, matrices, options, None if device is None else device._core)

    def _repr_png_(self) -> Optional[bytes]:
        """Shows the picture in notebooks; None without a device."""
        try:
            return png(self.picture(size=(320, 320)))
        except Error:
            return None

    # Closing

    def close(self) -> None:
        """Frees memory on the host and on the device; later queries raise NotReadyError."""
        self._closed = True
        self._core.close()

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        x, y, z = self._volume._core.size
        points = ", ".join(f"{value:g}:{opacity:g}" for value, opacity in self.opacity[:8])
        where = "closed" if self._closed else "on the host" if self._device is None else f"on {self._device.info.name!r}"
        return (f"<voxtact.Scene of {self._volume.name!r}, {x} x {y} x {z}: opacity {points}"
                f"{', …' if len(self.opacity) > 8 else ''}, threshold {self.threshold:g}, {where}>")

    def __reduce__(self) -> NoReturn:
        not_pickled(self)
