#pragma once

// Libraries in C, compiled for a test and called in its process. tests/cli/foreign_test.sh drives
// those in a process of their own.

#include "tests/estimators/foreign/foreign.h"

namespace assay::foreign {

class Library : public Programs {
 protected:
  /// Compiles as the manual says, with every warning an error, against nothing at all.
  std::string compile(const std::string& source, const std::string& flags = "-nostdlib") const {
    const std::string file = (folder_ / "mine.so").string();
    const std::string command = "cc -std=c11 -O2 -Wall -Wextra -Wpedantic -Werror -fPIC -shared " +
                                flags + " -I " + ASSAY_SOURCE_DIR + "/estimators " + source +
                                " -o " + file;
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return file;
  }
  std::string compile_text(const std::string& text) const {
    return compile(write("mine.c", "#include \"plugin_abi.h\"\n" + text));
  }

  /// One of several libraries of a test: a file that is loaded is not written again.
  SharedSetup load_as(const std::string& name, const std::string& text) {
    const std::string file = (folder_ / (name + ".so")).string();
    std::filesystem::rename(compile_text(text), file);
    return load(file);
  }

  SharedSetup load(const std::string& file, std::vector<Value::Member> more = {}) {
    more.emplace_back("file", Value::scalar(file));
    more.emplace_back("isolated", Value::scalar("false"));
    return prepare("library", Value::map(std::move(more)));
  }

  std::string refusal(const std::string& file, std::vector<Value::Member> more = {}) {
    return thrown<InputError>([&] { load(file, std::move(more)); });
  }
};

/// A library around the body of secondary(), and more fields of its estimator.
inline std::string with_body(const std::string& body, const std::string& fields = "") {
  return "static int secondary(AssayCall *call) { " + body + R"(}
static const AssayChannel x = {.size = sizeof x, .name = "x"};
static const AssayEstimator mine = {.size = sizeof mine, .name = "mine", .channels = &x,
                                    .channel_count = 1, .secondary = secondary)" +
         fields + R"(};
static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, &mine, 1};
const AssayLibrary *assay_library(void) { return &library; }
)";
}

/// One that samples the unit interval with density 2 x.
inline const std::string ramp_sampler =
    R"(
static int sample(const void *setup, AssayStream *random, AssayDraw *draw) {
  double a = assay_uniform(random), b = assay_uniform(random), x = a > b ? a : b;
  (void)setup;
  draw->point[0] = x; draw->density = 2 * x; draw->weight = x > 0 ? 1 / (2 * x) : 0;
  return 0;
}
static double density(const void *setup, const double *p) { (void)setup; return 2 * p[0]; }
static double evaluate(const void *setup, const double *p) { (void)setup; (void)p; return 1; }
static const AssaySampler ramp = {.size = sizeof ramp, .name = "ramp", .domain = ASSAY_INTERVAL,
    .low = 0, .high = 1, .sample = sample, .density = density, .evaluate = evaluate};
)" + with_body("call->out[0] = 1; return 0; ", ", .samplers = &ramp, .sampler_count = 1");

}  // namespace assay::foreign
