// Writes pages of made-up records into a folder: write_example FOLDER.

#include <filesystem>
#include <iostream>

#include "reports/record/file.h"
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
  write_whole(folder / "example.html", html(example_record()));
  write_whole(folder / "many.html", html(many_claims(1508)));
  write_whole(folder / "ellipse.html", html(planted_ellipse()));
  write_whole(folder / "hot.html", html(hot_pixel()));
  write_whole(folder / "calibration.html", html(small_calibration()));
  return 0;
}
