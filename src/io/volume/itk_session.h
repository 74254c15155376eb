// SPDX-License-Identifier: MIT
#pragma once

#include <itkObject.h>

#include <mutex>

namespace voxtact::io {

/// Held around every use of ITK. NRRD's error list and more are global, so one thread at a time; and ITK prints
/// warnings unless a global flag says otherwise, which is put back afterwards for an embedder who uses
/// them as well.
class ItkSession {
  public:
    ItkSession() : lock_(mutex()), warned_(itk::Object::GetGlobalWarningDisplay()) {
        itk::Object::SetGlobalWarningDisplay(false);
    }
    ItkSession(const ItkSession&) = delete;
    ItkSession& operator=(const ItkSession&) = delete;
    ~ItkSession() { itk::Object::SetGlobalWarningDisplay(warned_); }

  private:
    static std::mutex& mutex() {
        static std::mutex only;
        return only;
    }

    std::lock_guard<std::mutex> lock_;
    bool warned_;
};

} // namespace voxtact::io
