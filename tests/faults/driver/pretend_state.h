// SPDX-License-Identifier: MIT
#pragma once

#include "faults/ledger.h"
#include "pretend_driver.h"
#include "vulkan/device_functions.h"

#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>

/// What PretendDriver is made of.
namespace voxtact::test {

using Id = std::uint64_t;

inline constexpr VkDeviceSize kAlignment = 16; ///< of buffers and images
inline constexpr VkDeviceSize kAtom = 64;      ///< nonCoherentAtomSize

struct PretendMemory {
    std::vector<std::byte> bytes;
    std::vector<std::byte> host; ///< what the host sees: other bytes until they are flushed or invalidated
    std::map<VkDeviceSize, VkDeviceSize> bound; ///< ranges of buffers and images: their ends by where they begin
};

struct PretendBuffer {
    VkDeviceSize size = 0;
    Id memory = 0;
    VkDeviceSize offset = 0;
};

struct PretendImage {
    VkExtent3D extent{};
    std::size_t texelBytes = 0;
    Id memory = 0;
    VkDeviceSize offset = 0;
    [[nodiscard]] std::size_t bytes() const { return texelBytes * extent.width * extent.height * extent.depth; }
};

struct PretendImageView {
    Id image = 0;
};

struct PretendSetLayout {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
};

struct PretendPipelineLayout {
    std::vector<Id> sets;
};

struct PretendShaderModule {
    std::uint64_t hash = 0;
    bool bricks = false;     ///< the pass that fills the bricks of a volume
    bool operations = false; ///< the arithmetic self-test
    bool edits = false;      ///< the pass that edits voxels
    bool tally = false;      ///< the pass that counts what others of the projection certified did
};

struct PretendPipeline {
    std::uint64_t hash = 0;
    std::size_t sets = 0; ///< of its layout
    std::uint32_t vertexBuffers = 0;
    bool bricks = false;       ///< as in its module
    bool operations = false;   ///< the same
    bool edits = false;        ///< the same
    bool tally = false;        ///< the same
    bool certified = false;    ///< the projection certified
    bool lists = false;        ///< a list of survivors
    std::uint32_t outputs = 0; ///< OUTPUT_*
    std::uint32_t views = 1;
};

struct PretendDescriptor {
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
    Id buffer = 0;
    VkDeviceSize offset = 0;
    VkDeviceSize range = 0;
    Id view = 0;
};

struct PretendDescriptorSet {
    Id pool = 0;
    std::map<std::uint32_t, PretendDescriptor> bindings;
};

struct PretendQueryPool {
    std::vector<std::optional<std::uint64_t>> values;
};

struct PretendFence {
    bool signalled = false;
};

/// What commands before a draw or dispatch have set.
struct Bound {
    Id graphics = 0;
    Id compute = 0;
    std::array<std::array<Id, 8>, 2> sets{}; ///< by VkPipelineBindPoint
    std::array<std::byte, 128> constants{};
    struct Vertices {
        Id buffer = 0;
        VkDeviceSize offset = 0;
        VkDeviceSize stride = 0;
    };
    std::array<Vertices, 2> vertices{};
    Id indices = 0;
    VkDeviceSize indexOffset = 0;
    VkViewport viewport{};
    std::vector<Id> colours; ///< views that are rendered to
    Id queries = 0;          ///< of the query that is active; 0: none
    std::uint32_t query = 0;
};

struct PretendCommand {
    std::vector<Id> uses;
    std::function<void()> execute;
};

struct PretendCommandBuffer {
    enum class State { Initial, Recording, Executable };
    Id pool = 0;
    State state = State::Initial;
    Bound bound;
    std::vector<PretendCommand> commands;
};

struct PretendCommandPool {
    std::vector<Id> buffers;
};

struct Submission {
    std::unordered_set<Id> uses; ///< every object that it reaches
    std::vector<PretendCommand> commands;
    Id fence = 0;
};

/// Objects of one kind by their handles.
template <class Handle, class Object> class Shelf {
  public:
    Handle add(Id id, Object object) {
        objects_.emplace(id, std::move(object));
        return reinterpret_cast<Handle>(id);
    }
    [[nodiscard]] Object* find(Id id) {
        const auto found = objects_.find(id);
        return found == objects_.end() ? nullptr : &found->second;
    }
    void remove(Id id) { objects_.erase(id); }

  private:
    std::unordered_map<Id, Object> objects_;
};

struct PretendState {
    PretendDriver::Counting counting = PretendDriver::Counting::Hash;
    std::uint32_t traced = 3;
    bool lost = false;
    VkDeviceSize heap = 0; ///< bytes
    Id next = 0x1000;
    std::vector<std::string> complaints;
    std::deque<Submission> pending;
    std::uint64_t ticks = 0;

    Shelf<VkDeviceMemory, PretendMemory> memories;
    Shelf<VkBuffer, PretendBuffer> buffers;
    Shelf<VkImage, PretendImage> images;
    Shelf<VkImageView, PretendImageView> views;
    Shelf<VkSampler, int> samplers;
    Shelf<VkDescriptorSetLayout, PretendSetLayout> setLayouts;
    Shelf<VkPipelineLayout, PretendPipelineLayout> pipelineLayouts;
    Shelf<VkShaderModule, PretendShaderModule> modules;
    Shelf<VkPipeline, PretendPipeline> pipelines;
    Shelf<VkDescriptorPool, std::vector<Id>> descriptorPools;
    Shelf<VkDescriptorSet, PretendDescriptorSet> sets;
    Shelf<VkQueryPool, PretendQueryPool> queryPools;
    Shelf<VkFence, PretendFence> fences;
    Shelf<VkCommandPool, PretendCommandPool> commandPools;
    Shelf<VkCommandBuffer, PretendCommandBuffer> commandBuffers;

    void complain(const std::string& what) { complaints.push_back(what); }
    /// The object of a handle; null, with a complaint, where there is none.
    template <class Handle, class Object> Object* get(Shelf<Handle, Object>& shelf, Id id) {
        Object* object = shelf.find(id);
        if (object == nullptr) {
            complain(std::string("a ") + kHandleName<Handle> + " is used that does not exist: " + std::to_string(id));
        }
        return object;
    }
    template <class Handle, class Object> Object* get(Shelf<Handle, Object>& shelf, Handle handle) {
        return get(shelf, bitsOf(handle));
    }
    /// Ends an object, with a complaint where it does not exist or a submission uses it.
    template <class Handle, class Object> void end(Shelf<Handle, Object>& shelf, Handle handle) {
        if (get(shelf, handle) != nullptr) {
            expectIdle(handle, "destroyed");
            shelf.remove(bitsOf(handle));
        }
    }
    template <class Handle> void expectIdle(Handle handle, const char* what) {
        if (inUse(bitsOf(handle))) {
            complain(std::string("a ") + kHandleName<Handle> + " is " + what + " while a submission uses it");
        }
    }
    [[nodiscard]] bool inUse(Id id) const;

    /// Binds a buffer or image to its memory, with a complaint where it is not aligned, leaves the memory or shares a
    /// byte of it with another one.
    void bind(Id memory, VkDeviceSize offset, VkDeviceSize size);
    void unbind(Id memory, VkDeviceSize offset);
    /// The memory of a buffer or image; empty, with a complaint, where it has none.
    std::span<std::byte> bytesOf(Id memory, VkDeviceSize offset, VkDeviceSize size, const char* what);
    std::span<std::byte> bufferBytes(Id buffer, VkDeviceSize offset = 0, VkDeviceSize size = VK_WHOLE_SIZE);
    std::span<std::byte> imageBytes(Id image);

    void executeUntil(Id fence); ///< 0: all
    void draw(const Bound& bound, std::span<const std::uint32_t> numbers, std::uint32_t firstInstance,
              std::uint32_t instances);
    void dispatch(const Bound& bound, std::span<const std::uint32_t> numbers);
};

/// What the arithmetic self-test's shader makes of its inputs: in all of its work groups, as the host does it. The same
/// inputs are gone through once.
void playOperations(std::span<const std::uint32_t> inputs, std::span<std::uint32_t> outputs);
/// What it reads of an image of UNORM texels or 32-bit floats.
void playTexels(std::span<const std::byte> image, std::size_t texelBytes, std::span<std::uint32_t> outputs);

/// The state of the driver that there is.
[[nodiscard]] PretendState& pretend();

/// 64-bit FNV-1a, by words.
class Hash {
  public:
    void add(std::span<const std::byte> bytes);
    template <class Number> void number(Number number) { add(std::as_bytes(std::span(&number, 1))); }
    [[nodiscard]] std::uint64_t value() const noexcept { return value_; }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325;
};

/// The driver's functions, with Vulkan's names without the vk: a declaration for each that voxtact calls.
namespace pretended {
#define VOXTACT_PRETENDED(name) std::remove_pointer_t<PFN_vk##name> name;
VOXTACT_INSTANCE_FUNCTIONS(VOXTACT_PRETENDED)
VOXTACT_DEVICE_FUNCTIONS(VOXTACT_PRETENDED)
VOXTACT_DEBUG_FUNCTIONS(VOXTACT_PRETENDED)
#undef VOXTACT_PRETENDED
} // namespace pretended

} // namespace voxtact::test
