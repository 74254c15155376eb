// SPDX-License-Identifier: MIT
#include "request.h"

#include "arrays.h"
#include "failure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace voxtact::python {

namespace {

constexpr std::array kFilters{Filter::Hardware, Filter::Exact};
constexpr std::array kBoundaries{Boundary::Auto, Boundary::Range, Boundary::Clamp};

/// One of `all` by its name.
template <class Name, class All> Name named(const std::string& word, const char* what, const All& all) {
    std::string names;
    for (const Name name : all) {
        if (word == toString(name)) {
            return name;
        }
        names += (names.empty() ? "" : ", ") + std::string(toString(name));
    }
    refuseArgument(std::string(what) + " '" + word + "' is none of " + names);
}

View cameraOf(const py::handle& value) {
    const auto parts = value.cast<py::tuple>();
    if (parts.size() != 3) {
        throw py::cast_error();
    }
    return {matrixOf(numbersOf(parts[0]), "clip_from_world"), parts[1].cast<std::uint32_t>(),
            parts[2].cast<std::uint32_t>()};
}

void read(Question& question, const std::string& name, const py::handle& value) {
    if (name == "projection") {
        question.projection = named<Projection>(value.cast<std::string>(), "projection", projections());
    } else if (name == "method") {
        question.method = named<CountingMethod>(value.cast<std::string>(), "method", countingMethods());
    } else if (name == "filter") {
        question.filter = named<Filter>(value.cast<std::string>(), "filter", kFilters);
    } else if (name == "boundary") {
        question.boundary = named<Boundary>(value.cast<std::string>(), "boundary", kBoundaries);
    } else if (name == "triangles") {
        question.outputs.triangles = value.cast<bool>();
    } else if (name == "contacts") {
        question.outputs.contacts = value.cast<bool>();
    } else if (name == "bounds") {
        question.outputs.bounds = value.cast<bool>();
    } else if (name == "labels") {
        question.outputs.labels = value.cast<bool>();
    } else if (name == "max_depth") {
        question.outputs.maxDepth = value.cast<double>();
        // It is looked at only where contacts are asked for.
        if (!std::isfinite(question.outputs.maxDepth) || question.outputs.maxDepth <= 0) {
            refuseArgument("max_depth is " + py::str(value).cast<std::string>() + "; it must be positive and finite");
        }
    } else if (name == "samples_per_voxel") {
        question.samplesPerVoxel = value.cast<std::uint32_t>();
    } else if (name == "resolution") {
        question.resolution = value.cast<double>();
    } else if (name == "yes_no") {
        question.yesNo = value.cast<bool>();
    } else if (name == "overestimate") {
        question.overestimate = value.cast<bool>();
    } else if (name == "counters") {
        question.counters = value.cast<bool>();
    } else if (name == "most_contacts") {
        question.mostContacts = value.cast<std::uint32_t>();
    } else if (name == "view") {
        question.view = cameraOf(value);
    } else {
        throw py::type_error("there is no option " + name);
    }
}

/// Of 16 numbers, row by row. Without a branch for each: a hundred thousand poses are looked at.
bool isAffine(const double* rows) noexcept {
    constexpr double kMost = std::numeric_limits<double>::max();
    unsigned finite = 1;
    for (std::size_t i = 0; i < 12; ++i) {
        finite &= static_cast<unsigned>(std::abs(rows[i]) <= kMost);
    }
    return finite != 0 && rows[12] == 0 && rows[13] == 0 && rows[14] == 0 && rows[15] == 1;
}

/// Of one item, in one go over the numbers. All are looked at before any work: a later piece of it would count from its
/// own first pose.
std::vector<Mat4> posesOf(const Doubles& rows, std::size_t item) {
    const std::string which = item == 0 ? "" : "item " + std::to_string(item) + ", ";
    if (rows.ndim() != 3 || rows.shape(1) != 4 || rows.shape(2) != 4) {
        std::vector<Mat4> one = matricesOf(rows, "poses"); // or refuses it
        take(checkAffine(one.front(), which + "pose 0"));
        return one;
    }
    std::vector<Mat4> poses;
    poses.reserve(static_cast<std::size_t>(rows.shape(0)));
    const double* from = rows.data();
    for (py::ssize_t pose = 0; pose < rows.shape(0); ++pose, from += std::tuple_size_v<Mat4>) {
        poses.push_back({from[0], from[4], from[8], from[12], from[1], from[5], from[9], from[13], from[2], from[6],
                         from[10], from[14], from[3], from[7], from[11], from[15]});
        if (!isAffine(from)) {
            take(checkAffine(poses.back(), which + "pose " + std::to_string(pose)));
        }
    }
    return poses;
}

} // namespace

void Request::add(std::shared_ptr<const Shape> mesh, std::vector<Mat4> world_from_object) {
    const std::size_t segmentsBefore = segments();
    const std::size_t poses = world_from_object.size();
    items.push_back({std::move(mesh), std::move(world_from_object), pairs, segmentsBefore});
    pairs += poses;
}

std::size_t Request::segments() const noexcept {
    return items.empty() ? 0 : items.back().firstSegment + items.back().segments();
}

std::size_t Request::mostTriangles() const noexcept {
    std::size_t most = 1;
    for (const Item& item : items) {
        most = std::max<std::size_t>(most, item.mesh->facts().triangles);
    }
    return most;
}

View viewOf(const Question& question, const Grid& grid) {
    constexpr std::uint32_t kPixels = 512;
    if (!usesView(question.projection)) {
        return {};
    }
    return question.view ? *question.view : View{framingCamera(grid, kPixels, kPixels), kPixels, kPixels};
}

Request requestOf(const py::object& meshes, const py::object& poses) {
    Request request;
    const auto add = [&](const py::handle& mesh, const py::handle& matrices) {
        request.add(mesh.cast<std::shared_ptr<Shape>>(), posesOf(numbersOf(matrices), request.items.size()));
    };
    if (py::isinstance<Shape>(meshes)) {
        add(meshes, poses);
    } else {
        for (const py::handle& pair : meshes) {
            const auto item = pair.cast<py::tuple>();
            add(item[0], item[1]);
        }
    }
    return request;
}

void readOptions(const py::dict& options, const std::function<void(const std::string&, const py::handle&)>& read) {
    for (const auto& [key, value] : options) {
        const auto name = key.cast<std::string>();
        try {
            read(name, value);
        } catch (const py::cast_error&) {
            throw py::type_error(name + " cannot be " + py::repr(value).cast<std::string>());
        }
    }
}

Question questionOf(const py::dict& options) {
    Question question;
    readOptions(options, [&](const std::string& name, const py::handle& value) { read(question, name, value); });
    if (options.contains("samples_per_voxel") && question.projection != Projection::DominantAxis) {
        refuseArgument(std::string("samples_per_voxel is for projection='dominant-axis', not for '") +
                       toString(question.projection) + "'");
    }
    const bool certified = question.projection == Projection::Conservative;
    if (options.contains("view") && (certified || question.projection == Projection::DominantAxis)) {
        refuseArgument(std::string("view is for projection='view' and 'two-view', not for '") +
                       toString(question.projection) + "'");
    }
    if (options.contains("resolution") && !certified) {
        refuseArgument(std::string("resolution is for projection='conservative', not for '") +
                       toString(question.projection) + "'");
    }
    if (question.boundary == Boundary::Clamp && certified) {
        refuseArgument("boundary='clamp' is not for projection='conservative', which always tests the range");
    }
    return question;
}

} // namespace voxtact::python
