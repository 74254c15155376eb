// SPDX-License-Identifier: MIT
#include "c/errors.h"

#include <new>

namespace voxtact::c {
namespace {

static_assert(VXT_ERROR_INVALID_ARGUMENT == static_cast<int>(ErrorCode::InvalidArgument));
static_assert(VXT_ERROR_UNSUPPORTED == static_cast<int>(ErrorCode::Unsupported));
static_assert(VXT_ERROR_LIMIT_EXCEEDED == static_cast<int>(ErrorCode::LimitExceeded));
static_assert(VXT_ERROR_OUT_OF_MEMORY == static_cast<int>(ErrorCode::OutOfMemory));
static_assert(VXT_ERROR_DEVICE_LOST == static_cast<int>(ErrorCode::DeviceLost));
static_assert(VXT_ERROR_VULKAN == static_cast<int>(ErrorCode::Vulkan));
static_assert(VXT_ERROR_FILE == static_cast<int>(ErrorCode::File));
static_assert(VXT_ERROR_FORMAT == static_cast<int>(ErrorCode::Format));
static_assert(VXT_ERROR_NOT_READY == static_cast<int>(ErrorCode::NotReady));
static_assert(VXT_ERROR_INTERNAL == static_cast<int>(ErrorCode::Internal));
static_assert(VXT_ERROR_CANCELLED == static_cast<int>(ErrorCode::Cancelled));

/// Short enough for a std::string without memory of its own.
constexpr const char* kNoMemory = "no host memory";

// A thread's own, as errno is; the context has the errors of all threads.
thread_local LastError threadError;
/// Last result of vxt_last_error() in this thread.
thread_local LastError told;

vxt_result keep(ContextErrors* errors, const Error& error) noexcept {
    threadError.set(error);
    if (errors != nullptr) {
        errors->set(error);
    }
    return static_cast<vxt_result>(error.code);
}

} // namespace

void LastError::set(const Error& error) noexcept {
    vkResult = error.vkResult;
    noMemory = false;
    try {
        text = error.text;
    } catch (...) {
        noMemory = true;
    }
}

const char* LastError::what() const noexcept {
    return noMemory ? kNoMemory : text.c_str();
}

void ContextErrors::set(const Error& error) noexcept {
    const std::scoped_lock lock(mutex_);
    last_.set(error);
}

LastError ContextErrors::get() const {
    const std::scoped_lock lock(mutex_);
    return last_;
}

void refuse(ErrorCode code, const std::string& text) {
    throw Refusal({code, 0, text});
}

vxt_result keepError(ContextErrors* errors) noexcept {
    try {
        throw;
    } catch (const Refusal& refusal) {
        return keep(errors, refusal.error);
    } catch (const std::bad_alloc&) {
        return keep(errors, {ErrorCode::OutOfMemory, 0, kNoMemory});
    } catch (const std::exception& unforeseen) {
        try {
            return keep(errors, {ErrorCode::Internal, 0, unforeseen.what()});
        } catch (...) {
            return keep(errors, {ErrorCode::OutOfMemory, 0, kNoMemory});
        }
    } catch (...) {
        return keep(errors, {ErrorCode::Internal, 0, "unforeseen"});
    }
}

const LastError& lastError(const ContextErrors* errors) noexcept {
    try {
        told = errors == nullptr ? threadError : errors->get();
    } catch (...) {
        told.noMemory = true;
    }
    return told;
}

} // namespace voxtact::c
