#pragma once

// The record of a run: plain data that every report is a pure function of. Versioned; its JSON form
// is described by record.schema.json. A number that does not exist is std::nullopt (JSON null) and
// `message` says why. Quantities carry the unit of the estimator's output unless stated.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace assay::reports {

/// Stands at the end of a struct: ASSAY_FIELDS(Tool, name, version). It lists the members that the
/// JSON has, in their order; a key is the member's name. What writes, reads or compares the struct
/// follows this list.
#define ASSAY_FIELDS(Struct, ...)                               \
  bool operator==(const Struct&) const = default;               \
  static constexpr std::string_view field_names = #__VA_ARGS__; \
  void with_fields(auto&& take) { take(__VA_ARGS__); }          \
  void with_fields(auto&& take) const { take(__VA_ARGS__); }

template <class T>
concept has_fields = requires {
  T::field_names;
};

/// Calls visit(key, member) for each field.
template <has_fields T, class Visit>
void for_each_field(T& value, Visit visit) {
  std::string_view rest = T::field_names;
  const auto next_key = [&rest] {
    const std::string_view key = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), key.size() + std::string_view(", ").size()));
    return key;
  };
  value.with_fields([&](auto&... member) { (visit(next_key(), member), ...); });
}

/// A number of the record that may not exist: JSON null.
using Number = std::optional<double>;

/// A number with its interval at `confidence`.
struct Estimate {
  Number value, low, high;
  ASSAY_FIELDS(Estimate, value, low, high)
};

/// theta of the claim: its estimate, and the interval that the verdict rests on. A fail, and a pass
/// that excludes nothing, have the confidence 1 - the share of alpha. It is 1 - 2 x the share of
/// beta where a region is excluded, or should have been.
struct Effect {
  std::string quantity;  ///< "relative difference of means", "ln variance ratio", …
  Number estimate, low, high;
  double confidence = 0;
  bool relative = false;  ///< in units of the reference: shown in per cent
  ASSAY_FIELDS(Effect, quantity, estimate, low, high, confidence, relative)
};

/// A sum over part of an image, or over all of it, that speaks against equality.
struct ImageFinding {
  /// "window", "alternating" (signs); of laws what differs: "the mean is larger in a".
  std::string statistic;
  std::string place;                                  ///< where, in words
  std::uint64_t x = 0, y = 0, width = 0, height = 0;  ///< the rectangle of pixels
  std::string component;
  Number z;  ///< positive where the first image is brighter
  Number log10_p;
  Number log10_p_adjusted;       ///< In the family of everything that was looked at in the image.
  std::optional<Effect> effect;  ///< Difference of the means over the rectangle, of the winner.
  std::string others;  ///< Other components there, of the winner: "G by -5.1 %, B by -4.9 %".
  ASSAY_FIELDS(ImageFinding, statistic, place, x, y, width, height, component, z, log10_p,
               log10_p_adjusted, effect, others)
};

/// A claim on all elements of an image together.
struct Image {
  std::uint64_t width = 0, height = 0;
  std::vector<std::string> components;
  std::uint64_t replicates = 0;
  std::uint64_t tested = 0;          ///< Elements that vary.
  std::uint64_t constant = 0;        ///< Elements that do not vary and equal the reference.
  std::uint64_t unseen = 0;          ///< Elements that do not vary and differ from it.
  ImageFinding winner;               ///< The least adjusted p.
  std::vector<ImageFinding> groups;  ///< The best of each group of sums.
  ASSAY_FIELDS(Image, width, height, components, replicates, tested, constant, unseen, winner,
               groups)
};

/// Numbers of an image; in JSON base64 of little-endian 32-bit floats.
struct Texels {
  std::vector<float> values;
  bool operator==(const Texels&) const = default;
};

/// One number an element: column x, row y and component c are at (y * width + x) * components + c.
/// A map of a sampler's domain has a number a cell: `cells_observed`, `cells_expected`, `cells_z`.
/// One sample has z = (observed - expected) / sqrt(expected). Two samples are expected to follow
/// both together.
struct Map {
  std::string name;    ///< `z`, `mean`, `variance`, `reference`, `other_mean`, …
  std::string source;  ///< The estimator of a mean or variance.
  std::string file;    ///< The EXR beside the JSON, if written; `name` is its layer.
  std::uint64_t width = 0, height = 0;
  std::vector<std::string> components;
  Texels texels;
  ASSAY_FIELDS(Map, name, source, file, width, height, components, texels)
};

/// The evidence of one night, and of all nights up to it.
struct LedgerNight {
  std::string date;  ///< UTC, ISO 8601
  std::string commit;
  Number estimate, low, high;  ///< Theta by this night, with its own 95 % interval.
  Number mean;                 ///< Theta by all nights up to it, pooled by their observations.
  Number log_p;                ///< Logarithm of the p-value of a night without an estimate.
  Number log_e;                ///< Logarithm of the e-value of all nights up to it.
  ASSAY_FIELDS(LedgerNight, date, commit, estimate, low, high, mean, log_p, log_e)
};

/// One channel of one claim in the ledger: what all nights with fresh seeds say together.
struct LedgerSeries {
  std::string test;  ///< id
  std::string channel;
  std::string series;    ///< hash of claim, margins and parameters: another one is another series
  std::string quantity;  ///< theta, as in Effect; empty where nights have p-values
  bool relative = false;
  std::vector<LedgerNight> nights;   ///< In their order.
  Number estimate, standard_error;   ///< Of theta, by all nights.
  Number reference_error;            ///< The standard error of theta that all nights share.
  Number limit;                      ///< The ln E that is an alarm.
  bool alarm = false;                ///< ln E reached the limit after some night.
  std::string since;                 ///< The first such night.
  std::string moved;                 ///< The night at which theta most likely moved, of an alarm.
  std::string moved_commit;          ///< The commit of that night.
  std::string moved_from, moved_to;  ///< First and last of the nights that hold 90 % of it.
  bool added = false;                ///< This run is one of the nights.
  std::string note;                  ///< Why it is not, or that a new series began.

  /// ln of the e-value of all nights.
  Number log_e() const { return nights.empty() ? Number() : nights.back().log_e; }
  ASSAY_FIELDS(LedgerSeries, test, channel, series, quantity, relative, nights, estimate,
               standard_error, reference_error, limit, alarm, since, moved, moved_commit,
               moved_from, moved_to, added, note)
};

/// The ledger that a run added to, of the tests it ran. An empty file name: none was kept.
struct Ledger {
  std::string file;
  Number budget;  ///< of each suite, over all nights
  std::vector<LedgerSeries> series;
  ASSAY_FIELDS(Ledger, file, budget, series)
};

inline constexpr int schema_version = 6;

/// The verdict of a test. `skipped` was not run (another shard's).
enum class Verdict { pass, fail, inconclusive, invalid, error, skipped };
inline constexpr const char* verdict_names[] = {"pass",    "fail",  "inconclusive",
                                                "invalid", "error", "skipped"};
constexpr const char* to_string(Verdict verdict) {
  return verdict_names[static_cast<int>(verdict)];
}

struct Tool {
  std::string name = "assay";
  std::string version;
  std::string commit;
  ASSAY_FIELDS(Tool, name, version, commit)
};

struct Environment {
  std::string compiler;
  std::string cpu;
  std::string isa;  ///< instruction set that rays were traced with; their bits depend on it
  int threads = 0;
  ASSAY_FIELDS(Environment, compiler, cpu, isa, threads)
};

struct Cost {
  std::uint64_t camera_rays = 0;
  std::uint64_t closest_hit_rays = 0;
  std::uint64_t shadow_rays = 0;
  std::uint64_t samples = 0;
  double seconds = 0;  ///< CPU seconds of drawing
  ASSAY_FIELDS(Cost, camera_rays, closest_hit_rays, shadow_rays, samples, seconds)
};

/// Counts of observations in equal bins over [low, high); the rest below and above.
struct Histogram {
  double low = 0;
  double high = 0;
  std::vector<std::uint64_t> counts;
  std::uint64_t below = 0;
  std::uint64_t above = 0;
  ASSAY_FIELDS(Histogram, low, high, counts, below, above)
};

/// Points of a normal quantile plot: theoretical standard normal quantile, observed value.
struct QuantilePoint {
  double normal;
  double observed;
  ASSAY_FIELDS(QuantilePoint, normal, observed)
};

/// The joint variation of the cost c and the value x of an observation. Sums over the observations:
/// m2 of `(c - mean c)^2`, m11 of `(x - mean x)(c - mean c)`, m21 of `(x - mean x)^2 (c - mean c)`.
struct CostMoments {
  std::string kind;  ///< rays, samples
  double mean = 0, m2 = 0, m11 = 0, m21 = 0;
  ASSAY_FIELDS(CostMoments, kind, mean, m2, m11, m21)
};

/// Observations of one channel of one estimator, as one test saw them.
struct Sample {
  std::string estimator;  ///< its name in the suite
  std::string plugin;
  std::string parameters;  ///< canonical text
  std::string channel;
  /// 16 hexadecimal digits. Samples of one plugin, parameters, stream and number of primaries are
  /// the same draws, or the longer of them begins with the shorter.
  std::string stream;
  std::uint64_t primaries = 0;
  std::uint64_t secondaries = 0;
  Number mean, variance, skewness, kurtosis, min, max;  ///< of secondary estimates
  std::uint64_t nonzero = 0;
  std::uint64_t nonfinite = 0;
  Histogram histogram;
  std::vector<QuantilePoint> quantiles;
  Cost cost;
  std::vector<CostMoments> with_cost;  ///< where a claim on a cost or an efficiency kept them
  ASSAY_FIELDS(Sample, estimator, plugin, parameters, channel, stream, primaries, secondaries, mean,
               variance, skewness, kurtosis, min, max, nonzero, nonfinite, histogram, quantiles,
               cost, with_cost)
};

/// An assumption checked. state: green, amber, red.
struct Gate {
  std::string name;
  Number value;
  Number limit;
  std::string state;
  ASSAY_FIELDS(Gate, name, value, limit, state)
};

struct Distribution {
  std::string family;  ///< of the statistic under the null hypothesis
  std::vector<double> parameters;
  ASSAY_FIELDS(Distribution, family, parameters)
};

/// An empirical distribution function at one of its values, what the law it is drawn from may be
/// there, and what the claimed law is.
struct LawPoint {
  double value = 0;
  double observed = 0;  ///< part of the values up to here
  double low = 0;       ///< of the band
  double high = 0;
  Number law;  ///< null where two samples are compared
  ASSAY_FIELDS(LawPoint, value, observed, low, high, law)
};

/// The empirical law of one sample: with probability `confidence` all of its band's points hold the
/// law that the sample was drawn from.
struct EmpiricalLaw {
  std::string source;  ///< the estimator's name
  double confidence = 0;
  std::vector<LawPoint> points;
  ASSAY_FIELDS(EmpiricalLaw, source, confidence, points)
};

/// The numbers of one channel of a claim.
struct Channel {
  std::string name;
  Number statistic;
  Distribution distribution;
  Number p_value;  ///< of the null hypothesis; may underflow to the least double, see log10_p
  Number log10_p;
  Number p_adjusted;  ///< After Holm; null outside the family (mutants, filtered runs).
  Number p_pass;      ///< Of "theta lies in the forbidden region".
  Number log10_p_adjusted, log10_p_pass;  ///< The same, without underflow.
  Effect effect;
  Number reference;  ///< what the mean is marked against in the histogram, if a number
  std::vector<EmpiricalLaw> laws;  ///< of a claim about laws of one coordinate: one or two
  ASSAY_FIELDS(Channel, name, statistic, distribution, p_value, log10_p, p_adjusted, p_pass,
               log10_p_adjusted, log10_p_pass, effect, reference, laws)
};

/// One look: what the first so many observations say by themselves. It rejects the claim or the
/// contrary at these levels. The test's own p-value is the least alpha of the test at which one of
/// its looks would reject.
struct Look {
  std::uint64_t secondaries = 0;
  double alpha = 0;  ///< level of the claim's test at this look
  double beta = 0;
  Number log10_p;
  Number p_pass;
  Number log10_p_pass;
  std::optional<Effect> effect;  ///< that of the worst channel; absent if the look is void
  ASSAY_FIELDS(Look, secondaries, alpha, beta, log10_p, p_pass, log10_p_pass, effect)
};

/// A reader of a test can do this next: write a setting, or else follow the words.
struct Advice {
  std::string words;       ///< "give about 44000 rows in all"
  std::string key, value;  ///< "secondaries", "12000"
  ASSAY_FIELDS(Advice, words, key, value)
};

struct Test {
  std::string name;
  std::string id;  ///< suite file's stem, slash, name
  std::string claim;
  std::string file;
  int line = 0;
  std::vector<std::string> tags;
  std::string over, reference, cost;  ///< these keys of the test, as replay needs them; "" if unset
  bool paired = false;                ///< the same
  Verdict verdict = Verdict::skipped;
  Verdict expected = Verdict::pass;
  bool ok = false;
  std::string method;   ///< design: method names
  bool forced = false;  ///< by name: red gates on the data are shown and do not invalidate
  std::string null_hypothesis;
  std::string tail;  ///< "two-sided", "upper", "lower"
  Number alpha;      ///< this test's share of the suite's alpha
  Number beta;
  Number detect, allow;  ///< as margins on theta (same unit as effect)
  Number detectable;     ///< least effect found with probability 1 - beta at this n
  Number power;          ///< at `detect` (planned)
  std::vector<std::uint64_t> planned_looks;  ///< sizes
  std::vector<Look> looks;                   ///< those taken
  std::vector<Gate> gates;
  std::vector<Sample> samples;
  std::vector<Channel> channels;  ///< the worst first; never empty once tested
  std::optional<Image> image;
  std::vector<Map> maps;  ///< of an image
  std::string message;    ///< what a reader needs to know: what was excluded, or what would decide
  std::optional<Advice> advice;
  std::string replay;     ///< command that repeats the numbers
  std::string no_replay;  ///< why there is none
  ASSAY_FIELDS(Test, name, id, claim, file, line, tags, over, reference, cost, paired, verdict,
               expected, ok, method, forced, null_hypothesis, tail, alpha, beta, detect, allow,
               detectable, power, planned_looks, looks, gates, samples, channels, image, maps,
               message, advice, replay, no_replay)
};

/// One channel of an estimator.
struct EstimatorChannel {
  std::string name;
  Estimate mean;
  Estimate variance;  ///< of one primary estimate where it averages, else of the secondary
  Number reference;   ///< analytic mean
  Number reference_variance;
  ASSAY_FIELDS(EstimatorChannel, name, mean, variance, reference, reference_variance)
};

/// An estimator of a suite as the test saw it that drew most of it; nothing if none drew it.
struct EstimatorSummary {
  std::string name;
  std::string plugin;
  std::string parameters;
  std::string bias;      ///< bias class
  std::string original;  ///< of a mutant
  std::string defect;    ///< of a mutant
  std::uint64_t primaries = 0;
  std::uint64_t secondaries = 0;
  double confidence = 0;  ///< of the intervals in channels
  std::string
      variance_of;  ///< what `variance` in channels is of: "primary", "secondary", or not said
  std::vector<EstimatorChannel> channels;
  Cost cost;
  ASSAY_FIELDS(EstimatorSummary, name, plugin, parameters, bias, original, defect, primaries,
               secondaries, confidence, variance_of, channels, cost)
};

/// A sentence from elsewhere, and the names of the tests that answer it. The answer is not part of
/// the record; it follows from the verdicts (words/statements.h).
struct Statement {
  std::string text;
  std::string source;              ///< Who says it, and where.
  std::string condition;           ///< Completes "only if"; empty unless both lists have tests.
  std::vector<std::string> holds;  ///< Tests whose expected verdicts show it true.
  std::vector<std::string> fails;  ///< Tests whose expected verdicts show it false.
  int line = 0;                    ///< in the suite's file
  ASSAY_FIELDS(Statement, text, source, condition, holds, fails, line)
};

/// A program of an estimator that failed and was started again.
struct Retry {
  std::string estimator;
  std::uint64_t seed = 0;   ///< of the observation
  std::uint64_t retry = 1;  ///< from 1
  std::string reason;
  ASSAY_FIELDS(Retry, estimator, seed, retry, reason)
};

struct Suite {
  std::string name;
  std::string file;
  std::string about;
  std::uint64_t seed = 0;  ///< of this suite's streams
  double alpha = 0;
  double beta = 0;
  bool timed = false;  ///< a budget in seconds ended sampling: another run may end elsewhere
  std::vector<Retry> retries;
  std::vector<EstimatorSummary> estimators;
  std::vector<Test> tests;
  std::vector<Statement> statements;
  ASSAY_FIELDS(Suite, name, file, about, seed, alpha, beta, timed, retries, estimators, tests,
               statements)
};

/// The part that Holm's method over the whole suite needs of the test at the same place in
/// `Suite::tests`.
struct FamilyResult {
  std::uint64_t position = 0;  ///< Place in the suite's file.
  bool inside = false;         ///< In the family; mutants and expected failures are not.
  double weight = 0;           ///< One channel's; the family's weights sum to 1.
  std::uint64_t untested = 0;  ///< Channels without a p-value.
  std::vector<double> log_p;   ///< Natural logarithms, one a channel of the test.
  ASSAY_FIELDS(FamilyResult, position, inside, weight, untested, log_p)
};

/// A selected test of another shard.
struct ShardElsewhere {
  std::uint64_t shard = 1;     ///< from 1
  std::uint64_t position = 0;  ///< Place in the suite's file.
  std::string id;
  std::string name;
  std::string claim;
  int line = 0;
  ASSAY_FIELDS(ShardElsewhere, shard, position, id, name, claim, line)
};

struct ShardSuite {
  std::string digest;       ///< of the suite's file and the data files it names
  std::uint64_t tests = 0;  ///< in the suite's file
  std::vector<FamilyResult> results;
  std::vector<ShardElsewhere> elsewhere;
  ASSAY_FIELDS(ShardSuite, digest, tests, results, elsewhere)
};

/// A run that is one part of several, with all that joining the parts takes.
struct Shard {
  std::uint64_t index = 1;  ///< from 1
  std::uint64_t count = 1;
  std::string options;             ///< the command without seed, shard and reports
  std::vector<ShardSuite> suites;  ///< in the record's order
  ASSAY_FIELDS(Shard, index, count, options, suites)
};

struct Record {
  int schema = schema_version;
  Tool tool;
  Environment environment;
  std::uint64_t seed = 0;
  std::string started;  ///< UTC, ISO 8601
  double seconds = 0;
  std::string note;  ///< "filtered: verdicts rest on fixed shares" and the like
  std::vector<Suite> suites;
  Ledger ledger;
  std::optional<Shard> shard;  ///< none: a whole run, or shards merged
  ASSAY_FIELDS(Record, schema, tool, environment, seed, started, seconds, note, suites, ledger,
               shard)
};

/// Series with an alarm.
int alarms(const Ledger&);

/// True unless an assumption of the test's numbers is violated.
bool is_evidence(const Test&);

/// The groups that a reader sorts claims by; those that most need a look come first. A claim
/// without a verdict was to have one, but its data break an assumption, or drawing them failed. A
/// planted bug is caught where the test is ok and its expected verdict is not pass.
enum class Standing { broken, no_verdict, undecided, holds, caught, not_run };
Standing standing(const Test&);
inline bool is_failed(Standing how) { return how <= Standing::no_verdict; }
inline bool is_trouble(Standing how) { return how <= Standing::undecided; }

/// The tests of all suites.
std::vector<const Test*> tests_of(const Record&);

/// The cost of a test. The same draws count once, though each of their channels has a sample.
Cost total_cost(const Test&);

/// The cost of the suite's tests and of its estimators' rows, without pilots. The same draws count
/// once.
Cost total_cost(const Suite&);

}  // namespace assay::reports
