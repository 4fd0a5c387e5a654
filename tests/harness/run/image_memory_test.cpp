// Pictures that do not fit into memory are refused before they are read.

#include "harness/run/planned_run.h"
#include "harness/suite/suite.h"
#include "harness/theta/ask.h"
#include "tests/harness/pictures.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

constexpr int pictures = 20;
constexpr double elements = 8 * 6 * 3;

class ImageMemory : public InFolder {
 protected:
  ImageMemory() {
    write_stack(place_, "a", {.width = 8, .height = 6, .count = pictures}, flat(1));
    const Suite suite =
        load_suite(place_.write("s.yaml",
                                "suite: s\nestimators:\n  a: {plugin: recorded, file: 'a*.exr'}\n"
                                "  one: {plugin: recorded, file: a00.exr, exact: true}\n"
                                "  noise: {plugin: analytic/dart_throwing}\n"
                                "tests:\n  - claim: mean(a) == mean(one)\n"));
    estimators_ = prepare_all(suite);
  }

  std::map<std::string, PreparedEstimator> estimators_;
};

// Only the pictures of `a` count: a reference keeps none, and the other is no image.
TEST_F(ImageMemory, IsThatOfEveryNumberAndMore) {
  EXPECT_GT(picture_bytes(estimators_, {}), 4 * pictures * elements);
  EXPECT_LT(picture_bytes(estimators_, {}), 100 * pictures * elements);
}

// A window of rows of such small pictures is all of them; of each element less is kept.
TEST_F(ImageMemory, OfPicturesThatAreTakenRowsAfterRowsIsLess) {
  const Suite suite =
      load_suite(place_.write("rows.yaml",
                              "suite: s\nestimators:\n  a: {plugin: recorded, file: 'a0*.exr'}\n"
                              "  b: {plugin: recorded, file: 'a1*.exr'}\n"
                              "tests:\n  - claim: mean(a) == mean(b)\n"));
  const auto estimators = prepare_all(suite);
  const Question question = ask(suite.tests[0], estimators, 1);
  EXPECT_LT(picture_bytes(estimators, {&question}), picture_bytes(estimators, {}) - 100 * elements);
  EXPECT_GT(picture_bytes(estimators, {&question}), 4 * pictures * elements);
}

TEST_F(ImageMemory, ThatIsNotThereIsAnErrorThatSaysHowMuch) {
  const double needed = picture_bytes(estimators_, {});
  EXPECT_NO_THROW(require_memory(estimators_, {}, needed));
  const std::string message = refusal([&] { require_memory(estimators_, {}, needed - 1); });
  EXPECT_THAT(message, HasSubstr("3:"));
  EXPECT_THAT(message, HasSubstr("20 pictures of 8 x 6 pixels of 3 components"));
  EXPECT_THAT(message, HasSubstr("GB are free; take fewer pictures"));
  EXPECT_THAT(refusal([&] { require_memory(estimators_, {}, 0, "`a03.exr` is not finite"); }),
              HasSubstr("`a03.exr` is not finite, so that all are to be kept: 20 pictures"));
}

TEST_F(ImageMemory, OfThisMachineIsKnown) {
  EXPECT_GT(available_bytes(), 1e6);
  EXPECT_LT(available_bytes(), 1e15);
}

}  // namespace
}  // namespace assay::harness
