# SPDX-License-Identifier: MIT
"""Volumes from arrays and files, their edits, and what is opaque of them."""
import errno
import os
import pathlib
import struct

import numpy as np
import pytest

import voxtact as vx
from conftest import TURN, answers, cube, half_space, noise, oblique, placed, random_poses


def test_an_array_is_not_copied():
    for dtype in (np.uint8, np.int16, np.uint16, np.float32):
        array = noise(dtype)
        volume = vx.read_volume(array, axes="zyx", affine=np.eye(4))
        assert np.shares_memory(volume.array, array) and volume.notes == ()
        assert volume.dtype == dtype and volume.shape == (14, 18, 22)
        assert not volume.array.flags.writeable
        array.setflags(write=False)
        assert np.shares_memory(vx.read_volume(array, axes="zyx", affine=np.eye(4)).array, array)


def test_the_order_of_the_axes_is_said():
    array = noise()
    expected = answers(vx.read_volume(array, axes="zyx", affine=oblique()))
    assert 0 < (expected > 0).sum() < len(expected), "the poses say nothing"
    turned = np.ascontiguousarray(array.transpose(2, 1, 0))  # [x, y, z], C order
    as_nibabel = array.transpose(2, 1, 0)  # [x, y, z], Fortran order
    for axes in (None, "xyz"):  # whatever the order in memory
        volume = vx.read_volume(as_nibabel, affine=oblique(), axes=axes)
        assert np.shares_memory(volume.array, array) and volume.notes == ()
        np.testing.assert_array_equal(answers(volume), expected)
        volume = vx.read_volume(turned, affine=oblique(), axes=axes)
        assert "voxels copied" in volume.notes[0]
        np.testing.assert_array_equal(answers(volume), expected)
    for same in (as_nibabel + 0, np.pad(as_nibabel, 0), as_nibabel.copy()):  # what numpy makes of it
        np.testing.assert_array_equal(answers(vx.read_volume(same, affine=oblique())), expected)
    fortran = np.asfortranarray(array)  # [z, y, x], Fortran order
    np.testing.assert_array_equal(answers(vx.read_volume(fortran, affine=oblique(), axes="zyx")), expected)
    with pytest.raises(vx.InvalidArgumentError, match="axes='yxz'"):
        vx.read_volume(array, affine=np.eye(4), axes="yxz")


def test_strides_of_all_kinds():
    wide = noise(shape=(28, 18, 44))
    part = wide[::2, :, ::2]
    volume = vx.read_volume(part, axes="zyx", affine=oblique())
    assert "copied" in volume.notes[0]
    np.testing.assert_array_equal(volume.array, part)
    np.testing.assert_array_equal(answers(volume), answers(vx.read_volume(part.copy(), axes="zyx", affine=oblique())))
    upside_down = vx.read_volume(noise()[::-1], axes="zyx", affine=oblique())
    np.testing.assert_array_equal(upside_down.array, noise()[::-1])
    raw = np.frombuffer(b"\0" + noise().tobytes(), dtype=np.uint8)[1:].view(np.int16).reshape(14, 18, 22)
    assert "not aligned" in vx.read_volume(raw, axes="zyx", affine=np.eye(4)).notes[0]


@pytest.mark.parametrize("dtype, stored", [("bool", "uint8"), ("int8", "int16"), ("int32", "int16"), ("uint32", "int16"),
                                           ("int64", "int16"), ("float16", "float32"), ("float64", "float32"),
                                           (">i2", "int16"), (">f4", "float32")])
def test_types_become_those_that_there_are(dtype, stored):
    array = (noise() % 2).astype(dtype)
    volume = vx.read_volume(array, axes="zyx", affine=np.eye(4))
    assert volume.dtype == np.dtype(stored)
    np.testing.assert_array_equal(volume.array, array)
    assert dtype == "bool" or len(volume.notes) == 1


def test_whole_numbers_keep_their_values():
    large = np.full((2, 2, 2), 40000, dtype=np.int32)
    assert vx.read_volume(large, axes="zyx", affine=np.eye(4)).dtype == np.uint16
    large[0, 0, 0] = -1
    assert vx.read_volume(large, axes="zyx", affine=np.eye(4)).dtype == np.float32
    large[0, 0, 0] = 2**24 + 1
    with pytest.raises(vx.InvalidArgumentError, match="fit neither"):
        vx.read_volume(large, axes="zyx", affine=np.eye(4))
    with pytest.raises(vx.InvalidArgumentError, match="too large for a float32"):
        vx.read_volume(np.full((2, 2, 2), 1e300), axes="zyx", affine=np.eye(4))
    with pytest.raises(vx.InvalidArgumentError, match="complex128"):
        vx.read_volume(np.zeros((2, 2, 2), dtype=complex), axes="zyx", affine=np.eye(4))


def test_spaces():
    array = half_space()
    lps = vx.read_volume(array, axes="zyx", affine=np.eye(4), space="lps")
    ras = vx.read_volume(array, axes="zyx", affine=vx.LPS_FROM_RAS)
    np.testing.assert_array_equal(ras.world_from_index, lps.world_from_index)
    np.testing.assert_array_equal(ras.affine, vx.LPS_FROM_RAS)
    assert vx.read_volume(array, axes="zyx", affine=oblique()).direction @ np.diag([1, 1, 1]) == pytest.approx(
        np.diag([-1, -1, 1]) @ TURN)
    assert vx.read_volume(array, axes="zyx", affine=oblique()).spacing == pytest.approx([0.7, 1.1, 2.3])
    with pytest.raises(vx.InvalidArgumentError, match="space='sar'"):
        vx.read_volume(array, axes="zyx", affine=np.eye(4), space="sar")
    np.testing.assert_array_equal(vx.read_volume(array, affine=np.eye(4), space="RAS").affine, np.eye(4))


@pytest.mark.parametrize("array, affine, text", [
    (np.zeros((3, 3)), np.eye(4), "three dimensions"),
    (np.zeros((3, 3, 3)), None, "needs affine="),
    (np.zeros((3, 3, 3)), np.eye(3), r"\(4, 4\) is needed"),
    (np.zeros((3, 3, 3)), np.full((4, 4), np.nan), "not finite"),
    (np.zeros((3, 3, 3)), np.zeros((4, 4)), "last row"),
    (np.zeros((3, 3, 3)), np.diag([1, 0, 1, 1]), "0 mm"),
    (np.zeros((3, 3, 3)), [[1, 1, 0, 0], [1, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], "singular"),
    (np.full((3, 3, 3), np.nan), np.eye(4), "nan|NaN"),
    (np.zeros((0, 3, 3)), np.eye(4), "size|empty"),
    (np.array([["a"]] * 3), np.eye(4), "three dimensions"),
])
def test_what_is_wrong_is_named(array, affine, text):
    with pytest.raises(vx.InvalidArgumentError, match=text):
        vx.read_volume(array, axes="zyx", affine=affine)


def test_an_array_of_it():
    volume = vx.read_volume(noise(), affine=oblique(), axes="zyx")
    assert np.shares_memory(np.asarray(volume), volume.array)
    np.testing.assert_array_equal(np.asarray(volume, dtype=float), noise())
    assert np.array(volume).flags.writeable and np.max(volume) == noise().max()


def test_a_missing_file_is_the_one_of_python(tmp_path):
    for ask in (lambda: vx.read_volume(tmp_path / "no.nii"), lambda: vx.read_mesh(tmp_path / "no.stl"),
                lambda: vx.read_poses(tmp_path / "no.txt"), lambda: vx.read_label_names(tmp_path / "no.txt"),
                lambda: vx.read_volume(noise(), affine=np.eye(4)).write(tmp_path / "no" / "no.nii")):
        with pytest.raises(FileNotFoundError) as caught:
            ask()
        assert isinstance(caught.value, vx.FileError) and caught.value.errno == errno.ENOENT
        assert pathlib.Path(caught.value.filename).name.startswith("no.") and caught.value.filename in str(caught.value)
    (tmp_path / "half.nhdr").write_text("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: gone.raw\n")
    with pytest.raises(vx.FileError) as caught:
        vx.read_volume(tmp_path / "half.nhdr")
    assert not isinstance(caught.value, FileNotFoundError) or caught.value.filename.endswith("gone.raw")


def test_other_objects_are_refused_by_name():
    for thing in (3, object(), {"a": 1}, None):
        with pytest.raises(TypeError, match="no volume can be made of a builtins"):
            vx.read_volume(thing)
    with pytest.raises(vx.FileError, match="nowhere.nii"):
        vx.read_volume("nowhere.nii")
    with pytest.raises(OSError):
        vx.read_volume(b"/nowhere/\xff.nii")
    with pytest.raises(vx.InvalidArgumentError, match="a file says where"):
        vx.read_volume("nowhere.nii", affine=np.eye(4))


def test_edits(head, knife):
    scene = vx.Scene(vx.read_volume(half_space(np.int16), axes="zyx", affine=np.eye(4), space="lps"), opacity=[(99, 0), (101, 1)])
    touching, free = placed((4, 4, 4)), placed((9, 4, 4))
    assert scene.count(cube(), touching).touches[0] and not scene.count(cube(), free).touches[0]
    scene.edit(ball=(4, 4, 4, 3), value=-1000)
    assert not scene.count(cube(), touching).touches[0]
    scene.edit(box=(8, 3, 3, 2, 2, 2), value=200)
    assert scene.count(cube(), free).touches[0]
    scene.edit(at=(8, 3, 3), voxels=np.zeros((2, 2, 2)))
    assert not scene.count(cube(), free).touches[0]
    scene.edit(at=(0, 0, 0), voxels=np.ascontiguousarray(half_space(np.int16)))
    assert scene.count(cube(), touching).touches[0]
    assert (scene.volume.array == half_space()).all(), "the volume itself is not edited"
    for wrong, text in (({"ball": (1, 2, 3), "value": 1}, "four numbers"), ({"ball": (1, 2, 3, -4), "value": 1}, "radius"),
                        ({"ball": (1, 2, 3, 4), "value": 1.5}, "1.5"), ({"ball": (1, 2, 3, 4), "value": 40000}, "40000"),
                        ({"box": (0, 0, 0, 99, 1, 1), "value": 1}, "box"), ({"box": (0, 0, -1, 1, 1, 1), "value": 1}, "box"),
                        ({"at": (0, 0, 0), "voxels": [[[70000]]]}, "do not all fit"), ({"value": 3}, "one of"),
                        ({"at": (0, 0, 0), "voxels": np.zeros((2, 2))}, "three dimensions"),
                        ({"ball": (1, 2, 3, 4)}, "value="), ({"at": (11, 0, 0), "voxels": np.zeros((1, 1, 2))}, "box"),
                        ({"ball": (1, 2, 3, 4), "box": (0, 0, 0, 1, 1, 1), "value": 3}, "one of")):
        with pytest.raises(vx.InvalidArgumentError, match=text):
            scene.edit(**wrong)


def test_opacity_and_threshold(scene, knife):
    poses = random_poses(30, 5)
    before = scene.count(knife, poses).count
    scene.opacity = [(100, 0), (200, 1)]
    after = scene.count(knife, poses).count
    assert (after <= before).all() and (after < before).any()
    np.testing.assert_array_equal(scene.opacity, [(100, 0), (200, 1)])
    scene.opacity = "40:0,80:1"
    np.testing.assert_array_equal(scene.count(knife, poses).count, before)
    scene.threshold = 0.0
    assert scene.count(knife, poses).count.sum() > before.sum() and scene.threshold == 0
    for wrong in (2, -1, float("nan")):
        with pytest.raises(vx.InvalidArgumentError, match="threshold"):
            scene.threshold = wrong
    for wrong in ([(80, 1), (40, 0)], [(0, 2)], [1, 2], [], "a:b"):
        with pytest.raises((vx.InvalidArgumentError, vx.FormatError)):
            scene.opacity = wrong
    assert scene.threshold == 0 and scene.opacity.tolist() == [[40, 0], [80, 1]]


def test_words():
    scene = vx.Scene(vx.read_volume("builtin:ct:32"), "0:0,300:1", 0.2, domain=(-1000, 2000), table_size=1024)
    assert repr(scene) == "<voxtact.Scene of 'ct', 32 x 32 x 11: opacity 0:0, 300:1, threshold 0.2, on the host>"
    assert "int16" in repr(scene.volume) and "mm" in repr(scene.volume) and scene.domain == (-1000, 2000)
    assert repr(cube()) == "<voxtact.Mesh 'arrays': 12 triangles, 8 vertices, 2 x 2 x 2 mm>"
    answer = scene.count(cube(150), placed((0, 0, 0), (500, 0, 0)))
    assert repr(answer) == "<voxtact.Count: 1 of 2 poses touch; certified, cpu>"
    assert repr(scene.distance(cube(150), np.eye(4))).startswith("<voxtact.Distance of 1 poses: min 0 to 0 mm")


def test_large_whole_numbers_are_not_rounded():
    for dtype, numbers in ((np.int64, [2**60 + 1, 2**60]), (np.uint64, [2**63, 2**63 + 1]), (np.int32, [2**24 + 1, 0]),
                           (np.int64, [-2**63, 1 - 2**63]), (np.uint64, [2**64 - 1, 0])):
        with pytest.raises(vx.InvalidArgumentError, match="exactly"):
            vx.read_volume(np.array([[numbers]], dtype), axes="zyx", affine=np.eye(4))
    for dtype, numbers in ((np.int64, [2**60, -2**63]), (np.uint64, [2**63, 2**24 - 1]), (np.int32, [2**24, -2**31])):
        volume = vx.read_volume(np.array([[numbers]], dtype), axes="zyx", affine=np.eye(4))
        assert volume.dtype == np.float32 and [int(voxel) for voxel in volume.array[0, 0]] == numbers


def test_edits_that_the_voxels_cannot_have():
    floats = vx.Scene(vx.read_volume(np.zeros((2, 2, 2), np.float32), axes="zyx", affine=np.eye(4)), opacity=[(0, 0), (1, 1)])
    floats.edit(at=(0, 0, 0), voxels=[[[0.1]]])
    for voxels in ([[[2**24 + 1]]], [[[np.inf]]], [[[1e300]]]):
        with pytest.raises(vx.InvalidArgumentError):
            floats.edit(at=(0, 0, 0), voxels=voxels)
    bytes_ = vx.Scene(vx.read_volume(np.zeros((2, 2, 2), np.uint8), axes="zyx", affine=np.eye(4)))
    for voxels in ([[[10**30]]], [[[256]]], [[[1.5]]], [[[np.nan]]], [[[-1]]]):
        with pytest.raises(vx.InvalidArgumentError):
            bytes_.edit(at=(0, 0, 0), voxels=voxels)
    for voxels in ([[["5"]]], [[[1j]]], np.zeros((1, 1, 1), "datetime64[s]")):
        for scene in (floats, bytes_):
            with pytest.raises(TypeError, match="numbers are needed"):
                scene.edit(at=(0, 0, 0), voxels=voxels)


def test_edits_do_not_pile_up():
    scene = vx.Scene(vx.read_volume(np.zeros((64, 64, 65), np.int16), axes="zyx", affine=np.eye(4)), opacity=[(0, 0), (1, 1)])
    voxels = np.zeros((64, 64, 64), np.int16)

    def resident():
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    scene.edit(at=(0, 0, 0), voxels=voxels)
    before = resident()
    for _ in range(200):
        scene.edit(at=(0, 0, 0), voxels=voxels)
    assert resident() - before < 30 * voxels.nbytes


def test_names_that_mean_something_else(tmp_path, knife):
    with pytest.raises(vx.InvalidArgumentError, match="null"):
        knife.write(str(tmp_path / "a\0.stl"))
    with pytest.raises(vx.InvalidArgumentError, match="frame="):
        vx.read_volume("builtin:head:16", frame=3)
    assert not list(tmp_path.iterdir())


def test_paths_in_a_list(tmp_path):
    for affine in (None, np.eye(4)):
        for paths in (["a.dcm", "b.dcm"], [tmp_path / "a.dcm"], (b"a.dcm",)):
            with pytest.raises(TypeError, match="folder"):
                vx.read_volume(paths, axes="zyx", affine=affine)


@pytest.mark.filterwarnings("error")
def test_an_affine_beyond_measure():
    with pytest.raises(vx.InvalidArgumentError):
        vx.read_volume(noise(), axes="zyx", affine=np.diag([1e200, 1, 1, 1]))


def dicom_slice(height: float) -> bytes:
    """Explicit VR little endian without a preamble: 2 x 2 pixels that are 10 times as high as they lie."""
    def element(group: int, number: int, kind: str, value: bytes) -> bytes:
        value += b"" if len(value) % 2 == 0 else b"\0" if kind == "UI" else b" "
        size = b"\0\0" + struct.pack("<I", len(value)) if kind == "OW" else struct.pack("<H", len(value))
        return struct.pack("<HH", group, number) + kind.encode() + size + value

    def short(number: int) -> bytes:
        return struct.pack("<H", number)

    return b"".join([
        element(0x0008, 0x0016, "UI", b"1.2.840.10008.5.1.4.1.1.2"), element(0x0008, 0x0060, "CS", b"CT"),
        element(0x0020, 0x000E, "UI", b"1.2.3.4"), element(0x0020, 0x0032, "DS", f"0\\0\\{height}".encode()),
        element(0x0020, 0x0037, "DS", b"1\\0\\0\\0\\1\\0"), element(0x0028, 0x0002, "US", short(1)),
        element(0x0028, 0x0004, "CS", b"MONOCHROME2"), element(0x0028, 0x0010, "US", short(2)),
        element(0x0028, 0x0011, "US", short(2)), element(0x0028, 0x0030, "DS", b"1\\1"),
        element(0x0028, 0x0100, "US", short(16)), element(0x0028, 0x0101, "US", short(16)),
        element(0x0028, 0x0102, "US", short(15)), element(0x0028, 0x0103, "US", short(0)),
        element(0x7FE0, 0x0010, "OW", short(round(10 * height)) * 4)])


def test_uneven_slices_are_resampled_where_that_is_asked_for(tmp_path):
    for height in (0, 1, 3, 4):
        (tmp_path / f"s{height}").write_bytes(dicom_slice(height))
    with pytest.raises(vx.FormatError, match="a slice is missing"):
        vx.read_volume(tmp_path)
    volume = vx.read_volume(tmp_path, resample=True)
    assert volume.array.dtype == np.float32 and any("resampled to a regular grid" in note for note in volume.notes)
    np.testing.assert_array_equal(volume.array[:, 1, 1], [0, 10, 20, 30, 40])
    with pytest.raises(vx.InvalidArgumentError, match="labels are not interpolated"):
        vx.read_labels(tmp_path, resample=True)
    for source in ("builtin:head:16", noise(), vx.read_volume("builtin:head:16")):
        with pytest.raises(vx.InvalidArgumentError, match="resample= is for a folder"):
            vx.read_volume(source, resample=True)


def test_poses_are_translations_and_quaternions(tmp_path):
    (tmp_path / "poses.txt").write_text("7 8 9 0.5 0.5 0.5 0.5\n")
    for name in ("t-xyzw", "t-wxyz"):
        np.testing.assert_array_equal(vx.read_poses(tmp_path / "poses.txt", name),
                                      [[[0, 0, 1, 7], [1, 0, 0, 8], [0, 1, 0, 9], [0, 0, 0, 1]]])
    with pytest.raises(vx.FormatError, match="16"):
        vx.read_poses(tmp_path / "poses.txt")
    with pytest.raises(vx.InvalidArgumentError, match="'quaternion' is unknown; choose from: matrix, t-xyzw"):
        vx.read_poses(tmp_path / "poses.txt", "quaternion")
