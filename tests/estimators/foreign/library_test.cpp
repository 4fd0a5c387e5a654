// Libraries called in the process of the tests; those in a process of their own are driven through
// the program, by tests/cli/foreign_test.sh.

#include "tests/estimators/foreign/library.h"

#include "estimators/plugin_abi.h"

namespace assay::foreign {
namespace {

TEST(PluginAbi, DrawsTheVeryNumbersOfAStream) {
  for (const std::uint64_t key : {0ull, 1ull, 0xfedcba9876543210ull}) {
    for (const std::uint64_t index : {0ull, 7ull, 0x1234567890ull}) {
      Stream ours({key}, index);
      AssayStream theirs = assay_stream(key, index);
      for (int i = 0; i < 5; ++i) EXPECT_EQ(ours(), assay_word(&theirs));
      EXPECT_EQ(ours.uniform(), assay_uniform(&theirs));
      EXPECT_EQ(ours.uniform_open(), assay_uniform_open(&theirs));
      Stream split = ours.substream(3);
      AssayStream their_split = assay_substream(&theirs, 3);
      for (int i = 0; i < 3; ++i) EXPECT_EQ(split(), assay_word(&their_split));
    }
  }
}

TEST_F(Library, TheExampleDrawsWhatTheBuiltInOneDraws) {
  const auto theirs = load(compile(examples + "/darts_library.c"));
  EXPECT_EQ(theirs->channels()[0].name, "area");
  EXPECT_EQ(theirs->channels()[0].high, 4);
  EXPECT_TRUE(theirs->nature()->averages);
  EXPECT_EQ(theirs->nature()->bias, BiasClass::unbiased);
  const auto ours = prepare("analytic/dart_throwing", Value{});
  EXPECT_EQ(draw(*theirs, 100, 0, 64), draw(*ours, 100, 0, 64));
}

TEST_F(Library, TheExampleIsShorterThan30LinesAndExportsOneSymbol) {
  const std::string text = bytes_in(examples + "/darts_library.c");
  EXPECT_THAT(std::ranges::count(text, '\n'), AllOf(Lt(30), Gt(10)));
  const std::string count =
      "test \"$(nm -D --defined-only " + compile(examples + "/darts_library.c") + " | wc -l)\" = 1";
  EXPECT_EQ(std::system(count.c_str()), 0);
}

TEST_F(Library, ChecksParametersAsThoseOfAnyPlugin) {
  const std::string file = compile_text(R"(
typedef struct { double rate; double count; char first; } Setup;
static Setup setup;
static const AssayParameter parameters[] = {
    {.size = sizeof parameters[0], .name = "rate", .summary = "events", .flags = ASSAY_LOW, .low = 0},
    {.size = sizeof parameters[0], .name = "count", .type = ASSAY_COUNT, .fallback = "3"},
    {.size = sizeof parameters[0], .name = "law", .type = ASSAY_TEXT, .fallback = "normal"}};
static int prepare(AssayPreparation *p) {
  setup.rate = assay_value(p, 0)->number;
  setup.count = assay_value(p, 1)->number;
  setup.first = assay_value(p, 2)->text[0];
  p->setup = &setup;
  if (setup.rate < 10) return 0;
  p->message[0] = 'n'; p->message[1] = 'o'; p->message[2] = 0;
  return 5;
}
static int secondary(AssayCall *call) {
  const Setup *s = call->setup;
  call->out[0] = s->rate; call->out[1] = s->count; call->out[2] = s->first;
  return 0;
}
static const AssayChannel x[] = {{.size = sizeof x[0], .name = "x"}, {.size = sizeof x[0], .name = "y"},
                                 {.size = sizeof x[0], .name = "z"}};
static const AssayEstimator mine = {.size = sizeof mine, .name = "mine", .channels = x,
    .channel_count = 3, .secondary = secondary, .parameters = parameters, .parameter_count = 3,
    .prepare = prepare};
static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, &mine, 1};
const AssayLibrary *assay_library(void) { return &library; }
)");
  const auto given = [](const char* name, const char* value) {
    return std::vector<Value::Member>{{"parameters", Value::map({{name, Value::scalar(value)}})}};
  };
  EXPECT_THAT(draw(*load(file, given("rate", "2.5")), 1, 0), ElementsAre(2.5, 3, 'n'));
  EXPECT_THAT(refusal(file), HasSubstr("needs the parameter `rate`"));
  EXPECT_THAT(refusal(file, given("rat", "2")), HasSubstr("did you mean `rate`?"));
  EXPECT_THAT(refusal(file, given("rate", "-1")), HasSubstr("must be at least 0, but it is -1"));
  EXPECT_THAT(refusal(file, given("rate", "11")), HasSubstr("refuses: no (status 5 of prepare())"));
}

TEST_F(Library, OfAnOlderInterfaceStillLoads) {
  // Its structs end where the first version's had to: all that came after is not there.
  const std::string older = R"(
#include <stddef.h>
#include <stdint.h>
struct call { size_t size; const void *setup; void *random; uint64_t primaries; double *out; };
struct channel { size_t size; const char *name; uint32_t flags; };
static int secondary(struct call *call) { call->out[0] = 1; call->out[1] = 2; return 0; }
static const struct channel x[] = {{sizeof x[0], "a", 0}, {sizeof x[0], "b", 0}};
static const struct { size_t size; const char *name, *summary; uint32_t flags, bias;
  const void *channels; size_t channel_count; int (*secondary)(struct call *);
} mine[] = {{sizeof mine[0], "one", "", 0, 0, x, 2, secondary},
            {sizeof mine[0], "two", "", 0, 0, x, 1, secondary}};
static const struct { size_t size; uint32_t version; const void *estimators; size_t count; }
  library = {sizeof library, 1, mine, 2};
const void *assay_library(void);
const void *assay_library(void) { return &library; }
)";
  const std::string file = compile(write("older.c", older));
  const auto setup = load(file, {{"estimator", Value::scalar("one")}});
  EXPECT_THAT(draw(*setup, 1, 0), ElementsAre(1, 2));
  EXPECT_FALSE(setup->channels()[1].mean.has_value());
  EXPECT_THAT(refusal(file), HasSubstr("set `estimator` to one of `one`, `two`"));
  EXPECT_THAT(refusal(file, {{"estimator", Value::scalar("twi")}}),
              HasSubstr("did you mean `two`?"));
}

TEST_F(Library, OfALaterInterfaceStillLoads) {
  const std::string later = R"(
#include "plugin_abi.h"
typedef struct { AssayChannel now; double more[7]; } Channel;
typedef struct { AssayEstimator now; void (*more[9])(void); } Estimator;
typedef struct { AssayLibrary now; double more; } Table;
static int secondary(AssayCall *call) { call->out[0] = 1; call->out[1] = 2; return 0; }
static const Channel x[] = {{{.size = sizeof x[0], .name = "a"}, {3}},
                            {{.size = sizeof x[0], .name = "b", .flags = ASSAY_MEAN, .mean = 2}, {4}}};
static const Estimator mine[] = {
    {{.size = sizeof mine[0], .name = "one", .channels = &x[0].now, .channel_count = 2,
      .secondary = secondary}, {0}},
    {{.size = sizeof mine[0], .name = "two", .channels = &x[0].now, .channel_count = 1,
      .secondary = secondary}, {0}}};
static const Table library = {{sizeof library, ASSAY_ABI_VERSION, &mine[0].now, 2}, 1};
const AssayLibrary *assay_library(void) { return &library.now; }
)";
  const std::string file = compile(write("later.c", later));
  const auto setup = load(file, {{"estimator", Value::scalar("one")}});
  EXPECT_THAT(draw(*setup, 1, 0), ElementsAre(1, 2));
  EXPECT_EQ(setup->channels()[1].mean, 2);
  EXPECT_EQ(load(file, {{"estimator", Value::scalar("two")}})->channels().size(), 1u);
}

TEST_F(Library, RefusesTablesThatItCannotUse) {
  const std::string estimators =
      "static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, &mine, 1};\n";
  for (const auto& [definitions, table, said] :
       {std::array<std::string, 3>{"", "0", "returns no table"},
        {"static const AssayLibrary library = {sizeof library, ASSAY_ABI_VERSION, 0, 0};\n",
         "&library", "has no estimators"},
        {"static const AssayEstimator mine = {.name = \"mine\"};\n" + estimators, "&library",
         "set it to sizeof(AssayEstimator)"},
        {"static const AssayEstimator mine = {.size = sizeof mine, .name = \"mine\"};\n" +
             estimators,
         "&library", "without secondary()"}}) {
    EXPECT_THAT(
        refusal(compile_text(definitions + "const AssayLibrary *assay_library(void) { return " +
                             table + "; }\n")),
        HasSubstr(said));
  }
}

TEST_F(Library, OffersItsSamplers) {
  const auto setup = load(compile_text(ramp_sampler));
  const auto samplers = setup->samplers();
  ASSERT_EQ(samplers.size(), 1u);
  EXPECT_EQ(samplers[0].name, "ramp");
  const Sampler& sampler = *samplers[0].sampler;
  EXPECT_EQ(sampler.domain(), Domain::interval);
  EXPECT_EQ(sampler.density({0.25, 0, 0}), 0.5);
  EXPECT_EQ(sampler.evaluate({0.25, 0, 0}), 1);
  Stream random({1}, 0);
  const SamplerDraw draw = sampler.sample(random);
  EXPECT_TRUE(draw.valid);
  EXPECT_EQ(draw.density, 2 * draw.point[0]);
  // The same each time, so that their tables are made once.
  EXPECT_EQ(setup->samplers()[0].sampler, samplers[0].sampler);
}

}  // namespace
}  // namespace assay::foreign
