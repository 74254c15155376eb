# SPDX-License-Identifier: MIT
"""Volumes from the objects of other libraries: the same answers, wherever they come from."""
import os
import types

import numpy as np
import pytest

import voxtact as vx
from conftest import answers, noise, oblique, program


def same_place(volume, expected):
    np.testing.assert_allclose(volume.world_from_index, expected.world_from_index, rtol=1e-6, atol=1e-5)
    np.testing.assert_array_equal(volume.array, expected.array)


@pytest.fixture(params=["head", "ct", "oblique"])
def nifti(request, tmp_path):
    path = tmp_path / "volume.nii.gz"
    if request.param == "oblique":
        vx.read_volume(noise(), axes="zyx", affine=oblique()).write(path)
    else:
        program("make", "volume", f"builtin:{request.param}:24", path, cwd=tmp_path)
    return path


def test_nibabel(nifti, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    image, expected = nibabel.load(nifti), vx.read_volume(nifti)
    volume = vx.read_volume(image)
    same_place(volume, expected)
    np.testing.assert_array_equal(answers(volume), answers(expected))
    np.testing.assert_allclose(volume.affine, image.affine, atol=1e-5)
    rounded = vx.read_volume(image.get_fdata(), affine=image.affine, axes="xyz")
    np.testing.assert_array_equal(answers(rounded), answers(expected))


def test_an_image_says_itself_where_it_is(nifti):
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.load(nifti)
    for option in ({"affine": np.eye(4)}, {"space": "lps"}, {"axes": "zyx"}, {"series": "1.2"}, {"frame": 5}):
        with pytest.raises(vx.InvalidArgumentError):
            vx.read_volume(image, **option)
        with pytest.raises(vx.InvalidArgumentError, match="a Volume is taken as it is"):
            vx.read_volume(vx.read_volume(nifti), **option)
    same_place(vx.read_volume(image, frame=0), vx.read_volume(nifti))


def test_nibabel_scaling_units_and_frames(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    path = tmp_path / "scaled.nii"
    affine = oblique(spacing=(0.001, 0.001, 0.002), origin=(0, 0.01, 0))
    image = nibabel.Nifti1Image(noise(shape=(6, 7, 8, 3)), affine)
    image.header.set_xyzt_units("meter")
    image.header.set_slope_inter(0.5, -3)
    nibabel.save(image, path)
    with pytest.raises(vx.InvalidArgumentError, match="holds 3 volumes"):
        vx.read_volume(nibabel.load(path))
    with pytest.raises(vx.InvalidArgumentError, match="frame=3"):
        vx.read_volume(nibabel.load(path), frame=3)
    volume = vx.read_volume(nibabel.load(path), frame=2)
    same_place(volume, vx.read_volume(path, frame=2))
    assert any("from meter to mm" in note for note in volume.notes)


def test_shears_are_refused_as_of_the_file_or_noted(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    voxels = noise(shape=(6, 7, 8))
    for shear, accepted in (0.0, True), (0.001, True), (0.1, False):  # 0.057 and 5.7 degrees
        affine = np.eye(4)
        affine[0, 1] = shear
        image = nibabel.Nifti1Image(voxels, affine)
        image.set_qform(None, 0)
        image.set_sform(affine, 1)
        path = tmp_path / "sheared.nii"
        nibabel.save(image, path)
        notes = vx.read_volume(voxels, affine=affine, axes="xyz").notes
        assert any("sheared by" in note for note in notes) == (shear > 0)
        if accepted:
            same_place(vx.read_volume(nibabel.load(path)), vx.read_volume(path))
            continue
        with pytest.raises(vx.Error, match="shears the image by 5.7"):
            vx.read_volume(path)
        with pytest.raises(vx.InvalidArgumentError, match="shears it by 5.71 degrees.*hand over its array"):
            vx.read_volume(nibabel.load(path))


def test_vtk(nifti):
    vtk_util = pytest.importorskip("vtkmodules.util.numpy_support")
    from vtkmodules.vtkCommonDataModel import vtkImageData

    expected = vx.read_volume(nifti)
    z, y, x = expected.shape
    image = vtkImageData()
    image.SetDimensions(x, y, z)
    image.SetSpacing(*expected.spacing)
    image.SetOrigin(*expected.origin)
    image.SetDirectionMatrix(*expected.direction.ravel())
    image.GetPointData().SetScalars(vtk_util.numpy_to_vtk(expected.array.ravel()))
    same_place(vx.read_volume(image), expected)
    np.testing.assert_array_equal(answers(vx.read_volume(image)), answers(expected))
    assert vx.read_volume(image, space="ras").origin == pytest.approx(expected.origin * [-1, -1, 1])


class ItkImage:
    """The methods of a SimpleITK image that are asked; the place is LPS."""

    def __init__(self, volume):
        self.volume = volume

    def GetSpacing(self):
        return tuple(self.volume.spacing)

    def GetOrigin(self):
        return tuple(self.volume.origin)

    def GetDirection(self):
        return tuple(self.volume.direction.ravel())

    def GetNumberOfComponentsPerPixel(self):
        return 1

    def __array__(self, dtype=None):
        return self.volume.array


def test_simple_itk(nifti):
    expected = vx.read_volume(nifti)
    same_place(vx.read_volume(ItkImage(expected)), expected)
    np.testing.assert_array_equal(answers(vx.read_volume(ItkImage(expected))), answers(expected))


class CutItkImage(ItkImage):
    """What itk cut out of a larger image: the origin is that of the larger one, and the first voxel has a number."""

    first = (2, -3, 1)

    def GetOrigin(self):
        volume = self.volume
        return tuple(volume.origin - volume.direction @ (volume.spacing * self.first))

    def GetBufferedRegion(self):
        return types.SimpleNamespace(GetIndex=lambda: self.first)


def test_part_of_an_itk_image(nifti):
    expected = vx.read_volume(nifti)
    same_place(vx.read_volume(CutItkImage(expected)), expected)


class NamedArray:
    """What xarray.DataArray has."""

    def __init__(self, array, dims):
        self.array, self.dims = array, dims

    def __array__(self, dtype=None):
        return self.array


def test_named_dimensions():
    array = noise()
    expected = vx.read_volume(array, axes="zyx", affine=oblique())
    same_place(vx.read_volume(NamedArray(array, ("z", "y", "x")), affine=oblique()), expected)
    turned = vx.read_volume(NamedArray(np.ascontiguousarray(array.T), ("x", "y", "z")), affine=oblique())
    same_place(turned, expected)
    np.testing.assert_array_equal(turned.array, expected.array)
    same_place(vx.read_volume(NamedArray(np.ascontiguousarray(array.T), ("X", "Y", "Z")), affine=oblique()), expected)
    same_place(vx.read_volume(NamedArray(array, ("slice", "row", "column")), axes="zyx", affine=oblique()), expected)
    for dims, axes in ((("z", "y", "x"), "xyz"), (("x", "y", "z"), "zyx"), (("time", "y", "x"), None), (("time", "y", "x"), "zyx")):
        with pytest.raises(vx.InvalidArgumentError, match="dimensions are"):
            vx.read_volume(NamedArray(array, dims), affine=oblique(), axes=axes)
    np.testing.assert_array_equal(vx.read_volume(NamedArray(array, ("time", "row", "column")), axes="zyx", affine=oblique()).array, array)
    with pytest.raises(vx.InvalidArgumentError, match=r"dimensions are \('y', 'z', 'x'\)"):
        vx.read_volume(NamedArray(array, ("y", "z", "x")), affine=oblique())


class Thing:
    """Of which numpy makes an array of one object, as of a dataset of pydicom."""

    def __array__(self, dtype=None):
        out = np.empty((), dtype=object)
        out[()] = self
        return out


@pytest.mark.parametrize("source", [Thing(), [Thing(), Thing()], {}, object()])
def test_what_is_no_volume(source):
    with pytest.raises(TypeError, match="no volume can be made of"):
        vx.read_volume(source)


def test_dicom_by_pydicom(tmp_path):
    """Slices that pydicom wrote, read by us from their folder and by pydicom into an array."""
    pydicom = pytest.importorskip("pydicom")
    from pydicom.dataset import FileDataset, FileMetaDataset
    from pydicom.uid import CTImageStorage, ExplicitVRLittleEndian, generate_uid

    array = noise(shape=(5, 8, 9))
    rows, columns, normal = np.array([0.96, 0.28, 0]), np.array([-0.28, 0.96, 0]), np.array([0, 0, 1])
    series, study, frame = generate_uid(), generate_uid(), generate_uid()
    for number, voxels in enumerate(array):
        meta = FileMetaDataset()
        meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID = CTImageStorage, generate_uid()
        meta.TransferSyntaxUID = ExplicitVRLittleEndian
        dicom = FileDataset(None, {}, file_meta=meta, preamble=b"\0" * 128)
        dicom.is_little_endian, dicom.is_implicit_VR = True, False
        dicom.SOPClassUID, dicom.SOPInstanceUID = CTImageStorage, meta.MediaStorageSOPInstanceUID
        dicom.SeriesInstanceUID, dicom.StudyInstanceUID, dicom.FrameOfReferenceUID = series, study, frame
        dicom.Modality, dicom.InstanceNumber = "CT", number + 1
        dicom.Rows, dicom.Columns, dicom.PixelSpacing = 8, 9, [1.5, 0.5]
        dicom.ImageOrientationPatient = [*rows, *columns]
        dicom.ImagePositionPatient = [*(np.array([10.0, -5, 3]) + 2.5 * number * normal)]
        dicom.BitsAllocated, dicom.BitsStored, dicom.HighBit, dicom.PixelRepresentation = 16, 16, 15, 1
        dicom.SamplesPerPixel, dicom.PhotometricInterpretation = 1, "MONOCHROME2"
        dicom.RescaleSlope, dicom.RescaleIntercept = 1, 0
        dicom.PixelData = voxels.tobytes()
        dicom.save_as(tmp_path / f"{number}.dcm", write_like_original=False)
    slices = [pydicom.dcmread(path) for path in sorted(tmp_path.iterdir())]
    affine = np.eye(4)
    affine[:3, :3] = np.stack([rows * 0.5, columns * 1.5, normal * 2.5], axis=1)
    affine[:3, 3] = slices[0].ImagePositionPatient
    volume = vx.read_volume(np.stack([one.pixel_array for one in slices]), axes="zyx", affine=affine, space="lps")
    same_place(volume, vx.read_volume(tmp_path))


def test_files_of_all_formats(tmp_path):
    expected = vx.read_volume(noise(), axes="zyx", affine=oblique())
    for ending in ("nii", "nii.gz", "nrrd", "mha"):
        expected.write(tmp_path / f"volume.{ending}")
        same_place(vx.read_volume(os.fspath(tmp_path / f"volume.{ending}")), expected)
    with pytest.raises(vx.InvalidArgumentError, match="jpg"):
        expected.write(tmp_path / "volume.jpg")


def test_what_nibabel_cannot_place(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    path = tmp_path / "unset.nii"
    nibabel.save(nibabel.Nifti1Image(noise(), None), path)
    assert "qform and sform are unset" in vx.read_volume(path).notes[0]
    volume = vx.read_volume(nibabel.load(path))
    assert "qform and sform are unset" in volume.notes[0]
    same_place(volume, vx.read_volume(path))
    same_place(vx.read_volume(nibabel.spatialimages.SpatialImage(noise(), np.eye(4))),
               vx.read_volume(noise(), affine=np.eye(4), axes="xyz"))
    with pytest.raises(vx.InvalidArgumentError, match="no affine"):
        vx.read_volume(nibabel.Nifti1Image(noise(), None))
    with pytest.raises(vx.InvalidArgumentError, match=r"shape \(3, 4, 5, 1, 2\)"):
        vx.read_volume(nibabel.Nifti1Image(noise(shape=(3, 4, 5, 1, 2)), np.eye(4)), frame=1)


def test_bits_of_vtk():
    vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    image = vtk.vtkImageData()
    image.SetDimensions(3, 4, 5)
    image.AllocateScalars(1, 1)  # VTK_BIT
    with pytest.raises(vx.InvalidArgumentError, match="bits"):
        vx.read_volume(image)


def test_vtk_with_scalars_of_another_size():
    vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    image = vtk.vtkImageData()
    image.SetDimensions(3, 4, 5)
    image.AllocateScalars(3, 1)  # VTK_UNSIGNED_CHAR
    image.GetPointData().GetScalars().SetNumberOfTuples(7)
    with pytest.raises(vx.InvalidArgumentError, match="7 scalars; 3 x 4 x 5"):
        vx.read_volume(image)


@pytest.mark.parametrize("kind", ["?", "u1", "i2", "i4", "u4", "i8", "f2", "f4", "f8"])
def test_empty(kind):
    with pytest.raises(vx.InvalidArgumentError, match="the image is empty"):
        vx.read_volume(np.zeros((0, 3, 3), kind), axes="zyx", affine=np.eye(4))
