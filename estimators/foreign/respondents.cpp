// Programs, and libraries as a program hosts them, that answer by the protocol.

#include <atomic>
#include <filesystem>
#include <memory>

#include "estimators/foreign/setup.h"
#include "estimators/foreign/shared_library.h"
#include "estimators/library_host.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> process(Parameters& parameters) {
  foreign::Terms terms = foreign::read_terms(parameters);
  terms.launch.command = parameters.texts("command");
  const std::vector<std::string>& command = terms.launch.command;
  parameters.require(!command.empty() && !command.front().empty(), "command",
                     "names no program; as in `[python3, mine.py]`");
  terms.asked_whether_it_flushes = std::make_shared<std::atomic_flag>();
  return foreign::start(std::move(terms), parameters, "command");
}

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

std::shared_ptr<const Setup> library(Parameters& parameters) {
  foreign::Terms terms = foreign::read_terms(parameters);
  const foreign::LibraryChoice choice = choice_of(parameters);
  if (parameters.boolean("isolated")) return isolated(std::move(terms), choice, parameters);
  return in_process(choice, parameters);
}

}  // namespace

std::vector<Entry> foreign_respondents() {
  return {
      {{.name = "process",
        .summary = "Observations that another program draws and sends through pipes.",
        .description =
            "Each worker starts the program once, in its own process group. The program writes a "
            "hello to its standard output: `assay 1 text` (or `assay 1 binary`), a line `channel "
            "NAME` for each number of an observation, `ready`.\n"
            "Then it reads questions from its standard input until that ends. As text a question "
            "is a line of five numbers: the high and the low 32 bits of the key, the index of the "
            "first observation, the number of observations, and the number of primaries of each. "
            "The program answers with a line for each observation, which has the numbers of its "
            "channels, then repeats the question's line and flushes. In binary a question is four "
            "little-endian 64-bit words (key, first, count, primaries). The reply is count times "
            "channels doubles and the question again.\n"
            "An observation must depend on key and index alone, whatever was asked before. Assay "
            "asks for the first ones twice; different bits are an error, and so are the same "
            "numbers under another key. A program that ends, takes too long or writes anything "
            "else is an error too, with the index of the observation and the end of its standard "
            "error. Assay then kills the rest of its process group.\n"
            "The hello may have more lines: after a channel's name `mean X`, `error X`, `variance "
            "X` (of a primary), `low X`, `high X`, `rounding X`, `diagnostic`; `averages` if an "
            "observation is the mean of its primaries; `bias` unknown, unbiased, primaries, "
            "bootstrap, start-up or reconstruction; `image WIDTH HEIGHT COMPONENT…` instead of "
            "channels, with `range LOW HIGH` of its elements and `independent` if pixels are; "
            "`rays` if one more number follows each observation, the rays it took; `sampler NAME "
            "DOMAIN`, in binary only, for a source of points that Assay asks for draws and "
            "densities (estimators/foreign/README.md); `error WORDS` to refuse.",
        .parameters = joined({{.name = "command",
                               .type = ParameterType::texts,
                               .summary = "the program and its arguments, `[python3, mine.py]`; it "
                                          "runs in the suite's folder"}},
                             foreign::terms_parameters()),
        .averages = false,
        .says_nature = true},
       process},
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
       library}};
}

}  // namespace assay::plugins
