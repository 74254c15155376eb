// SPDX-License-Identifier: MIT
#include "answer.h"

#include "arrays.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <iterator>

namespace voxtact::python {

namespace {

/// Appends rows whose pairs begin at `first`.
template <class Row> void append(std::vector<Row>& all, std::vector<Row> piece, std::size_t first) {
    for (Row& row : piece) {
        row.pair += static_cast<std::uint32_t>(first);
    }
    if (all.empty()) {
        all = std::move(piece);
    } else {
        all.insert(all.end(), piece.begin(), piece.end());
    }
}

py::array_t<std::uint32_t> itemsOf(const Request& request) {
    py::array_t<std::uint32_t> numbers(static_cast<py::ssize_t>(request.pairs));
    std::uint32_t* to = numbers.mutable_data();
    for (std::size_t item = 0; item < request.items.size(); ++item) {
        to = std::fill_n(to, request.items[item].world_from_object.size(), static_cast<std::uint32_t>(item));
    }
    return numbers;
}

py::array_t<std::uint32_t> posesOf(const Request& request) {
    py::array_t<std::uint32_t> numbers(static_cast<py::ssize_t>(request.pairs));
    std::uint32_t* to = numbers.mutable_data();
    for (const Request::Item& item : request.items) {
        for (std::size_t pose = 0; pose < item.world_from_object.size(); ++pose) {
            *to++ = static_cast<std::uint32_t>(pose);
        }
    }
    return numbers;
}

/// (N,2,3): least and greatest corner.
py::array boxesOf(const std::vector<std::array<double, 6>>& bounds, const py::object& owner) {
    return py::array(py::dtype::of<double>(), {static_cast<py::ssize_t>(bounds.size()), py::ssize_t{2}, py::ssize_t{3}},
                     bounds.data(), owner);
}

/// In the order of voxtact.Counters; nothing where they were not asked for.
py::object countersOf(const Answer& answer) {
    if (!answer.counters) {
        return py::none();
    }
    const CertifiedCounters& of = *answer.counters;
    return py::make_tuple(of.clusters, of.clustersKept, of.runsKept, of.largeParts, of.bricksSeen, of.cellsSeen,
                          of.cellsListed, of.cellsCertain, of.cellsDecided, of.lanes, of.cellsOpen, of.left,
                          of.bricksLeft, of.cellsLeft, of.rounds, of.room, of.mostClusters, of.mostRuns, of.mostParts,
                          of.mostCells, of.mostOpen, of.mostLeft, of.mostLooks, of.mostLooksLeft);
}

template <class T>
py::array inLabelColumns(const Measured& from, const std::vector<T>& values, const py::object& owner) {
    if (!from.byLabel) {
        return shown(values, owner);
    }
    return py::array(py::dtype::of<T>(),
                     {static_cast<py::ssize_t>(from.request->pairs), static_cast<py::ssize_t>(from.labels.size())},
                     values.data(), owner);
}

template <class Row> void addBounds(const std::vector<Row>& rows, double milliseconds, Measured& to) {
    for (const Row& row : rows) {
        to.lo.push_back(row.bounds.lo);
        to.hi.push_back(row.bounds.hi);
        to.end.push_back(static_cast<std::uint8_t>(row.end));
    }
    to.milliseconds += milliseconds;
}

/// What Clearances and Areas have in common.
template <class Of> py::class_<Of, std::shared_ptr<Of>> defineMeasured(py::module_& module, const char* name) {
    const auto measured = [](auto member) {
        return [member](const py::object& self) {
            const auto& from = self.cast<const Of&>();
            return inLabelColumns(from, from.*member, self);
        };
    };
    return py::class_<Of, std::shared_ptr<Of>>(module, name)
        .def_property_readonly("lo", measured(&Of::lo))
        .def_property_readonly("hi", measured(&Of::hi))
        .def_property_readonly("end", measured(&Of::end))
        .def_property_readonly("item", [](const Of& from) { return itemsOf(*from.request); })
        .def_property_readonly("pose", [](const Of& from) { return posesOf(*from.request); })
        .def_property_readonly("labels",
                               [](const py::object& self) { return shown(self.cast<const Of&>().labels, self); })
        .def_readonly("milliseconds", &Of::milliseconds)
        .def("__len__", [](const Of& from) { return from.request->pairs; });
}

} // namespace

Answer::Answer(std::shared_ptr<const Request> asked, const Question& how) : request(std::move(asked)), question(how) {
    hit.reserve(request->pairs);
    possible.reserve(request->pairs);
    exact.reserve(request->pairs);
    count.reserve(request->pairs);
}

void Answer::add(std::size_t first, BatchAnswer piece) {
    for (const PairAnswer& pair : piece.pairs) {
        hit.push_back(pair.hit ? 1 : 0);
        possible.push_back(pair.possible ? 1 : 0);
        exact.push_back(pair.exactness == Exactness::Exact ? 1 : 0);
        count.push_back(pair.count);
        method = pair.method;
    }
    append(triangles, std::move(piece.triangles), first);
    append(labels, std::move(piece.labels), first);
    for (const std::optional<Box>& box : piece.bounds) {
        bounds.push_back(box ? std::array{box->lo[0], box->lo[1], box->lo[2], box->hi[0], box->hi[1], box->hi[2]}
                             : std::array{kNone, kNone, kNone, kNone, kNone, kNone});
    }
    contactsFound += piece.contactsFound;
    if (piece.counters) {
        counters = counters ? together(*counters, *piece.counters) : *piece.counters;
    }
    addContacts(first, std::move(piece.contacts));
    milliseconds += piece.wallMilliseconds;
    deviceMilliseconds += piece.gpuMilliseconds;
}

void Answer::addContacts(std::size_t first, std::vector<Contact> piece) {
    const std::size_t room = question.mostContacts - std::min<std::size_t>(contacts.size(), question.mostContacts);
    if (piece.size() > room) {
        piece.resize(room);
    }
    // Behind the last member there is what was in that memory before: equal contacts are equal as bytes, too.
    constexpr std::size_t kEnd = offsetof(Contact, label) + sizeof(Contact::label);
    for (Contact& contact : piece) {
        std::memset(reinterpret_cast<std::byte*>(&contact) + kEnd, 0, sizeof(Contact) - kEnd);
    }
    append(contacts, std::move(piece), first);
}

void Clearances::add(const ClearanceAnswer& piece) {
    for (const PairClearance& pair : piece.pairs) {
        constexpr std::array<double, 3> kNowhere{kNone, kNone, kNone};
        const ClosestPoints* const found = pair.closest ? &*pair.closest : nullptr;
        closest.push_back(found != nullptr ? ClosestRow{found->triangle, found->mesh, found->volume,
                                                        found->perTranslation, found->perRotation}
                                           : ClosestRow{-1, kNowhere, kNowhere, kNowhere, kNowhere});
    }
    addBounds(piece.pairs, piece.wallMilliseconds, *this);
}

void Clearances::add(const LabelClearanceAnswer& piece) {
    addBounds(piece.labels, piece.wallMilliseconds, *this);
}

void Areas::add(const AreaAnswer& piece) {
    addBounds(piece.pairs, piece.wallMilliseconds, *this);
}

void Areas::add(const TriangleAreaAnswer& piece) {
    const auto first = static_cast<std::uint32_t>(lo.size());
    addBounds(piece.pairs, piece.wallMilliseconds, *this);
    for (const TriangleArea& area : piece.triangles) {
        triangles.push_back({first + area.pair, area.triangle, area.whole, area.bounds.lo, area.bounds.hi});
    }
}

void Areas::add(const LabelAreaAnswer& piece) {
    addBounds(piece.labels, piece.wallMilliseconds, *this);
}

void defineAnswers(py::module_& module) {
    PYBIND11_NUMPY_DTYPE(TouchedTriangle, pair, triangle, count);
    PYBIND11_NUMPY_DTYPE(Contact, pair, triangle, position, normal, depth, value, opacity, label);
    PYBIND11_NUMPY_DTYPE(LabelCount, pair, label, count);
    PYBIND11_NUMPY_DTYPE_EX(ClosestRow, triangle, "triangle", mesh, "mesh", volume, "volume", perTranslation,
                            "per_translation", perRotation, "per_rotation");
    PYBIND11_NUMPY_DTYPE(TriangleAreaRow, pair, triangle, whole, lo, hi);

    // Each array shows the answer's own memory, and keeps the answer.
    const auto column = [](auto member, auto show) {
        return [member, show](const py::object& self) { return show(self.cast<const Answer&>().*member, self); };
    };
    const auto rows = [](const auto& values, const py::object& self) { return shown(values, self); };
    py::class_<Answer, std::shared_ptr<Answer>>(module, "Answer")
        .def_property_readonly("hit", column(&Answer::hit, truths))
        .def_property_readonly("possible", column(&Answer::possible, truths))
        .def_property_readonly("exact", column(&Answer::exact, truths))
        .def_property_readonly("count", column(&Answer::count, rows))
        .def_property_readonly("triangles", column(&Answer::triangles, rows))
        .def_property_readonly("contacts", column(&Answer::contacts, rows))
        .def_property_readonly("bounds", column(&Answer::bounds, boxesOf))
        .def_property_readonly("labels", column(&Answer::labels, rows))
        .def_property_readonly("item", [](const Answer& answer) { return itemsOf(*answer.request); })
        .def_property_readonly("pose", [](const Answer& answer) { return posesOf(*answer.request); })
        .def_readonly("contacts_found", &Answer::contactsFound)
        .def_readonly("milliseconds", &Answer::milliseconds)
        .def_readonly("device_milliseconds", &Answer::deviceMilliseconds)
        .def_readonly("revision", &Answer::revision)
        .def_property_readonly("counters", &countersOf)
        .def_property_readonly("method", [](const Answer& answer) { return toString(answer.method); })
        .def_property_readonly("projection", [](const Answer& answer) { return toString(answer.question.projection); })
        .def_property_readonly("outputs",
                               [](const Answer& answer) {
                                   const Outputs& outputs = answer.question.outputs;
                                   return py::make_tuple(outputs.triangles, outputs.contacts, outputs.bounds,
                                                         outputs.labels);
                               })
        .def("__len__", [](const Answer& answer) { return answer.hit.size(); });

    defineMeasured<Clearances>(module, "Clearances").def_property_readonly("closest", [](const py::object& self) {
        return shown(self.cast<const Clearances&>().closest, self);
    });
    defineMeasured<Areas>(module, "Areas")
        .def_readonly("by_triangle", &Areas::byTriangle)
        .def_property_readonly("triangles",
                               [](const py::object& self) { return shown(self.cast<const Areas&>().triangles, self); });
}

} // namespace voxtact::python
