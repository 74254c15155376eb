// SPDX-License-Identifier: MIT
#include "cpu/outputs.h"
#include "core/output_pair.h"
#include "core/pair_transform.h"
#include "core/sort_contacts.h"
#include "cpu/lone_triangle.h"
#include "cpu/scalar_sample.h"

#include <algorithm>
#include <limits>
#include <new>
#include <tuple>

namespace voxtact::cpu {

namespace {

using namespace shader;

/// The opacity of a volume under a transfer function, as contact.h wants it.
struct HostField {
    const StoredImage& image;
    const Occupancy& occupancy;

    [[nodiscard]] float stored(const ContactVector& inside) const {
        return storedAt(image, inside.x, inside.y, inside.z);
    }
    [[nodiscard]] float opacityOf(float stored) const {
        return cpu::opacityOf(occupancy.table(), occupancy.constants(), stored);
    }
    [[nodiscard]] float opacity(const OutputPair&, const ContactVector& inside) const {
        return opacityOf(stored(inside));
    }
};

Vec3 widened(const ContactVector& vector) {
    return {vector.x, vector.y, vector.z};
}

/// The number of the label 0 stands for an index beyond the values, which makeLabels() does not make.
std::uint32_t labelNumber(const OutputPair& pair, const LabelData& labels, const ContactVector& at) {
    const ContactVector place =
        contactTransform(pair.label_from_texture[0], pair.label_from_texture[1], pair.label_from_texture[2], at);
    const std::size_t x = contactVoxel(place.x, pair.labelSizeX);
    const std::size_t y = contactVoxel(place.y, pair.labelSizeY);
    const std::size_t z = contactVoxel(place.z, pair.labelSizeZ);
    if (x >= pair.labelSizeX || y >= pair.labelSizeY || z >= pair.labelSizeZ) {
        return pair.outsideLabel;
    }
    const std::uint32_t number = labels.indices[(z * pair.labelSizeY + y) * pair.labelSizeX + x];
    return number < pair.labelCount ? number : pair.outsideLabel;
}

} // namespace

/// Some clusters of one pair.
class OutputRun::Part {
  public:
    Part(OutputRun& run, const PairJob& job, const ItemOutputs& item, std::uint32_t pair, Found& found)
        : run_(run), job_(job), item_(item), pair_(pair), found_(found), field_{job.volume.image, job.occupancy} {
        if (run.outputs_.labels) {
            histogram_.resize(item.labels->values.size());
        }
    }

    std::uint64_t collect() {
        for (std::uint32_t cluster = job_.clusterBegin; cluster < job_.clusterEnd; ++cluster) {
            if (!isClear(job_, cluster)) {
                addCluster(cluster);
            }
        }
        publish();
        return survivors_;
    }

  private:
    void addCluster(std::uint32_t cluster) {
        const ClusterPlace& place = job_.mesh.clusters[cluster];
        for (std::uint32_t i = place.firstTriangle; i < place.firstTriangle + place.triangleCount; ++i) {
            ExactTriangle pieces[EXACT_MAX_CORNERS];
            const std::size_t count = setUpLone(job_, {cluster, i}, pieces);
            const std::uint64_t before = survivors_;
            for (std::size_t piece = 0; piece < count; ++piece) {
                addPiece(pieces[piece], job_.mesh.numbers[i]);
            }
            if (run_.outputs_.triangles && survivors_ > before) {
                found_.triangles.push_back(
                    {pair_, job_.mesh.numbers[i], static_cast<std::uint32_t>(survivors_ - before)});
            }
        }
    }

    void addPiece(const ExactTriangle& piece, std::uint32_t triangle) {
        if (triangleClass(job_, piece) == kClearBrick) {
            return;
        }
        const RowSpans spans(piece);
        for (std::int32_t row = 0; row < spans.rows(); ++row) {
            const RowSpan span = spans.span(row);
            for (std::int32_t column = span.first; column <= span.last; ++column) {
                ContactVector at{};
                exactFragment(piece, piece.minX + column, piece.minY + row, at.x, at.y, at.z);
                addFragment(at, triangle);
            }
        }
    }

    void addFragment(const ContactVector& at, std::uint32_t triangle) {
        if (job_.view.rangeTest && !contactInDomain(at)) {
            return;
        }
        const float stored = field_.stored(contactClamp(at));
        const float opacity = field_.opacityOf(stored);
        if (!(opacity >= item_.pair.item.threshold)) {
            return;
        }
        ++survivors_;
        const auto& rows = item_.pair.world_from_texture;
        const Vec3 position = widened(contactTransform(rows[0], rows[1], rows[2], at));
        if (run_.outputs_.bounds) {
            extend(position);
        }
        const std::uint32_t label = item_.labels == nullptr ? 0 : labelNumber(item_.pair, *item_.labels, at);
        if (run_.outputs_.labels) {
            ++histogram_[label];
        }
        if (run_.outputs_.contacts && run_.contacts_.fetch_add(1, std::memory_order_relaxed) < run_.mostContacts_) {
            addContact(at, position, triangle, label, stored, opacity);
        }
    }

    void extend(const Vec3& position) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box_.lo[axis] = std::min(box_.lo[axis], position[axis]);
            box_.hi[axis] = std::max(box_.hi[axis], position[axis]);
        }
    }

    void addContact(const ContactVector& at, const Vec3& position, std::uint32_t triangle, std::uint32_t label,
                    float stored, float opacity) {
        const ContactVector normal = contactNormal(field_, item_.pair, at);
        const float scaled = stored * item_.pair.valueScale;
        found_.contacts.push_back({.pair = pair_,
                                   .triangle = triangle,
                                   .position = position,
                                   .normal = widened(normal),
                                   .depth = contactDepth(field_, item_.pair, at, normal),
                                   .value = scaled + item_.pair.valueBias,
                                   .opacity = opacity,
                                   .label = item_.labels == nullptr ? 0 : item_.labels->values[label]});
    }

    void publish() {
        if (run_.outputs_.bounds && survivors_ > 0) {
            found_.boxes.emplace_back(pair_, box_);
        }
        for (std::size_t label = 0; label < histogram_.size(); ++label) {
            if (histogram_[label] > 0) {
                found_.labels.push_back({pair_, item_.labels->values[label], histogram_[label]});
            }
        }
    }

    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    OutputRun& run_;
    const PairJob& job_;
    const ItemOutputs& item_;
    std::uint32_t pair_;
    Found& found_;
    HostField field_;
    std::uint64_t survivors_ = 0;
    Box box_{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    std::vector<std::uint64_t> histogram_;
};

Result<void> checkOutputs(const DetectorDesc& desc) {
    if (desc.outputs.any() && desc.stopAtFirst) {
        return Error{ErrorCode::InvalidArgument, 0,
                     "DetectorDesc::stopAtFirst finds one survivor, the outputs need all of them"};
    }
    return voxtact::checkOutputs(desc.outputs);
}

Result<void> checkLabelMaps(const Batch& batch, const Outputs& outputs) {
    if (!outputs.labels && !outputs.contacts) {
        return {};
    }
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const LabelData* labels = batch.items[i].labels;
        const std::string which = "batch item " + std::to_string(i);
        if (labels == nullptr && outputs.labels) {
            return Error{ErrorCode::InvalidArgument, 0, which + " has no label map, which the output labels needs"};
        }
        if (labels == nullptr) {
            continue;
        }
        if (Result<void> checked = checkLabelValues(*labels); !checked.ok()) {
            return Error{ErrorCode::InvalidArgument, 0, which + ": " + checked.error().text};
        }
    }
    return {};
}

OutputRun::OutputRun(const Batch& batch, const DetectorDesc& desc, std::uint32_t pairs, std::uint32_t threads)
    : outputs_(desc.outputs), mostContacts_(desc.mostContacts), pairs_(pairs), found_(threads) {
    for (const BatchItem& item : batch.items) {
        const VolumeImpl& volume = item.volume->impl();
        const ItemConstants constants =
            itemConstants(1, volume.storedIntercept, item.transferFunction->impl().domain, batch.threshold);
        const LabelData* labels = outputs_.labels || outputs_.contacts ? item.labels : nullptr;
        items_.push_back(
            {outputPair(volume.grid, volume.texture_from_world, constants, 1, volume.storedIntercept, outputs_),
             labels});
        if (labels != nullptr) {
            addLabelMap(items_.back().pair, volume.grid, labels->grid, labels->values);
        }
    }
}

std::uint64_t OutputRun::collect(const PairJob& job, std::size_t item, std::uint32_t pair,
                                 std::uint32_t thread) noexcept {
    try {
        return Part(*this, job, items_[item], pair, found_[thread]).collect();
    } catch (const std::bad_alloc&) {
        outOfMemory_.store(true, std::memory_order_relaxed);
        return 0;
    }
}

void OutputRun::mergeBoxes(BatchAnswer& answer) const {
    answer.bounds.resize(pairs_);
    for (const Found& found : found_) {
        for (const auto& [pair, box] : found.boxes) {
            std::optional<Box>& whole = answer.bounds[pair];
            if (!whole) {
                whole = box;
            }
            for (std::size_t axis = 0; axis < 3; ++axis) {
                whole->lo[axis] = std::min(whole->lo[axis], box.lo[axis]);
                whole->hi[axis] = std::max(whole->hi[axis], box.hi[axis]);
            }
        }
    }
}

void OutputRun::mergeLabels(BatchAnswer& answer) const {
    std::vector<LabelCount> parts;
    for (const Found& found : found_) {
        parts.insert(parts.end(), found.labels.begin(), found.labels.end());
    }
    std::sort(parts.begin(), parts.end(), [](const LabelCount& a, const LabelCount& b) {
        return std::tie(a.pair, a.label) < std::tie(b.pair, b.label);
    });
    for (const LabelCount& part : parts) {
        if (!answer.labels.empty() && answer.labels.back().pair == part.pair &&
            answer.labels.back().label == part.label) {
            answer.labels.back().count += part.count;
        } else {
            answer.labels.push_back(part);
        }
    }
}

void OutputRun::finish(BatchAnswer& answer) {
    if (outOfMemory_.load(std::memory_order_relaxed)) {
        throw std::bad_alloc();
    }
    for (const Found& found : found_) {
        answer.triangles.insert(answer.triangles.end(), found.triangles.begin(), found.triangles.end());
        answer.contacts.insert(answer.contacts.end(), found.contacts.begin(), found.contacts.end());
    }
    std::sort(answer.triangles.begin(), answer.triangles.end(), [](const TouchedTriangle& a, const TouchedTriangle& b) {
        return std::tie(a.pair, a.triangle) < std::tie(b.pair, b.triangle);
    });
    sortContacts(answer.contacts);
    answer.contactsFound = contacts_.load(std::memory_order_relaxed);
    if (outputs_.bounds) {
        mergeBoxes(answer);
    }
    mergeLabels(answer);
}

} // namespace voxtact::cpu
