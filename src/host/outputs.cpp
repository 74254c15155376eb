// SPDX-License-Identifier: MIT
#include "host/outputs.h"
#include "core/base/infinity.h"
#include "core/base/refuse.h"
#include "core/batch/output_pair.h"
#include "core/batch/sort_contacts.h"
#include "core/geometry/pair_transform.h"
#include "host/count/lone_triangle.h"
#include "host/count/scalar_sample.h"

#include <algorithm>
#include <new>
#include <tuple>

namespace voxtact::cpu {

namespace {

using namespace shader;

/// The opacity of a volume under a transfer function, as contact.h wants it.
struct HostField {
    const StoredImage& image;
    const std::vector<float>& table;
    const ItemConstants& constants;

    [[nodiscard]] float stored(const ContactVector& inside) const {
        return storedAt(image, inside.x, inside.y, inside.z);
    }
    [[nodiscard]] float opacityOf(float stored) const { return cpu::opacityOf(table, constants, stored); }
    [[nodiscard]] float opacity(const OutputPair&, const ContactVector& inside) const {
        return opacityOf(stored(inside));
    }
    /// Data of a contact that sampling its position provides.
    [[nodiscard]] ContactSample sample(const ContactVector& at) const {
        const float value = stored(contactClamp(at));
        return {value, opacityOf(value)};
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

/// The fragments of some clusters of one pair.
template <class Survivor> class Fragments {
  public:
    Fragments(const PairJob& job, float threshold, const Survivor& survivor)
        : job_(job), threshold_(threshold), survivor_(survivor) {}

    std::uint64_t visit() {
        for (std::uint32_t cluster = job_.clusterBegin; cluster < job_.clusterEnd && !isCancelled(job_.cancel);
             ++cluster) {
            if (!isClear(job_, cluster)) {
                visitCluster(cluster);
            }
        }
        return survivors_;
    }

  private:
    void visitCluster(std::uint32_t cluster) {
        const ClusterPlace& place = job_.mesh.clusters[cluster];
        for (std::uint32_t i = place.firstTriangle; i < place.firstTriangle + place.triangleCount; ++i) {
            ExactTriangle pieces[EXACT_MAX_CORNERS];
            const std::size_t count = setUpLone(job_, {cluster, i}, pieces);
            for (std::size_t piece = 0; piece < count; ++piece) {
                visitPiece(pieces[piece], job_.mesh.numbers[i]);
            }
        }
    }

    void visitPiece(const ExactTriangle& piece, std::uint32_t triangle) {
        if (triangleClass(job_, piece) == kClearBrick) {
            return;
        }
        const RowSpans spans(piece);
        for (std::int32_t row = 0; row < spans.rows() && !isCancelled(job_.cancel); ++row) {
            const RowSpan span = spans.span(row);
            for (std::int32_t column = span.first; column <= span.last; ++column) {
                ContactVector at{};
                exactFragment(piece, piece.minX + column, piece.minY + row, at.x, at.y, at.z);
                if (survives(at)) {
                    ++survivors_;
                    survivor_(triangle, at);
                }
            }
        }
    }

    [[nodiscard]] bool survives(const ContactVector& at) const {
        if (job_.view.rangeTest && !contactInDomain(at)) {
            return false;
        }
        const HostField field{job_.volume.image, job_.occupancy.table(), job_.occupancy.constants()};
        return field.opacityOf(field.stored(contactClamp(at))) >= threshold_;
    }

    const PairJob& job_;
    float threshold_;
    const Survivor& survivor_;
    std::uint64_t survivors_ = 0;
};

constexpr Box kNoBox{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};

void grow(Box& box, const Box& by) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(box.lo[axis], by.lo[axis]);
        box.hi[axis] = std::max(box.hi[axis], by.hi[axis]);
    }
}

using PairBox = std::pair<std::uint32_t, Box>;

/// Parts of lists, one after the other, by pair and `what`; the counts of equal ones are added.
template <class T, class What> std::vector<T> together(std::vector<T> parts, What what) {
    std::sort(parts.begin(), parts.end(),
              [&](const T& a, const T& b) { return std::tie(a.pair, a.*what) < std::tie(b.pair, b.*what); });
    std::vector<T> whole;
    for (const T& part : parts) {
        if (!whole.empty() && whole.back().pair == part.pair && whole.back().*what == part.*what) {
            whole.back().count += part.count;
        } else {
            whole.push_back(part);
        }
    }
    return whole;
}

void mergeBoxes(const std::vector<PairBox>& parts, std::vector<std::optional<Box>>& bounds) {
    for (const auto& [pair, box] : parts) {
        std::optional<Box>& whole = bounds[pair];
        if (!whole) {
            whole = box;
        }
        grow(*whole, box);
    }
}

template <class T> void append(std::vector<T>& to, const std::vector<T>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

} // namespace

/// Results of one thread.
struct OutputRun::Found {
    std::vector<TouchedTriangle> triangles;
    std::vector<Contact> contacts;
    std::vector<PairBox> boxes;     ///< of parts of pairs
    std::vector<LabelCount> labels; ///< of parts of pairs

    /// State of the current sink.
    bool any = false;
    Box box = kNoBox;
    std::vector<std::uint64_t> histogram;
};

OutputRun::Sink::Sink(OutputRun& run, std::size_t item, std::uint32_t pair, std::uint32_t thread)
    : run_(run), item_(run.items_[item]), pair_(pair), found_(*run.found_[thread]) {
    found_.any = false;
    found_.box = kNoBox;
    found_.histogram.assign(run.outputs_.labels ? item_.labels->values.size() : 0, 0);
}

void OutputRun::Sink::add(std::uint32_t triangle, const ContactVector& at, const std::optional<ContactSample>& known) {
    found_.any = true;
    if (run_.outputs_.triangles) {
        std::vector<TouchedTriangle>& list = found_.triangles;
        if (list.empty() || list.back().pair != pair_ || list.back().triangle != triangle) {
            list.push_back({pair_, triangle, 0});
        }
        ++list.back().count;
    }
    const auto& rows = item_.pair.world_from_texture;
    const Vec3 position = widened(contactTransform(rows[0], rows[1], rows[2], at));
    if (run_.outputs_.bounds) {
        grow(found_.box, {position, position});
    }
    const std::uint32_t label = item_.labels == nullptr ? 0 : labelNumber(item_.pair, *item_.labels, at);
    if (run_.outputs_.labels) {
        ++found_.histogram[label];
    }
    if (run_.outputs_.contacts && run_.contacts_.fetch_add(1, std::memory_order_relaxed) < run_.mostContacts_) {
        const HostField field{*item_.image, *item_.table, item_.pair.item};
        addContact(at, position, triangle, label, known ? *known : field.sample(at));
    }
}

void OutputRun::Sink::addContact(const ContactVector& at, const Vec3& position, std::uint32_t triangle,
                                 std::uint32_t label, const ContactSample& sample) {
    const HostField field{*item_.image, *item_.table, item_.pair.item};
    const ContactVector normal = contactNormal(field, item_.pair, at);
    const float scaled = sample.stored * item_.pair.valueScale;
    found_.contacts.push_back({.pair = pair_,
                               .triangle = triangle,
                               .position = position,
                               .normal = widened(normal),
                               .depth = contactDepth(field, item_.pair, at, normal),
                               .value = scaled + item_.pair.valueBias,
                               .opacity = sample.opacity,
                               .label = item_.labels == nullptr ? 0 : item_.labels->values[label]});
}

void OutputRun::Sink::publish() {
    if (run_.outputs_.bounds && found_.any) {
        found_.boxes.emplace_back(pair_, found_.box);
    }
    const std::vector<std::uint64_t>& histogram = found_.histogram;
    for (std::size_t label = 0; label < histogram.size(); ++label) {
        if (histogram[label] > 0) {
            found_.labels.push_back({pair_, item_.labels->values[label], histogram[label]});
        }
    }
}

Result<void> checkOutputs(const Count& desc) {
    return voxtact::checkOutputs(desc.outputs, desc.stopAtFirst);
}

Result<void> checkLabelMaps(const Batch& batch, const Outputs& outputs) {
    if (!outputs.labels && !outputs.contacts) {
        return {};
    }
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const LabelData* labels = batch.items[i].labels;
        const std::string which = "batch item " + std::to_string(i);
        if (labels == nullptr && outputs.labels) {
            return refuse(which + " has no label map, which the output labels needs");
        }
        if (labels == nullptr) {
            continue;
        }
        if (Result<void> checked = checkLabelValues(*labels); !checked.ok()) {
            return refuse(which + ": " + checked.error().text);
        }
    }
    return {};
}

OutputRun::OutputRun(const Batch& batch, const Count& desc, std::uint32_t pairs, std::uint32_t threads)
    : outputs_(desc.outputs), mostContacts_(desc.maxContacts), pairs_(pairs), found_(threads) {
    std::ranges::generate(found_, [] { return std::make_unique<Found>(); });
    for (const BatchItem& item : batch.items) {
        const VolumeImpl& volume = item.volume->impl();
        const ItemConstants constants =
            itemConstants(1, volume.storedIntercept, item.transferFunction->impl().domain, batch.threshold);
        const LabelData* labels = outputs_.labels || outputs_.contacts ? item.labels : nullptr;
        items_.push_back(
            {outputPair(volume.grid, volume.texture_from_world, constants, 1, volume.storedIntercept, outputs_), labels,
             &volume.image, &item.transferFunction->impl().table});
        if (labels != nullptr) {
            addLabelMap(items_.back().pair, volume.grid, labels->grid, labels->values);
        }
    }
}

OutputRun::~OutputRun() = default;

void OutputRun::collect(std::size_t item, std::uint32_t pair, std::uint32_t thread,
                        const std::function<void(Sink&)>& body) {
    Sink sink(*this, item, pair, thread);
    body(sink);
    sink.publish();
}

std::uint64_t OutputRun::collect(const PairJob& job, std::size_t item, std::uint32_t pair, std::uint32_t thread) {
    std::uint64_t survivors = 0;
    collect(item, pair, thread, [&](Sink& sink) {
        const auto add = [&sink](std::uint32_t triangle, const ContactVector& at) { sink.add(triangle, at); };
        survivors = Fragments(job, items_[item].pair.item.threshold, add).visit();
    });
    return survivors;
}

void OutputRun::finish(BatchAnswer& answer) {
    answer.bounds.resize(outputs_.bounds ? pairs_ : 0);
    for (const std::unique_ptr<Found>& found : found_) {
        append(answer.triangles, found->triangles);
        append(answer.contacts, found->contacts);
        append(answer.labels, found->labels);
        mergeBoxes(found->boxes, answer.bounds);
    }
    // A triangle comes more than once where a pair is seen more than once.
    answer.triangles = together(std::move(answer.triangles), &TouchedTriangle::triangle);
    answer.labels = together(std::move(answer.labels), &LabelCount::label);
    sortContacts(answer.contacts);
    answer.contactsFound = contacts_.load(std::memory_order_relaxed);
}

} // namespace voxtact::cpu
