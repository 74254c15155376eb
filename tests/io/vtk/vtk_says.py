# SPDX-License-Identifier: MIT
"""Asks VTK about PolyData. `write FOLDER`: writes one surface in every layout that VTK knows. `read FILE...`: reads
files. Either prints a line per file: `NAME`, then 9 numbers (hexadecimal) for each triangle."""
import itertools
import os
import sys

from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkIOLegacy import vtkPolyDataReader, vtkPolyDataWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter


def cells(lists):
    array = vtkCellArray()
    for corners in lists:
        array.InsertNextCell(len(corners))
        for corner in corners:
            array.InsertCellPoint(corner)
    return array


def surface(double):
    points = vtkPoints()
    points.SetDataType(11 if double else 10)
    for z, y, x in itertools.product(range(3), range(4), range(5)):
        points.InsertNextPoint(0.1 * x + 0.01 * z, 1.7 * y - 3, -2.3 * z + 0.001 * x * y)
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetPolys(cells([[0, 1, 6], [0, 6, 5], [20, 25, 21], [40, 41, 47], [59, 58, 40]]))
    data.SetStrips(cells([[0, 5, 1, 6, 2, 7, 3], [20, 21, 25, 26], [40, 45, 41]]))
    data.SetVerts(cells([[0, 3, 4], [7]]))
    data.SetLines(cells([[0, 1, 2, 3], [9, 8]]))
    name = vtkStringArray()
    name.SetName("SPACE")
    name.InsertNextValue("LPS")
    data.GetFieldData().AddArray(name)
    return data


def report(name, data):
    triangles = vtkTriangleFilter()
    triangles.SetInputData(data)
    triangles.PassVertsOff()
    triangles.PassLinesOff()
    triangles.Update()
    out = triangles.GetOutput()
    numbers = []
    for i in range(out.GetNumberOfCells()):
        for j in range(3):
            numbers += out.GetPoint(out.GetCell(i).GetPointId(j))
    print(name, *(number.hex() for number in numbers))


def write(folder):
    os.chdir(folder)
    for double, binary, version in itertools.product((0, 1), (0, 1), (42, 51)):
        writer = vtkPolyDataWriter()
        writer.SetFileName(f"legacy_{double}{binary}{version}.vtk")
        writer.SetInputData(surface(double))
        writer.SetFileType(2 if binary else 1)
        writer.SetFileVersion(version)
        writer.Write()
        report(writer.GetFileName(), surface(double))
    for double, mode, coded, packed, wide, big in itertools.product((0, 1), "012", (0, 1), (0, 1), (0, 1), (0, 1)):
        writer = vtkXMLPolyDataWriter()
        writer.SetFileName(f"xml_{double}{mode}{coded}{packed}{wide}{big}.vtp")
        writer.SetInputData(surface(double))
        writer.SetDataMode(int(mode))
        writer.SetEncodeAppendedData(coded)
        writer.SetCompressorTypeToZLib() if packed else writer.SetCompressorTypeToNone()
        writer.SetBlockSize(256)  # several blocks in an array
        writer.SetHeaderType(64 if wide else 32)
        writer.SetByteOrder(0 if big else 1)
        writer.Write()
        report(writer.GetFileName(), surface(double))


def read(names):
    for name in names:
        reader = vtkPolyDataReader() if name.endswith(".vtk") else vtkXMLPolyDataReader()
        reader.SetFileName(name)
        reader.Update()
        report(os.path.basename(name), reader.GetOutput())


write(sys.argv[2]) if sys.argv[1] == "write" else read(sys.argv[2:])
