// SPDX-License-Identifier: MIT
#include "scene.h"

#include "failure.h"
#include "lock.h"
#include "voxtact/cpu.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace voxtact::python {

namespace {

/// Triangles that a first piece may look at: some milliseconds; and the poses that it has at most, as one triangle may
/// go through all of the volume. A device, which cannot be interrupted, gets fewer; the host one for each thread at
/// least.
constexpr std::size_t kFirstTriangles = std::size_t{1} << 20U;
constexpr std::size_t kFirstOnHost = 64;
constexpr std::size_t kFirstOnDevice = 8;
/// Clearances take that many times as long.
constexpr std::size_t kClearanceCost = 16;
constexpr std::size_t kMostHostPairs = std::size_t{1} << 20U;

std::size_t firstPiece(const Request& request, std::size_t cost, std::size_t most) {
    return std::clamp<std::size_t>(kFirstTriangles / (request.mostTriangles() * cost), 1, most);
}

/// So that all threads have something to do.
std::size_t firstOnHost(const Request& request, std::size_t cost, std::size_t threads) {
    return std::max(firstPiece(request, cost, kFirstOnHost), threads);
}

/// A certified yes or no that a device is asked for.
Question yesOrNoByDevice() {
    Question question;
    question.method = CountingMethod::Compute;
    question.yesNo = true;
    return question;
}

void checkThreshold(double threshold) {
    if (!(threshold >= 0 && threshold <= 1)) {
        std::array<char, 32> text{}; // without the locale that std::to_string() has
        const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), threshold);
        refuseArgument("threshold is " + std::string(text.data(), end) + "; it must be from 0 to 1");
    }
}

} // namespace

Scene::Scene(SceneDesc desc) : desc_(std::move(desc)) {
    checkThreshold(desc_.threshold);
    if (desc_.device != nullptr) {
        (void)onDevice(desc_.device);
    } else {
        (void)host();
    }
}

void Scene::checkOpen() const {
    if (!open_) {
        refuse(ErrorCode::NotReady, "the scene is closed; make a new one");
    }
}

HostSide& Scene::host() {
    if (host_ == nullptr) {
        host_ = std::make_unique<HostSide>(desc_.volume->view(), desc_.opacity, desc_.threads);
    }
    return *host_;
}

DeviceSide& Scene::onDevice(const std::shared_ptr<Device>& device) {
    if (onDevice_.isForeign() && desc_.device != nullptr) {
        (void)desc_.device->context(); // says why not
    }
    if (onDevice_.get() == nullptr) {
        VolumeView volume = desc_.volume->view();
        const std::vector<std::byte> now = edited_ ? host_->voxels(volume) : std::vector<std::byte>();
        volume.voxels = edited_ ? now : volume.voxels;
        onDevice_ =
            OfThisProcess<DeviceSide>(std::make_unique<DeviceSide>(device, volume, desc_.opacity, desc_.labels.get()));
    }
    return *onDevice_.get();
}

void Scene::setOpacity(OpacityDesc opacity) {
    const Turns::Turn turn(turns_);
    checkOpen();
    if (host_ != nullptr) {
        host_->setOpacity(opacity);
    }
    if (onDevice_.get() != nullptr) {
        onDevice_.get()->setOpacity(opacity);
    }
    const Locked locked;
    desc_.opacity = std::move(opacity);
    ++revision_;
}

void Scene::setThreshold(double threshold) {
    checkThreshold(threshold);
    const Turns::Turn turn(turns_);
    checkOpen();
    const Locked locked;
    desc_.threshold = threshold;
    ++revision_;
}

void Scene::edit(const Edit& edit) {
    const Turns::Turn turn(turns_);
    checkOpen();
    HostSide& side = host();
    // The device first: both refuse the same edits, and it has more reasons to fail.
    if (onDevice_.get() != nullptr) {
        onDevice_.get()->edit(edit);
    }
    side.edit(edit);
    edited_ = true;
    ++revision_;
}

std::shared_ptr<Answer> Scene::answered(std::shared_ptr<const Request> request, const Question& question,
                                        const Progress& progress) {
    if (question.outputs.labels && desc_.labels == nullptr) {
        refuseArgument("labels of what touches need a scene with labels=");
    }
    auto answer = std::make_shared<Answer>(request, question);
    answer->revision = revision_;
    if (desc_.device != nullptr) {
        DeviceSide& side = onDevice(desc_.device);
        inPieces(request->pairs, firstPiece(*request, 1, kFirstOnDevice), DeviceSide::mostPairs(*request, question),
                 progress, [&](std::size_t first, std::size_t count) {
                     answer->add(first, side.detect(*request, first, count, question, desc_.threshold));
                 });
    } else {
        HostSide& side = host();
        inPieces(request->pairs, firstOnHost(*request, 1, side.threads()), kMostHostPairs, progress,
                 [&](std::size_t first, std::size_t count) {
                     answer->add(first,
                                 side.detect({*request, first, count}, question, desc_.threshold, desc_.labels.get()));
                 });
    }
    return answer;
}

std::shared_ptr<Answer> Scene::detect(std::shared_ptr<const Request> request, const Question& question,
                                      const Progress& progress) {
    const Turns::Turn turn(turns_);
    checkOpen();
    return answered(std::move(request), question, progress);
}

std::shared_ptr<Answer> Scene::again(const Answer& answer, const Outputs& outputs) {
    const Turns::Turn turn(turns_);
    checkOpen();
    if (answer.revision != revision_) {
        return nullptr;
    }
    Question question = answer.question;
    question.outputs = outputs;
    question.outputs.maxDepth = answer.question.outputs.maxDepth;
    question.yesNo = false;
    return answered(answer.request, question, {});
}

std::vector<double> Scene::engineSeconds(const Request& request, const Question& question, std::uint32_t times) {
    const Turns::Turn turn(turns_);
    checkOpen();
    std::vector<double> seconds;
    for (std::uint32_t time = 0; time < times; ++time) {
        const BatchAnswer answer =
            host().detect({request, 0, request.pairs}, question, desc_.threshold, desc_.labels.get());
        seconds.push_back(answer.wallMilliseconds / 1000);
    }
    return seconds;
}

std::shared_ptr<Clearances> Scene::clearance(std::shared_ptr<const Request> request, const Distance& distance,
                                             const Progress& progress) {
    const Turns::Turn turn(turns_);
    checkOpen();
    HostSide& side = host();
    auto found = std::make_shared<Clearances>();
    found->request = request;
    inPieces(request->pairs, firstOnHost(*request, kClearanceCost, side.threads()), kMostHostPairs, progress,
             [&](std::size_t first, std::size_t count) {
                 found->add(side.measure({*request, first, count}, distance, desc_.threshold));
             });
    return found;
}

std::shared_ptr<Clearances> Scene::clearanceByDevice(std::shared_ptr<const Request> request,
                                                     const ClearanceSearch& search,
                                                     std::optional<std::vector<std::int32_t>> labels,
                                                     bool labelsAtAnyOpacity, const Progress& progress) {
    const Turns::Turn turn(turns_);
    checkOpen();
    if (desc_.device == nullptr) {
        refuseWithoutDevice(CountingMethod::Compute);
    }
    Question question;
    question.method = CountingMethod::Compute;
    question.yesNo = true;
    question.clearance = search;
    question.toLabels = labels.has_value();
    question.labelsAtAnyOpacity = labelsAtAnyOpacity;
    DeviceSide& side = onDevice(desc_.device);
    auto found = std::make_shared<Clearances>();
    found->request = request;
    found->byLabel = question.toLabels;
    found->labels = labels ? std::move(*labels) : std::vector<std::int32_t>();
    inPieces(request->pairs, firstPiece(*request, kClearanceCost * (1 + found->labels.size()), kFirstOnDevice),
             DeviceSide::mostPairs(*request, question, found->labels.size()), progress,
             [&](std::size_t first, std::size_t count) {
                 BatchAnswer answer = side.detect(*request, first, count, question, desc_.threshold, found->labels);
                 if (question.toLabels) {
                     found->add(LabelClearanceAnswer{std::move(answer.labelClearances), answer.wallMilliseconds});
                 } else {
                     found->add(ClearanceAnswer{std::move(answer.clearances), answer.wallMilliseconds});
                 }
             });
    return found;
}

std::shared_ptr<Clearances> Scene::labelClearance(std::shared_ptr<const Request> request, const Distance& distance,
                                                  std::vector<std::int32_t> labels, const Progress& progress) {
    const Turns::Turn turn(turns_);
    checkOpen();
    HostSide& side = host();
    auto found = std::make_shared<Clearances>();
    found->request = request;
    found->byLabel = true;
    found->labels = std::move(labels);
    inPieces(request->pairs, firstOnHost(*request, kClearanceCost * (1 + found->labels.size()), side.threads()),
             kMostHostPairs, progress, [&](std::size_t first, std::size_t count) {
                 found->add(side.measureLabels({*request, first, count}, distance, desc_.threshold, desc_.labels.get(),
                                               found->labels));
             });
    return found;
}

std::shared_ptr<Areas> Scene::area(std::shared_ptr<const Request> request, const Extent& extent,
                                   std::optional<std::vector<std::int32_t>> labels, bool byTriangle,
                                   const Progress& progress) {
    const Turns::Turn turn(turns_);
    checkOpen();
    HostSide& side = host();
    auto found = std::make_shared<Areas>();
    found->byTriangle = byTriangle;
    found->request = request;
    found->byLabel = labels.has_value();
    found->labels = labels ? std::move(*labels) : std::vector<std::int32_t>();
    inPieces(request->pairs, firstOnHost(*request, kClearanceCost, side.threads()), kMostHostPairs, progress,
             [&](std::size_t first, std::size_t count) {
                 const Part part{*request, first, count};
                 if (found->byLabel) {
                     found->add(side.measureLabels(part, extent, desc_.threshold, desc_.labels.get(), found->labels));
                 } else if (byTriangle) {
                     found->add(side.measureTriangles(part, extent, desc_.threshold));
                 } else {
                     found->add(side.measure(part, extent, desc_.threshold));
                 }
             });
    return found;
}

template <class Ask>
std::shared_ptr<Answer> Scene::yesOrNo(const std::shared_ptr<const Request>& request, std::size_t cost,
                                       const Progress& progress, const Ask& ask) {
    const Turns::Turn turn(turns_);
    checkOpen();
    HostSide& side = host();
    Question question;
    question.yesNo = true;
    auto answer = std::make_shared<Answer>(request, question);
    answer->revision = revision_;
    inPieces(request->pairs, firstOnHost(*request, cost, side.threads()), kMostHostPairs, progress,
             [&](std::size_t first, std::size_t count) {
                 answer->add(first, ask(side, Part{*request, first, count}));
             });
    return answer;
}

std::shared_ptr<Answer> Scene::within(const std::shared_ptr<const Request>& request, double margin, bool byDevice,
                                      const Progress& progress) {
    if (byDevice) {
        Question question = yesOrNoByDevice();
        question.margin = margin;
        return detect(request, question, progress);
    }
    return yesOrNo(request, 1, progress,
                   [&](HostSide& side, const Part& part) { return side.within(part, margin, desc_.threshold); });
}

std::shared_ptr<Answer> Scene::around(const std::shared_ptr<const Request>& request, const PoseTolerance& tolerance,
                                      bool byDevice, const Progress& progress) {
    if (byDevice) {
        Question question = yesOrNoByDevice();
        question.tolerance = tolerance;
        return detect(request, question, progress);
    }
    return yesOrNo(request, kClearanceCost, progress,
                   [&](HostSide& side, const Part& part) { return side.around(part, tolerance, desc_.threshold); });
}

std::shared_ptr<Motions> Scene::motionByDevice(std::shared_ptr<const Request> request, const MotionSearch& search,
                                               const Progress& progress) {
    const Turns::Turn turn(turns_);
    checkOpen();
    if (desc_.device == nullptr) {
        refuseWithoutDevice(CountingMethod::Compute);
    }
    Question question = yesOrNoByDevice();
    question.motion = search;
    DeviceSide& side = onDevice(desc_.device);
    auto found = std::make_shared<Motions>();
    found->request = request;
    inPieces(request->segments(), firstPiece(*request, kClearanceCost, kFirstOnDevice),
             DeviceSide::mostPairs(*request, question), progress, [&](std::size_t first, std::size_t count) {
                 found->add(side.move(*request, first, count, question, desc_.threshold), desc_.labels.get());
             });
    return found;
}

std::shared_ptr<Motions> Scene::motion(std::shared_ptr<const Request> request, const Way& way,
                                       const Progress& progress) {
    const Turns::Turn turn(turns_);
    checkOpen();
    HostSide& side = host();
    auto found = std::make_shared<Motions>();
    found->request = request;
    inPieces(request->segments(), firstOnHost(*request, kClearanceCost, side.threads()), kMostHostPairs, progress,
             [&](std::size_t first, std::size_t count) {
                 found->add(side.move({*request, first, count}, way, desc_.threshold), desc_.labels.get());
             });
    return found;
}

TrackedClearance Scene::track(cpu::ClearanceTracker& tracker, const Shape& mesh, const Mat4& world_from_object) {
    const Turns::Turn turn(turns_);
    checkOpen();
    return host().track(tracker, mesh, world_from_object, desc_.threshold);
}

std::shared_ptr<Plan> Scene::plan(const PlanWish& wish) {
    const Turns::Turn turn(turns_);
    checkOpen();
    return std::make_shared<Plan>(host().plan(wish, desc_.threshold, desc_.labels.get()), !wish.avoid.empty());
}

Picture Scene::picture(const PictureWish& wish, const std::shared_ptr<Device>& device) {
    const Turns::Turn turn(turns_);
    checkOpen();
    PictureWish complete = wish;
    complete.threshold = desc_.threshold;
    return onDevice(desc_.device != nullptr ? desc_.device : device).picture(complete, desc_.opacity);
}

void Scene::close() {
    const Turns::Turn turn(turns_);
    open_ = false;
    host_.reset();
    onDevice_.reset();
}

} // namespace voxtact::python
