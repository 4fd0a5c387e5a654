#include <atomic>
#include <memory>

#include "estimators/foreign/setup.h"

namespace assay::plugins {

namespace {

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  foreign::Terms terms = foreign::read_terms(parameters);
  terms.launch.command = parameters.texts("command");
  const std::vector<std::string>& command = terms.launch.command;
  parameters.require(!command.empty() && !command.front().empty(), "command",
                     "names no program; as in `[python3, mine.py]`");
  terms.asked_whether_it_flushes = std::make_shared<std::atomic_flag>();
  return foreign::start(std::move(terms), parameters, "command");
}

}  // namespace

std::vector<Entry> foreign_process() {
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
       prepare}};
}

}  // namespace assay::plugins
