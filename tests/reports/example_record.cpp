#include "tests/reports/example_record.h"

#include <cmath>

#include "tests/reports/example_tests.h"

namespace assay::reports {
namespace {

struct Entry {
  const char* name;
  double mean;
  double variance;
  const char* original = "";
  const char* defect = "";
};

EstimatorChannel estimator_channel(const std::string& name, double mean, double variance) {
  EstimatorChannel c;
  c.name = name;
  const double half = 2.6 * std::sqrt(variance / (64.0 * 16384));
  c.mean = {mean, mean - half, mean + half};
  c.variance = {variance, 0.94 * variance, 1.07 * variance};
  c.reference = 0.481046907316;
  return c;
}

EstimatorSummary summary(const Entry& entry) {
  EstimatorSummary e;
  e.name = entry.name;
  e.plugin = std::string(*entry.original ? "mutants/" : "luminaire/") + entry.name;
  e.parameters = R"(sampler=":published",scene="triangle")";
  e.variance_of = "primary";
  e.bias = "unbiased";
  e.original = entry.original;
  e.defect = entry.defect;
  e.stream = "5d3c1f0a9b7e2468";
  e.primaries = 64;
  e.secondaries = 16384;
  e.confidence = 0.99;
  e.channels = {estimator_channel("value", entry.mean, entry.variance)};
  e.cost = {.camera_rays = 12,
            .closest_hit_rays = 1048576,
            .shadow_rays = 1048576,
            .samples = 1048576,
            .seconds = 0.75};
  return e;
}

Comparison compare(const EstimatorSummary& a, const EstimatorSummary& b, std::size_t channel) {
  const EstimatorChannel& x = a.channels[channel];
  const EstimatorChannel& y = b.channels[channel];
  Comparison c;
  c.first = a.name;
  c.second = b.name;
  c.channel = x.name;
  if (!x.mean.value || !y.mean.value) return c;
  c.means_differ = *x.mean.high < *y.mean.low || *y.mean.high < *x.mean.low;
  c.variances_differ = *x.variance.high < *y.variance.low || *y.variance.high < *x.variance.low;
  c.mean_p = c.means_differ ? 3.2e-12 : 0.37;
  c.variance_p = c.variances_differ ? 5e-324 : 0.21;
  c.log10_mean_p = std::log10(*c.mean_p);
  c.log10_variance_p = c.variances_differ ? -403.2 : std::log10(*c.variance_p);
  if (*y.variance.value > 0) c.variance_ratio = *x.variance.value / *y.variance.value;
  return c;
}

void compare_all(Suite& suite) {
  for (std::size_t i = 0; i < suite.estimators.size(); ++i) {
    for (std::size_t j = i + 1; j < suite.estimators.size(); ++j) {
      for (std::size_t k = 0; k < suite.estimators[i].channels.size(); ++k)
        suite.comparisons.push_back(compare(suite.estimators[i], suite.estimators[j], k));
    }
  }
}

// One of each answer, in another order than that of their urgency.
std::vector<Statement> statements_of_each_answer(const Suite& s) {
  const auto name = [&](std::size_t t) { return s.tests[t].name; };
  const std::string source = "A talk, slide 7";
  return {{.text = "Areas are sampled without bias, and with less variance than hemispheres.",
           .source = source,
           .condition = "",
           .holds = {name(0), name(1)},
           .fails = {},
           .line = 50},
          {.text = "The receiver's cosine does not matter.",
           .source = source,
           .condition = "",
           .holds = {},
           .fails = {name(3)},
           .line = 53},
          {.text = "Every estimator has the same mean.",
           .source = source,
           .condition = "the cosine is not forgotten",
           .holds = {name(0)},
           .fails = {name(3)},
           .line = 56},
          {.text = "Nothing is known of these.",
           .source = source,
           .condition = "",
           .holds = {name(0), name(5), name(6), name(7), name(8), "a test that was filtered out"},
           .fails = {},
           .line = 60},
          {.text = "Winners have no bias.",
           .source = source,
           .condition = "",
           .holds = {name(0), name(2)},
           .fails = {},
           .line = 63}};
}

Suite triangle() {
  Suite s;
  s.name = "triangle luminaire";
  s.file = "suites/triangle.yaml";
  s.about = "Irradiance from a triangle, four ways to sample it (Subr & Arvo 2007).";
  s.retries = {{.estimator = "a<b>&\"c\"",
                .seed = 2147483647,
                .retry = 2,
                .reason = "`render \"<x>\"` ended with exit status 3"}};
  s.seed = 18446744073709551615u;
  s.alpha = 0.01;
  s.beta = 0.01;
  s.estimators = {
      summary({"hemisphere", 0.4809, 0.246}),
      summary({"area", 0.4812, 0.0615}),
      summary({"solid_angle", 0.48104, 0.0121}),
      summary({"winners", 0.4711, 0.0282}),
      summary({"heavy", 0.46, 10.24}),
      summary({"no_cosine", 0.68, 0.16, "luminaire/area", "the receiver's cosine is missing"}),
      summary({"rare_nan", 0.48, 0.1})};
  s.estimators.back().channels[0].mean = s.estimators.back().channels[0].variance = {};
  s.estimators.back().primaries = 1;
  s.estimators.back().cost = {
      .camera_rays = 0, .closest_hit_rays = 0, .shadow_rays = 0, .samples = 16384, .seconds = 0.01};
  s.estimators[3].variance_of = "secondary";
  s.estimators[2].channels[0].reference_variance = 0.0119;
  compare_all(s);
  s.tests = {passing(),   proof(),   failing(), caught_mutant(), surviving_mutant(),
             undecided(), invalid(), broken(),  not_run(),       unseen_mutant()};
  s.statements = statements_of_each_answer(s);
  return s;
}

// Text as a careless author or a broken child process would send it.
Suite hostile() {
  Suite s;
  s.name = "colours <b>&amp; \"names\"</b> | *stars* _bars_ `ticks`";
  s.file = "suites/farben & größen.yaml";
  s.about =
      "Text with \x1b[31mescapes\x1b[0m, a bell \x07, half a character \xC3, "
      "a wide 光線追跡 and a right-to-left override \xE2\x80\xAE.\nA second line.";
  s.seed = 18446744073709551615u;
  s.alpha = 0.005;
  s.beta = 0.02;
  s.timed = true;
  for (const Entry& entry :
       {Entry{
            "an estimator with a name so long that no column of any table or chart has room for it",
            0.4809, 0.05},
        Entry{"光線追跡法による推定量", 0.4822, 0.04}, Entry{"a<b>&\"c\"", 0.4809, 0.0}}) {
    EstimatorSummary e = summary(entry);
    e.channels = {estimator_channel("R", entry.mean, entry.variance),
                  estimator_channel("G", -entry.mean / 3, entry.variance / 2),
                  estimator_channel("B", entry.mean / 9, entry.variance / 4)};
    s.estimators.push_back(e);
  }
  compare_all(s);
  Test t = base("mean(\"a<b>&\") == analytic | `x` *y* _z_ " + std::string(160, 'w'), 7);
  t.verdict = Verdict::fail;
  t.message = "]]> </failure> <script>alert(1)</script>\nsecond line\r\nthird \x01 line";
  t.channels = {channel("R", mean_effect(0.013, 0.002)), channel("G", mean_effect(-0.004, 0.0025)),
                channel("B", mean_effect(0.0001, 0.003))};
  t.samples = {sample("a<b>&\"c\"", {0.4809, 0.02, 0.0})};
  t.samples[0].channel = "R";
  Test copy = t;
  copy.name += " again";
  copy.verdict = Verdict::pass;
  copy.ok = true;
  copy.replay = "assay check 'mean(area) == \"x  y\"' --estimator " + std::string(120, 'k') + "=1";
  Test constant = base("mean(\"a<b>&\") == 0.5", 9);
  constant.id = "farben/constant";
  constant.verdict = Verdict::inconclusive;
  constant.samples = {sample("a<b>&\"c\"", {0.5, 0.0, 0.0})};
  constant.samples[0].channel = "R";
  constant.channels = {channel("R", mean_effect(0, 0))};
  constant.message = "every observation is 0.5; what was not seen could still add more than detect";
  s.tests = {t, copy, constant};
  s.statements = {{.text = "Text | with *marks*, <b>tags</b> and a \x1b[31mescape.",
                   .source = "\"a<b>&\" | `x`\nof two lines",
                   .condition = "]]> " + std::string(130, 'c'),
                   .holds = {copy.name},
                   .fails = {copy.name},
                   .line = 12}};
  return s;
}

// One series with an alarm, one of e-values without a night of this run, one of a second channel.
Ledger nights() {
  Ledger ledger{.file = "nightly.ledger", .budget = 0.003, .series = {}};
  ledger.series.push_back({.test = "triangle/mean(area) == analytic",
                           .channel = "irradiance",
                           .series = "17ab1f5b7c630505",
                           .quantity = "relative difference from the reference",
                           .relative = true,
                           .nights = {},
                           .estimate = 0.001,
                           .standard_error = 0.00025298,
                           .reference_error = 0.0001,
                           .limit = 6.5,
                           .alarm = true,
                           .since = "2026-11-18T02:00:00Z",
                           .moved = "2026-11-13T02:00:00Z",
                           .moved_commit = "14467a0bbe61",
                           .moved_from = "2026-11-11T02:00:00Z",
                           .moved_to = "2026-11-15T02:00:00Z",
                           .added = true,
                           .note = ""});
  for (int i = 9; i <= 20; ++i) {
    ledger.series[0].nights.push_back(
        {.date = (i < 10 ? "2026-11-0" : "2026-11-") + std::to_string(i) + "T02:00:00Z",
         .commit = "14467a0bbe61",
         .estimate = 0.001,
         .low = -0.0007,
         .high = 0.0027,
         .log_e = i == 20 ? 9.5 : i / 2.0 - 1});
  }
  ledger.series.push_back(ledger.series[0]);
  ledger.series[1].channel = "<b>|shadow|";
  ledger.series[1].alarm = false;
  ledger.series[1].nights.back().log_e = -1.5;
  ledger.series[1].nights[0].log_p = -2;
  ledger.series[1].since = ledger.series[1].moved = ledger.series[1].moved_commit = "";
  ledger.series[1].moved_from = ledger.series[1].moved_to = "";
  ledger.series.push_back({.test = "triangle/a law",
                           .channel = "theta",
                           .series = "a0",
                           .quantity = "",
                           .note = "nothing added: its verdict is invalid"});
  return ledger;
}

Shard shard_of(const Record& record) {
  Shard shard{.index = 2, .count = 4, .options = "assay run 'suites/光線.yaml'", .suites = {}};
  for (const Suite& suite : record.suites) {
    shard.suites.push_back(
        {.digest = "17ab1f5b7c630505", .tests = 12, .pictures = {}, .results = {}});
    shard.suites.back().pictures.push_back(
        {.position = 3,
         .by_tests = true,
         .secondaries = 16384,
         .drawn = true,
         .averaged = 64,
         .image = shard.suites.size() == 2,
         .channels = {{.name = "value",
                       .reference = 0.25,
                       .moments = {16384, 0.2501, 3.5, -0.1, 2e-3, -0.5, 1.5, 16000, 1e-18}},
                      {.name = "never finite", .reference = {}, .moments = {}}}});
    shard.suites.back().results.push_back({.position = 7,
                                           .inside = true,
                                           .weight = 0.125,
                                           .untested = 1,
                                           .log_p = {-3.5, -0.25},
                                           .compared = {suite.name, "b"}});
    shard.suites.back().elsewhere.push_back({.shard = 4,
                                             .position = 11,
                                             .id = "farben/<光線>",
                                             .name = "<光線>",
                                             .claim = "mean(a) == 1",
                                             .line = 17});
  }
  return shard;
}

}  // namespace

Record example_record() {
  Record r;
  r.tool = {"assay", "0.1.0", "0123abc"};
  r.environment = {"g++ 12.2.0", "Example CPU @ 3 GHz", "avx2", 2};
  r.seed = 18446744073709551615u;
  r.started = "2026-01-31T12:34:56Z";
  r.seconds = 83.25;
  r.note = "filtered: verdicts rest on fixed shares";
  r.suites = {triangle(), hostile()};
  r.ledger = nights();
  r.suites.push_back({});
  r.suites.back().name = "an empty suite";
  r.shard = shard_of(r);
  return r;
}

}  // namespace assay::reports
