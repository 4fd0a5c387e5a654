#pragma once

// Turns drawn observations into the numbers and the verdict of a test.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/plan/outcome.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

/// A test with one pool for each subject.
struct TestWork {
  const Budget* suite_budget = nullptr;  ///< shared by the suite's tests; null: none
  TestOutcome outcome;
  std::vector<std::shared_ptr<Pool>> pools = {};
  /// The look that a recorded run ended with.
  std::optional<std::size_t> last_look = {};
  /// Skips the interval of the effect, the power and the sentence.
  bool verdict_only = false;

  /// A subject's sample at the current look, once it is drawn.
  Sample sample(std::size_t subject) const;
};

/// A test at its current look, without faults.
struct DrawnTest {
  const TestOutcome& outcome;
  std::vector<Drawn> samples;  ///< one for each subject
};

/// The test, or nullopt if a subject has a fault, which `why` gets.
std::optional<DrawnTest> drawn(const TestWork& work, std::string* why = nullptr);

/// Computes numbers, gates and the verdict on the test's fixed share at the current look, once it
/// is drawn. Sets `decided` if no later look can or need change it, or none is allowed.
void take_look(TestWork& work, bool may_go_on = true);

std::vector<ChannelData> data_of(const DrawnTest& test, std::size_t channel);

/// Says what to do about pixels that are not finite.
constexpr const char* leave_out_nonfinite =
    ": mend the renderer, or leave such pixels out by `--ignore nonfinite` (in a suite by "
    "`finite`), which hides what is wrong there";
/// The first draw that contradicts its sampler, in a clause; "" if none does.
std::string first_contradiction(const DrawnTest& test);

/// A tested claim's verdict in one or two sentences. They say what was found, what is excluded, and
/// what could be missed or how many more samples would decide.
Reason narrate(const TestOutcome& outcome);

/// Says that these observations exclude no `what` ("exponent").
std::string excludes_no(const std::string& what);

/// Settings of the family's test at the current look. They refer to `test`.
ImageTest image_test(const DrawnTest& test);

/// True if a place of the images rejects the claim, and not their distance over all pixels alone.
bool is_told_by_place(const TestOutcome& outcome, const ChannelOutcome& channel);

/// The mean difference over the cell that speaks most against equality, in units of the images and
/// weighted as the test weighs it. The cell was searched for: the interval is one of those that
/// hold the differences of all cells at once.
struct PlaceEffect {
  double estimate = 0;
  stats::Interval interval = {};
  double other = 0;                        ///< The mean that it is held against.
  std::vector<std::size_t> elements = {};  ///< In the question.
};
std::optional<PlaceEffect> effect_at_place(const DrawnTest& test);

/// "G differs by -5.1 %, B by -4.9 % (plain means)": components that clearly differ there, three at
/// most. The place's own component is among them if its effect says otherwise.
std::string others_at(const DrawnTest& test, const PlaceEffect& place);

/// "; at that place it is 3 % too bright (2 to 4 %): 1.03 against 1". It is "" unless one cell
/// decided a failed claim on images.
std::string where_it_differs(const DrawnTest& test);

/// Sets the differences that this look would find: one that is the same everywhere, by the sum, and
/// one in a typical cell. A claim that allows a difference has none.
void note_detectable(const TestOutcome& outcome, std::size_t look, ChannelOutcome& channel);

}  // namespace assay::harness
