#include "harness/googletest/sources.h"

#include <memory>
#include <utility>

namespace assay::googletest {
namespace {

class Callable final : public Estimator {
 public:
  explicit Callable(const Source& source) : source_(source) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    cost.samples += primaries;
    source_.draw(random, out);
    if (!source_.averages || primaries == 1) return;
    double sum = out[0];
    for (std::uint64_t i = 1; i < primaries; ++i) {
      source_.draw(random, out);
      sum += out[0];
    }
    out[0] = sum / static_cast<double>(primaries);
  }

 private:
  const Source& source_;
};

class CallableSetup final : public Setup {
 public:
  explicit CallableSetup(Source source) : source_(std::move(source)) {
    entry_.information = {.name = "googletest",
                          .summary = "a callable",
                          .description = "A callable of a test.",
                          .averages = source_.averages};
  }

  std::vector<Channel> channels() const override {
    if (source_.channels == 1) return {{.name = "value"}};
    std::vector<Channel> channels;
    for (std::size_t i = 1; i <= source_.channels; ++i) {
      channels.push_back({.name = "value" + std::to_string(i)});
    }
    return channels;
  }
  std::unique_ptr<Estimator> make() const override { return std::make_unique<Callable>(source_); }

  const Entry& entry() const { return entry_; }

 private:
  Source source_;
  Entry entry_;
};

}  // namespace

harness::PreparedEstimator prepared(const Source& source, const std::string& stream) {
  const auto setup = std::make_shared<const CallableSetup>(source);
  return {.name = source.name,
          .listed = source.name,
          .entry = &setup->entry(),
          .setup = setup,
          .parameters = "",
          .folder = "",
          .key_plugin = "googletest",
          .key_parameters = stream,
          .primaries = source.averages ? std::optional<std::uint64_t>() : 1,
          .original = nullptr,
          .where = {},
          .given = {}};
}

}  // namespace assay::googletest
