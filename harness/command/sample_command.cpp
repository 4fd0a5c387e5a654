#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>

#include "estimators/core/flush_denormals.h"
#include "harness/base/interrupt.h"
#include "harness/command/commands.h"
#include "harness/draws/sampler_setup.h"
#include "harness/question/question.h"
#include "harness/sampling/pool.h"
#include "harness/sampling/prepare.h"
#include "harness/sampling/recorded_run.h"

namespace assay::harness {
namespace {

constexpr std::uint64_t usual = 10;

/// A name as the plugin `recorded` reads it.
std::string in_header(const std::string& name) {
  if (name.find_first_of(" \t,;#\"") == std::string::npos) return name;
  return fmt::format("\"{}\"", boost::replace_all_copy(name, "\"", "\"\""));
}

/// A source's channels: all of an estimator, or a part of it. The cells of a sampler's draws are
/// computed here.
Subject sampled_by(Source source, const Estimators& estimators, std::uint64_t seed) {
  const std::string cell = "." + cell_channel;
  if (!source.part.ends_with(cell)) {
    Subject sampled = values(source, estimators);
    if (source.part.empty()) sampled.channels = {0, 1, sampled.setup->channel_count()};
    return sampled;
  }
  source.part.resize(source.part.size() - cell.size());
  Subject sampled = draws(source, estimators, Draws::cells);
  seed_cells(sampled, source.where, seed);
  try {
    dynamic_cast<const SamplerSetup&>(*sampled.setup).density_cells();
  } catch (const std::domain_error& error) {
    refuse(source.where, error.what());
  }
  return sampled;
}

}  // namespace

int sample(const SampleArguments& arguments) {
  const Source source = parse_source(arguments.source, {arguments.source, 0, 0});
  const std::vector<EstimatorEntry> entries = estimators_of(
      {source}, arguments.estimators, arguments.primaries, "assay sample " + arguments.source);
  const Estimators estimators{{source.estimator, prepare(entries.front(), ".")}};
  const Subject sampled = sampled_by(source, estimators, arguments.seed);
  const PreparedEstimator& estimator = *sampled.estimator;
  const auto rows = sampled.setup->observations();
  if (sampled.setup->is_reference()) {
    refuse(source.where, "`{}` is a reference, a mean without observations", source.estimator);
  }
  if (as_recorded_run(*sampled.setup) != nullptr) {
    refuse({}, "`{}` has the moments of a run, not its observations", source.estimator);
  }
  if (rows && arguments.secondaries.value_or(0) > *rows) {
    refuse({}, "--secondaries {}: `{}` has {} rows", *arguments.secondaries, source.estimator,
           *rows);
  }
  const std::uint64_t count = arguments.secondaries.value_or(std::min(usual, rows.value_or(usual)));
  const StreamKey key = key_of(estimator, arguments.seed, 0, sampled.purpose);

  std::vector<std::string> names;
  for (const Channel& column : sampled.declared()) names.push_back(in_header(column.name));
  fmt::print("# {} {} of {} primaries, seed {}\n", estimator.entry->information.name,
             estimator.parameters, arguments.primaries, arguments.seed);
  fmt::print("# stream: {:016x}\n# columns: {}\n", key.bits, fmt::join(names, " "));
  if (const auto* draws = dynamic_cast<const SamplerSetup*>(sampled.setup.get())) {
    fmt::print("# a draw without a point: {}\n",
               fmt::join(mapped(draws->marginals(), no_point), " "));
  }
  const std::unique_ptr<Estimator> worker = sampled.setup->make();
  const FlushDenormals flush;
  std::vector<double> out(sampled.setup->channel_count());
  worker->announce({.key = key, .first = 0, .last = count});
  for (std::uint64_t row = 0; row < count && !interrupted(); ++row) {
    Stream random(key, row);
    Cost unused;
    worker->secondary(random, arguments.primaries, out, unused);
    std::string line;
    for (const std::size_t column : sampled.channels.all()) {
      line += fmt::format("{}{}", line.empty() ? "" : " ", out[column]);
    }
    fmt::print("{}\n", line);
  }
  return 0;
}

}  // namespace assay::harness
