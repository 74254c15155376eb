// SPDX-License-Identifier: MIT
#include "host/overlap/sheet.h"

#include <glm/common.hpp>

#include <algorithm>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

void addCorner(Sheet& sheet, const dvec3& corner) noexcept {
    if (sheet.count > 0 && sheet.count < Sheet::kMax && sheet.corners[sheet.count - 1] == corner) {
        return;
    }
    if (sheet.count < Sheet::kMax) {
        sheet.corners[sheet.count] = corner;
    }
    ++sheet.count;
}

/// The box around a sheet in y and z, as far ahead as the sheet reaches.
void becomeBox(const Sheet& of, Sheet& box) noexcept {
    dvec3 lo = of.corners[0];
    dvec3 hi = lo;
    for (std::uint32_t i = 1; i < of.count; ++i) {
        lo = glm::min(lo, of.corners[i]);
        hi = glm::max(hi, of.corners[i]);
    }
    box.corners[0] = lo;
    box.corners[1] = {lo.x, hi.y, lo.z};
    box.corners[2] = {lo.x, hi.y, hi.z};
    box.corners[3] = {lo.x, lo.y, hi.z};
    box.count = 4;
    box.jump = kUnknownJump;
}

} // namespace

double Sheet::area() const noexcept {
    double twice = 0;
    double lastY = corners[1].y - corners[0].y;
    double lastZ = corners[1].z - corners[0].z;
    for (std::uint32_t i = 2; i < count; ++i) {
        const double y = corners[i].y - corners[0].y;
        const double z = corners[i].z - corners[0].z;
        twice += lastY * z - lastZ * y;
        lastY = y;
        lastZ = z;
    }
    return twice / 2;
}

double Sheet::volumeTo(double x) const noexcept {
    double sum = 0;
    double lastY = corners[1].y - corners[0].y;
    double lastZ = corners[1].z - corners[0].z;
    const double first = x - corners[0].x;
    double last = x - corners[1].x;
    for (std::uint32_t i = 2; i < count; ++i) {
        const double y = corners[i].y - corners[0].y;
        const double z = corners[i].z - corners[0].z;
        const double height = x - corners[i].x;
        sum += (lastY * z - lastZ * y) * (first + last + height);
        lastY = y;
        lastZ = z;
        last = height;
    }
    return sum / 6;
}

void Sheet::range(int axis, double& lo, double& hi) const noexcept {
    lo = hi = corners[0][axis];
    for (std::uint32_t i = 1; i < count; ++i) {
        lo = std::min(lo, corners[i][axis]);
        hi = std::max(hi, corners[i][axis]);
    }
}

void Sheet::flatten(double x) noexcept {
    for (std::uint32_t i = 0; i < count; ++i) {
        corners[i].x = std::max(corners[i].x, x);
    }
}

void cut(const Sheet& sheet, int axis, double at, Sheet& below, Sheet& above) noexcept {
    below.count = 0;
    above.count = 0;
    below.jump = sheet.jump;
    above.jump = sheet.jump;
    dvec3 last = sheet.corners[sheet.count - 1];
    double lastHeight = last[axis] - at;
    for (std::uint32_t i = 0; i < sheet.count; ++i) {
        const dvec3& here = sheet.corners[i];
        const double height = here[axis] - at;
        if ((height < 0 && lastHeight > 0) || (height > 0 && lastHeight < 0)) {
            dvec3 crossing = last + lastHeight / (lastHeight - height) * (here - last);
            crossing[axis] = at;
            addCorner(below, crossing);
            addCorner(above, crossing);
        }
        if (height <= 0) {
            addCorner(below, here);
        }
        if (height >= 0) {
            addCorner(above, here);
        }
        last = here;
        lastHeight = height;
    }
    for (Sheet* half : {&below, &above}) {
        if (half->count > Sheet::kMax) {
            becomeBox(sheet, *half);
        } else if (half->count < 3) {
            half->count = 0;
        }
    }
}

} // namespace voxtact::cpu
