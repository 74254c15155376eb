// SPDX-License-Identifier: MIT
// Edits of a volume in place: through a scratch buffer of some slices, or from a buffer of the caller's.
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/volume/edit_rows.h"
#include "core/volume/voxel_value.h"
#include "device/scene/bricks.h"
#include "device/scene/edit_pass.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/submit.h"
#include "vulkan/texels.h"

#include <algorithm>
#include <array>

namespace voxtact {

namespace {

constexpr VkDeviceSize kFillWord = 4; ///< what vkCmdFillBuffer and vkCmdUpdateBuffer write multiples of

VkDeviceSize roundedUp(VkDeviceSize bytes) {
    return (bytes + kFillWord - 1) / kFillWord * kFillWord;
}

Result<void> checkEditable(const VolumeImpl& volume, VkCommandBuffer commandBuffer) {
    if (!volume.editScratch.buffer) {
        return refuse(volume.image.image ? "the volume was made without VolumeOptions::editable"
                                         : "the volume is wrapped: its voxels are the caller's");
    }
    if (!volume.uploaded) {
        return neverUploaded("the volume");
    }
    return volume.context.recordable(commandBuffer);
}

/// The texel of a voxel, as often as it fits 32 bits.
std::uint32_t wordOf(const VoxelBytes& voxel, ScalarType type) {
    VoxelBytes texel{};
    fillTexels(type, voxel, texel.data());
    std::array<std::byte, kFillWord> word{};
    for (std::size_t at = 0; at < word.size(); ++at) {
        word[at] = texel[at % bytesPerVoxel(type)];
    }
    std::uint32_t bits = 0;
    std::memcpy(&bits, word.data(), sizeof bits);
    return bits;
}

VkBufferImageCopy copyOf(const VoxelBox& box, VkDeviceSize offset) {
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageOffset = {static_cast<std::int32_t>(box.first[0]), static_cast<std::int32_t>(box.first[1]),
                          static_cast<std::int32_t>(box.first[2])};
    region.imageExtent = {box.size[0], box.size[1], box.size[2]};
    return region;
}

bool reachesFaces(const VoxelBox& box, const Grid& grid) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.first[axis] == 0 || box.first[axis] + box.size[axis] == grid.size[axis]) {
            return true;
        }
    }
    return false;
}

/// One edit, while it is being recorded: what is before it, between its steps, and after it.
class Edit {
  public:
    Edit(VolumeImpl& volume, VkCommandBuffer commandBuffer, const VoxelBox& bounds)
        : volume_(volume), vk_(volume.context.vk), commandBuffer_(commandBuffer), bounds_(bounds),
          label_(volume.context, commandBuffer, "voxtact volume edit") {
        // The scratch buffer, and what the caller copies from.
        barrier(volume_.context, commandBuffer_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT);
        barrier(volume_.context, commandBuffer_, volume_.image.image.get(),
                {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, kReadByShaders.layout}, kCopied);
    }

    void fillScratch(VkDeviceSize bytes, std::uint32_t word) {
        beginScratch();
        vk_.CmdFillBuffer(commandBuffer_, volume_.editScratch.get(), 0, roundedUp(bytes), word);
        endScratch();
    }
    void writeScratch(std::span<const std::byte> voxels) {
        beginScratch();
        std::array<std::byte, 65536> texels; // what one vkCmdUpdateBuffer takes
        for (std::size_t done = 0; done < voxels.size(); done += texels.size()) {
            const auto part = voxels.subspan(done, std::min(texels.size(), voxels.size() - done));
            const auto whole = static_cast<std::size_t>(roundedUp(part.size()));
            std::fill(texels.begin() + static_cast<std::ptrdiff_t>(part.size()),
                      texels.begin() + static_cast<std::ptrdiff_t>(whole), std::byte{0});
            fillTexels(volume_.type, part, texels.data());
            vk_.CmdUpdateBuffer(commandBuffer_, volume_.editScratch.get(), done, whole, texels.data());
        }
        endScratch();
    }

    /// Gives those voxels of a box that are in rows a value. The scratch buffer has room for the box.
    void change(const VoxelBox& box, std::span<const VoxelRow> rows, std::uint32_t word) {
        constexpr VkAccessFlags2 kShader = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
        const VkImage image = volume_.image.image.get();
        const std::vector<std::uint32_t> table = rowTable(rows, box);
        const VkBufferImageCopy region = copyOf(box, 0);
        // What was changed before has been copied back, and its rows have been read.
        barrier(volume_.context, commandBuffer_, image, kCopied, kCopiedFrom);
        barrier(volume_.context, commandBuffer_,
                VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
        vk_.CmdCopyImageToBuffer(commandBuffer_, image, kCopiedFrom.layout, volume_.editScratch.get(), 1, &region);
        cmdUpdateBuffer(volume_.context, commandBuffer_, volume_.editRows.get(), 0, std::as_bytes(std::span(table)));
        barrier(volume_.context, commandBuffer_, image, kCopiedFrom, kCopied);
        barrier(volume_.context, commandBuffer_, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kShader);
        cmdChangeRows(volume_, commandBuffer_, box, word);
        barrier(volume_.context, commandBuffer_, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                VK_ACCESS_2_TRANSFER_READ_BIT);
        copyFromScratch(box);
        flushCopiesFromScratch();
    }

    /// Copies into a box of voxels, sooner or later.
    void copy(const VoxelBox& box, VkBuffer from, VkDeviceSize offset = 0) {
        copies_[pending_++] = copyOf(box, offset);
        if (pending_ == copies_.size()) {
            flushCopies(from);
        }
    }
    void copyFromScratch(const VoxelBox& box) { copy(box, volume_.editScratch.get()); }
    void flushCopies(VkBuffer from) {
        if (pending_ > 0) {
            vk_.CmdCopyBufferToImage(commandBuffer_, from, volume_.image.image.get(), kCopied.layout, pending_,
                                     copies_.data());
            pending_ = 0;
        }
    }
    void flushCopiesFromScratch() { flushCopies(volume_.editScratch.get()); }

    /// `values`: what was written, where that is known.
    void finish(const std::optional<ValueRange>& values) {
        barrier(volume_.context, commandBuffer_, volume_.image.image.get(), kCopied, kReadByShaders);
        if (volume_.bricks.buffer) {
            cmdBricks(volume_, commandBuffer_, bounds_);
        }
        if (reachesFaces(bounds_, volume_.grid)) {
            volume_.boundary.reset();
        }
        if (values && volume_.valueRange) {
            volume_.valueRange =
                ValueRange{std::min(volume_.valueRange->lo, values->lo), std::max(volume_.valueRange->hi, values->hi)};
        } else {
            volume_.valueRange.reset();
        }
    }

  private:
    static constexpr ImageUse kCopied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    static constexpr ImageUse kCopiedFrom{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                          VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};

    void beginScratch() {
        barrier(volume_.context, commandBuffer_, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    }
    void endScratch() {
        barrier(volume_.context, commandBuffer_, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
    }

    VolumeImpl& volume_;
    const DeviceFunctions& vk_;
    VkCommandBuffer commandBuffer_;
    VoxelBox bounds_;
    Label label_;
    std::array<VkBufferImageCopy, 256> copies_;
    std::uint32_t pending_ = 0;
};

VkDeviceSize bytesOf(const VolumeImpl& volume, VkDeviceSize voxels) {
    return voxels * bytesPerVoxel(volume.type);
}

/// The part of a box that an edit takes at once, from slice `done` of it on.
VoxelBox slab(const VolumeImpl& volume, const VoxelBox& box, std::uint32_t done) {
    return {{box.first[0], box.first[1], box.first[2] + done},
            {box.size[0], box.size[1], std::min(slicesAtOnce(volume, box), box.size[2] - done)}};
}

void set(const VolumeImpl& volume, Edit& edit, const VoxelBox& box, std::uint32_t word) {
    const std::uint32_t most = slicesAtOnce(volume, box);
    edit.fillScratch(bytesOf(volume, VkDeviceSize{box.size[0]} * box.size[1] * most), word);
    for (std::uint32_t done = 0; done < box.size[2]; done += most) {
        edit.copyFromScratch(slab(volume, box, done));
    }
    edit.flushCopiesFromScratch();
}

void set(const VolumeImpl& volume, Edit& edit, const std::vector<VoxelRow>& rows, std::uint32_t word) {
    const VoxelBox box = boundsOf(rows);
    const auto most = slicesAtOnce(volume, box);
    auto next = rows.begin();
    for (std::uint32_t done = 0; done < box.size[2]; done += most) {
        const VoxelBox part = slab(volume, box, done);
        const auto end = std::ranges::find_if(
            next, rows.end(), [&](const VoxelRow& row) { return row.z >= part.first[2] + part.size[2]; });
        edit.change(part, {next, end}, word);
        next = end;
    }
}

/// Writes as many slices at once as the scratch buffer holds.
void write(VolumeImpl& volume, Edit& edit, const VoxelBox& box, std::span<const std::byte> voxels) {
    const auto slice = static_cast<std::size_t>(bytesOf(volume, VkDeviceSize{box.size[0]} * box.size[1]));
    const std::uint32_t atOnce = slicesAtOnce(volume, box);
    for (std::uint32_t done = 0; done < box.size[2]; done += atOnce) {
        const std::uint32_t slices = std::min(atOnce, box.size[2] - done);
        edit.writeScratch(voxels.subspan(done * slice, slices * slice));
        edit.copyFromScratch({{box.first[0], box.first[1], box.first[2] + done}, {box.size[0], box.size[1], slices}});
        edit.flushCopiesFromScratch();
    }
}

} // namespace

Result<void> Volume::cmdSet(VkCommandBuffer commandBuffer, const VoxelRegion& region, double value) {
    return guard([&]() -> Result<void> {
        VolumeImpl& volume = live(impl_);
        VOXTACT_TRY(checkEditable(volume, commandBuffer));
        const Result<VoxelBox> bounds = voxelBounds(region, volume.grid);
        VOXTACT_TRY(bounds);
        const Result<VoxelBytes> voxel = voxelOf(volume.type, value);
        VOXTACT_TRY(voxel);
        if (isEmpty(*bounds)) {
            return {};
        }
        const std::uint32_t word = wordOf(*voxel, volume.type);
        const double held = valueOf(volume.type, *voxel);
        Edit edit(volume, commandBuffer, *bounds);
        if (std::holds_alternative<VoxelBox>(region)) {
            set(volume, edit, *bounds, word);
        } else {
            set(volume, edit, voxelRows(region, volume.grid), word);
        }
        edit.finish(ValueRange{held, held});
        return {};
    });
}

Result<void> Volume::cmdWrite(VkCommandBuffer commandBuffer, const VoxelBox& box, std::span<const std::byte> voxels) {
    return guard([&]() -> Result<void> {
        VolumeImpl& volume = live(impl_);
        VOXTACT_TRY(checkEditable(volume, commandBuffer));
        VOXTACT_TRY(voxelBounds(box, volume.grid));
        const Result<ValueRange> values = checkVoxels(volume.type, box, voxels);
        VOXTACT_TRY(values);
        if (isEmpty(box)) {
            return {};
        }
        Edit edit(volume, commandBuffer, box);
        write(volume, edit, box, voxels);
        edit.finish(*values);
        return {};
    });
}

Result<void> Volume::cmdCopy(VkCommandBuffer commandBuffer, const VoxelBox& box, VkBuffer source, VkDeviceSize offset) {
    return guard([&]() -> Result<void> {
        VolumeImpl& volume = live(impl_);
        VOXTACT_TRY(checkEditable(volume, commandBuffer));
        VOXTACT_TRY(voxelBounds(box, volume.grid));
        if (source == VK_NULL_HANDLE) {
            return refuse("the buffer to copy voxels from is null");
        }
        if (offset % kFillWord != 0) {
            return refuse("the offset " + std::to_string(offset) + " of the voxels to copy is not a multiple of 4");
        }
        if (isEmpty(box)) {
            return {};
        }
        Edit edit(volume, commandBuffer, box);
        edit.copy(box, source, offset);
        edit.flushCopies(source);
        edit.finish(std::nullopt);
        return {};
    });
}

} // namespace voxtact
