// Estimators against the means, variances and ranges that they declare (tests/tables/families.txt),
// and mutants against the bias of their defect (mutants.txt).

#include "tests/estimators/prelude.h"
#include "tests/estimators/scenes.h"

namespace assay {
namespace {

using direct_light_scenes::parameters;

const std::string glossy = parameters("small", "glossy");

/// A row of the table.
struct Family {
  std::string plugin;
  std::vector<std::string> parameters;
  Extent extent;
  bool has_variance = true;
};
void PrintTo(const Family& family, std::ostream* out) { *out << family.plugin; }

/// The text with each of the alternatives of its first (a|b), and so on.
std::vector<std::string> alternatives(const std::string& text) {
  for (std::size_t begin = text.find('('); begin != text.npos; begin = text.find('(', begin + 1)) {
    std::vector<std::string> options(1);
    int depth = 1;
    std::size_t end = begin + 1;
    for (; depth > 0; ++end) {
      depth += (text[end] == '(') - (text[end] == ')');
      if (depth == 1 && text[end] == '|') {
        options.emplace_back();
      } else if (depth > 0) {
        options.back() += text[end];
      }
    }
    if (options.size() == 1) continue;
    std::vector<std::string> all;
    for (const std::string& option : options) {
      const auto rest = alternatives(text.substr(0, begin) + option + text.substr(end));
      all.insert(all.end(), rest.begin(), rest.end());
    }
    return all;
  }
  return {text};
}

/// The rows of a table; what stands before the colon of a heading; and extents.
struct Row {
  std::string of;
  std::string text;
  Extent extent;
  bool has_variance;
};

std::vector<Row> rows_of(const char* table) {
  static const std::regex form(R"((.*): (\d+)(?: x (\d+))?(, false alarms 1e-4)?(, means)?)");
  std::vector<Row> all;
  for (const auto& [heading, text] :
       parameter_rows(table, {{"$horizon", horizon_scene},
                              {"$hidden_beyond(0.5)", hidden_beyond(.5)},
                              {"$hidden_beyond(0.05)", hidden_beyond(.05)},
                              {"$hidden_beyond(-0.5)", hidden_beyond(-.5)},
                              {"$glossy", glossy.substr(1, glossy.size() - 2)}})) {
    std::smatch words;
    if (!std::regex_match(heading, words, form)) throw std::runtime_error(heading);
    const Extent extent{.count = std::stoull(words[2]),
                        .primaries = words[3].matched ? std::stoull(words[3]) : 1,
                        .limit = words[4].matched ? four : five};
    all.push_back({words[1], text, extent, !words[5].matched});
  }
  return all;
}

std::vector<Family> families() {
  std::vector<Family> all;
  for (const Row& row : rows_of("families.txt")) {
    for (const std::string& plugin : alternatives(row.of)) {
      all.push_back({plugin, alternatives(row.text), row.extent, row.has_variance});
    }
  }
  return all;
}

class Families : public testing::TestWithParam<Family> {};

TEST_P(Families, AreWhatTheyDeclare) {
  const Family& family = GetParam();
  for (const std::string& parameters : family.parameters) {
    SCOPED_TRACE(parameters);
    const Prepared plugin = prepare(family.plugin, parameters);
    EXPECT_EQ(plugin.channel().variance.has_value(), family.has_variance);
    expect_declared(plugin, family.extent);
  }
}

INSTANTIATE_TEST_SUITE_P(Table, Families, testing::ValuesIn(families()));

/// A mutant's mean is that which it declares, times 1 + `bias`. False alarms: 1e-6 each.
struct Biased {
  std::string mutant;
  std::string parameters;
  double bias;
  double precision = 0;  ///< of what is known of it
  Extent extent{.count = 200000};
};
void PrintTo(const Biased& biased, std::ostream* out) { *out << biased.mutant; }

class Mutants : public testing::TestWithParam<Biased> {};

TEST_P(Mutants, HaveTheBiasOfTheirDefect) {
  const Biased& of = GetParam();
  const Prepared mutant = prepare("mutants/" + of.mutant, of.parameters);
  const double declared = mutant.channel().mean.value();
  const Sample sample = observe(mutant, of.extent.count, of.extent.primaries)[0];
  EXPECT_NEAR(sample.mean() / declared - 1, of.bias,
              of.precision + of.extent.limit * sample.mean_error() / declared);
}

std::vector<Biased> mutants() {
  static const std::regex form(R"((\w+) (.*) => (\S+)(?: / (\S+))?(?: within (\S+))?)");
  std::vector<Biased> all;
  for (const Row& row : rows_of("mutants.txt")) {
    if (row.text.ends_with('}')) continue;
    std::smatch words;
    if (!std::regex_match(row.text, words, form)) throw std::runtime_error(row.text);
    const double bias = std::stod(words[3]);
    all.push_back({words[1], words[2], words[4].matched ? bias / std::stod(words[4]) - 1 : bias,
                   words[5].matched ? std::stod(words[5]) : 0, row.extent});
  }
  for (const auto& row : table("lens_mutants.csv")) {
    const std::string parameters = std::regex_replace(row[1], std::regex(";"), ",");
    all.push_back(
        {row[0], parameters, std::stod(row[2]) / std::stod(row[3]) - 1, 1e-10, {.count = 60000}});
  }
  // Quadrature from elsewhere, good to 1e-6.
  for (const auto& row : table("direct_light_mutants.csv")) {
    const std::string& name = row[0];
    const bool without = name == "brdf_weight_without_counts" || name == "weights_without_counts";
    const char* more = without                        ? "brdf_samples: 3"
                       : name == "misses_not_counted" ? "brdf_samples: 4"
                                                      : "";
    all.push_back({name, parameters("small", "glossy", more), std::stod(row[1]), 2e-6});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Table, Mutants, testing::ValuesIn(mutants()));

/// Looks at each mutant below a heading, and at its original.
void for_each_mutant(const std::string& heading,
                     const std::function<void(const Prepared&, const Prepared&, Extent)>& look) {
  int count = 0;
  for (const Row& row : rows_of("mutants.txt")) {
    if (row.of != heading) continue;
    SCOPED_TRACE(row.text);
    const std::size_t blank = row.text.find(' ');
    const std::string parameters = row.text.substr(blank + 1);
    const Prepared mutant = prepare("mutants/" + row.text.substr(0, blank), parameters);
    look(mutant, prepare(mutant.information.original, parameters), row.extent);
    ++count;
  }
  EXPECT_GT(count, 5);
}

TEST(Mutants, ThatAreNotActivatedGiveTheOriginalsNumbers) {
  for_each_mutant("never activated", [](const Prepared& mutant, const Prepared& original,
                                        Extent extent) {
    ASSERT_EQ(mutant.key, original.key);
    EXPECT_EQ(observe(mutant, extent.count)[0].values, observe(original, extent.count)[0].values);
  });
}

TEST(Mutants, WithoutAClosedFormMissEveryChannel) {
  for_each_mutant(
      "off in every channel", [](const Prepared& mutant, const Prepared&, Extent extent) {
        const auto samples = observe(mutant, extent.count, extent.primaries);
        for (std::size_t c = 0; c < samples.size(); ++c) {
          const Channel channel = mutant.channel(c);
          if (channel.diagnostic) continue;
          EXPECT_THAT(samples[c], Not(HasMean(*channel.mean))) << channel.name;
          EXPECT_THAT(samples[c].mean(), Not(DoubleNear(*channel.mean, 0.1 * *channel.mean)));
        }
      });
}

}  // namespace
}  // namespace assay
