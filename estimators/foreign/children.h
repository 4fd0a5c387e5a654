#pragma once

// The programs that answer the workers of one set-up, one for each. They are kept from one round of
// sampling to the next.

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "estimators/foreign/dialogue.h"
#include "estimators/foreign/examination.h"

namespace assay::foreign {

/// Observations that need not be asked for again, and the CPU seconds that they took.
struct Recalled {
  std::vector<double> numbers = {};
  std::uint64_t count = 0;
  double seconds = 0;
};

class Children {
 public:
  using Start = std::function<std::unique_ptr<Respondent>()>;

  /// Starts the first one, for its hello. Throws what `start` throws. Messages call it `name`.
  Children(std::string name, Start start);
  /// Asks all to end, and kills those that do not.
  ~Children();
  Children(const Children&) = delete;
  Children& operator=(const Children&) = delete;

  const Hello& hello() const { return hello_; }
  const std::string& name() const { return name_; }

  /// One that nobody uses, else a new one; its hello must be that of the first.
  std::unique_ptr<Respondent> take();
  void give_back(std::unique_ptr<Respondent> dialogue);

  /// Asks a program that is new to observations of so many primaries for the first ones
  /// (examination.h). The set-up's first program is asked for all of them twice. Every other waits
  /// until they are drawn and is compared with two of them. Throws NoAnswer where numbers are no
  /// function of key and index, and where a program ends at what another has answered, or at
  /// another key. False where the first one ended: the observation that ends it tells. If it ended
  /// at many, the next one is asked for one at a time.
  bool examine(Respondent& dialogue, const Question& wanted);
  /// Returns those observations at the head of the question that an examination has drawn.
  Recalled recalled(const Question& question) const;
  /// If all first observations were the same, asks again for the first other one among these
  /// numbers. Throws NoAnswer if it is then another.
  void examine_unusual(Respondent& dialogue, const Question& question,
                       const std::vector<double>& numbers);

  /// That observation `index` of a stream could not be had. Those after it need not be tried.
  void note_failure(const Question& at, const std::string& why);
  /// Throws NoAnswer where it or an earlier observation of the same stream could not be had. So it
  /// does where an examination found that no numbers are worth anything. A draw of a sampler is an
  /// observation of no primaries.
  void refuse_after_failure(const Question& question) const;

 private:
  /// First observations, incomplete until a program has drawn them.
  struct Known {
    FirstObservations first = {};
    bool being_drawn = false;
    bool complete = false;
    bool one_by_one = false;  ///< A program did not answer for many.
    double seconds = 0;       ///< of CPU, for each
    /// The only value so far; none once another was asked for again.
    std::optional<std::vector<double>> usual = {};
  };

  bool is_to_draw(const Question& wanted);
  void settle(std::uint64_t primaries, Known known);
  Known known_of(std::uint64_t primaries) const;
  void refuse_unless_empty(const std::string& why);
  bool examine_first(Respondent& dialogue, const Question& wanted);

  struct Failure {
    std::uint64_t index;
    std::string why;
  };
  using StreamName = std::pair<std::uint64_t, std::uint64_t>;  // key, primaries

  std::string name_;
  Start start_;
  Hello hello_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Respondent>> idle_;
  std::condition_variable drawn_;         ///< no longer being drawn
  std::map<std::uint64_t, Known> known_;  ///< by primaries
  std::map<StreamName, Failure> failures_;
  std::string unfit_ = "";  ///< why no observation of any stream is worth anything
};

}  // namespace assay::foreign
