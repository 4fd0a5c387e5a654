#pragma once

// Drawing from plugins by name, and plain statistics to judge the draws by. Bounds are for a false
// alarm of 1e-6 a comparison unless they say so themselves; keys are those of seed 1.

#include "estimators/catalogue.h"
#include "estimators/core/value.h"
#include "tests/prelude.h"

namespace assay::tests {

/// A text that has all of these parts.
template <class... Parts>
auto Says(const Parts&... parts) {
  return testing::AllOf(testing::HasSubstr(parts)...);
}

}  // namespace assay::tests

namespace assay::draws {

/// Standard normal quantiles of the two-sided probabilities 1e-6 and 1e-4.
inline constexpr double five = 4.892;
inline constexpr double four = 3.8906;

/// The folder that files of parameters are relative to.
inline const std::string suite_data = ASSAY_SOURCE_DIR "/suites/data";

/// Observations of one channel.
struct Sample {
  std::vector<double> values;

  double size() const { return static_cast<double>(values.size()); }
  double mean() const { return std::accumulate(values.begin(), values.end(), 0.0) / size(); }
  double variance() const { return moment(2) * size() / (size() - 1); }
  double mean_error() const { return std::sqrt(variance() / size()); }
  double variance_error() const { return std::sqrt((moment(4) - std::pow(moment(2), 2)) / size()); }

 private:
  /// The central moment of power 2 or 4.
  double moment(int power) const {
    double sum = 0;
    for (const double about = mean(); const double x : values) {
      const double square = (x - about) * (x - about);
      sum += power == 2 ? square : square * square;
    }
    return sum / size();
  }
};

/// Holds for a sample whose mean is `mean` but for chance, and but for `rest`.
MATCHER_P2(HasMean, mean, rest, "") {
  *result_listener << "the mean is " << arg.mean() << " +- " << arg.mean_error();
  return std::abs(arg.mean() - mean) <= five * arg.mean_error() + rest;
}
MATCHER_P(HasMean, mean, "") {
  return ExplainMatchResult(HasMean(mean, 0.0), arg, result_listener);
}

/// A prepared plugin and the key of its streams.
struct Prepared {
  std::shared_ptr<const Setup> setup;
  StreamKey key;
  Information information;

  Channel channel(std::size_t i = 0) const { return setup->channels().at(i); }
  /// The sampler of this name, or the first.
  std::shared_ptr<const Sampler> sampler(const std::string& name = "") const {
    for (const NamedSampler& named : setup->samplers()) {
      if (name.empty() || named.name == name) return named.sampler;
    }
    throw std::logic_error("no sampler " + name);
  }
};

/// A flow map, in which `law: name(a, b)` may stand too, whose comma a flow map does not take.
inline Value parameters_of(const std::string& text) {
  static const std::regex law(R"(law: (\w*\([^)]*\)))");
  std::smatch found;
  if (!std::regex_search(text, found, law)) return parse_flow(text);
  auto members = parse_flow(std::regex_replace(text, law, "law: name")).members();
  for (auto& [name, value] : members) {
    if (name == "law") value = Value::scalar(found[1]);
  }
  return Value::map(std::move(members));
}

inline Prepared prepare(const std::string& plugin, const Value& parameters,
                        const std::string& folder = suite_data) {
  const Entry& entry = find_plugin(plugin, {});
  Parameters given(plugin, entry.information.parameters, parameters, folder);
  auto setup = entry.prepare(given);
  given.require_all_read();
  // A mutant's key is its original's, with the parameters that the original has.
  std::string name = plugin;
  std::string canonical = given.canonical();
  if (!entry.information.original.empty()) {
    name = entry.information.original;
    std::vector<std::string> names;
    for (const auto& p : find_plugin(name, {}).information.parameters) names.push_back(p.name);
    canonical = given.canonical(names);
  }
  return {std::move(setup), stream_key(1, name, canonical, 0), entry.information};
}

inline Prepared prepare(const std::string& plugin, const std::string& parameters = "null",
                        const std::string& folder = suite_data) {
  return prepare(plugin, parameters_of(parameters), folder);
}

inline Channel channel(const std::string& plugin, const std::string& parameters = "null") {
  return prepare(plugin, parameters).channel();
}

/// Why parameters are refused.
inline std::string refusal(const std::string& plugin, const std::string& parameters,
                           const std::string& folder = suite_data) {
  return thrown<InputError>([&] { prepare(plugin, parameters, folder); });
}

/// Observations 0, 1, ... of every channel.
inline std::vector<Sample> observe(const Prepared& plugin, std::uint64_t count,
                                   std::uint64_t primaries = 1) {
  std::vector<double> out(plugin.setup->channels().size());
  std::vector<Sample> samples(out.size());
  const auto estimator = plugin.setup->make();
  Cost cost;
  for (std::uint64_t i = 0; i < count; ++i) {
    Stream random(plugin.key, i);
    estimator->secondary(random, primaries, out, cost);
    for (std::size_t c = 0; c < out.size(); ++c) samples[c].values.push_back(out[c]);
  }
  return samples;
}

/// Observations of the first channel by the key of another plugin.
inline std::vector<double> values_by(StreamKey key, Prepared plugin, std::uint64_t count,
                                     std::uint64_t primaries = 1) {
  plugin.key = key;
  return observe(plugin, count, primaries)[0].values;
}

/// One observation by itself, and what it cost.
struct Observation {
  std::vector<double> values;
  Cost cost;
};
inline Observation observe_one(const Prepared& plugin, std::uint64_t primaries,
                               std::uint64_t index = 0) {
  Observation one{std::vector<double>(plugin.setup->channels().size()), {}};
  Stream random(plugin.key, index);
  plugin.setup->make()->secondary(random, primaries, one.values, one.cost);
  return one;
}

/// The parameters of a scene.
inline std::string scene(const std::string& text) { return "{scene: " + text + "}"; }

/// Observations x primaries, and the limit of a comparison in standard errors.
struct Extent {
  std::uint64_t count = 0;
  std::uint64_t primaries = 1;
  double limit = five;
};

/// Holds every channel against the mean, the variance and the range that it declares.
inline void expect_declared(const Prepared& plugin, const Extent& extent) {
  const std::vector<Channel> channels = plugin.setup->channels();
  const std::vector<Sample> samples = observe(plugin, extent.count, extent.primaries);
  const double n = plugin.information.averages ? static_cast<double>(extent.primaries) : 1;
  ASSERT_TRUE(channels.at(0).mean);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const Channel& declared = channels[c];
    const Sample& sample = samples[c];
    SCOPED_TRACE(declared.name);
    if (declared.mean) {
      EXPECT_NEAR(sample.mean(), *declared.mean,
                  extent.limit * sample.mean_error() + declared.rounding +
                      1e-10 * std::abs(*declared.mean));
    }
    if (declared.variance) {
      EXPECT_NEAR(n * sample.variance(), *declared.variance,
                  extent.limit * n * sample.variance_error() + 1e-14);
    }
    EXPECT_GE(std::ranges::min(sample.values), declared.low);
    EXPECT_LE(std::ranges::max(sample.values), declared.high);
  }
}

/// Upper quantile of chi-square at 1e-6, after Wilson and Hilferty (1931).
inline double chi_square_bound(double freedom) {
  const double a = 2 / (9 * freedom);
  const double root = 1 - a + 4.753 * std::sqrt(a);
  return freedom * root * root * root;
}

/// Pearson's statistic of counts against expectations, cells below 20 expected pooled.
struct Pearson {
  double statistic = 0;
  double freedom = -1;
  double pooled_count = 0;
  double pooled_expected = 0;

  void add(double count, double expected) {
    if (expected < 20) {
      pooled_count += count;
      pooled_expected += expected;
      return;
    }
    statistic += (count - expected) * (count - expected) / expected;
    freedom += 1;
  }
  /// Cells of one probability.
  template <class Counts>
  static Pearson of_equal(const Counts& counts) {
    Pearson pearson;
    const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
    for (const double count : counts)
      pearson.add(count, total / static_cast<double>(counts.size()));
    return pearson;
  }
  /// True if the statistic is within the bound. The pooled cell counts if it is large enough.
  bool passes() {
    if (pooled_expected >= 20) {
      const double count = pooled_count, expected = pooled_expected;
      pooled_count = pooled_expected = 0;
      add(count, expected);
    }
    return statistic < chi_square_bound(freedom);
  }
};

}  // namespace assay::draws

namespace assay {
using namespace draws;
}  // namespace assay
