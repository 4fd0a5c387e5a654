#include "estimators/foreign/protocol.h"
#include "tests/estimators/table.h"

namespace assay::foreign {
namespace {

Hello hello(const std::string& lines) { return parse_hello("assay 1 text\n" + lines + "ready\n"); }

TEST(Hello, NamesChannelsInOrder) {
  const Hello said = hello("channel area\nchannel nodes diagnostic\n");
  ASSERT_EQ(said.channels.size(), 2u);
  EXPECT_EQ(said.channels[0].name, "area");
  EXPECT_FALSE(said.channels[0].mean.has_value());
  EXPECT_FALSE(said.channels[0].diagnostic);
  EXPECT_EQ(said.channels[1].name, "nodes");
  EXPECT_TRUE(said.channels[1].diagnostic);
  EXPECT_EQ(said.numbers, Numbers::text);
  EXPECT_EQ(said.width(), 2u);
}

TEST(Hello, SaysNothingThatItDoesNotSay) {
  const Hello said = hello("channel area\n");
  EXPECT_FALSE(said.nature.averages);
  EXPECT_FALSE(said.nature.bias.has_value());
  EXPECT_FALSE(said.image.has_value());
  EXPECT_EQ(said.channels[0].low, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_text(said), to_text(hello("channel area\nbias unknown\n")));
  EXPECT_EQ(hello("channel area\nbias bootstrap\n").nature.bias, BiasClass::inverse_bootstrap);
}

TEST(Hello, TakesWhatIsKnownOfAChannel) {
  const Channel area =
      hello("channel area mean 3.5 error 1e-9 variance 2 low 0 high inf rounding 1e-12\n")
          .channels[0];
  EXPECT_EQ(area.mean, 3.5);
  EXPECT_EQ(area.mean_error, 1e-9);
  EXPECT_EQ(area.variance, 2);
  EXPECT_EQ(area.low, 0);
  EXPECT_EQ(area.high, std::numeric_limits<double>::infinity());
  EXPECT_EQ(area.rounding, 1e-12);
}

TEST(Hello, DescribesAnImage) {
  const Hello said =
      hello("image 3 2 red green\nrange 0 10\nindependent\nchannel rays_missed diagnostic\nrays\n");
  ASSERT_TRUE(said.image.has_value());
  EXPECT_EQ(said.image->elements(), 12u);
  EXPECT_TRUE(said.image->independent);
  EXPECT_EQ(said.channel_count(), 13u);
  EXPECT_EQ(said.element.high, 10);
  EXPECT_EQ(said.width(), 14u);
  EXPECT_FALSE(hello("image 3 2\n").image->independent);
}

TEST(Hello, AnnouncesSamplers) {
  const Hello said = parse_hello(
      "assay 1 binary\nchannel x\nsampler lens square\n"
      "sampler ramp interval low -1 high 0.5 rounding 1e-6\nready\n");
  ASSERT_EQ(said.samplers.size(), 2u);
  EXPECT_EQ(said.samplers[0].name, "lens");
  EXPECT_EQ(said.samplers[0].domain, Domain::square);
  EXPECT_EQ(said.samplers[0].rounding, 0);
  EXPECT_EQ(said.samplers[1].domain, Domain::interval);
  EXPECT_EQ(said.samplers[1].bounds, (std::array<double, 2>{-1, .5}));
  EXPECT_EQ(said.samplers[1].rounding, 1e-6);
  EXPECT_EQ(said.width(), 1u);
}

TEST(Hello, SurvivesBeingWrittenAndReadAgain) {
  const std::string lines =
      "assay 1 binary\nimage 2 2 red green\nindependent\nrange -inf 10\n"
      "channel nodes mean 0.1 error 1e-09 variance 3 low 0 rounding 1e-12 diagnostic\n"
      "averages\nbias start-up\nrays\nsampler ramp interval low -1 high 0.5 rounding 1e-06\n"
      "sampler lens hemisphere\nready\n";
  EXPECT_EQ(to_text(parse_hello(lines)), lines);
}

TEST(Hello, IsWholeOnceALineEndsIt) {
  EXPECT_FALSE(is_whole_hello("assay 1 text\nchannel a\nready"));
  EXPECT_TRUE(is_whole_hello("assay 1 text\nchannel a\nready\n"));
  EXPECT_TRUE(is_whole_hello("assay 1 text\nerror no licence\n"));
  EXPECT_TRUE(is_whole_hello("assay 1 text\nchannel a\nready\nhello\n"));
  EXPECT_FALSE(is_whole_hello("already\n"));
}

TEST(Hello, IsRefusedForEachMistake) {
  for (const auto& [text, said] : refused_texts("hellos")) {
    EXPECT_THAT(thrown<ProtocolError>([&] { parse_hello(text); }), HasSubstr(said)) << text;
  }
}

TEST(Hello, GivesTheProgramsOwnWordsWhereItRefuses) {
  EXPECT_EQ(
      thrown<Refusal>([] { parse_hello("assay 1 text\nerror the licence server is away\n"); }),
      "the licence server is away");
}

}  // namespace
}  // namespace assay::foreign
