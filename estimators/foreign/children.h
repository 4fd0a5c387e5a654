#pragma once

// The running programs of one set-up: one a worker, kept from one round of sampling to the next.

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "estimators/foreign/dialogue.h"

namespace assay::foreign {

class Children {
 public:
  /// Starts the first one, for its hello. Throws NoAnswer, or std::system_error where the program
  /// cannot be started.
  explicit Children(Terms terms);
  /// Asks all to end, and kills those that do not.
  ~Children();
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  const Hello& hello() const { return hello_; }
  const Terms& terms() const { return terms_; }

  /// One that nobody uses, else a new one; its hello must be that of the first.
  std::unique_ptr<Dialogue> take();
  void give_back(std::unique_ptr<Dialogue> dialogue);

  /// Draws the numbers of one observation a second time, once for each program: first that which
  /// the first program drew, asked of itself, then the same one asked of every other. Throws
  /// NoAnswer where the bits differ: an observation is then no function of key and index. Of the
  /// first program it also asks whether another key gives other numbers and, of means, whether
  /// another index does, else NoAnswer. `numbers` are those of the question's only observation.
  void witness(Dialogue& dialogue, const Question& question, const std::vector<double>& numbers);

  /// That observation `index` of a stream could not be had. Those after it need not be tried.
  void note_failure(const Question& at, const std::string& why);
  /// Throws NoAnswer where an earlier observation of the same stream could not be had, or where
  /// witness() found that the program ignores key or index. A draw of a sampler is an observation
  /// of no primaries.
  void refuse_after_failure(const Question& question) const;

 private:
  void examine(Dialogue& dialogue, const Question& question);

  struct Witness {
    Question question;
    std::vector<double> numbers;
  };
  struct Failure {
    std::uint64_t index;
    std::string why;
  };
  using StreamName = std::pair<std::uint64_t, std::uint64_t>;  // key, primaries

  Terms terms_;
  Hello hello_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Dialogue>> idle_;
  std::optional<Witness> witness_;
  std::map<StreamName, Failure> failures_;
  std::string unfit_ = "";  ///< why no observation of any stream is worth anything
};

}  // namespace assay::foreign
