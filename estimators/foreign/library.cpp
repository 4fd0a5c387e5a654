// Observations of an estimator in a shared library (plugin_abi.h): in a process of its own unless
// asked otherwise.

#include <array>
#include <filesystem>
#include <memory>

#include "estimators/foreign/examination.h"
#include "estimators/foreign/setup.h"
#include "estimators/foreign/shared_library.h"
#include "estimators/library_host.h"

namespace assay::foreign {

namespace {

std::vector<double> numbers_of(const SamplerDraw& draw) {
  const auto& [x, y, z] = draw.point;
  return {x, y, z, draw.density, draw.weight, draw.valid ? 1.0 : 0.0};
}

/// A sampler that nobody else asks twice. It asks again for the first draw, density and evaluation.
/// Other bits are a LibraryError, then and at every later call.
class InProcessSampler final : public LibrarySampler {
 public:
  InProcessSampler(std::shared_ptr<const PreparedLibrary> library, const AssaySampler& sampler);

  SamplerDraw sample(Stream& random) const override;
  double density(const Point& point) const override;
  double evaluate(const Point& point) const override;

 private:
  template <class Ask>
  void look_at_first(Asked what, const Ask& ask) const;

  std::string name_;
  std::string file_;
  mutable std::array<FirstLook, 3> first_looks_;
};

InProcessSampler::InProcessSampler(std::shared_ptr<const PreparedLibrary> library,
                                   const AssaySampler& sampler)
    : LibrarySampler(library, sampler), name_(sampler.name), file_(library->file()) {}

template <class Ask>
void InProcessSampler::look_at_first(Asked what, const Ask& ask) const {
  first_looks_[static_cast<std::size_t>(what)].at([&] {
    const std::vector<double> numbers = ask();
    const Question question{.first = static_cast<std::uint64_t>(what), .primaries = 0};
    return same_bits(ask(), numbers) ? ""
                                     : "sampler `" + name_ + "`: " + other_numbers(file_, question);
  });
}

SamplerDraw InProcessSampler::sample(Stream& random) const {
  const std::uint64_t key = random();
  const std::uint64_t observation = random();
  look_at_first(Asked::draws, [&] { return numbers_of(draw(key, observation)); });
  return draw(key, observation);
}

double InProcessSampler::density(const Point& point) const {
  look_at_first(Asked::densities, [&] { return std::vector{LibrarySampler::density(point)}; });
  return LibrarySampler::density(point);
}

double InProcessSampler::evaluate(const Point& point) const {
  look_at_first(Asked::evaluations, [&] { return std::vector{LibrarySampler::evaluate(point)}; });
  return LibrarySampler::evaluate(point);
}

/// A library in this process.
class LibraryRespondent final : public Respondent {
 public:
  explicit LibraryRespondent(std::shared_ptr<const PreparedLibrary> library)
      : library_(std::move(library)) {}

  const Hello& hello() const override { return library_->hello(); }

 private:
  std::vector<double> hear(const Question& question, std::string_view /*items*/) override {
    try {
      std::uint64_t at = 0;
      return library_->answer(question, at);
    } catch (const LibraryError& error) {
      throw NoAnswer(error.what());
    }
  }

  std::shared_ptr<const PreparedLibrary> library_;
};

std::shared_ptr<const Setup> in_this_process(const LibraryChoice& choice) {
  const auto library = std::make_shared<const PreparedLibrary>(choice);
  std::vector<NamedSampler> samplers;
  for (const AssaySampler& sampler : library->samplers()) {
    samplers.push_back({sampler.name, std::make_shared<InProcessSampler>(library, sampler)});
  }
  const auto start = [library] { return std::make_unique<LibraryRespondent>(library); };
  return setup_of(std::make_shared<Children>(library->file(), start), std::move(samplers));
}

}  // namespace

}  // namespace assay::foreign

namespace assay::plugins {

namespace {

foreign::LibraryChoice choice_of(Parameters& parameters) {
  // Absolute: the host runs in the suite's folder.
  foreign::LibraryChoice choice{
      .file = std::filesystem::absolute(parameters.file("file")).lexically_normal().string(),
      .estimator = parameters.string("estimator"),
      .folder = parameters.folder()};
  if (!parameters.given("estimator")) choice.estimator.clear();
  const Value& given = parameters.structure("parameters");
  if (given.kind() != Value::Kind::map) {
    parameters.refuse("parameters", "must be a map of names to values: `{rate: 2}`");
  }
  for (const auto& [name, value] : given.members()) {
    choice.parameters.emplace_back(name, value.string("parameter `" + name + "` of the library"));
  }
  return choice;
}

std::shared_ptr<const Setup> isolated(foreign::Terms terms, const foreign::LibraryChoice& choice,
                                      const Parameters& parameters) {
  try {
    terms.launch.command = {library_host(), library_host_word, choice.file, choice.estimator,
                            std::filesystem::absolute(choice.folder).string()};
  } catch (const std::runtime_error& error) {
    parameters.refuse("isolated", error.what());
  }
  for (const auto& [name, text] : choice.parameters) {
    terms.launch.command.push_back(name);
    terms.launch.command.push_back(text);
  }
  terms.name = choice.file;
  return foreign::start(std::move(terms), parameters, "file");
}

std::shared_ptr<const Setup> in_process(const foreign::LibraryChoice& choice,
                                        const Parameters& parameters) {
  try {
    return foreign::in_this_process(choice);
  } catch (const std::runtime_error& error) {
    parameters.refuse("file", std::string("is of no use: ") + error.what());
  }
}

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  foreign::Terms terms = foreign::read_terms(parameters);
  const foreign::LibraryChoice choice = choice_of(parameters);
  if (parameters.boolean("isolated")) return isolated(std::move(terms), choice, parameters);
  return in_process(choice, parameters);
}

std::vector<ParameterInformation> parameters() {
  std::vector<ParameterInformation> all = {
      {.name = "file",
       .type = ParameterType::string,
       .summary = "the library, relative to the suite"},
      text_parameter("estimator", "which of its estimators; where it has one, that", "only"),
      structure_parameter("parameters", "what the library declares, `{rate: 2}`", "{}"),
      beside_draws(boolean_parameter(
          "isolated",
          "run in a process of its own; if false a crash of the library ends the whole run",
          true))};
  for (const ParameterInformation& term : foreign::terms_parameters()) all.push_back(term);
  return all;
}

}  // namespace

std::vector<Entry> foreign_library() {
  return {
      {{.name = "library",
        .summary = "Observations of an estimator in a shared library.",
        .description =
            "The library exports assay_library(), as the header plugin_abi.h (C11, linked "
            "against nothing) declares it, and is compiled by `gcc -std=c11 -O2 -fPIC -shared`. "
            "Its random numbers are Assay's own streams: a C copy of an estimator draws the very "
            "numbers of the original under the same key.\n"
            "It runs in a process of its own, one a worker, with `timeout` and `memory` as those "
            "of `process`. A crash, a time-out, an error that it reports, a number that is not "
            "finite and a word on standard output are then errors of the tests that use it, with "
            "the index of the observation, and all other tests go on. With `isolated: false` it "
            "is called in the run's own process: faster for estimators that cost nothing, the "
            "same numbers to the last bit, but a crash ends the run, nothing times out, and "
            "secondary() is called by several threads at a time. All this is "
            "true of its samplers too; a message then names the draw, or the point of a density.",
        .parameters = parameters(),
        .averages = false,
        .says_nature = true},
       prepare}};
}

}  // namespace assay::plugins
