// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/bent_meshes.h"
#include "device/detector/detector_impl.h"
#include "raw_fixture.h"
#include "vulkan/context_impl.h"

#include <deque>

namespace voxtact::test {

/// Of vertices in buffers of the test's own: `offset` bytes before the first, `stride` from one to the next.
struct Spacing {
    std::uint32_t stride = 12;
    std::uint32_t offset = 0;
};
[[nodiscard]] Spacing randomSpacing(std::mt19937_64& random);

/// Meshes that change between the commands of a command buffer, in one volume.
class BendFixture : public RawGpuTest {
  protected:
    void SetUp() override;
    void TearDown() override;

    /// A detector, and room for what it answers in one command buffer.
    struct Way {
        Detector detector;
        std::deque<Results> results;
    };
    /// All projections and methods that the device has; with outputs where there are any.
    [[nodiscard]] std::vector<Way> allWays() const;

    [[nodiscard]] BatchItem item(const Mesh& mesh) const { return {&mesh, &*volume_, &*function_, poses_, &*labels_}; }
    /// Records a detection by each way, into results of number `which`; 0 is for expectFresh().
    void detect(VkCommandBuffer commands, std::vector<Way>& ways, const Mesh& mesh, std::size_t which) const;
    /// What they hold, once that is complete.
    static BatchAnswer answerOf(Way& way, std::size_t which);
    /// A mesh made of a shape answers by each way as the results of number `which` do. `clusters`: it has some.
    void expectFresh(std::vector<Way>& ways, const MeshData& shape, std::size_t which, bool clusters);

    /// A buffer that a command of the test's own has filled with vertices; a reader needs a barrier. What is
    /// between them is NaN.
    VkBuffer written(VkCommandBuffer commands, std::span<const double> positions, const Spacing& spacing,
                     VkBufferUsageFlags usage);
    /// Fills it again. Earlier readers are waited for.
    void write(VkCommandBuffer commands, VkBuffer buffer, std::span<const double> positions, const Spacing& spacing);
    /// A host's copy of a buffer on the device.
    std::vector<std::uint32_t> wordsOf(const Buffer& buffer);
    /// The boxes of clusters and runs that a mesh has on the device are those of its shape.
    void expectBoxes(const Mesh& mesh, const MeshData& shape);

    VolumeData image_;
    std::optional<Volume> volume_;
    std::optional<TransferFunction> function_;
    std::optional<LabelMap> labels_;
    std::vector<Mat4> poses_{identity()};
    View view_;
    std::size_t hits_ = 0;  ///< that expectFresh() has seen
    std::size_t whole_ = 0; ///< answers that it has compared whole
    std::size_t cut_ = 0;   ///< and as far as a device that ends long loops lets it
};

} // namespace voxtact::test
