#include "harness/suite/suite_images.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimators/pictures.h"
#include "harness/suite/suite_entries.h"
#include "harness/suite/suite_keys.h"
#include "stats/images/image.h"

namespace assay::harness {
namespace {

/// The place of an option, as messages show it.
Location place(const char* option, const std::string& text) {
  return {fmt::format("{} {}", option, text), 0, 0};
}

std::vector<std::string> files_given(const char* option, const std::string& pattern) {
  try {
    return recorded::files_of(pattern);
  } catch (const InputError& error) {
    throw InputError(place(option, pattern), error.message());
  }
}

void require_enough(const char* option, const std::string& pattern, std::size_t count) {
  if (count >= stats::least_replicates) return;
  throw InputError(
      place(option, pattern),
      fmt::format("{} {}, and the test takes {} or more: how much a pixel varies is known from "
                  "them alone; render more, each with a seed of its own",
                  count, count == 1 ? "picture matches" : "pictures match",
                  stats::least_replicates));
}

EstimatorEntry entry(const char* name, const Location& where, std::vector<Value::Member> members) {
  return {.name = name,
          .plugin = "recorded",
          .parameters = Value::map(std::move(members), where),
          .primaries = {},
          .where = where};
}

Value::Member member(const char* key, const std::string& text, const Location& where) {
  return {key, Value::scalar(text, where)};
}

EstimatorEntry stack_entry(const char* name, const Location& where, const std::string& pattern,
                           const ImagesArguments& arguments) {
  std::vector<Value::Member> members{member("file", pattern, where),
                                     member("channels", arguments.channels, where)};
  if (arguments.independent_pixels) members.push_back(member("pixels", "independent", where));
  return entry(name, where, std::move(members));
}

/// One reference file, with the error that its channels tell.
EstimatorEntry reference_entry(const Location& where, const std::string& file,
                               const ImagesArguments& arguments) {
  std::vector<Value::Member> members{member("file", file, where),
                                     member("channels", arguments.channels, where)};
  const ExrFile picture(file);
  const recorded::MomentChannels errors =
      recorded::usual_moments(picture, recorded::choose_channels(picture, arguments.channels));
  if (errors.any()) {
    if (!arguments.samples && !picture.samples_per_pixel()) {
      throw InputError(where,
                       "the picture carries its variance and not of how many samples its means "
                       "are; give --samples, a number or the channel that counts them");
    }
    if (!errors.variance.empty()) members.push_back(member("variance", errors.variance, where));
    if (!errors.second_moment.empty()) {
      members.push_back(member("second_moment", errors.second_moment, where));
    }
    if (arguments.samples) members.push_back(member("samples", *arguments.samples, where));
  } else {
    if (arguments.samples) {
      throw InputError(place("--samples", *arguments.samples),
                       "the reference has no channels `Variance.*` or `m2_*` that it could be for");
    }
    members.push_back(member("exact", "true", where));
  }
  return entry("reference", where, std::move(members));
}

EstimatorEntry reference_of(const ImagesArguments& arguments) {
  const Location where = place("--reference", arguments.reference);
  const std::vector<std::string> files = files_given("--reference", arguments.reference);
  if (files.size() == 1) return reference_entry(where, files[0], arguments);
  if (arguments.samples) {
    throw InputError(place("--samples", *arguments.samples),
                     "is of a reference that is one picture with its variance; several tell it "
                     "themselves");
  }
  require_enough("--reference", arguments.reference, files.size());
  return stack_entry("reference", where, arguments.reference, arguments);
}

std::optional<Margin> margin(const std::optional<std::string>& text, const char* option) {
  if (!text) return {};
  Margin margin = parse_margin(*text, {}, option);
  margin.where = place(option, *text);
  return margin;
}

std::string claim_of(const ImagesArguments& arguments) {
  if (!arguments.within) return "mean(candidate) == mean(reference)";
  margin(arguments.within, "--within");
  for (const auto& [text, option] :
       {std::pair(&arguments.detect, "--detect"), std::pair(&arguments.allow, "--allow")}) {
    if (!*text) continue;
    throw InputError(place(option, **text),
                     "is of a claim that the pictures are equal; --within says itself what must "
                     "not pass");
  }
  return fmt::format("mean(candidate) within {} of mean(reference)", *arguments.within);
}

}  // namespace

Suite suite_of_images(const ImagesArguments& arguments) {
  const Location where{"claim", 1, 1};
  TestEntry test{.claim = parse_claim(claim_of(arguments), where), .where = where};
  test.name = test.claim.text;
  test.id = "images/" + test.name;
  test.detect = margin(arguments.detect, "--detect");
  test.allow = margin(arguments.allow, "--allow");
  if (test.detect) test.keys["detect"] = test.detect->where;
  if (test.allow) test.keys["allow"] = test.allow->where;
  if (arguments.within) test.claim.margin.where = place("--within", *arguments.within);
  check_test(test);
  require_enough("--candidate", arguments.candidate,
                 files_given("--candidate", arguments.candidate).size());
  Suite suite;
  suite.name = "images";
  suite.stem = "images";
  suite.folder = ".";
  suite.estimators = {stack_entry("candidate", place("--candidate", arguments.candidate),
                                  arguments.candidate, arguments),
                      reference_of(arguments)};
  suite.tests.push_back(std::move(test));
  return suite;
}

}  // namespace assay::harness
