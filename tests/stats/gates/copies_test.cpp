#include "stats/gates/copies.h"

#include "tests/stats/prelude.h"

namespace assay::stats {
namespace {

std::vector<double> uniform_values(std::size_t n, std::uint32_t stream) {
  Philox random(stream);
  return sample_of(n, [&] { return random.uniform(); });
}

std::vector<double> joined(std::vector<double> values, const std::vector<double>& more) {
  values.insert(values.end(), more.begin(), more.end());
  return values;
}

void expect_run(const std::optional<RepeatedRun>& run, std::size_t first, std::size_t second,
                std::size_t length) {
  ASSERT_TRUE(run);
  EXPECT_EQ(run->first, first);
  EXPECT_EQ(run->second, second);
  EXPECT_EQ(run->length, length);
}

TEST(RepeatedRun, FindsBlocksThatOccurAgainWholly) {
  const std::vector<double> block = uniform_values(100, 1);
  std::vector<double> values = block;
  for (int i = 1; i < 10; ++i) values = joined(values, block);
  expect_run(repeated_run(values), 0, 100, 900);
}

TEST(RepeatedRun, FindsTheSecondOfTwoFarApart) {
  const std::vector<double> block = uniform_values(60, 2);
  const auto values = joined(joined(joined(uniform_values(37, 3), block), uniform_values(500, 4)),
                             joined(block, uniform_values(11, 5)));
  expect_run(repeated_run(values), 37, 597, 60);
}

// 4 values over and over, which 60 draws from four values would not give.
TEST(RepeatedRun, FindsAShortPatternThatGoesOn) {
  std::vector<double> values;
  for (int i = 0; i < 60; ++i) values.push_back(std::sqrt(1 + i % 4));
  const auto run = repeated_run(values);
  ASSERT_TRUE(run);
  expect_run(run, run->first, run->first + 4, 56);
}

TEST(RepeatedRun, NeedsAsManyChangesAsChanceDoesNotMake) {
  // log2(100^2 / 1e-5) = 29.9: 31 values have the 30 changes, 29 have not.
  for (const std::size_t length : {29u, 31u}) {
    const auto block = uniform_values(length, 6);
    const auto one = joined(block, uniform_values(100 - length, 7));
    const auto two = joined(uniform_values(100 - length, 8), block);
    EXPECT_EQ(common_run(one, two).has_value(), length == 31) << length;
  }
}

TEST(RepeatedRun, OfTwoSamplesSaysWhereInEach) {
  const auto block = uniform_values(50, 9);
  const auto one = joined(block, uniform_values(20, 10));
  expect_run(common_run(one, joined(uniform_values(30, 11), block)), 0, 30, 50);
  EXPECT_FALSE(common_run(uniform_values(1000, 12), uniform_values(1000, 13)));
}

// Laws of few values repeat runs soonest. The header's bound is 0.016 for all samples together.
// With three equal values a change matches with probability 1/4 for each before it. Chance is below
// 1e-13, less for the others.
TEST(RepeatedRun, IsNotFoundInIndependentValues) {
  Philox random(14);
  const auto coin = [&] { return std::floor(2 * random.uniform()); };
  const auto die = [&] { return std::floor(3 * random.uniform()); };
  const auto spike = [&] { return random.uniform() < 0.02 ? std::floor(3 * random.uniform()) : 5; };
  const auto hundredths = [&] { return std::round(100 * random.uniform()) / 100; };
  for (int i = 0; i < 400; ++i) {
    EXPECT_FALSE(repeated_run(sample_of(2000, coin)));
    EXPECT_FALSE(repeated_run(sample_of(2000, die)));
    EXPECT_FALSE(repeated_run(sample_of(2000, spike)));
    EXPECT_FALSE(repeated_run(sample_of(2000, hundredths)));
  }
}

// Runs of the common value have many lengths, between two rare values that have few.
TEST(RepeatedRun, StaysOfDifferentLengthsDiffer) {
  Philox random(16);
  const auto rare = [&] {
    const double u = random.uniform();
    return u < 0.9 ? 0.0 : u < 0.998 ? 1.0 : 2.0;
  };
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(repeated_run(sample_of(20000, rare)));
}

// The stays of two states that change at nearly every step are short and alike.
TEST(RepeatedRun, IsNotFoundInChains) {
  Philox random(15);
  double place = 0;
  const auto walk = [&] { return place += random.uniform() < 0.5 ? -1 : 1; };
  const auto lazy = [&] { return random.uniform() < 0.9 ? place : walk(); };
  const auto two_states = [&](double change) {
    return [&, change] { return place = random.uniform() < change ? 1 - place : place; };
  };
  EXPECT_FALSE(repeated_run(sample_of(20000, walk)));
  EXPECT_FALSE(repeated_run(sample_of(20000, lazy)));
  place = 0;
  EXPECT_FALSE(repeated_run(sample_of(20000, two_states(0.05))));
  EXPECT_FALSE(repeated_run(sample_of(4000, two_states(0.97))));
  EXPECT_FALSE(repeated_run(std::vector<double>(1000, 0.25)));
  EXPECT_FALSE(repeated_run({}));
}

std::vector<double> uniform_values(std::size_t n, Philox& random) {
  return sample_of(n, [&] { return random.uniform(); });
}

std::vector<double> shuffled(std::vector<double> values, Philox& random) {
  for (std::size_t i = values.size(); i > 1; --i) {
    const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
    std::swap(values[i - 1], values[other]);
  }
  return values;
}

std::vector<double> copies(const std::vector<double>& values, int times) {
  std::vector<double> all;
  for (int i = 0; i < times; ++i) all.insert(all.end(), values.begin(), values.end());
  return all;
}

TEST(RecurringValues, FindsShuffledCopies) {
  Philox random(1);
  for (const int times : {2, 4, 10}) {
    const auto values = shuffled(copies(uniform_values(50, random), times), random);
    const auto found = recurring_values(values);
    ASSERT_TRUE(found) << times;
    // A stay of two equal neighbours counts once, which moves a few values to the count below.
    EXPECT_NEAR(static_cast<double>(found->times), times, times / 5.0);
    EXPECT_GT(found->values, 20u);
    EXPECT_LT(found->limit, 20u);
  }
}

TEST(RecurringValues, FindsCopiesOfAPartAndOnesWithRowsLeftOut) {
  Philox random(2);
  std::vector<double> part = uniform_values(500, random);
  const auto twice = copies(uniform_values(200, random), 2);
  part.insert(part.end(), twice.begin(), twice.end());
  ASSERT_TRUE(recurring_values(shuffled(part, random)));
  auto most = shuffled(copies(uniform_values(100, random), 4), random);
  most.resize(360);
  ASSERT_TRUE(recurring_values(most));
}

// With 12 or 13 values twice, and none once or thrice, the ratio is q^k with q = f / (2 + f). Here
// f^2 = 3 (n - 1) / (2 (n - 2)), which gives .385^12 = 1.06e-5 and .3846^13 = 4.0e-6.
TEST(RecurringValues, TakesThirteenPairs) {
  for (const std::size_t pairs : {12u, 13u}) {
    std::vector<double> once;
    for (std::size_t i = 0; i < pairs; ++i) once.push_back(std::sqrt(2.0 + static_cast<double>(i)));
    const auto found = recurring_values(copies(once, 2));
    ASSERT_EQ(found.has_value(), pairs == 13) << pairs;
    if (!found) continue;
    EXPECT_EQ(found->times, 2u);
    EXPECT_EQ(found->values, 13u);
    EXPECT_EQ(found->limit, 12u);
  }
}

struct AtomLaw {
  std::string name;
  std::function<double(Philox&)> draw;
};

std::vector<AtomLaw> laws_of_atoms() {
  std::vector<AtomLaw> found;
  for (const double atoms : {2.0, 3.0, 10.0, 50.0, 256.0, 1e4, 1e6}) {
    found.push_back({"equal " + std::to_string(atoms),
                     [atoms](Philox& random) { return std::floor(atoms * random.uniform()); }});
  }
  for (const double step : {1.0, 0.1, 0.001, 1e-6}) {
    found.push_back({"normal in steps of " + std::to_string(step),
                     [step](Philox& random) { return std::round(random.normal() / step); }});
  }
  found.push_back(
      {"geometric", [](Philox& random) { return std::floor(random.exponential() * 5); }});
  found.push_back({"Pareto", [](Philox& random) { return std::floor(1 / random.uniform()); }});
  const auto half_atoms = [](Philox& random) {
    const double u = random.uniform();
    return random.uniform() < 0.5 ? u : std::floor(40 * u);
  };
  found.push_back({"half of 40 atoms", half_atoms});
  return found;
}

// Such a ratio has a probability of at most about 1e-5. Among the 16,800 .17 would be found.
TEST(RecurringValues, AreNotFoundInIndependentValues) {
  Philox random(3);
  for (const AtomLaw& law : laws_of_atoms()) {
    for (const std::size_t n : {20u, 200u, 2000u}) {
      for (int i = 0; i < 400; ++i) {
        ASSERT_FALSE(recurring_values(sample_of(n, [&] { return law.draw(random); })))
            << law.name << " " << n;
      }
    }
  }
}

// Multiplicities about Poisson's with one mean are on the boundary of the bound. Resampling with
// replacement gives such a law.
TEST(RecurringValues, AreNotFoundInResampledValues) {
  Philox random(4);
  for (int i = 0; i < 200; ++i) {
    const auto from = uniform_values(1000, random);
    const auto values = sample_of(2000, [&] {
      return from[static_cast<std::size_t>(random.uniform() * static_cast<double>(from.size()))];
    });
    ASSERT_FALSE(recurring_values(values));
  }
}

TEST(RecurringValues, AreNotFoundInChains) {
  Philox random(5);
  double place = 0;
  const auto walk = [&] { return place += random.uniform() < 0.5 ? -1 : 1; };
  double state = 0;
  const auto metropolis = [&] {
    const double proposed = state + 4 * random.normal();
    if (random.uniform() < std::exp((state * state - proposed * proposed) / 2)) state = proposed;
    return state;
  };
  for (int i = 0; i < 100; ++i) {
    ASSERT_FALSE(recurring_values(sample_of(4000, walk)));
    ASSERT_FALSE(recurring_values(sample_of(4000, metropolis)));
  }
  EXPECT_FALSE(recurring_values({}));
  EXPECT_FALSE(recurring_values(std::vector<double>(1000, 0.25)));
}

TEST(SharedValues, FindsTheSameInAnotherOrder) {
  Philox random(6);
  const auto values = uniform_values(100, random);
  auto other = uniform_values(60, random);
  EXPECT_FALSE(shared_values(values, other));
  other.insert(other.end(), values.begin(), values.begin() + 40);
  const auto found = shared_values(values, shuffled(other, random));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->values, 40u);
  EXPECT_LT(found->limit, 20u);
}

TEST(SharedValues, AreNotFoundInIndependentSamples) {
  Philox random(7);
  for (const AtomLaw& law : laws_of_atoms()) {
    for (const AtomLaw& other : laws_of_atoms()) {
      for (int i = 0; i < 30; ++i) {
        ASSERT_FALSE(shared_values(sample_of(200, [&] { return law.draw(random); }),
                                   sample_of(500, [&] { return other.draw(random); })))
            << law.name << ", " << other.name;
      }
    }
  }
}

}  // namespace
}  // namespace assay::stats
