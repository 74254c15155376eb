// SPDX-License-Identifier: MIT
#pragma once

#include "process.h"
#include "voxtact/context.h"

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

/// A Vulkan device of the module's own, made with the loader of the machine, as any embedder makes one.
namespace voxtact::python {

namespace py = pybind11;

/// A device of the machine.
struct DeviceFacts {
    std::uint32_t index = 0;
    std::string name;
    std::string type; ///< discrete, integrated, virtual, cpu or other
    std::string driver;
    std::uint32_t apiVersion = 0;
};

struct VulkanObjects;

/// voxtact on a device, with one queue that scenes share.
class Device {
  public:
    [[nodiscard]] static std::vector<DeviceFacts> list();
    /// `wanted`: a number of list(), a part of a name, or empty for the best. Unsupported where there is none.
    [[nodiscard]] static std::shared_ptr<Device> open(const std::string& wanted);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceFacts& facts() const noexcept { return facts_; }
    /// Refuses a child of the process that opened it.
    [[nodiscard]] const Context& context() const;
    [[nodiscard]] QueueAccess queue() const;
    /// Records, submits and waits.
    void submit(const std::function<Result<void>(VkCommandBuffer)>& record);

  private:
    explicit Device(std::unique_ptr<VulkanObjects> objects);
    [[nodiscard]] VulkanObjects& objects() const;

    DeviceFacts facts_;
    OfThisProcess<VulkanObjects> objects_;
};

void defineDevice(py::module_& module);

} // namespace voxtact::python
