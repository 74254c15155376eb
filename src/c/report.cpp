// SPDX-License-Identifier: MIT
// What is known of a device before there is a context, and of its methods.
#include "c/convert_vulkan.h"

using namespace voxtact;
using namespace voxtact::c;

/// The pointers are into the strings, which stay where they are when the vectors are moved.
struct vxt_report {
    std::vector<std::string> lines;
    std::vector<const char*> missing;
    std::vector<std::string> texts;
    std::vector<vxt_method_report> methods;
    bool usable = true;
};

namespace {

/// A row of a method; put() sets its text once all texts exist.
vxt_method_report toRow(CountingMethod method, bool available, bool trusted) {
    vxt_method_report row{};
    row.method = number<vxt_method>(method);
    row.available = available ? 1 : 0;
    row.trusted = trusted ? 1 : 0;
    return row;
}

vxt_report finished(vxt_report report) {
    for (const std::string& line : report.lines) {
        report.missing.push_back(line.c_str());
    }
    for (std::size_t i = 0; i < report.methods.size(); ++i) {
        report.methods[i].text = report.texts[i].c_str();
    }
    return report;
}

vxt_report toReport(CheckReport found) {
    vxt_report report;
    report.usable = found.usable;
    report.lines = std::move(found.missing);
    for (MethodSupport& method : found.methods) {
        report.texts.push_back(std::move(method.reason));
        report.methods.push_back(toRow(method.method, method.available, false));
    }
    return finished(std::move(report));
}

void put(vxt_report& report, const SelfTestVerdict& verdict) {
    report.texts.push_back(verdict.text);
    report.methods.push_back(toRow(verdict.method, verdict.available, verdict.trusted));
}

/// A report is made by a context and lives without it.
template <class Make>
vxt_result createReport(const vxt_context* context, const vxt_queue* queue, vxt_report** report, Make make) noexcept {
    return call(context, [&] {
        vxt_report*& place = need(report, "the place for the new object");
        place = nullptr;
        vxt_report made;
        make(need(context, "context").object, toQueue(queue), made);
        place = std::make_unique<vxt_report>(finished(std::move(made))).release();
    });
}

} // namespace

vxt_result vxt_report_get(const vxt_report* report, vxt_report_view* view) {
    return call([&] {
        const vxt_report& from = need(report, "report");
        vxt_report_view out = zero<vxt_report_view>();
        out.missing = handOut<const char*>(from.missing, &out.missing_count);
        out.methods = handOut<vxt_method_report>(from.methods, &out.method_count);
        out.usable = from.usable ? 1 : 0;
        writeStruct(view, out, "view");
    });
}

void vxt_report_destroy(vxt_report* report) {
    delete report;
}

vxt_result vxt_check(const vxt_context_desc* desc, vxt_report** report) {
    return create(report, [&] { return toReport(check(toContextDesc(desc))); });
}

vxt_result vxt_context_methods(const vxt_context* context, vxt_report** report) {
    return call(context, [&] {
        vxt_report*& place = need(report, "the place for the new object");
        place = nullptr;
        vxt_report made;
        for (const MethodSupport& support : need(context, "context").object.methods()) {
            put(made, {support.method, support.available, false, support.reason});
        }
        place = std::make_unique<vxt_report>(finished(std::move(made))).release();
    });
}

vxt_result vxt_self_test(const vxt_context* context, const vxt_queue* queue, vxt_report** report) {
    return createReport(context, queue, report, [](const Context& on, const QueueAccess& by, vxt_report& out) {
        for (const SelfTestVerdict& verdict : take(selfTest(on, by))) {
            put(out, verdict);
        }
    });
}
