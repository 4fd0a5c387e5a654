#include "estimators/foreign/hello.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace assay::foreign {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& text) {
  try {
    parse_hello(text);
  } catch (const ProtocolError& error) {
    return error.what();
  }
  return "nothing was refused";
}

Hello hello(const std::string& lines) { return parse_hello("assay 1 text\n" + lines + "ready\n"); }
std::string wrong(const std::string& lines) {
  return refusal("assay 1 text\n" + lines + "ready\n");
}

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
}

TEST(Hello, MaySayThatItsBiasIsUnknown) {
  EXPECT_FALSE(hello("channel area\nbias unknown\n").nature.bias.has_value());
  EXPECT_EQ(to_text(hello("channel area\n")), to_text(hello("channel area\nbias unknown\n")));
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
  ASSERT_EQ(said.channels.size(), 13u);
  EXPECT_EQ(said.channels[11].name, "x2y1.green");
  EXPECT_EQ(said.channels[11].high, 10);
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

TEST(Hello, RefusesSamplersThatCannotBe) {
  const auto wrong_sampler = [](const std::string& line) {
    return refusal("assay 1 binary\nchannel x\n" + line + "\nready\n");
  };
  EXPECT_THAT(wrong_sampler("sampler lens"), HasSubstr("a sampler has a name"));
  EXPECT_THAT(wrong_sampler("sampler two.words square"), HasSubstr("a sampler has a name"));
  EXPECT_THAT(wrong_sampler("sampler lens circle"), HasSubstr("a domain is interval, square"));
  EXPECT_THAT(wrong_sampler("sampler lens interval low"), HasSubstr("pairs of a word"));
  EXPECT_THAT(wrong_sampler("sampler lens interval low 1 high 1"), HasSubstr("is empty"));
  EXPECT_THAT(wrong_sampler("sampler lens interval low nan"), HasSubstr("not a number"));
  EXPECT_THAT(wrong_sampler("sampler lens square rounding -1"), HasSubstr("from 0"));
  EXPECT_THAT(wrong_sampler("sampler lens square rounding inf"), HasSubstr("below 1"));
  EXPECT_THAT(wrong_sampler("sampler lens square low 0"), HasSubstr("of an interval low"));
  EXPECT_THAT(wrong_sampler("sampler lens square middle 1"), HasSubstr("rounding is known"));
  EXPECT_THAT(wrong_sampler("sampler lens square\nsampler lens sphere"), HasSubstr("twice"));
  EXPECT_THAT(wrong("channel x\nsampler lens square\n"), HasSubstr("binary only"));
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

TEST(Hello, RefusesWhatIsNoHello) {
  EXPECT_THAT(refusal(""), HasSubstr("says nothing"));
  EXPECT_THAT(refusal("Loading scene…\n"), HasSubstr("the first is `assay 1 text`"));
  EXPECT_THAT(refusal("assay 1\nchannel a\nready\n"), HasSubstr("`assay 1`"));
  EXPECT_THAT(refusal("assay 2 text\nchannel a\nready\n"), HasSubstr("speaks version 2"));
  EXPECT_THAT(refusal("assay 1 json\nchannel a\nready\n"), HasSubstr("`text` or `binary`"));
  EXPECT_THAT(refusal("assay 1 text\nchannel a\n"), HasSubstr("does not end with `ready`"));
  EXPECT_THAT(refusal("assay 1 text\nready\n"), HasSubstr("neither a `channel` nor an `image`"));
  EXPECT_THAT(refusal("assay 1 text\nchannel a\nready\n3.14\n"), HasSubstr("after `ready`"));
}

TEST(Hello, RefusesLinesThatItDoesNotKnow) {
  EXPECT_THAT(wrong("chanel a\n"), HasSubstr("`chanel a`"));
  EXPECT_THAT(wrong("channel a mean\n"), HasSubstr("needs a number"));
  EXPECT_THAT(wrong("channel a mean zero\n"), HasSubstr("`zero` is not a number"));
  EXPECT_THAT(wrong("channel a mean inf\n"), HasSubstr("not finite"));
  EXPECT_THAT(wrong("channel a low nan\n"), HasSubstr("`nan` is not a number"));
  EXPECT_THAT(wrong("channel a variance -1\n"), HasSubstr("cannot be negative"));
  EXPECT_THAT(wrong("channel a low 2 high 1\n"), HasSubstr("the range is empty"));
  EXPECT_THAT(wrong("channel a median 1\n"), HasSubstr("are known"));
  EXPECT_THAT(wrong("channel two.words\n"), HasSubstr("letters, digits"));
  EXPECT_THAT(wrong("channel a\nchannel a\n"), HasSubstr("`a` twice"));
  EXPECT_THAT(wrong("image 2 2\nchannel x0y0\n"), HasSubstr("leave such channels out"));
  EXPECT_THAT(wrong("channel a\nbias small\n"), HasSubstr("bias is unknown, unbiased"));
  EXPECT_THAT(wrong("channel a\naverages 3\n"), HasSubstr("nothing follows"));
}

TEST(Hello, RefusesImagesThatCannotBe) {
  EXPECT_THAT(wrong("image 3\n"), HasSubstr("a width and a height"));
  EXPECT_THAT(wrong("image 0 3\n"), HasSubstr("above 0"));
  EXPECT_THAT(wrong("image -1 3\n"), HasSubstr("above 0"));
  EXPECT_THAT(wrong("image 4294967296 4294967296\n"), HasSubstr("at most"));
  EXPECT_THAT(wrong("image 18446744073709551615 1\n"), HasSubstr("at most"));
  EXPECT_THAT(wrong("image 8 8 red red\n"), HasSubstr("component twice"));
  EXPECT_THAT(wrong("image 8 8\nimage 8 8\n"), HasSubstr("one image"));
  EXPECT_THAT(wrong("image 8 8\nchannel a\n"), HasSubstr("such a channel is `diagnostic`"));
  EXPECT_THAT(wrong("channel a\nrange 0 1\n"), HasSubstr("there is no `image`"));
  EXPECT_THAT(wrong("channel a\nindependent\n"), HasSubstr("after the `image`"));
}

TEST(Hello, GivesTheProgramsOwnWordsWhereItRefuses) {
  try {
    parse_hello("assay 1 text\nerror the licence server is away\n");
    FAIL() << "a refusal was not noticed";
  } catch (const Refusal& refusal) {
    EXPECT_STREQ(refusal.what(), "the licence server is away");
  }
}

}  // namespace
}  // namespace assay::foreign
