// SPDX-License-Identifier: MIT
#pragma once

#include "device/session.h"
#include "lab/compare_settings.h"
#include "voxtact/cpu.h"
#include "voxtact/detector.h"

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace voxtact::app {

/// What made the numbers, and what makes them again.
struct Provenance {
    std::string version;
    std::string gitRevision;
    std::string command;
};

/// How far long work is.
struct Steps {
    std::function<void(std::uint64_t total)> begin; ///< before the first
    std::function<void()> step;
};

/// What is compared, in host memory.
struct CompareData {
    std::string volumeName; ///< a path, or builtin:NAME
    std::string meshName;
    VolumeData volume;
    MeshData mesh;
    std::vector<ControlPoint> points;
    ValueRange domain;
    std::uint32_t tableSize = kDefaultTableSize;
    double threshold = kDefaultThreshold;
    std::vector<Mat4> poses;
    std::vector<std::uint32_t> poseNumbers; ///< of each pose, in the whole list
    std::string posesFrom;                  ///< "random, seed 1", or a path
    View view;

    [[nodiscard]] TransferFunctionDesc transferFunction() const { return {points, domain, tableSize}; }
};

/// Refuses a viewport beyond what the device or the host can do.
[[nodiscard]] Result<void> checkViewport(const Session& session, const VkExtent2D& size);

/// What the numbers were measured on.
struct Machine {
    Provenance provenance;
    std::string device;
    std::string deviceType;
    std::string driver;
    std::string driverVersion;
    std::string api;
    std::string cpu;
    std::uint32_t cpuThreads = 0;
    bool llvmpipe = false;
    bool eightBitFilter = false;    ///< the sampler filters this volume in 8-bit arithmetic
    std::string filter;             ///< the arithmetic of the hardware filter, in words
    std::vector<std::string> notes; ///< what to know when reading the times
};

/// Without a device.
[[nodiscard]] Machine describeHost(const Provenance& provenance);
[[nodiscard]] Machine describeMachine(const Session& session, ScalarType type, const Provenance& provenance);

/// A mesh on both sides.
struct Subject {
    MeshData data;
    Mesh device;
    cpu::Mesh host;
};

[[nodiscard]] Result<Subject> makeSubject(const Session& session, MeshData data);

/// Volume and transfer function on both sides.
struct Surroundings {
    Volume volume;
    TransferFunction transferFunction;
    cpu::Volume hostVolume;
    cpu::TransferFunction hostTransferFunction;
};

/// LimitExceeded where the volume is beyond what the device can do.
[[nodiscard]] Result<Surroundings> makeSurroundings(const Session& session, const VolumeView& volume,
                                                    const TransferFunctionDesc& transferFunction,
                                                    const VolumeOptions& volumeOptions = {});

/// Pairs to count or to time.
struct Work {
    const Subject* subject = nullptr;
    std::span<const Mat4> poses;
    View view;
};

/// One method on one scene.
/// Thread-safety: none; one thread at a time.
class MethodRunner {
  public:
    /// Of all the pairs of a work.
    struct Pass {
        double wallMilliseconds = 0;
        std::optional<double> gpuMilliseconds;
        std::vector<std::uint64_t> counts;
    };

    MethodRunner(CountingMethod method, Filter filter, const std::array<std::uint32_t, 3>& voxels)
        : method_(method), filter_(filter), voxels_(voxels) {}
    MethodRunner(const MethodRunner&) = delete;
    MethodRunner& operator=(const MethodRunner&) = delete;
    virtual ~MethodRunner() = default;

    [[nodiscard]] CountingMethod method() const noexcept { return method_; }
    [[nodiscard]] Filter filter() const noexcept { return filter_; }
    /// Of the volume that it counts in.
    [[nodiscard]] const std::array<std::uint32_t, 3>& voxels() const noexcept { return voxels_; }
    [[nodiscard]] std::string name() const { return toString(method_); }
    /// `frames` submissions of `batch` pairs in flight; one frame waits for each submission.
    [[nodiscard]] virtual Result<Pass> run(const Work& work, std::uint32_t batch, std::uint32_t frames) = 0;

  private:
    CountingMethod method_;
    Filter filter_;
    std::array<std::uint32_t, 3> voxels_;
};

/// A method of the device, or of the host. What it is given must outlive it.
[[nodiscard]] Result<std::unique_ptr<MethodRunner>> makeRunner(const Session& session, const Surroundings& surroundings,
                                                               CountingMethod method, double threshold);

using Runners = std::vector<std::unique_ptr<MethodRunner>>;

} // namespace voxtact::app
