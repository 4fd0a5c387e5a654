#include <fmt/format.h>
#include <wordexp.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <vector>

#include "harness/base/record_file.h"
#include "harness/base/terminal.h"
#include "harness/base/work.h"
#include "harness/command/help.h"
#include "harness/command/program.h"
#include "harness/draws/sampler_setup.h"
#include "harness/question/question.h"
#include "harness/record/record_of.h"
#include "harness/run/planned_run.h"
#include "reports/words/text.h"

namespace assay::harness {
namespace {

/// The record's sample of a subject's channel, or null.
const reports::Sample* recorded_of(const reports::Test& test, const Question& question,
                                   std::size_t subject, std::size_t channel) {
  const Subject& side = question.subjects[subject];
  if (!side.channels.contains(channel)) return nullptr;
  // Samples of two subjects with one estimator are in the subjects' order.
  auto earlier = std::ranges::count_if(
      std::span(question.subjects).first(subject),
      [&](const Subject& each) { return each.estimator->listed == side.estimator->listed; });
  const std::string name = side.setup->channel(channel).name;
  for (const reports::Sample& sample : test.samples) {
    const bool is_its = sample.estimator == side.estimator->listed &&
                        (side.image.has_value() || sample.channel == name);
    if (is_its && earlier-- == 0) return &sample;
  }
  return nullptr;
}

/// The words of a command line, as a shell that starts no command would split it.
std::vector<std::string> words_of_shell(const std::string& line) {
  wordexp_t words{};
  const bool split = wordexp(line.c_str(), &words, WRDE_NOCMD) == 0;
  const std::vector<std::string> all(words.we_wordv, words.we_wordv + words.we_wordc);
  wordfree(&words);
  if (!split) refuse({}, "the recorded command cannot be read: {}", line);
  return all;
}

/// The run that drew the test, by the command that its record keeps. No clock ends it.
Loaded recorded_run(const Recorded& recorded, const ReplayArguments& arguments) {
  namespace fs = std::filesystem;
  std::vector<std::string> words = words_of_shell(recorded.test.replay);
  words.erase(words.begin());
  // The suite's path starts where the command ran, which is here or beside the record.
  const std::string& file = recorded.suite.file;
  const fs::path beside = fs::absolute(arguments.record).parent_path() / file;
  if (!fs::exists(file) && fs::exists(beside)) {
    std::ranges::replace(words, file, beside.string());
  }
  Loaded run = loaded(parse_command_line(words));
  run.options.shard.reset();
  for (Suite& suite : run.suites) {
    // A budget in seconds sizes pilots and looks; here it ends none.
    const auto unbounded = [](std::optional<Budget>& budget) {
      if (budget && budget->seconds) budget->seconds = HUGE_VAL;
    };
    unbounded(suite.budget);
    for (TestEntry& each : suite.tests) unbounded(each.budget);
  }
  return run;
}

bool is_of(const TestEntry* test, const Recorded& recorded) { return test->id == recorded.test.id; }

/// A value beside the recorded ones: it is possible in their range, or if some are not finite.
struct Comparison {
  bool same = true;
  std::string text = "";
};

Comparison compared(const reports::Sample& sample, double value) {
  if (!std::isfinite(value)) {
    if (sample.nonfinite == 0) {
      return {false, fmt::format("  NOT as recorded: all {} were finite\n", sample.secondaries)};
    }
    return {.text = fmt::format("  not finite, as {} of the {} recorded\n", sample.nonfinite,
                                sample.secondaries)};
  }
  if (!sample.min || !sample.max) return {};
  const bool same = *sample.min <= value && value <= *sample.max;
  return {same, fmt::format("  {} [{}, {}], the range of the {} recorded\n",
                            same ? "lies in" : "NOT as recorded: lies outside", *sample.min,
                            *sample.max, sample.secondaries)};
}

/// The mean of an image's component over the finding's rectangle.
double mean_at(const reports::ImageFinding& found, const ImageShape& shape,
               const std::vector<double>& values) {
  const auto component = std::ranges::find(shape.components, found.component);
  double sum = 0;
  for (std::uint64_t y = found.y; y < found.y + found.height; ++y) {
    for (std::uint64_t x = found.x; x < found.x + found.width; ++x) {
      sum += values.at((y * shape.width + x) * shape.components.size() +
                       static_cast<std::size_t>(component - shape.components.begin()));
    }
  }
  return sum / static_cast<double>(found.width * found.height);
}

/// True if the record does not contradict the observation.
bool print_observation(const Question& question, const Recorded& recorded, std::uint64_t index) {
  const std::uint64_t drawn =
      std::ranges::max(recorded.test.samples, {}, &reports::Sample::secondaries).secondaries;
  if (index >= drawn) {
    refuse({}, "observation {} was not drawn: the test used 0 to {}", index, drawn - 1);
  }
  bool same = true;
  for (std::size_t i = 0; i < question.subjects.size(); ++i) {
    const Subject& side = question.subjects[i];
    const reports::Sample* const first = recorded_of(recorded.test, question, i, side.channels[0]);
    const Pool pool(side.setup, stream_of(side, recorded.suite.seed),
                    first != nullptr ? first->primaries : side.estimator->primaries.value_or(1));
    const bool taken = index < side.secondaries(drawn);
    if (pool.is_ready_made() || !taken) {
      fmt::print("{}  has {}\n", side.estimator->name,
                 taken ? "the moments of a run, not its observations" : "no such observation");
      same &= taken || first == nullptr || index >= first->secondaries;
      continue;
    }
    std::vector<double> values(pool.channels());
    try {
      pool.draw_again(*side.setup->make(), index, values);
    } catch (...) {
      const Fault fault{.observation = index, .words = words_of(std::current_exception())};
      throw std::runtime_error(sentence_of(fault, side));
    }
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (values[c] == no_cell && side.setup->channel(c).name == cell_channel) continue;
      const reports::Sample* sample = recorded_of(recorded.test, question, i, c);
      const bool has_range = sample != nullptr && index < sample->secondaries;
      const Comparison comparison = has_range ? compared(*sample, values[c]) : Comparison{};
      same &= comparison.same;
      // An image shows the numbers that the claim names, and those that are not as recorded.
      const bool is_one_of_many = side.setup->image() && (recorded.test.image || !has_range);
      if (comparison.same && is_one_of_many) continue;
      fmt::print("{}.{}  observation {}: {}\n{}", side.estimator->name, side.setup->channel(c).name,
                 index, values[c], comparison.text);
    }
    if (const auto& shape = side.setup->image()) {
      fmt::print(
          "{}  mean of observation {}: {}\n", side.estimator->name, index,
          std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()));
      if (recorded.test.image && recorded.test.image->winner.width > 0) {
        fmt::print("{}  its mean at {}: {}\n", side.estimator->name,
                   recorded.test.image->winner.place,
                   mean_at(recorded.test.image->winner, *shape, values));
      }
    }
    if (const auto* draws = dynamic_cast<const SamplerSetup*>(side.setup.get())) {
      fmt::print("{}", wrapped(fmt::format("draw of `{}`: {}", draws->name(),
                                           draw_text(draws->sampler(), pool.key(), index)),
                               2));
    }
  }
  return same;
}

/// Says why the run has no such test now.
[[noreturn]] void refuse_missing(const PlannedRun& run, const Recorded& recorded) {
  for (const auto& suite : run.suites) {
    for (const Untested& each : suite->untested) {
      if (is_of(each.test, recorded)) throw std::runtime_error(each.message);
    }
  }
  throw std::runtime_error("the recorded command no longer has this test");
}

/// Draws the observation alone, without a pilot.
bool replay_observation(const Loaded& run, const Recorded& recorded, std::uint64_t index) {
  const PlannedRun prepared = prepare_run(run.suites, run.options);
  for (const auto& suite : prepared.suites) {
    for (const Question& question : suite->questions) {
      if (is_of(question.test, recorded)) return print_observation(question, recorded, index);
    }
  }
  refuse_missing(prepared, recorded);
}

std::string shown(const reports::Number& value) {
  return value ? fmt::format("{}", *value) : "none";
}

reports::Number count(std::uint64_t number) { return static_cast<double>(number); }

bool same_line(const char* what, const reports::Number& now, const reports::Number& then,
               const std::string& note = "") {
  const bool same = now == then;
  fmt::print("  {:<27} {}{}{}\n", what, shown(now), note,
             same ? "" : fmt::format("   (recorded: {})", shown(then)));
  return same;
}

/// Prints the new numbers. True if they equal the recorded ones to the last bit, except those made
/// of seconds.
bool print_comparison(const reports::Test& now, const reports::Test& then, bool timed) {
  bool same = true;
  if (then.verdict == reports::Verdict::invalid || then.verdict == reports::Verdict::error) {
    fmt::print("{}", wrapped(fmt::format("{}, so the numbers below decide nothing: {}",
                                         reports::to_string(then.verdict), then.message)));
  }
  for (std::size_t i = 0; i < now.samples.size() && i < then.samples.size(); ++i) {
    const reports::Sample& is = now.samples[i];
    const reports::Sample& was = then.samples[i];
    fmt::print("{}.{}\n", is.estimator, is.channel);
    same &= same_line("secondaries", count(is.secondaries), count(was.secondaries));
    same &= same_line("primaries of each", count(is.primaries), count(was.primaries));
    if (is.nonfinite + was.nonfinite > 0) {
      same &= same_line("not finite", count(is.nonfinite), count(was.nonfinite),
                        "; mean and variance are of the others");
    }
    // A cell's number has neither mean nor variance.
    if (is.channel == cell_channel) continue;
    same &= same_line("mean", is.mean, was.mean);
    same &= same_line("variance of an observation", is.variance, was.variance);
  }
  for (std::size_t i = 0; i < now.channels.size() && i < then.channels.size(); ++i) {
    fmt::print("test {} on {}\n", now.method, now.channels[i].name);
    const bool statistic =
        same_line("statistic", now.channels[i].statistic, then.channels[i].statistic);
    const reports::Number& log10_p = now.channels[i].log10_p;
    const bool fits = !(log10_p.value_or(-HUGE_VAL) < -300);  // a double
    const std::string beside =
        fits ? fmt::format("   (p = {:.3g})", std::pow(10, *log10_p)) : std::string();
    const bool p = same_line(then.looks.size() > 1 ? "log10 p over the looks" : "log10 p", log10_p,
                             then.channels[i].log10_p, beside);
    same &= timed || (statistic && p);
  }
  same &= now.channels.size() == then.channels.size() && now.samples.size() == then.samples.size();
  return same;
}

/// Prints new beside recorded numbers; true if they are equal. std::runtime_error if a source can
/// no longer be drawn.
bool replay_test(const Loaded& run, const Recorded& recorded) {
  const std::unique_ptr<Progress> progress = make_progress(false);
  const PlannedRun planned = plan_run(run.suites, run.options, *progress);
  stop_if_interrupted();
  TestWork* found = nullptr;
  for (const auto& suite : planned.suites) {
    for (TestWork& each : suite->tests) {
      if (is_of(each.outcome.question.test, recorded)) found = &each;
    }
  }
  if (found == nullptr) refuse_missing(planned, recorded);
  TestWork& work = *found;
  const reports::Test& then = recorded.test;
  if (!then.looks.empty() && then.planned_looks == work.outcome.plan.looks.sizes) {
    work.last_look = then.looks.size() - 1;
  }
  sample_in_looks({&work}, planned.pools.all(), {}, *progress);
  stop_if_interrupted();
  const reports::Test now = record_of_test(work, recorded.suite.file);
  fmt::print("{}\n{}\n", then.id, then.claim);
  if (now.verdict == reports::Verdict::error && then.verdict != now.verdict) {
    throw std::runtime_error(now.message);
  }
  const bool timed = work.outcome.plan.method.keeps == Keeps::blocks;
  const bool same = print_comparison(now, then, timed);
  fmt::print("{}\n", !same   ? "NOT the numbers recorded: another version, machine or input file?"
                     : timed ? "the same observations as recorded; their seconds differ"
                             : "the same numbers as recorded");
  return same;
}

}  // namespace

int replay(ReplayArguments arguments) {
  const Location where{.file = arguments.record.empty() ? the_last_run : arguments.record};
  if (arguments.record.empty()) arguments.record = last_run();
  const reports::Record record = read_record(arguments.record);
  const Recorded recorded = find_test(record, where.file, arguments.test);
  const reports::Test& test = recorded.test;
  if (test.samples.empty())
    refuse(where, "test `{}` recorded no samples: {}", test.id, test.message);
  if (test.replay.empty()) {
    refuse(where, "test `{}` cannot be drawn again: {}", test.id,
           test.no_replay.empty() ? "its record has no command" : test.no_replay);
  }
  try {
    const Loaded run = recorded_run(recorded, arguments);
    const bool same = arguments.observation
                          ? replay_observation(run, recorded, *arguments.observation)
                          : replay_test(run, recorded);
    return same ? 0 : 1;
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& fault) {
    stop_if_interrupted();
    fmt::print("error: {}\n", fault.what());
    return 1;
  }
}

}  // namespace assay::harness
