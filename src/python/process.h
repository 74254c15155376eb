// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

namespace voxtact::python {

/// How often this process is the child of a fork since the module was loaded. Threads and Vulkan objects of a process
/// do not live on in its child.
[[nodiscard]] std::uint64_t forks() noexcept;
/// Begins the counting; once, when the module is loaded.
void watchForks();

/// Something that has threads or Vulkan objects. In a child of the process that made it, it is neither used nor ended:
/// ending it would wait for threads that are not there.
template <class T> class OfThisProcess {
  public:
    OfThisProcess() = default;
    explicit OfThisProcess(std::unique_ptr<T> object) : object_(std::move(object)), born_(forks()) {}
    OfThisProcess(OfThisProcess&&) noexcept = default;
    OfThisProcess& operator=(OfThisProcess&& other) noexcept {
        reset();
        object_ = std::move(other.object_);
        born_ = other.born_;
        return *this;
    }
    OfThisProcess(const OfThisProcess&) = delete;
    OfThisProcess& operator=(const OfThisProcess&) = delete;
    ~OfThisProcess() { reset(); }

    void reset() noexcept {
        if (isForeign()) {
            [[maybe_unused]] const T* lost = object_.release();
        }
        object_.reset();
    }
    [[nodiscard]] bool isForeign() const noexcept { return object_ != nullptr && born_ != forks(); }
    /// Null where there is none that this process can use.
    [[nodiscard]] T* get() const noexcept { return isForeign() ? nullptr : object_.get(); }

  private:
    std::unique_ptr<T> object_;
    std::uint64_t born_ = 0;
};

} // namespace voxtact::python
