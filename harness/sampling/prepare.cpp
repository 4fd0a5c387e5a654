#include "harness/sampling/prepare.h"

#include <fmt/format.h>

#include <filesystem>
#include <ranges>

#include "estimators/catalogue.h"
#include "harness/base/refuse.h"
#include "harness/sampling/recorded_run.h"

namespace assay::harness {
namespace {

/// The parameters on which an estimator's streams depend.
std::vector<std::string> parameter_names(const Information& information) {
  return mapped(information.parameters | std::views::filter(&ParameterInformation::shapes_draws),
                &ParameterInformation::name);
}

std::shared_ptr<const Setup> set_up(const Entry& entry, Parameters& parameters) {
  const bool of_run = entry.information.name == "recorded" && parameters.given("run");
  std::shared_ptr<const Setup> setup =
      of_run ? std::shared_ptr<const Setup>(read_recorded_run(parameters))
             : entry.prepare(parameters);
  parameters.require_all_read();
  return setup;
}

/// The members of a mutant's parameters that its original knows.
Value only(const Value& given, const std::vector<std::string>& names) {
  std::vector<Value::Member> kept = given.members();
  std::erase_if(kept,
                [&](const auto& member) { return std::ranges::count(names, member.first) == 0; });
  return Value::map(std::move(kept), given.where());
}

}  // namespace

Nature PreparedEstimator::nature() const {
  return setup->nature().value_or(
      Nature{.averages = entry->information.averages, .bias = entry->information.bias});
}

PreparedEstimator prepare(const EstimatorEntry& entry, const std::string& folder) {
  const Entry& plugin = find_plugin(entry.plugin, entry.where);
  Parameters parameters(entry.plugin, plugin.information.parameters, entry.parameters, folder);
  PreparedEstimator prepared{
      .name = entry.name,
      .listed = entry.name,
      .entry = &plugin,
      .setup = set_up(plugin, parameters),
      .parameters = parameters.canonical(),
      .folder = std::filesystem::weakly_canonical(folder).string(),
      .key_plugin = entry.plugin,
      .key_parameters = parameters.canonical(parameter_names(plugin.information)),
      .primaries = entry.primaries,
      .original = nullptr,
      .where = entry.where,
      .given = entry.parameters};
  if (const RecordedRun* run = as_recorded_run(*prepared.setup)) {
    if (entry.primaries.value_or(run->primaries) != run->primaries) {
      refuse(entry.where, "the moments of `{}` are of {} primaries each: leave `primaries` out",
             entry.name, run->primaries);
    }
    prepared.primaries = run->primaries;
  } else if (prepared.setup->observations() && entry.primaries.value_or(1) != 1) {
    refuse(entry.where, "`{}` reads finished observations: leave `primaries` out", entry.plugin);
  }
  if (!plugin.information.original.empty()) {
    const Entry& original = find_plugin(plugin.information.original, entry.where);
    const std::vector<std::string> names = parameter_names(original.information);
    Parameters theirs(original.information.name, original.information.parameters,
                      only(entry.parameters, names), folder);
    prepared.original = set_up(original, theirs);
    prepared.key_plugin = original.information.name;
    prepared.key_parameters = theirs.canonical(names);
  }
  return prepared;
}

void share_random_numbers(const Suite& suite, std::map<std::string, PreparedEstimator>& prepared) {
  std::map<std::string, std::string> leader;
  const auto leader_of = [&](std::string name) {
    while (leader.contains(name)) name = leader[name];
    return name;
  };
  for (const TestEntry& test : suite.tests) {
    if (!test.paired) continue;
    const std::vector<Source> sides = sources_of(test.claim);
    const std::string first = leader_of(sides.front().estimator);
    const std::string second = leader_of(sides.back().estimator);
    if (first != second) leader[second] = first;
  }
  for (const auto& [name, unused] : leader) {
    const auto from = prepared.find(leader_of(name));
    const auto to = prepared.find(name);
    if (from == prepared.end() || to == prepared.end()) continue;  // one could not be prepared
    to->second.key_plugin = from->second.key_plugin;
    to->second.key_parameters = from->second.key_parameters;
  }
}

StreamKey key_of(const PreparedEstimator& estimator, std::uint64_t seed, std::uint32_t copy,
                 const std::string& purpose) {
  const std::string plugin =
      purpose.empty() ? estimator.key_plugin : estimator.key_plugin + "#" + purpose;
  return stream_key(seed, plugin, estimator.key_parameters, copy);
}

std::string stream_text(StreamKey key) { return fmt::format("{:016x}", key.bits); }

std::optional<StreamKey> read_stream(const std::string& text) {
  const auto bits = read_as<std::uint64_t>(text, 16);
  return bits ? std::optional(StreamKey{*bits}) : std::nullopt;
}

}  // namespace assay::harness
