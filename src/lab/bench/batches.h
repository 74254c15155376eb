// SPDX-License-Identifier: MIT
#pragma once

#include "lab/bench/bench.h"

/// What a batch costs by how many pairs are in it.
namespace voxtact::lab {

struct BatchesSettings {
    std::uint32_t most = 100000; ///< pairs of the largest batch; the others are 1 and every power of ten below it
    std::uint64_t seed = 1;
    std::uint32_t repetitions = 3;
    double timeLimit = 60; ///< seconds, roughly: batches that would not fit are left out
};

/// One engine with batches of one size.
struct BatchesRow {
    std::string mesh{};
    std::uint32_t triangles = 0;
    EngineFacts engine{};
    std::uint32_t batch = 0;
    std::vector<double> wall{}; ///< ms of a batch
    std::vector<double> gpu{};  ///< the device's part of it; empty where there is none
    std::uint64_t rounding = 0; ///< pairs of all samples that the device's rasteriser counts otherwise than cpu
};

struct BatchesResult : BenchScene {
    std::vector<BatchesRow> rows;
};

/// 1, 10, 100, ... and `most`.
[[nodiscard]] std::vector<std::uint32_t> batchSizes(std::uint32_t most);

/// Batches of random poses, each a submission that is waited for or a call of the host, by the host and by the methods
/// of the device: certified yes or no, and the count in the view. The answers of every batch are held against the
/// host's as by judgeTick(). The volume and the meshes are made ready; `session` may be null, and must outlive the
/// parts.
[[nodiscard]] Result<void> measureBatches(const BatchesSettings& settings, const device::Session* session,
                                          VolumePart& volume, std::vector<MeshPart> meshes, const Steps& steps,
                                          BatchesResult& result);

void writeBatches(std::ostream& out, io::Format format, const BatchesSettings& settings, const BatchesResult& result);

} // namespace voxtact::lab
