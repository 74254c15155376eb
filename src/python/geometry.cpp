// SPDX-License-Identifier: MIT
#include "geometry.h"

#include "arrays.h"
#include "failure.h"
#include "image.h"
#include "lock.h"

#include <vector>

namespace voxtact::python {

namespace {

std::vector<Box> boxesOf(const Doubles& rows, const char* what) {
    if (rows.ndim() != 3 || rows.shape(1) != 2 || rows.shape(2) != 3) {
        refuseArgument(std::string(what) + " are no (N,2,3): the least and the greatest corner of each");
    }
    std::vector<Box> boxes(static_cast<std::size_t>(rows.shape(0)));
    const double* from = rows.data();
    for (Box& box : boxes) {
        for (Vec3* corner : {&box.lo, &box.hi}) {
            std::copy_n(from, corner->size(), corner->begin());
            from += corner->size();
        }
    }
    return boxes;
}

py::array_t<double> boxesInPython(const std::vector<Box>& boxes) {
    py::array_t<double> rows({static_cast<py::ssize_t>(boxes.size()), py::ssize_t{2}, py::ssize_t{3}});
    double* to = rows.mutable_data();
    for (const Box& box : boxes) {
        to = std::copy(box.lo.begin(), box.lo.end(), to);
        to = std::copy(box.hi.begin(), box.hi.end(), to);
    }
    return rows;
}

py::array_t<std::uint32_t> overlapping(const Doubles& left, const py::object& right) {
    const std::vector<Box> boxes = boxesOf(left, "boxes");
    std::vector<Box> others;
    const bool two = !right.is_none();
    if (two) {
        others = boxesOf(right.cast<Doubles>(), "others");
    }
    std::vector<BoxPair> pairs;
    {
        const Unlocked unlocked;
        pairs = take(two ? overlappingPairs(boxes, others) : overlappingPairs(boxes));
    }
    py::array_t<std::uint32_t> rows({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
    std::uint32_t* to = rows.mutable_data();
    for (const BoxPair& pair : pairs) {
        *to++ = pair.first;
        *to++ = pair.second;
    }
    return rows;
}

py::array_t<double> meshBoxes(const Shape& shape, const Doubles& poses) {
    std::vector<Box> boxes;
    for (const Mat4& pose : matricesOf(poses, "poses")) {
        take(checkAffine(pose, "pose " + std::to_string(boxes.size())));
        boxes.push_back(transformBox(pose, shape.facts().bounds));
    }
    return boxesInPython(boxes);
}

} // namespace

void defineGeometry(py::module_& module) {
    module.def("overlapping_pairs", &overlapping, py::arg("boxes"), py::arg("others"));
    module.def("mesh_boxes", &meshBoxes, py::arg("mesh"), py::arg("poses"));
    module.def(
        "volume_box",
        [](const Image& image) {
            const Box box = transformBox(worldFromTexture(image.data().grid), {{0, 0, 0}, {1, 1, 1}});
            return py::make_tuple(vectorInPython(box.lo), vectorInPython(box.hi));
        },
        py::arg("volume"));
}

} // namespace voxtact::python
