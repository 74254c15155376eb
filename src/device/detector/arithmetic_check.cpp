// SPDX-License-Identifier: MIT
#include "device/detector/arithmetic_check.h"

#include "core/base/try.h"
#include "device/scene/scene_impl.h"
#include "exact/operations.h"
#include "voxtact/scene.h"
#include "voxtact_shaders/operations_comp.h"
#include "voxtact_shaders/operations_doubles_comp.h"
#include "vulkan/barriers.h"
#include "vulkan/pipeline.h"
#include "vulkan/submit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <random>

namespace voxtact {

namespace {

/// Wrong results of an operation that are counted: a device that gets all of it wrong is known soon.
constexpr std::size_t kMostCounted = 1000;
constexpr std::array<std::uint32_t, 3> kTexelSize{64, 64, 16}; ///< a voxel for each number of 16 bits
constexpr std::uint32_t kTexels = 64 * 64 * 16;
static_assert(OPERATION_GROUP == OPERATION_COUNT);
static_assert(OPERATION_GROUP_WORDS <= VOXTACT_COMPUTE_GROUP * OPERATION_RESULTS, "a group's results fit");

constexpr std::array<const char*, OPERATION_COUNT> kNames{"float addition",
                                                          "float subtraction",
                                                          "float multiplication",
                                                          "float multiplication and addition",
                                                          "float multiplication and subtraction",
                                                          "a float sum in its order",
                                                          "the error of a float sum",
                                                          "the error of a float product",
                                                          "float negation",
                                                          "floor",
                                                          "float comparison",
                                                          "float comparison with NaN and infinity",
                                                          "float addition with NaN and infinity",
                                                          "float multiplication with NaN and infinity",
                                                          "the bits of a float",
                                                          "int to float",
                                                          "uint to float",
                                                          "float to int",
                                                          "int addition and subtraction",
                                                          "int multiplication",
                                                          "int shift",
                                                          "int comparison",
                                                          "int minimum and maximum",
                                                          "uint shift",
                                                          "uint division",
                                                          "uint comparison",
                                                          "the first bit of a uint",
                                                          "a 64-bit product of ints",
                                                          "64-bit addition",
                                                          "64-bit subtraction",
                                                          "the sign of a 64-bit integer",
                                                          "64-bit integer to float",
                                                          "double addition",
                                                          "double subtraction",
                                                          "double multiplication",
                                                          "double comparison",
                                                          "double to float",
                                                          "float to double",
                                                          "double addition with NaN and infinity",
                                                          "double multiplication with NaN and infinity",
                                                          "double comparison with NaN and infinity"};

float asFloat(std::uint32_t word) {
    return std::bit_cast<float>(word);
}

bool isDenormal(std::uint32_t word) {
    return (word & 0x7f800000U) == 0 && (word & 0x7fffffffU) != 0;
}

bool hasFloatResult(int operation) {
    return operation <= OPERATION_FLOAT_FLOOR || operation == OPERATION_FLOAT_SPECIAL_ADD ||
           operation == OPERATION_FLOAT_SPECIAL_MULTIPLY;
}

bool hasSpecials(int operation) {
    return operation == OPERATION_FLOAT_COMPARE_SPECIAL || operation == OPERATION_FLOAT_SPECIAL_ADD ||
           operation == OPERATION_FLOAT_SPECIAL_MULTIPLY;
}

/// Whether a result rests on a denormal, or, by the smallest normal number, on how denormals are rounded.
bool restsOnDenormals(int operation, const std::uint32_t* inputs, std::uint32_t expected) {
    if (operation == OPERATION_FLOAT_BITS) {
        return isDenormal(inputs[0]);
    }
    if (hasSpecials(operation) && (isDenormal(inputs[0]) || isDenormal(inputs[1]))) {
        return true;
    }
    constexpr std::uint32_t kLeastNormal = 0x00800000U;
    const std::uint32_t size = expected & 0x7fffffffU;
    const bool zeroOfTwo = size == 0 && operation == OPERATION_FLOAT_SPECIAL_MULTIPLY && asFloat(inputs[0]) != 0 &&
                           asFloat(inputs[1]) != 0;
    return hasFloatResult(operation) && ((size != 0 && size <= kLeastNormal) || zeroOfTwo);
}

bool isSame(int operation, std::uint32_t expected, std::uint32_t found) {
    const bool floats = hasFloatResult(operation) || operation == OPERATION_FLOAT_BITS;
    return expected == found || (floats && std::isnan(asFloat(expected)) && std::isnan(asFloat(found)));
}

std::string hex(std::uint32_t word) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string out = "0x";
    for (int shift = 28; shift >= 0; shift -= 4) {
        out += kDigits[(word >> static_cast<unsigned>(shift)) & 15U];
    }
    return out;
}

/// The pipeline with its buffers.
class Bench {
  public:
    static Result<Bench> create(const Context& context, const QueueAccess& queue, std::uint32_t groups);

    [[nodiscard]] std::uint32_t groups() const { return groups_; }
    [[nodiscard]] std::uint32_t sets() const { return groups_ * VOXTACT_COMPUTE_GROUP; }

    [[nodiscard]] std::span<std::uint32_t> inputs() const {
        return {static_cast<std::uint32_t*>(inputs_.mapped), std::size_t{sets()} * OPERATION_INPUTS};
    }
    /// Of the last run().
    [[nodiscard]] std::span<const std::uint32_t> results() const {
        return {static_cast<const std::uint32_t*>(results_.mapped), results_.size / sizeof(std::uint32_t)};
    }
    /// Where constants.texels says so, it reads `volume`.
    Result<void> run(const shader::OperationConstants& constants, const Volume* volume, std::uint32_t groupsX,
                     std::uint32_t groupsY);

  private:
    Bench(ContextImpl& context, Submitter submitter, std::uint32_t groups) noexcept
        : context_(&context), groups_(groups), submitter_(std::move(submitter)) {}

    ContextImpl* context_;
    std::uint32_t groups_; ///< work groups of inputs
    Owned<VkPipeline> pipeline_;
    Buffer inputs_;
    Buffer results_;
    DescriptorSet set_;
    Submitter submitter_;
};

Result<Bench> Bench::create(const Context& context, const QueueAccess& queue, std::uint32_t groups) {
    ContextImpl& impl = context.impl();
    Result<Submitter> submitter = Submitter::create(impl, queue, VK_QUEUE_COMPUTE_BIT);
    VOXTACT_TRY(submitter);
    Bench out(impl, std::move(*submitter), groups);
    Result<Owned<VkPipeline>> pipeline =
        impl.floatControls.doubles()
            ? makeComputePipeline(impl, spirv::operations_doubles_comp, {}, impl.computeLayout, "arithmetic self-test")
            : makeComputePipeline(impl, spirv::operations_comp, {}, impl.computeLayout, "arithmetic self-test");
    VOXTACT_TRY(pipeline);
    out.pipeline_ = std::move(*pipeline);
    Result<Buffer> inputs = makeBuffer(impl, std::size_t{out.sets()} * OPERATION_INPUTS * sizeof(std::uint32_t),
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::Upload, "arithmetic inputs");
    VOXTACT_TRY(inputs);
    out.inputs_ = std::move(*inputs);
    const std::size_t resultWords =
        std::max((OPERATION_COUNT + 1) * std::size_t{out.sets()} * OPERATION_RESULTS, std::size_t{kTexels});
    Result<Buffer> results = makeBuffer(impl, resultWords * sizeof(std::uint32_t), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                        MemoryUse::ReadBack, "arithmetic results");
    VOXTACT_TRY(results);
    out.results_ = std::move(*results);
    constexpr VkDescriptorPoolSize kSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 2};
    Result<DescriptorSet> set = makeDescriptorSet(impl, impl.setLayouts[VOXTACT_SET_PAIRS], {&kSize, 1}, "arithmetic");
    VOXTACT_TRY(set);
    out.set_ = std::move(*set);
    writeBuffer(impl, out.set_.set, VOXTACT_BINDING_TRANSFORMS, out.inputs_.get());
    writeBuffer(impl, out.set_.set, VOXTACT_BINDING_RESULTS, out.results_.get());
    return out;
}

Result<void> Bench::run(const shader::OperationConstants& constants, const Volume* volume, std::uint32_t groupsX,
                        std::uint32_t groupsY) {
    VOXTACT_TRY(flush(*context_, inputs_));
    const Result<VkCommandBuffer> commandBuffer = submitter_.begin();
    VOXTACT_TRY(commandBuffer);
    const DeviceFunctions& vk = context_->vk;
    const VkPipelineLayout layout = context_->computeLayout;
    vk.CmdBindPipeline(*commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
    vk.CmdBindDescriptorSets(*commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout, VOXTACT_SET_VOLUME, 1,
                             &volume->impl().descriptors.set, 0, nullptr);
    vk.CmdBindDescriptorSets(*commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout, VOXTACT_SET_PAIRS, 1, &set_.set, 0,
                             nullptr);
    vk.CmdPushConstants(*commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
    vk.CmdDispatch(*commandBuffer, groupsX, groupsY, 1);
    barrier(*context_, *commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    VOXTACT_TRY(submitter_.submitAndWait());
    return invalidate(*context_, results_);
}

/// What was found wrong: the first few by name.
class Findings {
  public:
    void add(const std::string& name, const std::string& detail) {
        ++count_;
        if (count_ <= kNamed) {
            text_ += (text_.empty() ? "" : ", ") + name + (count_ == 1 ? " (" + detail + ")" : "");
        }
    }
    [[nodiscard]] std::string text() const {
        return count_ > kNamed ? text_ + " and " + std::to_string(count_ - kNamed) + " more" : text_;
    }

  private:
    static constexpr std::size_t kNamed = 3;
    std::size_t count_ = 0;
    std::string text_;
};

/// How many work groups have other results than they should, of what lanes do together.
std::size_t wrongGroups(std::span<const std::uint32_t> inputs, std::span<const std::uint32_t> results) {
    constexpr std::size_t kGroupInputs = std::size_t{OPERATION_INPUTS} * VOXTACT_COMPUTE_GROUP;
    std::size_t wrong = 0;
    for (std::size_t group = 0; group < inputs.size() / kGroupInputs; ++group) {
        std::uint32_t sum = 0;
        std::uint32_t bits = 0;
        std::uint32_t most = 0;
        for (std::size_t lane = 0; lane < VOXTACT_COMPUTE_GROUP; ++lane) {
            const std::uint32_t value = inputs[group * kGroupInputs + OPERATION_INPUTS * lane] & 0xffffU;
            sum += value;
            bits |= value;
            most = std::max(most, value);
        }
        const std::array<std::uint32_t, OPERATION_GROUP_WORDS> expected{sum, bits, most};
        const auto found = results.subspan(group * OPERATION_GROUP_WORDS, OPERATION_GROUP_WORDS);
        wrong += std::ranges::equal(expected, found) ? 0U : 1U;
    }
    return wrong;
}

static_assert(std::endian::native == std::endian::little, "the low bytes of a word are a voxel");

/// Every number of 8 or 16 bits; of floats the inputs of operations that are finite and not denormal.
std::vector<std::byte> everyTexel(ScalarType type, std::span<const std::uint32_t> inputs) {
    std::vector<std::byte> out(kTexels * bytesPerVoxel(type));
    for (std::uint32_t i = 0; i < kTexels; ++i) {
        std::uint32_t word = i;
        if (type == ScalarType::Float32) {
            word = inputs[i % inputs.size()];
            word = std::isfinite(asFloat(word)) && !isDenormal(word) ? word : (i << 7U) | 0x3f800000U;
        }
        std::memcpy(out.data() + i * bytesPerVoxel(type), &word, bytesPerVoxel(type));
    }
    return out;
}

/// What a shader must read of a voxel: the stored number. int16 is kept with its sign bit flipped.
float storedOf(ScalarType type, const std::byte* voxel) {
    std::uint32_t word = 0;
    std::memcpy(&word, voxel, bytesPerVoxel(type));
    if (type == ScalarType::Float32) {
        return asFloat(word);
    }
    return static_cast<float>(type == ScalarType::Int16 ? word ^ 0x8000U : word);
}

/// A volume of all voxels of a type; nothing where the device does not take it.
Result<std::optional<Volume>> makeTexels(const Context& context, const QueueAccess& queue, ScalarType type,
                                         std::span<const std::byte> voxels) {
    Grid grid;
    grid.size = kTexelSize;
    Result<Volume> volume = Volume::upload(context, queue, {grid, type, voxels}, {.name = "every texel"});
    if (!volume.ok() && volume.error().code == ErrorCode::Unsupported) {
        return std::optional<Volume>();
    }
    VOXTACT_TRY(volume);
    return std::optional<Volume>(std::move(*volume));
}

Result<void> checkTexels(Bench& bench, ScalarType type, const Volume& volume, std::span<const std::byte> voxels,
                         Findings& findings) {
    const double unit = volume.impl().storedUnit;
    VOXTACT_TRY(bench.run({0, 1, static_cast<float>(unit)}, &volume, kTexels / VOXTACT_COMPUTE_GROUP, 1));
    const std::span<const std::uint32_t> results = bench.results();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < kTexels; ++i) {
        const float stored = storedOf(type, voxels.data() + i * bytesPerVoxel(type));
        wrong += results[i] == std::bit_cast<std::uint32_t>(stored) ? 0U : 1U;
    }
    if (wrong > 0) {
        findings.add(std::string("texels of ") + toString(type),
                     std::to_string(wrong) + " of " + std::to_string(kTexels));
    }
    return {};
}

/// `any`: the shader has a volume, read or not.
Result<std::uint32_t> checkOperations(const ContextImpl& context, Bench& bench, const Volume& any, Findings& findings) {
    const std::size_t each = std::size_t{bench.sets()} * OPERATION_RESULTS;
    VOXTACT_TRY(bench.run({bench.sets(), 0, 0}, &any, bench.groups(), OPERATION_COUNT + 1));
    const std::span<const std::uint32_t> inputs = bench.inputs();
    std::uint32_t asked = 1;
    for (int operation = 0; operation < OPERATION_COUNT; ++operation) {
        const bool isOfDoubles = operation >= OPERATION_WIDE_ADD;
        if ((hasSpecials(operation) && !context.floatControls.keepsSpecials) ||
            (isOfDoubles && !context.floatControls.doubles())) {
            continue;
        }
        ++asked;
        const auto results = bench.results().subspan(static_cast<std::size_t>(operation) * each, each);
        const OperationFaults faults = operationFaults(operation, inputs, results, kMostCounted);
        if (faults.count > 0) {
            const std::uint32_t* first = inputs.data() + faults.first * OPERATION_INPUTS;
            findings.add(operationName(operation), std::string(faults.count == kMostCounted ? "at least " : "") +
                                                       std::to_string(faults.count) + " of " +
                                                       std::to_string(bench.sets()) + ", first of " + hex(first[0]) +
                                                       " " + hex(first[1]) + " " + hex(first[2]));
        }
    }
    const std::size_t groups = wrongGroups(inputs, bench.results().subspan(OPERATION_GROUP * each));
    if (groups > 0) {
        findings.add("sums of work groups", std::to_string(groups) + " of " + std::to_string(bench.groups()));
    }
    return asked;
}

} // namespace

const char* operationName(int operation) noexcept {
    return kNames[static_cast<std::size_t>(operation)];
}

std::vector<std::uint32_t> operationInputs(std::size_t count) {
    constexpr std::array<std::uint32_t, 24> kSpecial{
        0,           0x80000000U, 1,           0x7fffffffU, 0xffffffffU, 0x3f800000U, 0xbf800000U, 0x3f800001U,
        0x3f7fffffU, 0x4b000000U, 0x4b7fffffU, 0x4b800000U, 0xcb800000U, 0x7f800000U, 0xff800000U, 0x7fc00000U,
        0x7f7fffffU, 0xff7fffffU, 0x00800000U, 0x80800000U, 0x4f000000U, 0xcf000000U, 0x3f000000U, 0x33800000U};
    std::mt19937_64 random(count);
    std::vector<std::uint32_t> out(count * OPERATION_INPUTS);
    for (std::size_t set = 0; set < count; ++set) {
        const std::uint64_t kind = random() % 4;
        for (std::size_t i = 0; i < OPERATION_INPUTS; ++i) {
            auto word = static_cast<std::uint32_t>(random());
            if (kind == 1 || (kind == 2 && random() % 2 == 0)) {
                word = kSpecial[random() % kSpecial.size()];
            } else if (kind == 3) {
                // Few bits of the mantissa, so that sums and products are ties, and numbers meet.
                word &= 0xff800000U | (3U << static_cast<unsigned>(random() % 22));
            }
            out[set * OPERATION_INPUTS + i] = word;
        }
    }
    return out;
}

OperationFaults operationFaults(int operation, std::span<const std::uint32_t> inputs,
                                std::span<const std::uint32_t> results, std::size_t most) {
    OperationFaults faults;
    const std::size_t sets = inputs.size() / OPERATION_INPUTS;
    for (std::size_t set = 0; set < sets && faults.count < most; ++set) {
        const std::uint32_t* in = inputs.data() + set * OPERATION_INPUTS;
        const std::uint32_t* found = results.data() + set * OPERATION_RESULTS;
        std::uint32_t low = 0;
        std::uint32_t high = 0;
        shader::operate(operation, in[0], in[1], in[2], in[3], low, high);
        const bool wrong = (!isSame(operation, low, found[0]) && !restsOnDenormals(operation, in, low)) ||
                           (!isSame(operation, high, found[1]) && !restsOnDenormals(operation, in, high));
        if (wrong && faults.count++ == 0) {
            faults.first = set;
        }
    }
    return faults;
}

Result<ArithmeticVerdict> checkArithmetic(const Context& context, const QueueAccess& queue, std::uint32_t groups) {
    Result<Bench> bench = Bench::create(context, queue, groups);
    VOXTACT_TRY(bench);
    std::ranges::copy(operationInputs(bench->sets()), bench->inputs().begin());
    ArithmeticVerdict verdict;
    Findings findings;
    for (const ScalarType type : {ScalarType::UInt8, ScalarType::UInt16, ScalarType::Int16, ScalarType::Float32}) {
        const std::vector<std::byte> voxels = everyTexel(type, bench->inputs());
        const Result<std::optional<Volume>> volume = makeTexels(context, queue, type, voxels);
        VOXTACT_TRY(volume);
        if (!volume->has_value()) {
            continue;
        }
        if (verdict.operations == 0) {
            const Result<std::uint32_t> asked = checkOperations(context.impl(), *bench, **volume, findings);
            VOXTACT_TRY(asked);
            verdict.operations = *asked;
        }
        ++verdict.operations;
        VOXTACT_TRY(checkTexels(*bench, type, **volume, voxels, findings));
    }
    verdict.wrong = findings.text();
    return verdict;
}

} // namespace voxtact
