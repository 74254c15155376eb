// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/version.h"

#if __cplusplus < 202002L && !(defined(_MSVC_LANG) && _MSVC_LANG >= 202002L)
#error "voxtact needs C++20: -std=c++20, or target_compile_features(... cxx_std_20)"
#endif

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

/// Marks the symbols that a shared build exports; all others are hidden. A static build exports none: its packages
/// define VOXTACT_STATIC, so a shared library that links it does not export voxtact's symbols.
#if defined(_WIN32) && defined(VOXTACT_EXPORTS)
#define VOXTACT_API __declspec(dllexport)
#elif defined(_WIN32) || defined(VOXTACT_STATIC)
#define VOXTACT_API
#else
#define VOXTACT_API __attribute__((visibility("default")))
#endif

namespace voxtact {

/// Kind of an error. `Error::text` names the argument, the reason and the fix.
enum class ErrorCode : std::uint32_t {
    InvalidArgument = 1, ///< an argument that no device could accept
    Unsupported,         ///< not supported by the device or its enabled features
    LimitExceeded,       ///< a limit of the device, named in the text with its size
    OutOfMemory,         ///< host or device memory
    DeviceLost,          ///< sticky: every later call on the same Context returns it
    Vulkan,              ///< another VkResult, in `Error::vkResult`
    File,                ///< a file cannot be read or written
    Format,              ///< a file can be read, but its contents cannot be used
    NotReady,            ///< the result does not exist yet, or was replaced
    Internal,            ///< a bug in voxtact
    Cancelled,           ///< the caller cancelled the call: cpu::Batch::cancel, a progress function
};

/// An error. One line of text, without a final full stop or newline.
struct Error {
    ErrorCode code = ErrorCode::Internal; ///< kind of error
    std::int32_t vkResult = 0;            ///< the VkResult that caused the error; 0 (VK_SUCCESS): none
    std::string text;                     ///< the argument, the reason and the fix
};

/// A value or an Error. voxtact throws nothing across its public boundary and returns a Result instead. Reading the
/// value of a failure, or the error of a success, is undefined: call `ok()` first.
template <class T> class [[nodiscard]] Result {
  public:
    /// Creates a success.
    Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
    /// Creates a failure.
    Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

    /// True if there is a value.
    [[nodiscard]] bool ok() const noexcept { return content_.index() == 0; }
    /// Returns ok().
    explicit operator bool() const noexcept { return ok(); }

    /// Returns the value; requires ok(). Moves the value out of a temporary result.
    /// @{
    [[nodiscard]] T& value() & noexcept { return *std::get_if<0>(&content_); }
    [[nodiscard]] const T& value() const& noexcept { return *std::get_if<0>(&content_); }
    [[nodiscard]] T&& value() && noexcept { return std::move(*std::get_if<0>(&content_)); }
    /// @}
    /// Returns the error of a result that is not ok().
    /// @{
    [[nodiscard]] Error& error() & noexcept { return *std::get_if<1>(&content_); }
    [[nodiscard]] const Error& error() const& noexcept { return *std::get_if<1>(&content_); }
    /// @}

    /// Returns value().
    /// @{
    T& operator*() & noexcept { return value(); }
    const T& operator*() const& noexcept { return value(); }
    T&& operator*() && noexcept { return std::move(*this).value(); }
    T* operator->() noexcept { return std::get_if<0>(&content_); }
    const T* operator->() const noexcept { return std::get_if<0>(&content_); }
    /// @}

  private:
    std::variant<T, Error> content_;
};

/// Success, or an Error.
template <> class [[nodiscard]] Result<void> {
  public:
    /// Creates a success.
    Result() = default;
    /// Creates a failure.
    Result(Error error) : error_(std::move(error)), ok_(false) {}

    /// True on success.
    [[nodiscard]] bool ok() const noexcept { return ok_; }
    /// Returns ok().
    explicit operator bool() const noexcept { return ok_; }
    /// Returns the error of a result that is not ok().
    [[nodiscard]] const Error& error() const noexcept { return error_; }

  private:
    Error error_;
    bool ok_ = true;
};

} // namespace voxtact
