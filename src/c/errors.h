// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"
#include "voxtact/voxtact.h"

#include <concepts>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

/// Error handling of the C interface. Inside a call errors are exceptions, because std::bad_alloc is one anyway; call()
/// catches all of them.
namespace voxtact::c {

/// Results of vxt_last_error() and vxt_last_vk_result().
struct LastError {
    std::string text;
    std::int32_t vkResult = 0;
    bool noMemory = false; ///< there was none for the text

    void set(const Error& error) noexcept;
    [[nodiscard]] const char* what() const noexcept;
};

/// The last error of a context, shared with all that is made with it.
class ContextErrors {
  public:
    void set(const Error& error) noexcept;
    [[nodiscard]] LastError get() const;

  private:
    mutable std::mutex mutex_;
    LastError last_;
};
using SharedErrors = std::shared_ptr<ContextErrors>;

/// An Error on its way to call().
struct Refusal : std::exception {
    explicit Refusal(Error refused) : error(std::move(refused)) {}
    Error error;
};

[[noreturn]] void refuse(ErrorCode code, const std::string& text);

/// The value of a result.
template <class T> T take(Result<T> result) {
    if (!result.ok()) {
        throw Refusal(std::move(result.error()));
    }
    return std::move(*result);
}
inline void take(const Result<void>& result) {
    if (!result.ok()) {
        throw Refusal(result.error());
    }
}

/// Returns the object of a caller's pointer; refuses null. `what` is the argument's name.
template <class T> T& need(T* pointer, const char* what) {
    if (pointer == nullptr) {
        refuse(ErrorCode::InvalidArgument, std::string(what) + " is null");
    }
    return *pointer;
}

/// Keeps the error of the exception that is being handled, in the calling thread and, where there is one, the context.
[[nodiscard]] vxt_result keepError(ContextErrors* errors) noexcept;

/// The error of a context, or of the calling thread; kept until the thread asks again.
[[nodiscard]] const LastError& lastError(const ContextErrors* errors) noexcept;

/// Runs `body`, and makes a vxt_result of whatever it throws.
template <std::invocable Body> vxt_result call(ContextErrors* errors, Body&& body) noexcept {
    try {
        std::forward<Body>(body)();
        return VXT_OK;
    } catch (...) {
        return keepError(errors);
    }
}
template <std::invocable Body> vxt_result call(Body&& body) noexcept {
    return call(nullptr, std::forward<Body>(body));
}

/// Like call(), for an object of a context; the object may be null.
template <class Handle, std::invocable Body>
requires requires(Handle& handle) {
    handle.errors.get();
}
vxt_result call(Handle* handle, Body&& body) noexcept {
    return call(handle == nullptr ? nullptr : handle->errors.get(), std::forward<Body>(body));
}

/// Creates an object from the result of `body`; null on failure.
template <class Handle, std::invocable Body> vxt_result create(Handle** out, Body&& body) noexcept {
    return call([&] {
        Handle*& place = need(out, "the place for the new object");
        place = nullptr;
        place = std::make_unique<Handle>(Handle{std::forward<Body>(body)()}).release();
    });
}

/// Like create(), for an object that belongs to a context.
template <class Handle, class Owner, class Body>
vxt_result create(Owner* owner, const char* what, Handle** out, Body&& body) noexcept {
    return call(owner, [&] {
        Handle*& place = need(out, "the place for the new object");
        place = nullptr;
        const auto& object = need(owner, what).object;
        place = std::make_unique<Handle>(Handle{std::forward<Body>(body)(object), owner->errors}).release();
    });
}

} // namespace voxtact::c
