// SPDX-License-Identifier: MIT
#pragma once

#include "request.h"
#include "voxtact/area.h"
#include "voxtact/clearance.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

/// Answers as columns, which numpy shows.
namespace voxtact::python {

/// What a scene said about a request, piece by piece.
class Answer {
  public:
    Answer(std::shared_ptr<const Request> request, const Question& question);
    /// The pairs from `first` on.
    void add(std::size_t first, BatchAnswer piece);

    std::shared_ptr<const Request> request;
    Question question;
    std::uint64_t revision = 0; ///< of the scene
    CountingMethod method = CountingMethod::Cpu;
    std::vector<std::uint8_t> hit;
    std::vector<std::uint8_t> possible;
    std::vector<std::uint8_t> exact;
    std::vector<std::uint64_t> count;
    std::vector<TouchedTriangle> triangles;
    std::vector<Contact> contacts;
    std::vector<std::array<double, 6>> bounds;
    std::vector<LabelCount> labels;
    std::uint64_t contactsFound = 0;
    std::optional<CertifiedCounters> counters; ///< of all pieces together, where the question asks for them
    double milliseconds = 0;
    double deviceMilliseconds = 0;

  private:
    void addContacts(std::size_t first, std::vector<Contact> piece);
};

/// A row of Clearances::closest.
struct ClosestRow {
    std::int64_t triangle; ///< -1: there is none
    std::array<double, 3> mesh;
    std::array<double, 3> volume;
    std::array<double, 3> perTranslation;
    std::array<double, 3> perRotation;
};

/// Bounds of what is measured of the pairs of a request.
struct Measured {
    std::shared_ptr<const Request> request;
    std::vector<double> lo;
    std::vector<double> hi;
    std::vector<std::uint8_t> end;    ///< ClearanceEnd, or AreaEnd
    bool byLabel = false;             ///< lo, hi and end have a column for each of these
    std::vector<std::int32_t> labels; ///< none are labels, too
    double milliseconds = 0;
};

/// Clearances of a request.
struct Clearances : Measured {
    std::vector<ClosestRow> closest;

    void add(const ClearanceAnswer& piece);
    void add(const LabelClearanceAnswer& piece);
};

/// A row of Areas::triangles.
struct TriangleAreaRow {
    std::uint32_t pair; ///< of the request
    std::uint32_t triangle;
    double whole;
    double lo;
    double hi;
};

/// Contact areas of a request.
struct Areas : Measured {
    bool byTriangle = false;
    std::vector<TriangleAreaRow> triangles;

    void add(const AreaAnswer& piece);
    void add(const TriangleAreaAnswer& piece);
    void add(const LabelAreaAnswer& piece);
};

void defineAnswers(py::module_& module);

} // namespace voxtact::python
