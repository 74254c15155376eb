// SPDX-License-Identifier: MIT
#include "detect/certified/open_pairs.h"
#include "clearance_words.h"
#include "detect/certified/certified_queues.h"

namespace voxtact {

namespace {

constexpr std::uint32_t groupsFor(std::uint32_t lanes) noexcept {
    return (lanes + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP;
}

} // namespace

OpenPairs::OpenPairs(const ResultsImpl& results, const BatchItem& item) noexcept
    : results_(&results), pairs_(static_cast<std::uint32_t>(item.pairs())),
      word_(firstQueueWord(results) + VOXTACT_WORD_OPEN_PAIRS(results.queueRoom, results.maxPairs)) {}

std::uint32_t OpenPairs::setOf(std::uint32_t step) const noexcept {
    return word_ + step % 2 * VOXTACT_OPEN_SET_WORDS(pairs_);
}

std::uint32_t OpenPairs::listWord() const noexcept {
    return word_ + VOXTACT_OPEN_SETS_WORDS(pairs_);
}

void OpenPairs::recordNone(const ContextImpl& context, VkCommandBuffer commandBuffer) const {
    context.vk.CmdFillBuffer(commandBuffer, results_->transforms.get(), VkDeviceSize{word_} * sizeof(std::uint32_t),
                             VkDeviceSize{VOXTACT_OPEN_SETS_WORDS(pairs_)} * sizeof(std::uint32_t), 0);
}

shader::OpenPairs OpenPairs::listing(std::uint32_t step, const RoundCut* touch, const RoundCut& look) const {
    shader::OpenPairs open{};
    open.list = listWord();
    open.set = setOf(step);
    open.nextSet = setOf(step + 1);
    open.slots = pairs_;
    if (touch != nullptr) {
        const RoundSize size = sizeOfRounds(*touch);
        open.touchPairs = size.pairs;
        open.touchGroups = groupsFor(size.clusters);
    }
    const RoundSize size = sizeOfRounds(look);
    open.lookPairs = size.pairs;
    open.lookGroups = groupsFor(size.clusters);
    return open;
}

ListedPairs OpenPairs::touches(std::uint32_t step) const noexcept {
    return {listWord(), setOf(step) + VOXTACT_OPEN_TOUCH(0)};
}

ListedPairs OpenPairs::looks(std::uint32_t step) const noexcept {
    return {listWord(), setOf(step) + VOXTACT_OPEN_LOOK(pairs_, 0)};
}

} // namespace voxtact
