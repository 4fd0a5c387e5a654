// Writes pages of made-up records into a folder: write_example FOLDER.

#include <filesystem>
#include <fstream>
#include <iostream>

#include "reports/report_formats.h"
#include "tests/reports/example_record.h"
#include "tests/reports/large_records.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_example FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  using namespace assay::reports;
  const auto write = [&](const char* name, const std::string& page) {
    std::ofstream(folder / name, std::ios::binary) << page;
  };
  write("example.html", html(example_record()));
  Record without_detect = example_record();
  for (Suite& suite : without_detect.suites)
    for (Test& test : suite.tests) test.detect.reset();
  write("without-detect.html", html(without_detect));
  write("many.html", html(many_claims(1508)));
  write("ellipse.html", html(planted_ellipse()));
  write("hot.html", html(hot_pixel()));
  write("calibration.html", html(small_calibration()));
  return 0;
}
