#include <filesystem>
#include <memory>

#include "estimators/foreign/setup.h"
#include "estimators/foreign/shared_library.h"
#include "estimators/library_host.h"

namespace assay::plugins {

namespace {

/// A library in this process.
class LibraryRespondent final : public foreign::Respondent {
 public:
  explicit LibraryRespondent(std::shared_ptr<const foreign::PreparedLibrary> library)
      : library_(std::move(library)) {}

  const foreign::Hello& hello() const override { return library_->hello(); }

 private:
  std::vector<double> hear(const foreign::Question& question, std::string_view items) override {
    try {
      return library_->answer(question, items);
    } catch (const foreign::LibraryError& error) {
      throw foreign::NoAnswer(error.what());
    }
  }

  std::shared_ptr<const foreign::PreparedLibrary> library_;
};

foreign::LibraryChoice choice_of(Parameters& parameters) {
  // Absolute: the host runs in the suite's folder.
  foreign::LibraryChoice choice{
      .file = std::filesystem::absolute(parameters.file("file")).lexically_normal().string(),
      .estimator = parameters.string("estimator"),
      .folder = parameters.folder()};
  if (!parameters.given("estimator")) choice.estimator.clear();
  const Value& given = parameters.structure("parameters");
  parameters.require(given.kind() == Value::Kind::map, "parameters",
                     "must be a map of names to values: `{rate: 2}`");
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
  terms.who_is_ready = "its host prints it once the library is loaded and has taken its parameters";
  return foreign::start(std::move(terms), parameters, "file");
}

std::shared_ptr<const Setup> in_process(const foreign::LibraryChoice& choice,
                                        const Parameters& parameters) {
  try {
    const auto library = std::make_shared<const foreign::PreparedLibrary>(choice);
    const auto start = [library] { return std::make_unique<LibraryRespondent>(library); };
    return foreign::setup_of(std::make_shared<foreign::Children>(library->file(), start));
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

}  // namespace

std::vector<Entry> foreign_library() {
  return {
      {{.name = "library",
        .summary = "Observations of an estimator in a shared library.",
        .description =
            "The library exports assay_library(), which the header plugin_abi.h (C11, linked "
            "against nothing) declares. Compile it by `gcc -std=c11 -O2 -fPIC -shared`. Its random "
            "numbers are Assay's own streams: a C copy of an estimator draws the numbers of the "
            "original under the same key.\n"
            "Each worker runs the library in another process, with `timeout` and `memory` as for "
            "`process`. A crash, a time-out, a reported error, a number that is not finite and a "
            "word on standard output are then errors of its tests alone, with the index of the "
            "observation. With `isolated: false` the run calls the library directly. That is "
            "faster for estimators that cost nothing and gives the same bits. But a crash ends the "
            "run, nothing times out, and several threads call secondary() at a time. The same "
            "holds for its samplers; a message then names the draw, or the point of a density.",
        .parameters = joined(
            {{.name = "file",
              .type = ParameterType::string,
              .summary = "the library; its path starts at the suite's folder"},
             text_parameter("estimator", "which of its estimators to use, if it has several",
                            "only"),
             structure_parameter("parameters", "parameters that the library declares, `{rate: 2}`",
                                 "{}"),
             beside_draws(boolean_parameter(
                 "isolated",
                 "run the library in another process; if false, its crash ends the whole run",
                 true))},
            foreign::terms_parameters()),
        .averages = false,
        .says_nature = true},
       prepare}};
}

}  // namespace assay::plugins
