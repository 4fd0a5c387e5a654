#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "harness/question.h"
#include "running.h"

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
inline std::unique_ptr<Asked> ask_text(const std::string& text) {
  const Workplace place;
  auto asked = std::make_unique<Asked>();
  asked->suite = load_suite(place.write("suite.yaml", text));
  asked->estimators = prepare_all(asked->suite);
  for (const TestEntry& test : asked->suite.tests) {
    asked->questions.push_back(ask(test, asked->estimators, 1));
  }
  return asked;
}

}  // namespace assay::harness
