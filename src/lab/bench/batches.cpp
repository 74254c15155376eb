// SPDX-License-Identifier: MIT
#include "lab/bench/batches.h"

#include "core/base/try.h"
#include "lab/bench/latency.h"
#include "lab/measure/columns.h"
#include "lab/measure/random_poses.h"
#include "lab/measure/rounds.h"

#include <algorithm>
#include <ostream>

namespace voxtact::lab {

namespace {

/// A mesh at all its poses, and what must be answered there.
struct Series {
    Work work;
    std::vector<Mat4> poses;
    std::vector<TickTruth> truths; ///< of the first poses
    Engine& certified;             ///< yes or no
    Engine& view;
    double learning = 0; ///< ms that the last truths took
};

Result<void> learn(Series& series, std::size_t end) {
    const std::size_t begin = series.truths.size();
    if (begin >= end) {
        return {};
    }
    const Work work = series.work.at(std::span(series.poses).subspan(begin, end - begin));
    const Result<Pass> certified = series.certified.run(work, {});
    VOXTACT_TRY(certified);
    const Result<Pass> view = series.view.run(work, {});
    VOXTACT_TRY(view);
    series.learning = certified->wallMilliseconds + view->wallMilliseconds;
    for (std::size_t i = 0; i < work.poses.size(); ++i) {
        series.truths.push_back({certified->pairs[i], view->pairs[i]});
    }
    return {};
}

Result<double> takeBatch(Series& series, Engine& engine, bool kept, BatchesRow& row, std::string& disagreement) {
    const Result<Pass> pass = engine.run(series.work.at(std::span(series.poses).first(row.batch)), {});
    VOXTACT_TRY(pass);
    for (std::size_t i = 0; i < row.batch && disagreement.empty(); ++i) {
        const std::string wrong = judgeTick(engine.facts(), pass->pairs[i], series.truths[i]);
        row.rounding += kept && !engine.facts().certified && differsByRounding(pass->pairs[i], series.truths[i].view);
        if (!wrong.empty()) {
            disagreement = row.mesh + ", pose " + std::to_string(i) + " of " + std::to_string(row.batch) + ": " + wrong;
        }
    }
    if (kept) {
        row.wall.push_back(pass->wallMilliseconds);
        if (pass->gpuMilliseconds) {
            row.gpu.push_back(*pass->gpuMilliseconds);
        }
    }
    return pass->wallMilliseconds;
}

Result<Engines> makeBatchEngines(const device::Session* session) {
    Engines engines;
    const auto add = [&engines](MadeEngine engine) -> Result<void> {
        VOXTACT_TRY(engine);
        engines.push_back(std::move(*engine));
        return {};
    };
    VOXTACT_TRY(add(makeHostEngine({.stopAtFirst = true, .projection = Projection::Conservative})));
    VOXTACT_TRY(add(makeHostEngine()));
    const DetectorDesc computed{.method = CountingMethod::Compute, .filter = Filter::Exact};
    DetectorDesc certified = computed;
    certified.projection = Projection::Conservative;
    certified.stopAtFirst = true;
    for (const DetectorDesc& desc : {certified, computed, DetectorDesc{.method = CountingMethod::Query},
                                     DetectorDesc{.method = CountingMethod::Atomic}}) {
        if (session != nullptr && session->context.supports(desc.method, desc.projection)) {
            VOXTACT_TRY(add(makeDeviceEngine(*session, desc)));
        }
    }
    return engines;
}

/// One size, by every engine that is still `alive`; those for which the next would take longer than `longest` ms end,
/// and all where the host would take longer than `mostLearning` ms to say what must be answered.
Result<void> measureSize(Series& series, const Engines& engines, std::vector<bool>& alive, std::uint32_t batch,
                         double longest, double mostLearning, const BatchesSettings& settings, BatchesResult& result) {
    if (std::ranges::none_of(alive, [](bool on) { return on; })) {
        return {};
    }
    VOXTACT_TRY(learn(series, batch));
    const std::size_t firstRow = result.rows.size();
    std::vector<std::size_t> taken;
    for (std::size_t i = 0; i < engines.size(); ++i) {
        if (alive[i]) {
            taken.push_back(i);
            result.rows.push_back({.mesh = series.work.mesh->name,
                                   .triangles = series.work.mesh->triangles(),
                                   .engine = engines[i]->facts(),
                                   .batch = batch});
        }
    }
    std::vector<Timed> things;
    for (std::size_t i = 0; i < taken.size(); ++i) {
        things.push_back({.take = [&, i](const Turn& turn) {
            return takeBatch(series, *engines[taken[i]], turn.round > 0, result.rows[firstRow + i],
                             result.disagreement);
        }});
    }
    VOXTACT_TRY(takeRounds(things, {.repeats = settings.repetitions, .warmUp = true, .stop = [&] {
                                        return !result.disagreement.empty();
                                    }}));
    for (std::size_t i = 0; i < taken.size() && result.disagreement.empty(); ++i) {
        alive[taken[i]] =
            10 * medianOf(result.rows[firstRow + i].wall) <= longest && 10 * series.learning <= mostLearning;
    }
    return {};
}

Result<void> measureMesh(const BatchesSettings& settings, const VolumePart& volume, MeshPart& mesh, double limit,
                         const device::Session* session, const std::function<void()>& step, BatchesResult& result) {
    VOXTACT_TRY(makeReady(session, mesh));
    const Result<Engines> engines = makeBatchEngines(session);
    VOXTACT_TRY(engines);
    Series series{.work = {volume, mesh, {}, {framingCamera(volume.data.grid, 512, 512), 512, 512}},
                  .poses = randomPoses(volume.data.grid, mesh.data.view(), settings.most, settings.seed),
                  .truths = {},
                  .certified = *(*engines)[0],
                  .view = *(*engines)[1]};
    // The largest batch, its warm-up and what is smaller: a ninth more.
    const double mostLearning = limit / 4;
    const double longest =
        (limit - mostLearning) / (1.2 * (settings.repetitions + 1) * static_cast<double>(engines->size()));
    std::vector<bool> alive(engines->size(), true);
    for (const std::uint32_t batch : batchSizes(settings.most)) {
        if (result.disagreement.empty()) {
            VOXTACT_TRY(measureSize(series, *engines, alive, batch, longest, mostLearning, settings, result));
        }
        step();
    }
    return {};
}

Row rowOf(const BatchesRow& row) {
    Row out;
    out.add("mesh", row.mesh)
        .add("triangles", row.triangles)
        .add("engine", row.engine.name)
        .add("projection", row.engine.projection)
        .add("question", row.engine.question)
        .add("threads", row.engine.threads > 0 ? std::optional(row.engine.threads) : std::nullopt)
        .add("batch", row.batch)
        .add("samples", row.wall.size())
        .add("rounding", row.rounding)
        .add("wall_ms", row.wall, {"_median", "_min", "_max"})
        .add("gpu_ms", row.gpu, {"_median"})
        .add("pairs_per_s", 1000 * row.batch / std::max(medianOf(row.wall), 1e-6));
    return out;
}

Json batchesJson(const BatchesSettings& settings, const BatchesResult& result) {
    Json json = headJson(result.machine);
    json["scene"] = {{"volume", result.volume},
                     {"voxels", result.voxels},
                     {"threshold", result.threshold},
                     {"poses", settings.most},
                     {"seed", settings.seed}};
    json["repetitions"] = settings.repetitions;
    json["rows"] = arrayOf(result.rows, [](const BatchesRow& row) { return rowOf(row).json(); });
    json["notes"] = allNotes({result.machine, {}, result.notes});
    return json;
}

} // namespace

std::vector<std::uint32_t> batchSizes(std::uint32_t most) {
    std::vector<std::uint32_t> sizes;
    for (std::uint64_t size = 1; size < most; size *= 10) {
        sizes.push_back(static_cast<std::uint32_t>(size));
    }
    sizes.push_back(most);
    return sizes;
}

Result<void> measureBatches(const BatchesSettings& settings, const device::Session* session, VolumePart& volume,
                            std::vector<MeshPart> meshes, const Steps& steps, BatchesResult& result) {
    if (session != nullptr) {
        VOXTACT_TRY(upload(*session, {.bricks = true}, volume));
    }
    steps.begin(batchSizes(settings.most).size() * meshes.size());
    const double limit = settings.timeLimit * 1000 / static_cast<double>(meshes.size());
    for (MeshPart& mesh : meshes) {
        VOXTACT_TRY(measureMesh(settings, volume, mesh, limit, session, steps.step, result));
    }
    // After a disagreement nothing more is measured.
    std::erase_if(result.rows, [](const BatchesRow& row) { return row.wall.empty(); });
    return {};
}

void writeBatches(std::ostream& out, io::Format format, const BatchesSettings& settings, const BatchesResult& result) {
    if (format == io::Format::Json) {
        writeJson(out, batchesJson(settings, result));
        return;
    }
    io::writeTable(out, format, tableOf(result.rows, rowOf));
    out << "# volume " << result.volume << ", a batch is a submission that is waited for, or a call of the host\n";
    writeFindings(out, {result.machine, {}, result.notes});
}

} // namespace voxtact::lab
