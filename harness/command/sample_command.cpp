#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "estimators/core/flush_denormals.h"
#include "harness/base/interrupt.h"
#include "harness/command/commands.h"
#include "harness/draws/sampler_setup.h"
#include "harness/question/question_sources.h"
#include "harness/sampling/pool.h"
#include "harness/sampling/prepare.h"
#include "harness/sampling/recorded_run.h"

namespace assay::harness {
namespace {

constexpr std::uint64_t usual = 10;

/// A name as the plugin `recorded` reads it.
std::string in_header(const std::string& name) {
  if (name.find_first_of(" \t,;#\"") == std::string::npos) return name;
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// A source's channels: an estimator's, or the marginals of one of its samplers.
struct Sampled {
  std::shared_ptr<const Setup> setup;
  std::string purpose = "";
  std::vector<std::size_t> columns = {};
};

void add_columns(Sampled& sampled, const std::string& name) {
  const std::vector<Channel> channels = sampled.setup->channels();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (name.empty() ? channels[i].name != cell_channel : channels[i].name == name) {
      sampled.columns.push_back(i);
    }
  }
}

bool has_marginal(const NamedSampler& named, const std::string& name) {
  const std::vector<Marginal> all = marginals(named.sampler->domain());
  return std::ranges::find(all, name, &Marginal::name) != all.end();
}

/// Computes the cells if their numbers are to be printed.
void ask_for_cells(const Sampled& sampled, const Source& source) {
  const auto* draws = dynamic_cast<const SamplerSetup*>(sampled.setup.get());
  if (draws == nullptr) return;
  const std::vector<Channel> channels = draws->channels();
  const auto is_cell = [&](std::size_t column) { return channels[column].name == cell_channel; };
  if (std::ranges::none_of(sampled.columns, is_cell)) return;
  try {
    draws->density_cells();
  } catch (const std::domain_error& error) {
    refuse(source.where, error.what());
  }
}

Sampled sampled_by(const PreparedEstimator& estimator, const Source& source, std::uint64_t seed) {
  Sampled sampled{.setup = estimator.setup};
  add_columns(sampled, source.part);
  if (!sampled.columns.empty()) return sampled;
  const auto dot = source.part.find('.');
  const std::vector<NamedSampler> samplers = estimator.setup->samplers();
  for (const NamedSampler& named : samplers) {
    const bool by_name = named.name == source.part.substr(0, dot);
    // A marginal of the only sampler needs no sampler's name.
    const bool by_marginal = samplers.size() == 1 && has_marginal(named, source.part);
    if (!by_name && !by_marginal) continue;
    const StreamKey cells = stream_of_cells(estimator, named.name, seed);
    sampled = Sampled{.setup = sampler_setup(named, source.where, cells), .purpose = named.name};
    const std::string rest = dot == std::string::npos ? "" : source.part.substr(dot + 1);
    add_columns(sampled, by_name ? rest : source.part);
  }
  if (!sampled.columns.empty()) {
    ask_for_cells(sampled, source);
    return sampled;
  }
  refuse(source.where, "`{}` has no part `{}`; `assay describe {}` lists them", source.estimator,
         source.part, estimator.entry->information.name);
}

}  // namespace

int sample(const SampleArguments& arguments) {
  const Source source = parse_source(arguments.source, {arguments.source, 0, 0});
  const std::vector<EstimatorEntry> entries =
      estimators_of({source}, arguments.estimators, arguments.primaries);
  const PreparedEstimator estimator = prepare(entries.front(), ".");
  const Sampled sampled = sampled_by(estimator, source, arguments.seed);
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
  const std::vector<Channel> channels = sampled.setup->channels();
  for (const std::size_t column : sampled.columns) {
    names.push_back(in_header(channels[column].name));
  }
  fmt::print("# {} {} of {} primaries, seed {}\n", estimator.entry->information.name,
             estimator.parameters, arguments.primaries, arguments.seed);
  fmt::print("# stream: {:016x}\n# columns: {}\n", key.bits, fmt::join(names, " "));
  if (const auto* draws = dynamic_cast<const SamplerSetup*>(sampled.setup.get())) {
    std::vector<double> none;
    for (const Marginal& marginal : draws->marginals()) none.push_back(no_point(marginal));
    fmt::print("# a draw without a point: {}\n", fmt::join(none, " "));
  }
  const std::unique_ptr<Estimator> worker = sampled.setup->make();
  const FlushDenormals flush;
  std::vector<double> out(channels.size());
  worker->announce({.key = key, .first = 0, .last = count});
  for (std::uint64_t row = 0; row < count && !interrupted(); ++row) {
    Stream random(key, row);
    Cost unused;
    worker->secondary(random, arguments.primaries, out, unused);
    std::string line;
    for (const std::size_t column : sampled.columns) {
      line += fmt::format("{}{}", line.empty() ? "" : " ", out[column]);
    }
    fmt::print("{}\n", line);
  }
  return 0;
}

}  // namespace assay::harness
