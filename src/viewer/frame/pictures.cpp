// SPDX-License-Identifier: MIT
#include "viewer/frame/pictures.h"

#include "core/base/try.h"
#include "vulkan/own/created.h"

#include <utility>

namespace voxtact::view {

namespace {

constexpr std::uint32_t kStamps = 2; // of a frame: before its picture and after it
constexpr double kNanosecondsOfMillisecond = 1e6;

double tickOf(const device::VulkanDevice& device) {
    const ContextDesc& desc = device.contextDesc();
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceProperties>(
        desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceProperties"));
    VkPhysicalDeviceProperties properties{};
    get(desc.physicalDevice, &properties);
    return static_cast<double>(properties.limits.timestampPeriod) / kNanosecondsOfMillisecond;
}

} // namespace

Result<Pictures> Pictures::create(const device::Session& session, const Renderer& renderer, const Extent& extent) {
    Pictures out(session);
    const device::VulkanDevice& device = session.device;
    if (device.hasTimestamps()) {
        VkQueryPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = kStamps * kFramesInFlight;
        const VkResult result = device::createdOrNull(
            device.table().vkCreateQueryPool(device.handle(), &info, nullptr, &out.timestamps_), out.timestamps_);
        if (result != VK_SUCCESS) {
            return device::vulkanError(result, "making the timestamps of the window");
        }
        out.tick_ = tickOf(device);
    }
    VOXTACT_TRY(out.resize(renderer, extent));
    return out;
}

Pictures::Pictures(Pictures&& other) noexcept
    : session_(other.session_), timestamps_(std::exchange(other.timestamps_, VK_NULL_HANDLE)), tick_(other.tick_),
      targets_(std::move(other.targets_)), coarse_(std::move(other.coarse_)), fine_(std::move(other.fine_)),
      full_(other.full_), shown_(other.shown_), coarseOf_(other.coarseOf_), fineOf_(other.fineOf_),
      fineRows_(other.fineRows_), pace_(other.pace_), made_(other.made_) {}

Pictures::~Pictures() {
    session_->device.table().vkDestroyQueryPool(session_->device.handle(), timestamps_, nullptr);
}

bool Pictures::fits(const Extent& extent) const {
    return extent.width == full_.width && extent.height == full_.height;
}

Result<void> Pictures::resize(const Renderer& renderer, const Extent& extent) {
    const VkExtent2D size{extent.width, extent.height};
    constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    Result<Image> coarse = Image::create(session_->device, size, VK_FORMAT_R8G8B8A8_UNORM, kUsage);
    VOXTACT_TRY(coarse);
    Result<Image> fine = Image::create(session_->device, size, VK_FORMAT_R8G8B8A8_UNORM, kUsage);
    VOXTACT_TRY(fine);
    Result<RenderTargets> targets = RenderTargets::create(renderer, size);
    VOXTACT_TRY(targets);
    VOXTACT_TRY(submitAndWait(*session_, [&](VkCommandBuffer commands) {
        for (VkImage image : {coarse->handle(), fine->handle()}) {
            layoutBarrier(session_->device, commands, {image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL}, {},
                          {});
        }
    }));
    coarse_ = std::move(*coarse);
    fine_ = std::move(*fine);
    targets_ = std::move(*targets);
    full_ = extent;
    shown_ = {1, 1};
    coarseOf_ = fineOf_ = 0;
    return {};
}

Result<void> Pictures::record(VkCommandBuffer commands, DeviceScene& scene, State& state, std::uint32_t slot) {
    made_[slot] = {};
    const bool coarse = coarseOf_ != state.pictureRevision;
    const bool answered = state.answer && state.answer->revision == state.revision;
    const bool fresh = fineOf_ != state.pictureRevision;
    const bool fine = !coarse && answered && state.atRest() && (fresh || fineRows_ < full_.height);
    if (!coarse && !fine) {
        return {};
    }
    Target target;
    target.view = coarse ? coarse_.view() : fine_.view();
    target.layout = VK_IMAGE_LAYOUT_GENERAL;
    target.targets = &*targets_;
    target.extent = {full_.width, full_.height};
    if (coarse) {
        shown_ = pace_.coarse(full_);
        target.extent = {shown_.width, shown_.height};
        coarseOf_ = state.pictureRevision;
        made_[slot].coarse = static_cast<double>(shown_.width) * shown_.height;
    } else {
        const std::uint32_t first = fresh ? 0 : fineRows_;
        const std::uint32_t rows = std::min(pace_.rows(full_), full_.height - first);
        target.area = {{0, static_cast<std::int32_t>(first)}, {full_.width, rows}};
        fineOf_ = state.pictureRevision;
        fineRows_ = first + rows;
        state.fineShare = static_cast<double>(fineRows_) / full_.height;
        made_[slot].fine = static_cast<double>(full_.width) * rows;
    }
    const VolkDeviceTable& table = session_->device.table();
    const std::uint32_t stamp = slot * kStamps;
    if (timestamps_ != VK_NULL_HANDLE) {
        table.vkCmdResetQueryPool(commands, timestamps_, stamp, kStamps);
        table.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps_, stamp);
        made_[slot].timed = true;
    }
    // The frame before may show it still, and may still write the rows above.
    memoryBarrier(session_->device, commands,
                  {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
                  {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT});
    const Extent shape = coarse ? shown_ : full_;
    VOXTACT_TRY(scene.renderer().cmdRender(commands, scene.scene(state, slot, fine, shape).scene, target));
    if (made_[slot].timed) {
        table.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps_, stamp + 1);
    }
    return {};
}

void Pictures::collect(std::uint32_t slot, double wallMilliseconds) {
    Made& made = made_[slot];
    double milliseconds = wallMilliseconds;
    std::array<std::uint64_t, kStamps> stamps{};
    if (made.timed && session_->device.table().vkGetQueryPoolResults(
                          session_->device.handle(), timestamps_, slot * kStamps, kStamps, sizeof stamps, stamps.data(),
                          sizeof(std::uint64_t), VK_QUERY_RESULT_64_BIT) == VK_SUCCESS) {
        milliseconds = static_cast<double>(stamps[1] - stamps[0]) * tick_;
    }
    if (made.coarse > 0) {
        pace_.tookCoarse(made.coarse, milliseconds);
    } else if (made.fine > 0) {
        pace_.tookFine(made.fine, milliseconds);
    }
    made = {};
}

} // namespace voxtact::view
