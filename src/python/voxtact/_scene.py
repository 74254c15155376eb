# SPDX-License-Identifier: MIT
"""Scenes, which are asked."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal, NoReturn, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core as core
from ._answer import Answer
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
from ._common import array_of, encoded_text, exact_in_float32, listed, not_pickled, number, numbers, whole_number
from ._device import Device, best_device, opened
from ._errors import Error, InvalidArgumentError
from ._labels import Labels, read_labels
from ._measuring import RESOLUTION, Measuring
from ._mesh import Mesh
from ._picture import Clip, Colour, Light, Show, picture_options, png
from ._plan import Plan, plan_options
from ._view import View
from ._volume import Volume, read_volume

_MOST_CONTACTS = 2**20
_SAMPLES_PER_VOXEL = 1
_MAX_DEPTH = 10.0


class Scene(Measuring):
    """A volume, and what of it is opaque: what meshes are put to.

    volume
        whatever `read_volume` takes without options
    opacity
        points (value, opacity), ascending, in the volume's own units: linear between, constant outside, two with one
        value make a step. Or text ("40:0,80:1"), or a file. None: from 0 to 1 over the domain
    threshold
        a sample is opaque where its opacity is at least this: 0 to 1
    domain, table_size
        opacity is sampled into that many entries over these values; None: 0 to 255 for uint8, else the volume's values
    labels
        what `read_labels` takes: for the labels of contacts, and for clearances to and areas in labels
    device
        None: the host engine, on all processors. True: the best Vulkan device. Or a number or name of `devices()`, or a
        `Device`. Clearances and areas are measured by the host engine, and pictures are made by a device, wherever the scene is
    threads
        of the host engine; 0: one for each processor

    Poses are (N,4,4) or (4,4), world_from_object, written row by row (``pose @ [x, y, z, 1]``), affine; the world is
    LPS, millimetres (`LPS_FROM_RAS` is the way there from RAS). What is asked sees all changes that were made before.

    Scenes can be used by threads, one call at a time: the others wait. Work does not hold the interpreter's lock. A
    KeyboardInterrupt ends it within a second: on the host also in the middle of a pose, on a device between two pieces
    of about a tenth of a second.
    """

    __slots__ = ("_core", "_volume", "_labels", "_device", "_domain", "_table_size", "_closed", "__weakref__")

    def __init__(self, volume: Any, opacity: Opacity = None, threshold: float = core.DEFAULT_THRESHOLD, *,
                 domain: Optional[tuple[float, float]] = None, table_size: int = core.DEFAULT_TABLE_SIZE,
                 labels: Any = None, device: Union[None, bool, int, str, Device] = None, threads: int = 0) -> None:
        self._volume = read_volume(volume)
        self._labels: Optional[Labels] = None if labels is None else read_labels(labels)
        self._device = opened(device)
        self._domain = None if domain is None else pair(domain, "domain")
        self._table_size = whole_number(table_size, "table_size", 2, core.MOST_TABLE_SIZE)
        self._closed = False
        self._core = core.Scene(self._volume._core, points(opacity), self._domain, self._table_size, number(threshold, "threshold"),
                                 None if self._labels is None else self._labels._core,
                                 None if self._device is None else self._device._core,
                                 whole_number(threads, "threads", 0, core.MOST_THREADS))

    # What it is

    @property
    def volume(self) -> Volume:
        """What it was made of, without edits."""
        return self._volume

    @property
    def labels(self) -> Optional[Labels]:
        """Its label map."""
        return self._labels

    @property
    def device(self) -> Optional[Device]:
        """The device that it is on; None: the host."""
        return self._device

    @property
    def opacity(self) -> npt.NDArray[np.float64]:
        """(N,2): value and opacity. Set it, and the next answer has seen it."""
        return self._core.opacity

    @opacity.setter
    def opacity(self, opacity: Opacity) -> None:
        self._core.set_opacity(points(opacity), self._domain, self._table_size)

    @property
    def domain(self) -> tuple[float, float]:
        """The values that the table of opacity covers."""
        return self._core.domain

    @property
    def threshold(self) -> float:
        """The opacity from which a sample is opaque. Set it, and the next answer has seen it."""
        return self._core.threshold

    @threshold.setter
    def threshold(self, threshold: float) -> None:
        self._core.set_threshold(number(threshold, "threshold"))

    # Changes

    def edit(self, *, ball: Optional[npt.ArrayLike] = None, box: Optional[Sequence[int]] = None,
             value: Optional[float] = None, at: Optional[Sequence[int]] = None,
             voxels: Optional[npt.ArrayLike] = None) -> None:
        """Changes voxels; the next answer has seen it. One of:

        edit(ball=(x, y, z, r), value=v)
            all voxels whose centre is at most r mm from a point of the world (LPS, mm)
        edit(box=(x, y, z, nx, ny, nz), value=v)
            nx * ny * nz voxels from voxel (x, y, z) on
        edit(at=(x, y, z), voxels=array)
            those of an array indexed [z, y, x], from voxel (x, y, z) on

        Refuses values that the voxels' type cannot have, and boxes that leave the volume; then nothing is changed. To
        float32 numbers with a fraction are rounded.
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

    def detect(self, mesh: Union[Mesh, Sequence[tuple[Mesh, Poses]]], poses: Optional[Poses] = None, *,
               triangles: bool = False, contacts: bool = False, bounds: bool = False, labels: bool = False,
               yes_no: bool = False, projection: Projection = "conservative", method: Optional[Method] = None,
               filter: Optional[Literal["hardware", "exact"]] = None,
               boundary: Literal["auto", "range", "clamp"] = "auto", resolution: float = RESOLUTION,
               samples_per_voxel: int = _SAMPLES_PER_VOXEL, max_depth: float = _MAX_DEPTH, most_contacts: int = _MOST_CONTACTS,
               overestimate: bool = False, counters: bool = False, view: Optional[View] = None,
               progress: Progress = None) -> Answer:
        """Which poses touch, how much, and where: an `Answer` with a row for each pose, in order.

        mesh, poses
            a mesh at poses, (N,4,4) or (4,4); or a list of (mesh, poses) alone
        triangles, contacts, bounds, labels
            asks for these in the same go. What was not asked for is found out when you look at it, as long as the scene
            has not changed since; that costs another detection
        yes_no
            whether it touches is enough: it stops at the first contact, which is much faster for deep poses
        projection
            "conservative" is certified: no contact is missed, and *possible* says where rounding decides. "view",
            "two-view" (of `view`; without, from above) and "dominant-axis" (`samples_per_voxel`, 1 to 16) count pixels
        method, filter, boundary, overestimate
            how a device counts; see docs/counting.md. "auto" is the fastest one that counts, measured once for each
            `Device`; None: `Device.default_method`. The host engine has "cpu" and "exact"
        resolution
            conservative: how small, in voxels, the pieces of a triangle may get
        max_depth
            mm, how far a contact's depth is followed
        most_contacts
            longer lists of contacts are cut, arbitrarily; `Answer.contacts_found` still has their number
        counters
            counts what a device did for the projection "conservative": `Answer.counters`
        progress
            a function of (done, all), a bar of tqdm, or tqdm itself

        Raises InvalidArgumentError for shapes, NaN, and poses that are not affine (the first one is named).
        """
        options: dict[str, Any] = {}
        if triangles:
            options["triangles"] = True
        if contacts:
            options["contacts"] = True
        if bounds:
            options["bounds"] = True
        if labels:
            options["labels"] = True
        if yes_no:
            options["yes_no"] = True
        if projection != "conservative":
            options["projection"] = projection
        if method == "auto":  # the certified projection has one on a device, and the host has one
            if self._device is not None and projection != "conservative":
                options["method"] = self._device.fastest_method()
        elif method is not None:
            options["method"] = method
        if filter is not None:
            options["filter"] = filter
        if boundary != "auto":
            options["boundary"] = boundary
        # Compared by what they are: True is 1, too, and 1.0.
        if resolution is not RESOLUTION:
            options["resolution"] = number(resolution, "resolution")
        if samples_per_voxel is not _SAMPLES_PER_VOXEL:
            options["samples_per_voxel"] = whole_number(samples_per_voxel, "samples_per_voxel", 1,
                                                        core.MOST_SAMPLES_PER_VOXEL)
        if max_depth is not _MAX_DEPTH:
            options["max_depth"] = number(max_depth, "max_depth")
        if most_contacts is not _MOST_CONTACTS:
            options["most_contacts"] = whole_number(most_contacts, "most_contacts")
        if overestimate:
            options["overestimate"] = True
        if counters:
            options["counters"] = True
        if view is not None:
            if not isinstance(view, tuple) or len(view) != 3:
                raise TypeError(f"view is a {type(view).__name__}; a voxtact.View is needed")
            matrix, width, height = view
            options["view"] = (numbers(matrix, "clip_from_world"), whole_number(width, "width", 1), whole_number(height, "height", 1))
        meshes, matrices = asked(mesh, poses)
        if progress is None:
            return Answer(self._core.detect(meshes, matrices, options, None), self)
        with told(progress, pairs_in(meshes, matrices)) as tell:
            return Answer(self._core.detect(meshes, matrices, options, tell), self)

    def plan(self, target: npt.ArrayLike, *, avoid: Sequence[Union[int, str]] = (), avoid_opacity: Opacity = None,
             avoid_volume: Any = None, needle: Optional[tuple[float, float]] = None, mesh: Optional[Mesh] = None,
             tip: Optional[npt.ArrayLike] = None, axis: Optional[npt.ArrayLike] = None,
             entries: int = core.DEFAULT_PLAN_ENTRIES, entry_label: Union[None, int, str] = None,
             entry_radius: Optional[float] = None, border_entries: bool = False, margin: float = 0.0,
             max_length: Optional[float] = None, max_angle: Optional[float] = None,
             tolerance: float = core.DEFAULT_PLAN_TOLERANCE, maximum: float = core.DEFAULT_PLAN_MAXIMUM,
             most_steps: int = core.DEFAULT_PLAN_STEPS, triangle_clearances: bool = False) -> Plan:
        """Which straight paths to a target keep clear of what must not be touched: a `Plan` with a row for each entry.

        An instrument goes straight from an entry to the target, its axis on that line, and is certain to keep its
        distance all the way, or not.

        target
            (3,): where the tip goes, LPS, mm
        avoid
            labels that must not be touched, by number or name, opaque or not
        avoid_opacity, avoid_volume
            what must not be touched besides: all that is opaque under these points, in this volume (None: the scene's)
        needle
            (diameter, length), mm: round and solid, with round ends; 2 mm by 200 mm where there is no mesh either
        mesh, tip, axis
            instead of a needle: its tip, and the direction from there to where it is held, in its coordinates
        entries
            directions from the target, evenly spread: the least 10 n^2 + 2 that is no fewer
        entry_label, entry_radius
            entries are on the outside of this label, or all so far from the target, mm; None: on the outside of what is
            opaque in the scene
        border_entries
            paths may begin where the image ends within what is opaque, or within the label, too: there it is the image
            that was cut, as a scan of a head is at the neck
        margin
            mm that a safe path keeps from all that is to be avoided
        max_length, max_angle
            mm; degrees between a path and the normal of the entries' surface: paths beyond are left out
        tolerance, maximum, most_steps
            mm, how near to each other the bounds of a clearance are brought; mm, what is farther is not measured; a path
            that takes more steps is left with the bounds that it has
        triangle_clearances
            how much every path from a whole triangle keeps, too, of a needle: `Plan.triangle_clearance`

        The host engine plans, also for scenes on a device. Whether the target is inside of the volume is not asked.
        """
        wish = plan_options(self._labels, avoid=avoid, avoid_opacity=avoid_opacity, avoid_volume=avoid_volume, needle=needle, mesh=mesh,
                            tip=tip, axis=axis, entries=entries, entry_label=entry_label, entry_radius=entry_radius,
                            border_entries=border_entries, margin=margin, max_length=max_length, max_angle=max_angle,
                            tolerance=tolerance, maximum=maximum, most_steps=most_steps, triangle_clearances=triangle_clearances)
        avoided = None if avoid_volume is None else read_volume(avoid_volume)._core
        return Plan(self._core.plan(numbers(target, "target"), wish, avoided, points(avoid_opacity),
                                    self.domain if avoided is None else None), self._labels, bool(triangle_clearances))

    # Pictures

    def picture(self, mesh: Union[None, Mesh, Sequence[tuple[Mesh, Poses]]] = None, pose: Optional[Poses] = None, *,
                size: tuple[int, int] = (512, 512), view: Union[str, tuple[float, float], View, npt.ArrayLike] = "front",
                preset: Optional[str] = None, colours: Optional[npt.ArrayLike] = None,
                background: Colour = (0.0, 0.0, 0.0), lighting: Light = "soft", clip: Union[Clip, Sequence[Clip]] = (),
                clip_meshes: bool = False, show: Optional[Show] = None, triangles: Optional[npt.ArrayLike] = None,
                through: Optional[float] = None,
                mesh_colours: Optional[Sequence[Colour]] = None) -> npt.NDArray[np.uint8]:
        """A picture of the volume under its opacity, and of meshes in it: (H,W,4), uint8, the uppermost row first.

        A Vulkan device makes it: the scene's, else the best one of this machine; UnsupportedError where there is none.
        The same picture as `voxtact render --no-annotate` makes of the same.

        mesh, pose
            a mesh at a pose (4,4), None: where its coordinates are, or at several poses (N,4,4); or a list of (mesh,
            poses) alone
        size
            (width, height), pixels
        view
            "front", "back", "left", "right", "top", "bottom"; or (azimuth, elevation) in degrees, 0 before the face and
            90 beside the left ear; or (4,4), clip_from_world; or a `View`, whose size then is the picture's
        preset, colours
            colours of one of `looks()`; or (N,4), ascending: value, red, green, blue. None: one warm white
        background
            red, green and blue, 0 to 1
        lighting
            "soft": from the eye and from above its left, darker where a place is shut in; "eye"; "none"
        clip
            what is taken away of the volume, up to six times: "left", "right", "front", "back", "top" or "bottom" of a
            plane through its middle, or ("left", mm) of one at that x, y or z; "near" or ("near", mm): what is nearer to
            the eye than so many mm before the middle; or (x, y, z, offset): points with x px + y py + z pz > offset
        clip_meshes
            takes the same of meshes away
        show
            what is red on the meshes: "contacts" (None), as the projection "view" counts them; "discarded" also shows the
            rest in blue; "triangles": those that touch for certain, or those of `triangles`; "plain": nothing
        triangles
            chosen triangles: numbers, of one mesh at all its poses; or rows with `pair` and `triangle`, as
            `Answer.triangles` of the same meshes and poses has them
        through
            0 to 1: how much of what is painted is seen through the volume before it; None: 0.8, of "discarded" 1
        mesh_colours
            (red, green, blue) of each mesh; None: gray, and others
        """
        if isinstance(view, View):
            size, view = (view.width, view.height), view.clip_from_world
        meshes, matrices = None, None
        if mesh is not None:
            meshes, matrices = asked(mesh, np.eye(4) if pose is None and isinstance(mesh, Mesh) else pose)
        elif pose is not None:
            raise InvalidArgumentError("pose is about a mesh, and there is none")
        count = 0 if meshes is None else 1 if matrices is not None else len(meshes)
        if show == "triangles" and triangles is None:
            triangles = () if mesh is None else self.detect(mesh, matrices, triangles=True).triangles
        options = picture_options(0 if meshes is None else pairs_in(meshes, matrices), count, size=whole(size, 2, "size"),
                                  view=view, preset=preset, colours=colours, background=background, lighting=lighting,
                                  show=show, through=through, triangles=triangles, mesh_colours=mesh_colours, clip=clip,
                                  clip_meshes=clip_meshes)
        device = self._device if self._device is not None or self._closed else best_device()
        return self._core.picture(meshes, matrices, options, None if device is None else device._core)

    def _repr_png_(self) -> Optional[bytes]:
        """For notebooks; nothing where no device can draw."""
        try:
            return png(self.picture(size=(320, 320)))
        except Error:
            return None

    # Its end

    def close(self) -> None:
        """Frees what it holds, on the host and on the device; whatever is asked later is refused (NotReadyError)."""
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
