#pragma once

#include "harness/draws/sampler_setup.h"
#include "harness/question/question.h"
#include "harness/theta/ask.h"
#include "tests/harness/running.h"

namespace assay::harness {

/// A suite given as text, with the questions its tests ask.
struct Asked {
  Suite suite;
  std::map<std::string, PreparedEstimator> estimators;
  std::vector<Question> questions;

  const Question& question(const std::string& name) const {
    for (const Question& each : questions) {
      if (each.test->name == name) return each;
    }
    throw std::out_of_range("no test named " + name);
  }
};

/// On the heap: questions point into the suite and its estimators.
inline std::unique_ptr<Asked> ask_text(const std::string& text, std::uint64_t seed = 1) {
  const Workplace place;
  auto asked = std::make_unique<Asked>();
  asked->suite = load_suite(place.write("suite.yaml", text));
  asked->estimators = prepare_all(asked->suite);
  for (TestEntry& test : asked->suite.tests) {
    asked->questions.push_back(ask_as_written(test, asked->estimators, seed));
  }
  return asked;
}

/// The set-up behind the sampler of a plugin with these parameters.
inline std::shared_ptr<const SamplerSetup> setup_of(const std::string& plugin,
                                                    const std::string& part) {
  const auto asked =
      ask_text("suite: one\nestimators: {e: " + plugin +
               "}\ntests: [{name: t, claim: distribution(e." + part + ") == density}]\n");
  return std::dynamic_pointer_cast<const SamplerSetup>(asked->question("t").subjects[0].setup);
}

}  // namespace assay::harness
