// SPDX-License-Identifier: MIT
#pragma once

#include <gdcmTrace.h>
#include <itkObject.h>

#include <mutex>

namespace voxtact::io {

/// Held around every use of ITK. NRRD's error list and more are global, so one thread at a time; and ITK prints
/// warnings, GDCM errors, unless global flags say otherwise, which are put back afterwards for an embedder who uses
/// them as well.
class ItkSession {
  public:
    ItkSession()
        : lock_(mutex()), warned_(itk::Object::GetGlobalWarningDisplay()), gdcmWarned_(gdcm::Trace::GetWarningFlag()),
          gdcmErrors_(gdcm::Trace::GetErrorFlag()) {
        itk::Object::SetGlobalWarningDisplay(false);
        gdcm::Trace::SetWarning(false);
        gdcm::Trace::SetError(false);
    }
    ItkSession(const ItkSession&) = delete;
    ItkSession& operator=(const ItkSession&) = delete;
    ~ItkSession() {
        itk::Object::SetGlobalWarningDisplay(warned_);
        gdcm::Trace::SetWarning(gdcmWarned_);
        gdcm::Trace::SetError(gdcmErrors_);
    }

  private:
    static std::mutex& mutex() {
        static std::mutex only;
        return only;
    }

    std::lock_guard<std::mutex> lock_;
    bool warned_;
    bool gdcmWarned_;
    bool gdcmErrors_;
};

} // namespace voxtact::io
