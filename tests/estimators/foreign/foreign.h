#pragma once

// Programs that answer, and programs that do not, for the tests of `process` and `library`.

#include <sys/wait.h>

#include <cerrno>

#include "tests/estimators/draws.h"

namespace assay::foreign {

/// GoogleTest's fixtures have a Setup of their own.
using SharedSetup = std::shared_ptr<const Setup>;

inline const std::string examples = std::string(ASSAY_SOURCE_DIR) + "/estimators/foreign/examples";

/// Lines of a shell program that do this for each observation `i`.
inline std::string for_each(const std::string& observation) {
  return "while read -r high low first count primaries; do i=$first\n"
         "  while [ $i -lt $((first + count)) ]; do " +
         observation +
         "; i=$((i + 1)); done\n"
         "  echo \"$high $low $first $count $primaries\"; done\n";
}

/// At the end no program that it started may be left.
class Programs : public InFolder {
 protected:
  void TearDown() override {
    setups_.clear();
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a program was left";
    EXPECT_EQ(errno, ECHILD);
  }

  /// A plugin with parameters as a map.
  SharedSetup prepare(const std::string& plugin, const Value& given) {
    return setups_.emplace_back(draws::prepare(plugin, given, folder_.string()).setup);
  }

  /// `process` with these words as its command.
  SharedSetup run(const std::vector<std::string>& command, double timeout = 20) {
    std::vector<Value> words;
    for (const std::string& word : command) words.push_back(Value::scalar(word));
    return prepare("process", Value::map({{"command", Value::list(std::move(words))},
                                          {"timeout", Value::scalar(std::to_string(timeout))}}));
  }

  /// A shell program of these lines after a hello, whose channels are `said`.
  SharedSetup run_shell(const std::string& lines, double timeout = 20,
                        const std::string& said = "channel x") {
    const std::string hello = "printf 'assay 1 text\\n" + said + "\\nready\\n'\n";
    return run({"sh", write("program.sh", hello + lines)}, timeout);
  }

  std::string refusal(const std::vector<std::string>& command, double timeout = 20) {
    return thrown<InputError>([&] { run(command, timeout); });
  }
  /// The message of an exception that is no InputError.
  std::string fault(const std::vector<std::string>& command, double timeout = 20) {
    try {
      run(command, timeout);
    } catch (const InputError& error) {
      return std::string("refused: ") + error.what();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "nothing was thrown";
  }

  std::vector<SharedSetup> setups_;
};

/// Observations [0, count) of one stream as the harness draws them, `block` announced at a time; 0:
/// none announced.
inline std::vector<double> draw(const Setup& setup, std::uint64_t count, std::uint64_t block,
                                std::uint64_t primaries = 1,
                                std::uint64_t key = 0x9876543210abcdef) {
  const std::unique_ptr<Estimator> estimator = setup.make();
  const std::size_t width = setup.channels().size();
  std::vector<double> all(count * width);
  Cost cost;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (block > 0 && i % block == 0) {
      estimator->announce({.key = {key}, .first = i, .last = std::min(i + block, count)});
    }
    Stream random({key}, i);
    estimator->secondary(random, primaries, std::span(all).subspan(i * width, width), cost);
  }
  return all;
}

/// The same by streams that are not announced, at the cost that is added to.
inline double draw_one(Estimator& estimator, std::uint64_t index, std::uint64_t primaries,
                       Cost& cost, std::uint64_t key = 1) {
  double out = 0;
  Stream random({key}, index);
  estimator.secondary(random, primaries, {&out, 1}, cost);
  return out;
}
inline double draw_one(Estimator& estimator, std::uint64_t index, std::uint64_t key = 1) {
  Cost cost;
  return draw_one(estimator, index, 1, cost, key);
}

/// Why observations could not be drawn.
inline std::string failure(const Setup& setup, std::uint64_t count, std::uint64_t block) {
  return thrown([&] { draw(setup, count, block); });
}

}  // namespace assay::foreign
