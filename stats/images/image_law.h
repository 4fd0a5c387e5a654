#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "stats/basics/for_each.h"
#include "stats/images/image.h"
#include "stats/images/image_family.h"
#include "stats/tails/evidence.h"

namespace assay::stats {

// The score that is added up over a cell, in units of its standard deviation over all images.
enum class ImageScore {
  value,    // The element's value.
  rank,     // Its midrank among all images: fireflies weigh no more than others.
  spread,   // The squared distance of its midrank from the middle (Mood 1954, Ann. Math. Stat. 25,
            // 514).
  largest,  // The midrank of the image's largest value, for the whole image alone: a clamp.
};

// The sum that differs most between the sides.
struct ImageLawFinding {
  ImageScore score = ImageScore::value;
  Rectangle window = {};
  std::size_t channel = 0;
  double z = 0;  // Positive where the first side's scores are larger.
};

struct ImageLawTest {
  double log_p = 0;
  std::size_t permutations = 0;  // Drawn, without that of the data.
  ImageLawFinding most = {};
  std::vector<double> z = {};  // Each element's own, by its value.
};

// Draws a subset of `size` of the images 0 to count - 1, all subsets alike; different for each
// index.
using DrawSubset = std::function<std::vector<std::uint32_t>(std::uint64_t index, std::size_t count,
                                                            std::size_t size)>;

// The first steps of Fisher and Yates's shuffle, by numbers uniform in [0, 1).
std::vector<std::uint32_t> drawn_subset(const std::function<double()>& uniform, std::size_t count,
                                        std::size_t size);

// Enough for a test at this level. A small p-value is then known to a third: ten labels are as
// extreme. Beyond 9999 labels, one is.
std::size_t permutations_at(double alpha);

struct ImageLawOptions {
  std::size_t permutations = 999;  // At most.
  DrawSubset draw = {};
  ForEach for_each = one_by_one;
};

// Have two stacks of images one law? Null hypothesis: all images are exchangeable, as independent
// images of one law are. Exact at any size and law: the labels of the sides are permuted.
//
// Cells are squares of 1, 2, 4, ... elements to the whole image, side by side, of one channel. The
// statistic of a cell and a score is the sum of the first side's scores over its standard deviation
// under permutation. Its normal p-value is adjusted for the cells of one size (Sidak). The smallest
// over all sizes and scores is the test's statistic.
//
// Random labels give statistics to compare it with. Drawing ends after ten that are as small (Besag
// & Clifford 1991, Biometrika 78, 301). Then p is ten over the number drawn. Else it is (1 + as
// small) / (1 + drawn).
//
// It finds differences of means, of typical values, of spreads and of the brightest value. Other
// differences of laws it may miss. Throws std::domain_error for unequal extents and fewer than
// least_replicates images.
ImageLawTest image_law_test(const ImageStack& a, const ImageStack& b,
                            const ImageLawOptions& options);

// Evidence that the laws differ. Theta is 0 or not; it has no size.
Evidence law_evidence(const ImageLawTest& test);

}  // namespace assay::stats
