// Writes the example reports to a folder, to be looked at in a browser:
//   write_example FOLDER

#include <filesystem>
#include <iostream>

#include "reports/record/file.h"
#include "reports/viewer/html.h"
#include "tests/reports/example_record.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_example FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  using namespace assay::reports;
  write_whole(folder / "example.html", html(example_record()));
  write_whole(folder / "forty.html", html(forty_estimators()));
  return 0;
}
