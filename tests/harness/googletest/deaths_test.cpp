// Callables that die: each way, in each phase, of each kind of source. A program of its own: what
// is thrown into it must not end it.

#include <new>

#include "harness/googletest/claims.h"
#include "tests/prelude.h"

namespace assay::googletest {
namespace {

enum class Way { standard, wordless, no_memory, number, text, nan, infinite };
enum class Phase { pilot, first, later, last };
enum class Kind { primary, secondary };

using Cell = std::tuple<Kind, Way, Phase>;

// Two claims a cell. Each has its false-alarm rate from the binary: 1e-5 / 200.
const DeclaredClaims budget{{.claims = 200, .alpha = 1e-5}};

/// Dies at one observation of the pilot's stream or of the test's, which comes after it.
class Source {
 public:
  explicit Source(const Cell& cell) : way_(std::get<Way>(cell)), phase_(std::get<Phase>(cell)) {}

  std::uint64_t index() const {
    if (phase_ == Phase::later) return 500;
    return phase_ == Phase::last ? 999 : 3;
  }

  double draw(Stream& random) {
    std::uint64_t none = 0;
    pilot_.compare_exchange_strong(none, random.key().bits);
    const bool in_pilot = pilot_.load() == random.key().bits;
    const double value = random.uniform();
    if (in_pilot != (phase_ == Phase::pilot) || random.observation() != index()) return value;
    has_died_.store(true);
    return die();
  }

  bool has_died() const { return has_died_.load(); }

 private:
  double die() const {
    switch (way_) {
      case Way::standard:
        throw std::runtime_error("no light");
      case Way::wordless:
        throw std::runtime_error("");
      case Way::no_memory:
        throw std::bad_alloc();
      case Way::number:
        throw 7;
      case Way::text:
        throw "no light";
      case Way::nan:
        return std::numeric_limits<double>::quiet_NaN();
      case Way::infinite:
        return std::numeric_limits<double>::infinity();
    }
    return 0;
  }

  Way way_;
  Phase phase_;
  std::atomic<std::uint64_t> pilot_{0};
  std::atomic<bool> has_died_{false};
};

/// The source's own words in the message.
std::string words_of(Way way) {
  switch (way) {
    case Way::standard:
      return "no light";
    case Way::no_memory:
      return std::bad_alloc().what();
    case Way::nan:
    case Way::infinite:
      return "not finite";
    default:
      return "";
  }
}

class Deaths : public testing::TestWithParam<Cell> {};

TEST_P(Deaths, AreErrorsOfTheirClaimAlone) {
  const auto [kind, way, phase] = GetParam();
  Source source(GetParam());
  const auto draw = [&](Stream& random) { return source.draw(random); };
  std::vector<Part> parts;
  if (kind == Kind::primary) {
    parts.emplace_back(primary("mine", draw));
  } else {
    parts.emplace_back(secondary(
        "mine", 1, [&](Stream& random, std::span<double> out) { out[0] = source.draw(random); }));
  }
  // Several looks, of which the first have not seen enough; else one of 1000 observations.
  if (phase == Phase::later) parts.emplace_back(detect(kind == Kind::primary ? "0.2%" : "4%"));
  const testing::AssertionResult result = claim_holds("mean(mine) == 0.5", parts);
  std::string said = result.message();
  std::ranges::replace(said, '\n', ' ');
  ASSERT_TRUE(source.has_died()) << said;
  EXPECT_FALSE(result);
  EXPECT_THAT(said, testing::StartsWith("error: "));
  EXPECT_THAT(said, HasSubstr("`mine`"));
  EXPECT_THAT(said, HasSubstr("observation " + std::to_string(source.index())));
  EXPECT_THAT(said, HasSubstr(words_of(way)));
  EXPECT_CLAIM("mean(other) == 0.5",
               primary("other", [](Stream& random) { return random.uniform(); }));
}

std::string name_of(const testing::TestParamInfo<Cell>& cell) {
  static const std::vector<std::string> kinds{"Primary", "Secondary"};
  static const std::vector<std::string> ways{"Standard", "Wordless", "NoMemory", "Number",
                                             "Text",     "Nan",      "Infinite"};
  static const std::vector<std::string> phases{"Pilot", "FirstLook", "LaterLook", "LastBlock"};
  const auto [kind, way, phase] = cell.param;
  return kinds.at(static_cast<std::size_t>(kind)) + ways.at(static_cast<std::size_t>(way)) +
         phases.at(static_cast<std::size_t>(phase));
}

INSTANTIATE_TEST_SUITE_P(
    Callables, Deaths,
    testing::Combine(testing::Values(Kind::primary, Kind::secondary),
                     testing::Values(Way::standard, Way::wordless, Way::no_memory, Way::number,
                                     Way::text, Way::nan, Way::infinite),
                     testing::Values(Phase::pilot, Phase::first, Phase::later, Phase::last)),
    name_of);

}  // namespace
}  // namespace assay::googletest
