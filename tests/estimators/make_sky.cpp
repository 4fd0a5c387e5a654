// Writes the picture of tests/estimators/sky.h: make_sky FILE.exr. The suites' copy was made by
//   ninja make_sky && tests/estimators/make_sky suites/data/sky.exr

#include <exception>
#include <iostream>

#include "tests/estimators/exr.h"
#include "tests/estimators/sky.h"

int main(int count, char** arguments) {
  using namespace assay::draws;
  if (count != 2) {
    std::cerr << "usage: make_sky FILE.exr\n";
    return 2;
  }
  Picture picture{.width = sky_width, .height = sky_height, .channels = {"R", "G", "B"}};
  for (std::size_t row = 0; row < sky_height; ++row) {
    for (std::size_t column = 0; column < sky_width; ++column) {
      for (const float value : sky_texel(row, column)) picture.values.push_back(value);
    }
  }
  try {
    write_exr(arguments[1], picture);
  } catch (const std::exception& error) {
    std::cerr << "make_sky: " << error.what() << '\n';
    return 1;
  }
}
