// SPDX-License-Identifier: MIT
// What stands in for shaders: a hash of what they would read goes where they would write.
#include "exact/contact.h"
#include "exact/operations.h"
#include "exact/shared.h"
#include "pretend_state.h"
#include "voxtact/device_results.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace voxtact::test {

namespace {

/// Elements of a part of memory, read and written as the host would.
template <class Element> class Elements {
  public:
    explicit Elements(std::span<std::byte> bytes) : bytes_(bytes) {}
    [[nodiscard]] std::size_t size() const { return bytes_.size() / sizeof(Element); }
    [[nodiscard]] Element get(std::size_t at) const {
        Element out;
        std::memcpy(&out, bytes_.data() + at * sizeof out, sizeof out);
        return out;
    }
    void set(std::size_t at, const Element& element) {
        std::memcpy(bytes_.data() + at * sizeof element, &element, sizeof element);
    }

  private:
    std::span<std::byte> bytes_;
};

/// One draw or dispatch while it is executed.
class Execution {
  public:
    Execution(PretendState& state, const Bound& bound, VkPipelineBindPoint point, const PretendPipeline& pipeline)
        : s_(state), bound_(bound), pipeline_(pipeline), draws_(point == VK_PIPELINE_BIND_POINT_GRAPHICS) {
        for (std::size_t set = 0; set < pipeline.sets; ++set) {
            sets_.push_back(s_.sets.find(bound.sets[point][set]));
        }
        for (const Id view : bound.colours) {
            if (const PretendImageView* found = s_.get(s_.views, view)) {
                targets_.push_back(found->image);
            }
        }
    }

    void run(std::span<const std::uint32_t> numbers, std::uint32_t firstInstance, std::uint32_t instances) {
        if (pipeline_.operations) {
            runOperations();
            return;
        }
        if (pipeline_.edits) {
            runEdit();
            return;
        }
        if (pipeline_.tally) {
            return; // nothing here counts what it does
        }
        range_ = rangeOf(numbers, firstInstance, instances);
        hash_.number(pipeline_.hash);
        hash_.add(std::as_bytes(numbers));
        hash_.add(std::as_bytes(std::span(&bound_.viewport, draws_ ? 1 : 0)));
        hash_.add(bound_.constants);
        readSets();
        readVertices(numbers.size() > 2);
        write();
    }

  private:
    /// Pairs that it is about.
    struct Range {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    [[nodiscard]] Range rangeOf(std::span<const std::uint32_t> numbers, std::uint32_t firstInstance,
                                std::uint32_t instances) const {
        if (draws_) {
            return {firstInstance / pipeline_.views, instances / pipeline_.views};
        }
        if (pipeline_.certified) {
            shader::CertifiedConstants constants{};
            std::memcpy(&constants, bound_.constants.data(), sizeof constants);
            return {constants.firstPair, numbers[1]};
        }
        shader::ComputeConstants constants{};
        std::memcpy(&constants, bound_.constants.data(), sizeof constants);
        return {constants.firstTransform / pipeline_.views, numbers[1] / pipeline_.views};
    }

    [[nodiscard]] const PretendDescriptor* descriptor(std::size_t set, std::uint32_t binding) const {
        if (set >= sets_.size() || sets_[set] == nullptr) {
            return nullptr;
        }
        const auto found = sets_[set]->bindings.find(binding);
        return found == sets_[set]->bindings.end() ? nullptr : &found->second;
    }
    [[nodiscard]] const PretendDescriptor* storageBuffer(std::size_t set, std::uint32_t binding) const {
        const PretendDescriptor* found = descriptor(set, binding);
        return found != nullptr && found->type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ? found : nullptr;
    }
    [[nodiscard]] std::span<std::byte> contents(const PretendDescriptor& descriptor) const {
        if (descriptor.buffer != 0) {
            return s_.bufferBytes(descriptor.buffer, descriptor.offset, descriptor.range);
        }
        const PretendImageView* view = s_.get(s_.views, descriptor.view);
        return view == nullptr ? std::span<std::byte>() : s_.imageBytes(view->image);
    }

    /// Whether the shader would write it, so that what is in it does not matter.
    [[nodiscard]] bool isWritten(std::size_t set, std::uint32_t binding, const PretendDescriptor& descriptor) const {
        if (descriptor.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) {
            return true;
        }
        if (descriptor.type != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER) {
            const PretendImageView* view = s_.views.find(descriptor.view);
            return view != nullptr && std::ranges::count(targets_, view->image) > 0;
        }
        return (set == VOXTACT_SET_PAIRS &&
                (binding == VOXTACT_BINDING_RESULTS || binding == VOXTACT_BINDING_OUTPUTS)) ||
               (set == VOXTACT_SET_TRACE && pipeline_.lists) || (set == VOXTACT_SET_VOLUME && pipeline_.bricks);
    }

    void readSets() {
        for (std::size_t set = 0; set < sets_.size(); ++set) {
            // The pass of the bricks shares a layout with others, and has but the volume.
            if (sets_[set] == nullptr || (pipeline_.bricks && set != VOXTACT_SET_VOLUME)) {
                continue;
            }
            for (const auto& [binding, descriptor] : sets_[set]->bindings) {
                if (!isWritten(set, binding, descriptor)) {
                    readDescriptor(set, binding, descriptor);
                }
            }
        }
    }
    void readDescriptor(std::size_t set, std::uint32_t binding, const PretendDescriptor& descriptor) {
        const std::span<std::byte> bytes = contents(descriptor);
        const bool ofPairs = targets_.empty() && set == VOXTACT_SET_PAIRS && descriptor.buffer != 0;
        const std::size_t element = !ofPairs                                  ? 0
                                    : binding == VOXTACT_BINDING_OUTPUT_PAIRS ? sizeof(shader::OutputPair)
                                    : pipeline_.certified                     ? sizeof(shader::CertifiedPair)
                                                          : pipeline_.views * sizeof(shader::PairTransform);
        const std::size_t first = std::min(bytes.size(), range_.first * element);
        hash_.add(element == 0 ? bytes : bytes.subspan(first, std::min(range_.count * element, bytes.size() - first)));
    }
    void readVertices(bool indexed) {
        for (std::uint32_t i = 0; draws_ && i < pipeline_.vertexBuffers; ++i) {
            hash_.add(s_.bufferBytes(bound_.vertices[i].buffer, bound_.vertices[i].offset));
        }
        if (draws_ && indexed) {
            hash_.add(s_.bufferBytes(bound_.indices, bound_.indexOffset));
        }
    }

    void write() {
        if (!targets_.empty()) {
            std::ranges::for_each(targets_, [&](Id image) { fill(s_.imageBytes(image)); });
            return;
        }
        if (const PretendDescriptor* image = descriptor(0, 0);
            image != nullptr && image->type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) {
            fill(contents(*image));
            return;
        }
        if (pipeline_.bricks) {
            if (const PretendDescriptor* bricks = storageBuffer(VOXTACT_SET_VOLUME, VOXTACT_BINDING_BRICKS)) {
                fill(contents(*bricks));
            }
            return;
        }
        writeCounts();
        writeOutputs();
        writeList();
    }
    void fill(std::span<std::byte> bytes) const {
        Hash next = hash_;
        for (std::byte& byte : bytes) {
            byte = static_cast<std::byte>(next.value() >> 56U);
            next.number(byte);
        }
    }

    /// Does what the shader would: the self-test compares all of it.
    void runOperations() const {
        shader::OperationConstants constants{};
        std::memcpy(&constants, bound_.constants.data(), sizeof constants);
        const std::vector<std::uint32_t> inputs = wordsOf(VOXTACT_BINDING_TRANSFORMS);
        std::vector<std::uint32_t> outputs = wordsOf(VOXTACT_BINDING_RESULTS);
        if (constants.texels == 0) {
            playOperations(inputs, outputs);
        } else if (const PretendDescriptor* volume = descriptor(VOXTACT_SET_VOLUME, 0)) {
            const PretendImageView* view = s_.get(s_.views, volume->view);
            const PretendImage* image = view == nullptr ? nullptr : s_.get(s_.images, view->image);
            playTexels(contents(*volume), image == nullptr ? 0 : image->texelBytes, outputs);
        }
        if (const PretendDescriptor* buffer = storageBuffer(VOXTACT_SET_PAIRS, VOXTACT_BINDING_RESULTS)) {
            std::memcpy(contents(*buffer).data(), outputs.data(), outputs.size() * sizeof(std::uint32_t));
        }
    }
    /// Does what the shader would.
    void runEdit() const {
        shader::EditConstants constants{};
        std::memcpy(&constants, bound_.constants.data(), sizeof constants);
        const PretendDescriptor* rowsBuffer = storageBuffer(0, VOXTACT_BINDING_EDIT_ROWS);
        const PretendDescriptor* texelsBuffer = storageBuffer(0, VOXTACT_BINDING_EDIT_TEXELS);
        if (rowsBuffer == nullptr || texelsBuffer == nullptr) {
            return;
        }
        const Elements<std::array<std::uint32_t, 2>> rows(contents(*rowsBuffer));
        const std::span<std::byte> texels = contents(*texelsBuffer);
        for (std::uint32_t row = 0; row < constants.rows; ++row) {
            const auto [first, end] = rows.get(row);
            for (std::uint32_t x = first; x < end; ++x) {
                const std::size_t at = (std::size_t{row} * constants.rowTexels + x) * constants.texelBytes;
                std::memcpy(texels.data() + at, &constants.value, constants.texelBytes);
            }
        }
    }
    /// The words of a buffer of the pairs' set.
    [[nodiscard]] std::vector<std::uint32_t> wordsOf(std::uint32_t binding) const {
        const PretendDescriptor* buffer = storageBuffer(VOXTACT_SET_PAIRS, binding);
        const std::span<const std::byte> bytes = buffer == nullptr ? std::span<std::byte>() : contents(*buffer);
        std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
        std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
        return words;
    }

    [[nodiscard]] std::uint32_t survivors() const {
        constexpr std::uint32_t kMost = 997;
        if (s_.counting == PretendDriver::Counting::Hash) {
            return 1 + static_cast<std::uint32_t>(hash_.value() % kMost);
        }
        const PretendDescriptor* volume = descriptor(VOXTACT_SET_VOLUME, 0);
        const std::span<std::byte> voxels = volume == nullptr ? std::span<std::byte>() : contents(*volume);
        return 2 * static_cast<std::uint32_t>(voxels.size() -
                                              static_cast<std::size_t>(std::ranges::count(voxels, std::byte{0})));
    }

    void writeCounts() {
        if (PretendQueryPool* queries = bound_.queries == 0 ? nullptr : s_.queryPools.find(bound_.queries)) {
            std::optional<std::uint64_t>& value = queries->values.at(bound_.query);
            value = value.value_or(0) + survivors();
            return;
        }
        const PretendDescriptor* buffer = storageBuffer(VOXTACT_SET_PAIRS, VOXTACT_BINDING_RESULTS);
        if (buffer == nullptr) {
            return;
        }
        Elements<PairResult> results(contents(*buffer));
        for (std::uint32_t pair = range_.first; pair < range_.first + range_.count && pair < results.size(); ++pair) {
            PairResult result = results.get(pair);
            result.countLow += survivors();
            results.set(pair, result);
        }
    }

    /// One triangle, box, label and contact of each pair.
    void writeOutputs() {
        const PretendDescriptor* pairsBuffer = storageBuffer(VOXTACT_SET_PAIRS, VOXTACT_BINDING_OUTPUT_PAIRS);
        const PretendDescriptor* wordsBuffer = storageBuffer(VOXTACT_SET_PAIRS, VOXTACT_BINDING_OUTPUTS);
        if (pairsBuffer == nullptr || wordsBuffer == nullptr) {
            return;
        }
        const Elements<shader::OutputPair> pairs(contents(*pairsBuffer));
        Elements<std::uint32_t> words(contents(*wordsBuffer));
        for (std::uint32_t number = range_.first; number < range_.first + range_.count && number < pairs.size();
             ++number) {
            writeOutputsOf(number, pairs.get(number), words);
        }
    }
    void writeOutputsOf(std::uint32_t number, const shader::OutputPair& pair, Elements<std::uint32_t>& words) const {
        const auto add = [&](std::uint32_t at, std::uint32_t value) {
            if (at < words.size()) {
                words.set(at, words.get(at) + value);
            } else {
                s_.complain("an output is beyond its buffer");
            }
        };
        const std::uint32_t found = survivors();
        if ((pipeline_.outputs & OUTPUT_TRIANGLES) != 0) {
            add(pair.firstTriangle, found);
            words.set(pair.firstMask, words.get(pair.firstMask) | 1U);
        }
        for (std::uint32_t i = 0; (pipeline_.outputs & OUTPUT_BOUNDS) != 0 && i < OUTPUT_BOUND_WORDS; ++i) {
            const auto bound = std::bit_cast<std::uint32_t>(static_cast<float>(i < 3 ? 1 : found)) | 0x80000000U;
            words.set(pair.firstBound + i, std::max(words.get(pair.firstBound + i), bound));
        }
        if ((pipeline_.outputs & OUTPUT_LABELS) != 0 && pair.labelCount > 0) {
            add(pair.firstLabel + found % pair.labelCount, found);
        }
        if ((pipeline_.outputs & OUTPUT_CONTACTS) != 0) {
            const std::uint32_t place = words.get(pair.contacts);
            add(pair.contacts, 1);
            if (place < pair.contactRoom) {
                ContactResult contact{};
                contact.x = static_cast<float>(found);
                contact.pair = number;
                contact.label = pair.labelCount == 0 ? 0 : found % pair.labelCount;
                const auto values = std::bit_cast<std::array<std::uint32_t, OUTPUT_CONTACT_WORDS>>(contact);
                for (std::uint32_t i = 0; i < OUTPUT_CONTACT_WORDS; ++i) {
                    words.set(pair.contacts + OUTPUT_HEADER_WORDS + place * OUTPUT_CONTACT_WORDS + i, values[i]);
                }
            }
        }
    }

    void writeList() {
        if (const PretendDescriptor* list = pipeline_.lists ? storageBuffer(VOXTACT_SET_TRACE, 0) : nullptr) {
            const std::span<std::byte> bytes = contents(*list);
            std::fill(bytes.begin() + sizeof s_.traced, bytes.end(), std::byte{0});
            Elements<std::uint32_t>(bytes).set(0, s_.traced);
            Elements<std::uint32_t>(bytes).set(1, survivors()); // as the first triangle's number
        }
    }

    PretendState& s_;
    const Bound& bound_;
    const PretendPipeline& pipeline_;
    bool draws_;
    std::vector<const PretendDescriptorSet*> sets_;
    std::vector<Id> targets_; ///< images that are rendered to
    Range range_;
    Hash hash_;
};

} // namespace

void PretendState::draw(const Bound& bound, std::span<const std::uint32_t> numbers, std::uint32_t firstInstance,
                        std::uint32_t instances) {
    if (const PretendPipeline* pipeline = get(pipelines, bound.graphics)) {
        Execution(*this, bound, VK_PIPELINE_BIND_POINT_GRAPHICS, *pipeline).run(numbers, firstInstance, instances);
    }
}

void PretendState::dispatch(const Bound& bound, std::span<const std::uint32_t> numbers) {
    if (const PretendPipeline* pipeline = get(pipelines, bound.compute)) {
        Execution(*this, bound, VK_PIPELINE_BIND_POINT_COMPUTE, *pipeline).run(numbers, 0, 0);
    }
}

} // namespace voxtact::test
