// SPDX-License-Identifier: MIT
#include "detect/certified/clearance_programs.h"
#include "core/base/try.h"
#include "gpu/context_impl.h"
#include "shared.h"

#include "voxtact_shaders/certified_clearance_again_comp.h"
#include "voxtact_shaders/certified_clearance_bits_comp.h"
#include "voxtact_shaders/certified_clearance_cull_comp.h"
#include "voxtact_shaders/certified_clearance_decide_comp.h"
#include "voxtact_shaders/certified_clearance_expand_comp.h"
#include "voxtact_shaders/certified_clearance_finish_comp.h"
#include "voxtact_shaders/certified_clearance_large_comp.h"
#include "voxtact_shaders/certified_clearance_narrow_comp.h"
#include "voxtact_shaders/certified_clearance_near_comp.h"
#include "voxtact_shaders/certified_clearance_nearest_comp.h"
#include "voxtact_shaders/certified_clearance_probe_comp.h"
#include "voxtact_shaders/certified_clearance_probes_comp.h"
#include "voxtact_shaders/certified_clearance_refine_comp.h"
#include "voxtact_shaders/certified_clearance_scout_comp.h"
#include "voxtact_shaders/certified_clearance_sift_comp.h"
#include "voxtact_shaders/certified_label_again_comp.h"
#include "voxtact_shaders/certified_label_bits_comp.h"
#include "voxtact_shaders/certified_label_cull_comp.h"
#include "voxtact_shaders/certified_label_decide_comp.h"
#include "voxtact_shaders/certified_label_expand_comp.h"
#include "voxtact_shaders/certified_label_finish_comp.h"
#include "voxtact_shaders/certified_label_large_comp.h"
#include "voxtact_shaders/certified_label_narrow_comp.h"
#include "voxtact_shaders/certified_label_near_comp.h"
#include "voxtact_shaders/certified_label_nearest_comp.h"
#include "voxtact_shaders/certified_label_probe_comp.h"
#include "voxtact_shaders/certified_label_probes_comp.h"
#include "voxtact_shaders/certified_label_refine_comp.h"
#include "voxtact_shaders/certified_label_scout_comp.h"
#include "voxtact_shaders/certified_label_sift_comp.h"

#include <span>
#include <string>

namespace voxtact {

namespace {

struct Program {
    std::span<const std::uint32_t> plain;
    std::span<const std::uint32_t> ofLabel;
    const char* name;
};

/// By ClearanceProgram.
const Program kPrograms[] = {
    {spirv::certified_clearance_cull_comp, spirv::certified_label_cull_comp, "cull"},
    {spirv::certified_clearance_scout_comp, spirv::certified_label_scout_comp, "scout"},
    {spirv::certified_clearance_refine_comp, spirv::certified_label_refine_comp, "refine"},
    {spirv::certified_clearance_expand_comp, spirv::certified_label_expand_comp, "expand"},
    {spirv::certified_clearance_bits_comp, spirv::certified_label_bits_comp, "bits"},
    {spirv::certified_clearance_near_comp, spirv::certified_label_near_comp, "near"},
    {spirv::certified_clearance_sift_comp, spirv::certified_label_sift_comp, "sift"},
    {spirv::certified_clearance_probes_comp, spirv::certified_label_probes_comp, "probes"},
    {spirv::certified_clearance_probe_comp, spirv::certified_label_probe_comp, "probe"},
    {spirv::certified_clearance_nearest_comp, spirv::certified_label_nearest_comp, "nearest"},
    {spirv::certified_clearance_large_comp, spirv::certified_label_large_comp, "large"},
    {spirv::certified_clearance_narrow_comp, spirv::certified_label_narrow_comp, "narrow"},
    {spirv::certified_clearance_again_comp, spirv::certified_label_again_comp, "again"},
    {spirv::certified_clearance_decide_comp, spirv::certified_label_decide_comp, "decide"},
    {spirv::certified_clearance_finish_comp, spirv::certified_label_finish_comp, "finish"},
};
static_assert(std::size(kPrograms) == std::tuple_size_v<ClearancePipelines>);

} // namespace

Result<ClearancePipelines> makeClearancePipelines(ContextImpl& context, bool counters, bool closest) {
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_COUNTERS, counters ? 1U : 0U},
                                        {VOXTACT_CONSTANT_CLOSEST, closest ? 1U : 0U},
                                        {VOXTACT_CONSTANT_LISTED, 1}};
    ClearancePipelines out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Result<VkPipeline> made = computePipeline(context, kPrograms[i].plain, constants, context.computeLayout,
                                                        (std::string("clearance ") + kPrograms[i].name).c_str());
        VOXTACT_TRY(made);
        out[i] = *made;
    }
    return out;
}

Result<ClearancePipelines> makeLabelPipelines(ContextImpl& context, bool counters, VkPipelineLayout layout) {
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_COUNTERS, counters ? 1U : 0U}, {VOXTACT_CONSTANT_LISTED, 1}};
    ClearancePipelines out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Result<VkPipeline> made = computePipeline(context, kPrograms[i].ofLabel, constants, layout,
                                                        (std::string("label clearance ") + kPrograms[i].name).c_str());
        VOXTACT_TRY(made);
        out[i] = *made;
    }
    return out;
}

} // namespace voxtact
