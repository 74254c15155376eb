# SPDX-License-Identifier: MIT
"""Volumes: from files, arrays, and images of other libraries."""
from __future__ import annotations

import os
import sys
from typing import Any, Literal, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _handles as core
from ._common import (
    BUILTIN,
    LPS_FROM_RAS,
    Space,
    array_of,
    checked_space,
    encoded,
    encoded_text,
    exact_in_float32,
    numbers,
    whole_number,
)
from ._errors import InvalidArgumentError

_MILLIMETRES = {"mm": 1.0, "meter": 1000.0, "micron": 0.001}


class Volume:
    """An immutable 3D image with its position in the world. `read_volume` creates one.

    A `Scene` edits its own copy of the voxels. A volume may share the memory of an array without a copy; then the array
    must not change while scenes are created from it.
    """

    __slots__ = ("_core", "_assumed")
    _core: core.Volume
    _assumed: bool  # True: the affine maps to RAS by default, not by a statement

    def __init__(self) -> None:
        raise TypeError("voxtact.read_volume() makes volumes: from a file, an array with affine=, or an image object")

    @classmethod
    def _of(cls, made_of: core.Volume) -> Volume:
        made = cls.__new__(cls)
        made._core = made_of
        made._assumed = False
        return made

    @property
    def array(self) -> npt.NDArray[Any]:
        """The voxels, indexed [z, y, x]: uint8, int16, uint16 or float32, in the image's own units; read-only."""
        return self._core.array

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of voxels along z, y and x, like `array`."""
        x, y, z = self._core.size
        return (z, y, x)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the voxels."""
        return self._core.array.dtype

    @property
    def spacing(self) -> npt.NDArray[np.float64]:
        """mm between voxels along x, y and z."""
        return self._core.spacing

    @property
    def origin(self) -> npt.NDArray[np.float64]:
        """The centre of voxel (0, 0, 0): LPS, mm."""
        return self._core.origin

    @property
    def direction(self) -> npt.NDArray[np.float64]:
        """(3,3): the columns are the unit vectors along the index axes x, y and z, LPS."""
        return self._core.direction

    @property
    def world_from_index(self) -> npt.NDArray[np.float64]:
        """(4,4): maps voxel indices (x, y, z, 1) to LPS, mm."""
        return self._core.world_from_index

    @property
    def affine(self) -> npt.NDArray[np.float64]:
        """(4,4): maps voxel indices (x, y, z, 1) to RAS, mm, as in nibabel."""
        return LPS_FROM_RAS @ self._core.world_from_index

    @property
    def bounds(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Minimum and maximum corner of the world bounding box, out to the outer faces of the outermost voxels: LPS,
        mm."""
        return self._core.box

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest voxel."""
        return self._core.range

    @property
    def name(self) -> str:
        """Name of the file or source."""
        return self._core.name

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes of the reader: copies, conversions and assumptions."""
        return tuple(self._core.notes)

    def write(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes NIfTI-1 (.nii, .nii.gz), NRRD (.nrrd) or MetaImage (.mha), by the ending."""
        self._core.write(encoded(path))

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> npt.NDArray[Any]:
        """Implements `np.asarray(volume)`: `array`."""
        return np.array(self.array, dtype) if copy else np.asarray(self.array, dtype)

    def __repr__(self) -> str:
        x, y, z = self._core.size
        spacing = " x ".join(f"{step:.4g}" for step in self.spacing)
        lo, hi = self.range
        return f"<voxtact.Volume {self.name!r}: {x} x {y} x {z} {self._core.type}, {spacing} mm, values {lo:g} to {hi:g}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _volume_again, (self.array, self.spacing, self.origin, self.direction, self.name, self.notes)


# Arrays of voxels


def _volume_again(voxels: npt.NDArray[Any], spacing: npt.NDArray[np.float64], origin: npt.NDArray[np.float64],
                  direction: npt.NDArray[np.float64], name: str, notes: tuple[str, ...]) -> Volume:
    """Restores a volume from a pickle."""
    return Volume._of(core.Volume.wrap(voxels, spacing, origin, direction, encoded_text(name, "name"),
                                       [encoded_text(note, "a note") for note in notes]))


def _in_z_y_x(array: npt.NDArray[Any], axes: Optional[str]) -> npt.NDArray[Any]:
    """Returns the array indexed [z, y, x]. The meaning of an index does not depend on the order in memory."""
    if axes not in (None, "zyx", "xyz"):
        raise InvalidArgumentError(f"axes={axes!r} is neither 'zyx' nor 'xyz'")
    return array if axes == "zyx" else array.T


def _named_axes(source: Any, axes: Optional[str]) -> Optional[str]:
    """Returns `axes`, or the order of an array with named dimensions x, y and z, such as xarray's."""
    names = getattr(source, "dims", None)
    if not isinstance(names, tuple):
        return axes
    order = "".join(str(name).lower() for name in names)
    spatial = sum(str(name).lower() in ("x", "y", "z") for name in names)
    if spatial == 0:
        return axes
    if spatial < 3 or order not in ("zyx", "xyz"):
        raise InvalidArgumentError(f"the array's dimensions are {names}; rename or transpose it to ('z', 'y', 'x')")
    if axes not in (None, order):
        raise InvalidArgumentError(f"axes={axes!r}, but the array's dimensions are {names}")
    return order


def _stored(array: npt.NDArray[Any], notes: list[str]) -> npt.NDArray[Any]:
    """Converts to a voxel type of voxtact, by the rules of its file readers."""
    kind, size = array.dtype.kind, array.dtype.itemsize
    if kind == "b":
        return array.view(np.uint8)
    if kind == "f":
        if size == 4:
            return array
        if size > 4:
            with np.errstate(over="ignore"):
                rounded = array.astype(np.float32)
            if not np.isfinite(rounded).all() and np.isfinite(array).all():
                raise InvalidArgumentError("a voxel is too large for a float32")
            notes.append(f"voxels converted from {array.dtype} to float32, rounded")
            return rounded
        notes.append(f"voxels converted from {array.dtype} to float32, exactly")
        return array.astype(np.float32)
    if kind not in "iu":
        raise InvalidArgumentError(f"voxels of {array.dtype} cannot be used: whole numbers and floats can")
    if (kind, size) in (("u", 1), ("i", 2), ("u", 2)):
        return array
    if array.size == 0:
        return array.astype(np.int16)  # refused with all empty arrays
    lo, hi = int(array.min()), int(array.max())
    for target in (np.dtype(np.int16), np.dtype(np.uint16)):
        limits = np.iinfo(target)
        if limits.min <= lo and hi <= limits.max:
            notes.append(f"voxels converted from {array.dtype} to {target}, exactly")
            return array.astype(target)
    if max(-lo, hi) > 2**24 and not exact_in_float32(array):
        raise InvalidArgumentError(f"voxels of {array.dtype} from {lo} to {hi} fit neither 16-bit integers nor, exactly, "
                                   "float32")
    notes.append(f"voxels converted from {array.dtype} to float32, exactly")
    return array.astype(np.float32)


def _grid(affine: npt.ArrayLike, space: Space) -> tuple[npt.NDArray[np.float64], ...]:
    """Returns spacing, origin and direction of a matrix from voxel indices (x, y, z) to the world."""
    matrix = numbers(affine, "affine")
    if matrix.shape != (4, 4):
        raise InvalidArgumentError(f"affine has the shape {matrix.shape}; (4, 4) is needed")
    if not np.isfinite(matrix).all():
        raise InvalidArgumentError("affine has an element that is not finite")
    if (matrix[3] != (0, 0, 0, 1)).any():
        raise InvalidArgumentError(f"affine has the last row {matrix[3].tolist()}; 0 0 0 1 is needed")
    if checked_space(space, "space") == "ras":
        matrix = LPS_FROM_RAS @ matrix
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        spacing = np.sqrt((matrix[:3, :3] ** 2).sum(axis=0))
        direction = matrix[:3, :3] / spacing
    if not (spacing > 0).all():
        raise InvalidArgumentError(f"affine has a step of 0 mm along an axis: {spacing.tolist()}")
    return spacing, matrix[:3, 3], direction


def _volume_of_array(array: Any, affine: npt.ArrayLike, space: Space, axes: Optional[str], name: str,
                     notes: Optional[list[str]] = None) -> Volume:
    said = [] if notes is None else notes
    voxels = array_of(array, "the array")
    if voxels.ndim != 3:
        raise InvalidArgumentError(f"the array has the shape {voxels.shape}; three dimensions are needed")
    voxels = _in_z_y_x(voxels, axes)
    if voxels.dtype.byteorder not in "=|" and not voxels.dtype.isnative:
        voxels = voxels.astype(voxels.dtype.newbyteorder("="))
        said.append("voxels copied: they were in the other byte order")
    voxels = _stored(voxels, said)
    if not voxels.flags.c_contiguous:
        voxels = np.ascontiguousarray(voxels)
        said.append("voxels copied: they were not next to each other, x fastest")
    elif not voxels.flags.aligned:
        voxels = voxels.copy()
        said.append("voxels copied: they were not aligned")
    spacing, origin, direction = _grid(affine, space)
    return Volume._of(core.Volume.wrap(voxels, spacing, origin, direction, encoded_text(name, "name"),
                                       [encoded_text(note, "a note") for note in said]))


# Objects of other libraries, by their attributes


def _says_no_place(header: Any) -> bool:
    """Returns True for a NIfTI image with neither qform nor sform."""
    keys: Any = getattr(header, "keys", tuple)()
    return "sform_code" in keys and int(header["sform_code"]) == 0 and int(header["qform_code"]) == 0


def _of_nibabel(image: Any, frame: Optional[int]) -> Volume:
    if image.affine is None:
        raise InvalidArgumentError("the image has no affine, so nothing says where its voxels are; hand over its array "
                                   "with affine=")
    array = np.asanyarray(image.dataobj)
    while array.ndim > 3 and array.shape[-1] == 1:
        array = array[..., 0]
    if array.ndim > 4:
        raise InvalidArgumentError(f"the image has the shape {array.shape}; three dimensions are needed, or four and "
                                   "frame=")
    if array.ndim == 4:
        if frame is None:
            raise InvalidArgumentError(f"the image holds {array.shape[3]} volumes: choose one with frame=")
        if frame >= array.shape[3]:
            raise InvalidArgumentError(f"frame={frame}: the image holds {array.shape[3]} volumes, counted from 0")
        array = array[..., frame]
    elif frame:
        raise InvalidArgumentError(f"frame={frame}: the image holds one volume, counted from 0")
    notes: list[str] = []
    if _says_no_place(image.header):
        notes.append("the image does not say how the patient lies (qform and sform are unset); it is placed by the "
                     "affine that nibabel gives it")
    affine = np.array(image.affine, dtype=np.float64)
    units = getattr(image.header, "get_xyzt_units", lambda: ("mm",))()[0]
    factor = _MILLIMETRES.get(units, 1.0)
    if factor != 1.0:
        affine[:3] *= factor
        notes.append(f"lengths converted from {units} to mm")
    name = image.get_filename() if hasattr(image, "get_filename") else None
    volume = _volume_of_array(array, affine, "ras", "xyz", os.path.basename(name or "nibabel image"), notes)
    shear, most = volume._core.shear()
    if shear > most:  # as in the file
        raise InvalidArgumentError(f"the image's affine shears it by {shear:.3g} degrees (its axes are not at "
                                   "right angles); resample it to an upright grid, or hand over its array with affine=")
    return volume


def _of_itk(image: Any) -> Volume:
    """Reads images of SimpleITK and itk."""
    if hasattr(image, "GetNumberOfComponentsPerPixel") and image.GetNumberOfComponentsPerPixel() != 1:
        raise InvalidArgumentError("the image has several numbers per voxel; one is needed")
    spacing = np.array([float(step) for step in image.GetSpacing()])
    origin = np.array([float(at) for at in image.GetOrigin()])
    if len(spacing) != 3:
        raise InvalidArgumentError(f"the image has {len(spacing)} dimensions; three are needed")
    direction = image.GetDirection()
    if hasattr(direction, "GetVnlMatrix"):
        matrix = direction.GetVnlMatrix()
        columns = np.array([[matrix.get(row, column) for column in range(3)] for row in range(3)])
    else:
        columns = np.array([float(element) for element in direction]).reshape(3, 3)
    module = sys.modules.get(type(image).__module__.split(".")[0])
    view = getattr(module, "GetArrayViewFromImage", None) or getattr(module, "array_view_from_image", None)
    array = view(image) if view is not None else np.asarray(image)
    affine = np.eye(4)
    affine[:3, :3] = columns * spacing
    affine[:3, 3] = origin
    if hasattr(image, "GetBufferedRegion"):  # itk: the origin is that of voxel 0, and the array may begin at another
        first = image.GetBufferedRegion().GetIndex()
        affine[:3, 3] += affine[:3, :3] @ np.array([float(first[axis]) for axis in range(3)])
    return _volume_of_array(array, affine, "lps", "zyx", "ITK image")


def _of_vtk_image(image: Any, space: Space) -> Volume:
    from vtkmodules.util.numpy_support import vtk_to_numpy  # a VTK object proves that VTK is installed

    scalars = image.GetPointData().GetScalars()
    if scalars is None:
        raise InvalidArgumentError("the vtkImageData has no scalars")
    if scalars.GetDataTypeAsString() == "bit":
        raise InvalidArgumentError("the vtkImageData's scalars are bits, which VTK cannot hand over; cast them "
                                   "(vtkImageCast)")
    if scalars.GetNumberOfComponents() != 1:
        raise InvalidArgumentError("the vtkImageData has several numbers per voxel; one is needed")
    x, y, z = image.GetDimensions()
    first = np.array(image.GetExtent()[::2], dtype=np.float64)
    directions = image.GetDirectionMatrix()
    columns = np.array([[directions.GetElement(row, column) for column in range(3)] for row in range(3)])
    affine = np.eye(4)
    affine[:3, :3] = columns * np.array(image.GetSpacing())
    affine[:3, 3] = np.array(image.GetOrigin()) + affine[:3, :3] @ first
    voxels = vtk_to_numpy(scalars)
    if voxels.size != x * y * z:
        raise InvalidArgumentError(f"the vtkImageData has {voxels.size} scalars; {x} x {y} x {z} are needed")
    return _volume_of_array(voxels.reshape(z, y, x), affine, space, "zyx", "vtkImageData")


def _refuse_what_is_no_array(source: Any) -> None:
    """Raises TypeError for an object that numpy converts to an array of objects only."""
    if isinstance(source, (list, tuple)) and source and all(isinstance(one, (str, bytes, os.PathLike)) for one in source):
        raise TypeError("no volume can be made of a list of paths: give one, of a DICOM series that of the folder that "
                        "holds it")
    is_array = (hasattr(source, "__array__") or hasattr(source, "__array_interface__") or hasattr(source, "__buffer__")
                or isinstance(source, (list, memoryview)))
    if is_array and (isinstance(source, np.ndarray) or array_of(source, "the array").dtype != object):
        return
    of_what = isinstance(source, list) and len(source) > 0
    kind = type(source[0]) if of_what else type(source)
    raise TypeError(f"no volume can be made of a {'list of ' if of_what else ''}{kind.__module__}.{kind.__qualname__}: give a "
                    "path (of a DICOM series that of its folder), an array with affine=, or an image of nibabel, "
                    "SimpleITK, itk or VTK")


def read_volume(source: Any, *, affine: Optional[npt.ArrayLike] = None, space: Optional[Space] = None,
                axes: Optional[Literal["zyx", "xyz"]] = None, frame: Optional[int] = None, series: str = "",
                resample: bool = False) -> Volume:
    """Reads a volume from a file, an array, or an image of another library.

    source
        - a path: NIfTI, NRRD, MetaImage, or a folder with a DICOM series; ``"builtin:head:64"`` and the other names of
          the program's builtins. `frame` selects an image of a 4D file, `series` a SeriesInstanceUID. `resample`
          interpolates DICOM slices that make no regular grid (uneven gaps, a tilted gantry) linearly, with a note;
          without it they are refused.
        - an array of three dimensions with `affine`, (4,4): it maps voxel indices (x, y, z, 1) to the world in mm, RAS
          as in nibabel, or LPS with ``space="lps"``. The array is indexed [x, y, z], as in nibabel; with
          ``axes="zyx"`` it is indexed [z, y, x], like `Volume.array`. Its order in memory does not matter. Named
          dimensions x, y and z, such as xarray's, override `axes`; coordinates are ignored.
        - a nibabel image (4D: with `frame`), an image of SimpleITK or itk, or a vtkImageData (LPS, unless
          ``space="ras"``).

    uint8, int16, uint16 and float32 arrays whose x axis is contiguous are not copied, and must not change afterwards.
    Other whole numbers become int16, uint16 or, if exact, float32; float64 is rounded. `Volume.notes` lists copies.

    Raises FileError, FormatError, and InvalidArgumentError, also for NaN and infinite voxels.
    """
    placed = affine is not None or space is not None or axes is not None
    is_builtin = isinstance(source, str) and source.startswith(BUILTIN)
    if resample and (is_builtin or not isinstance(source, (str, bytes, os.PathLike))):
        raise InvalidArgumentError("resample= is for a folder with a DICOM series")
    if isinstance(source, Volume):
        if placed or frame is not None or series:
            raise InvalidArgumentError("a Volume is taken as it is: affine=, space=, axes=, frame= and series= are for others")
        return source
    if frame is not None:
        frame = whole_number(frame, "frame")
    if isinstance(source, (str, bytes, os.PathLike)):
        if placed:
            raise InvalidArgumentError("affine=, space= and axes= are for arrays: a file says where its voxels are")
        if isinstance(source, str) and is_builtin:
            if frame is not None or series:
                raise InvalidArgumentError("frame= and series= are for files and nibabel's images")
            return Volume._of(core.Volume.builtin(encoded_text(source[len(BUILTIN):], "the name of the builtin")))
        return Volume._of(core.Volume.read(encoded(source), frame, encoded_text(series, "series"), bool(resample)))
    if hasattr(source, "affine") and hasattr(source, "dataobj"):
        if placed or series:
            raise InvalidArgumentError("affine=, space= and axes= are for arrays, series= for files: an image of nibabel says "
                                       "where its voxels are")
        return _of_nibabel(source, frame)
    if frame is not None or series:
        raise InvalidArgumentError("frame= and series= are for files and nibabel's images")
    is_image = hasattr(source, "GetSpacing")
    if is_image and (affine is not None or axes is not None):
        raise InvalidArgumentError("affine= and axes= are for arrays: an image says where its voxels are")
    if is_image and hasattr(source, "GetPointData"):
        return _of_vtk_image(source, space or "lps")
    if is_image and hasattr(source, "GetDirection"):
        if space is not None:
            raise InvalidArgumentError("space= is for arrays and vtkImageData: an ITK image is in LPS")
        return _of_itk(source)
    dtype = getattr(source, "dtype", None)
    if dtype is None or dtype == object:
        _refuse_what_is_no_array(source)
    if affine is None:
        raise InvalidArgumentError("an array needs affine=, (4,4), voxel numbers (x, y, z, 1) to mm; np.eye(4) for "
                                   "voxels of 1 mm with the first one at the origin")
    volume = _volume_of_array(source, affine, space or "ras", _named_axes(source, axes), "array")
    volume._assumed = space is None
    return volume
