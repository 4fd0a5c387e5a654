// Samplers inside another program, of Python so that it can do whatever a test wants; those of
// libraries are driven through the program, by tests/cli/sampler_test.sh.

#include "estimators/core/flush_denormals.h"
#include "estimators/foreign/dialogue.h"
#include "tests/estimators/foreign/foreign.h"

namespace assay::foreign {
namespace {

// A ramp on [0, 2]: density x / 2, evaluation 1. A draw is as far as the observation's number says,
// so that tests know what was asked. {} is done to each question, about `items`.
const std::string ramp = R"(
import os, struct, sys
questions, replies = open(0, "rb"), open(1, "wb")
replies.write(b"assay 1 binary\nchannel x\n"
              b"sampler ramp interval low 0 high 2 rounding 1e-7\nsampler other sphere\nready\n")
replies.flush()
asked = 0
while question := questions.read(32):
    sampler, what, count, primaries = struct.unpack("<4Q", question)
    assert primaries == 0 and sampler == 0
    asked += 1
    what, flush = what % 4, what // 4
    form = "<2Q" if what == 0 else "<3d"
    items = list(struct.iter_unpack(form, questions.read(count * struct.calcsize(form))))
    draw = lambda key, index: (index / 2 ** 63, 0, 0, key / 2 ** 64, 1, index % 2)
    density = lambda point: point[0] / 2
    {}
    for item in items:
        if what == 0: replies.write(struct.pack("<6d", *draw(*item)))
        if what == 1: replies.write(struct.pack("<d", density(item)))
        if what == 2: replies.write(struct.pack("<d", 1 + flush))
    replies.write(question)
    replies.flush()
)";

class IsolatedSampler : public Programs {
 protected:
  std::shared_ptr<const Sampler> ramp_that(const std::string& does, double timeout = 20) {
    std::string text = ramp;
    const std::string place = "    {}\n";
    text.replace(text.find(place), place.size(), does.empty() ? "" : "    " + does + "\n");
    const auto setup = run({"/usr/bin/python3", write("ramp.py", text)}, timeout);
    EXPECT_EQ(setup->samplers().size(), 2u);
    return setup->samplers()[0].sampler;
  }
};

std::vector<Point> points(std::size_t count) {
  std::vector<Point> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back({2 * double(i) / double(count), 0, 0});
  return all;
}

/// All of them; how many questions that took is not said.
std::vector<double> densities(const Sampler& sampler, std::span<const Point> points) {
  std::vector<double> all(points.size());
  for (std::size_t done = 0; done < points.size();) {
    done += sampler.densities(points.subspan(done), std::span(all).subspan(done));
  }
  return all;
}

std::string failure_at(const Sampler& sampler, std::span<const Point> points) {
  return thrown<NoAnswer>([&] { densities(sampler, points); });
}

TEST_F(IsolatedSampler, IsAsItsProgramSays) {
  const auto sampler = ramp_that("");
  EXPECT_EQ(sampler->domain(), Domain::interval);
  EXPECT_EQ(sampler->bounds(), (std::array<double, 2>{0, 2}));
  EXPECT_EQ(sampler->rounding(), 1e-7);
  const auto other = setups_[0]->samplers()[1].sampler;
  EXPECT_EQ(other->domain(), Domain::sphere);
  EXPECT_EQ(other->rounding(), 1e-9);
}

TEST_F(IsolatedSampler, AnswersForOneAsForMany) {
  const auto sampler = ramp_that("");
  const std::vector<Point> all = points(3000);
  const std::vector<double> found = densities(*sampler, all);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(found[i], all[i][0] / 2);
  EXPECT_EQ(sampler->density(all[7]), all[7][0] / 2);
  EXPECT_EQ(sampler->lobe_density(0, all[7]), all[7][0] / 2);
  EXPECT_EQ(sampler->evaluate(all[7]), 1);
  EXPECT_EQ(densities(*sampler, {}).size(), 0u);
}

TEST_F(IsolatedSampler, DrawsFromTheNextTwoWordsOfAStream) {
  const auto sampler = ramp_that("");
  std::vector<Stream> streams;
  for (std::uint64_t i = 0; i < 100; ++i) streams.emplace_back(StreamKey{5}, i);
  std::vector<SamplerDraw> draws(streams.size());
  std::size_t done = 0;
  while (done < draws.size()) {
    done += sampler->samples(std::span(streams).subspan(done), std::span(draws).subspan(done));
    for (std::uint64_t i = done; i < streams.size(); ++i) streams[i] = Stream({5}, i);
  }
  for (std::uint64_t i = 0; i < draws.size(); ++i) {
    Stream random({5}, i);
    const std::uint64_t key = random();
    const std::uint64_t observation = random();
    EXPECT_EQ(draws[i].density, std::ldexp(double(key), -64));
    EXPECT_EQ(draws[i].point[0], std::ldexp(double(observation), -63));
    EXPECT_EQ(draws[i].valid, observation % 2 == 1);
    EXPECT_EQ(draws[i].weight, 1);
    Stream again({5}, i);
    EXPECT_EQ(sampler->sample(again).point, draws[i].point);
  }
}

TEST_F(IsolatedSampler, SaysWhetherDenormalsAreFlushed) {
  const auto sampler = ramp_that("");
  EXPECT_EQ(sampler->evaluate({1, 0, 0}), 1);
  const FlushDenormals flush;
  EXPECT_EQ(sampler->evaluate({1, 0, 0}), 2);
}

TEST_F(IsolatedSampler, CountsTheSecondsOfItsProgram) {
  const auto sampler = ramp_that("if what == 2: sum(range(3000000))");
  const double before = sampler->seconds_elsewhere();
  densities(*sampler, points(3));
  const double between = sampler->seconds_elsewhere();
  sampler->evaluate({1, 0, 0});
  EXPECT_GT(between, before);
  EXPECT_GT(sampler->seconds_elsewhere() - between, .02) << "nine million additions";
  std::jthread([&] { EXPECT_EQ(sampler->seconds_elsewhere(), 0) << "that it did not ask for"; });
}

TEST_F(IsolatedSampler, ServesSeveralThreads) {
  const auto sampler = ramp_that("");
  const std::vector<Point> all = points(2000);
  std::vector<std::vector<double>> found(4);
  {
    std::vector<std::jthread> threads;
    for (auto& mine : found) threads.emplace_back([&] { mine = densities(*sampler, all); });
  }
  for (const auto& mine : found) EXPECT_EQ(mine, found[0]);
}

TEST_F(IsolatedSampler, NamesThePointAtWhichItsProgramEnds) {
  const auto sampler =
      ramp_that("if what == 1 and any(p[0] == 1.5 for p in items): os.kill(os.getpid(), 11)");
  const std::vector<Point> all = points(1000);
  const std::string why = failure_at(*sampler, all);
  EXPECT_THAT(why, Says("sampler `ramp` at (1.5): `/usr/bin/python3",
                        "ended by signal 11 (Segmentation fault) instead of answering "
                        "for 1 density"));
  EXPECT_THAT(failure_at(*sampler, points(4)), HasSubstr("at (1.5)"));
  // The draws before it come, and a draw that does not ask for it goes on.
  std::vector<double> out(all.size());
  EXPECT_GT(sampler->densities(all, out), 0u);
  EXPECT_EQ(densities(*sampler, points(3)).size(), 3u);
}

TEST_F(IsolatedSampler, TellsTheFailureOfAllWhereEachCanBeHad) {
  const auto sampler = ramp_that("if count > 100: sys.exit('too many')");
  EXPECT_THAT(failure_at(*sampler, points(1000)),
              AllOf(HasSubstr("sampler `ramp`: "), HasSubstr("exit status 1"),
                    HasSubstr("densities"), HasSubstr("too many"), Not(HasSubstr(" at ("))));
}

TEST_F(IsolatedSampler, MustAnswerTheSameAgain) {
  const std::string words = "a draw must depend on its stream alone";
  const auto counts = ramp_that("density = lambda point: asked");
  EXPECT_THAT(failure_at(*counts, points(10)), HasSubstr(words));
  // Each program by itself always says the same.
  const auto seeded = ramp_that("density = lambda point: os.getpid()");
  densities(*seeded, points(10));
  std::vector<std::string> why(8);
  {
    std::vector<std::jthread> threads;
    for (auto& mine : why) {
      threads.emplace_back([&] {
        for (int i = 0; i < 200; ++i) {
          if (mine = failure_at(*seeded, points(500)); mine != thrown([] {})) return;
        }
      });
    }
  }
  EXPECT_THAT(why, ::testing::Contains(HasSubstr(words)));
}

// A program that draws on from the state of its random numbers gives others to the last of many.
TEST_F(IsolatedSampler, MustAnswerTheSameAloneAsAmongOthers) {
  const auto sampler = ramp_that("place = iter(range(9999)); density = lambda point: next(place)");
  const auto why = [&] { return failure_at(*sampler, points(10)); };
  EXPECT_THAT(why(), HasSubstr("other numbers when it was asked for one of "));
  EXPECT_THAT(why(), HasSubstr(" alone: ")) << "and it is found again";
}

TEST_F(IsolatedSampler, MustAnswerWithNumbers) {
  const auto nan = ramp_that("density = lambda point: float('nan')");
  EXPECT_THAT(failure_at(*nan, points(1)), Says("at (0)", "is no number"));
  for (const char* const draw : {"(0, 0, 0, float('nan'), 1, 1)", "(0, 0, 0, 1, 1, .5)"}) {
    const auto sampler = ramp_that(std::string("draw = lambda key, index: ") + draw);
    Stream random(StreamKey{3}, 7);
    EXPECT_THAT(thrown<NoAnswer>([&] { sampler->sample(random); }), HasSubstr("is no draw"));
  }
}

}  // namespace
}  // namespace assay::foreign
