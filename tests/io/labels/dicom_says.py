# SPDX-License-Identifier: MIT
"""Asks pydicom about label maps. `seg FOLDER`: writes segmentations; `rtstruct FOLDER`: writes structure sets. Prints a
line per file: `NAME`, the sizes, the labels of all voxels, x fastest, as numpy makes them from what pydicom decodes."""
import os
import sys

import numpy
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.filereader import dcmread
from pydicom.pixel_data_handlers.numpy_handler import pack_bits
from pydicom.sequence import Sequence
from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian

rng = numpy.random.default_rng(7)


def item(**elements):
    data = Dataset()
    for name, value in elements.items():
        setattr(data, name, value)
    return data


def start(sop_class, implicit):
    data = item(SOPClassUID=sop_class, SOPInstanceUID="1.2.3", FrameOfReferenceUID="1.2.4")
    data.file_meta = FileMetaDataset()
    data.file_meta.MediaStorageSOPClassUID = sop_class
    data.file_meta.MediaStorageSOPInstanceUID = "1.2.3"
    data.file_meta.TransferSyntaxUID = ImplicitVRLittleEndian if implicit else ExplicitVRLittleEndian
    data.is_little_endian, data.is_implicit_VR = True, implicit
    return data


def report(name, labels):
    print(name, *reversed(labels.shape), *labels.ravel())


def write_seg(name, columns, rows, slices, segments, fractional, implicit):
    data = start("1.2.840.10008.5.1.4.1.1.66.4", implicit)
    data.Modality, data.ImageType = "SEG", ["DERIVED", "PRIMARY"]
    data.Rows, data.Columns = rows, columns
    data.SamplesPerPixel, data.PhotometricInterpretation, data.PixelRepresentation = 1, "MONOCHROME2", 0
    bits = 8 if fractional else 1
    data.BitsAllocated, data.BitsStored, data.HighBit = bits, bits, bits - 1
    data.SegmentationType = "FRACTIONAL" if fractional else "BINARY"
    if fractional:
        data.MaximumFractionalValue, data.SegmentationFractionalType = 200, "PROBABILITY"
    data.SegmentSequence = Sequence(
        [item(SegmentNumber=n + 1, SegmentLabel=f"segment {n + 1}") for n in range(segments)])
    measures = item(PixelSpacing=[0.8, 0.5], SliceThickness=2.5, SpacingBetweenSlices=2.5)
    data.SharedFunctionalGroupsSequence = Sequence([item(
        PixelMeasuresSequence=Sequence([measures]),
        PlaneOrientationSequence=Sequence([item(ImageOrientationPatient=[1, 0, 0, 0, 0, -1])]))])
    owner = rng.integers(0, segments + 2, (slices, rows, columns))
    owner[owner > segments] = 0
    owner[1:-1][rng.random(slices - 2) < 0.4] = 0  # slices without a frame
    frames, groups = [], []
    for segment in range(1, segments + 1):
        for z in rng.permutation(slices):
            mask = owner[z] == segment
            if not mask.any():
                continue
            frames.append(numpy.where(mask, rng.integers(100, 201, mask.shape), rng.integers(0, 100, mask.shape))
                          if fractional else mask)
            groups.append(item(
                SegmentIdentificationSequence=Sequence([item(ReferencedSegmentNumber=segment)]),
                PlanePositionSequence=Sequence([item(ImagePositionPatient=[-10, 20 + 2.5 * int(z), 5])])))
    data.PerFrameFunctionalGroupsSequence, data.NumberOfFrames = Sequence(groups), len(frames)
    stored = numpy.stack(frames).astype("uint8")
    packed = stored.tobytes() if fractional else bytes(pack_bits(stored))
    data.PixelData = packed + b"\0" * (len(packed) % 2)
    data["PixelData"].VR = "OB" if not implicit else "OW"
    data.save_as(name, write_like_original=False)
    # What pydicom makes of it again; the normal is +y, so the slices go up with it.
    back = dcmread(name)
    labels = numpy.zeros_like(owner)
    for frame, group in zip(back.pixel_array.reshape(-1, rows, columns), back.PerFrameFunctionalGroupsSequence):
        z = round((group.PlanePositionSequence[0].ImagePositionPatient[1] - 20) / 2.5)
        inside = frame.astype(int) * 2 >= back.MaximumFractionalValue if fractional else frame > 0
        labels[z][inside] = group.SegmentIdentificationSequence[0].ReferencedSegmentNumber
    used = numpy.flatnonzero((labels > 0).any((1, 2)))
    report(name, labels[used[0]:used[-1] + 1])


def inside(contours, x, y):
    """Even-odd, by the sum of crossings of the ray to +x."""
    odd = numpy.zeros(x.shape, bool)
    for contour in contours:
        for (x0, y0), (x1, y1) in zip(contour, numpy.roll(contour, -1, 0)):
            if y0 == y1:
                continue
            across = (y0 > y) != (y1 > y)
            odd ^= across & (x < (x1 - x0) * (y - y0) / (y1 - y0) + x0)
    return odd


def write_rtstruct(name, implicit):
    """On a grid of 20 x 16 x 6 voxels of 0.5 x 0.8 x 2.5 mm from (-3, 4, 7)."""
    data = start("1.2.840.10008.5.1.4.1.1.481.3", implicit)
    data.Modality = "RTSTRUCT"
    y, x = numpy.mgrid[0:16, 0:20].astype(float)
    labels = numpy.zeros((6, 16, 20), int)
    regions, rois = [], []
    for number, centre in ((3, 5.1), (9, 14.3)):
        contours = []
        for z in range(1 + number % 2, 5):
            angles = numpy.sort(rng.random(40)) * 2 * numpy.pi
            radii = 2 + 1.5 * rng.random(40)
            outer = numpy.stack([centre + radii * numpy.cos(angles), 7.6 + 2 * radii * numpy.sin(angles)], 1)
            ring = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * 0.93 + [centre, 7.63]
            if z % 2:  # a hole as a contour of its own, else by a keyhole
                polygons = [outer, ring]
            else:
                polygons = [numpy.concatenate([outer, outer[:1], ring[::-1], ring[-1:], outer[:1]])]
            labels[z][inside(polygons, x, y)] = number
            for polygon in polygons:
                points = numpy.stack([-3 + 0.5 * polygon[:, 0], 4 + 0.8 * polygon[:, 1],
                                      numpy.full(len(polygon), 7 + 2.5 * z)], 1)
                contours.append(item(ContourGeometricType="CLOSED_PLANAR", NumberOfContourPoints=len(points),
                                     ContourData=[f"{value:.9g}" for value in points.ravel()]))
        rois.append(item(ROINumber=number, ROIName=f"region {number}", ReferencedFrameOfReferenceUID="1.2.4"))
        regions.append(item(ReferencedROINumber=number, ContourSequence=Sequence(contours)))
    data.StructureSetROISequence, data.ROIContourSequence = Sequence(rois), Sequence(regions)
    data.save_as(name, write_like_original=False)
    report(name, labels)


os.chdir(sys.argv[2])
if sys.argv[1] == "seg":
    write_seg("a.dcm", 7, 5, 9, 3, False, False)
    write_seg("b.dcm", 16, 3, 4, 1, False, True)
    write_seg("c.dcm", 3, 1, 12, 2, False, False)
    write_seg("d.dcm", 7, 5, 9, 3, True, False)
else:
    for i in range(4):
        write_rtstruct(f"{i}.dcm", i % 2 == 1)
