#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <filesystem>

#include "estimators/core/quoting.h"
#include "estimators/core/value.h"
#include "harness/base/text_file.h"
#include "harness/command/commands.h"
#include "harness/suite/yaml.h"

namespace assay::harness {
namespace {

constexpr std::string_view templates = "init/";
constexpr std::string_view next_steps = "NEXT.txt";  // printed, not written

/// The files of a kind, their paths below its folder.
std::vector<CarriedFile> files_of(const std::string& kind) {
  const std::string folder = fmt::format("{}{}/", templates, kind);
  std::vector<CarriedFile> files;
  for (const CarriedFile& file : carried_files()) {
    if (!file.path.starts_with(folder)) continue;
    files.push_back({file.path.substr(folder.size()), file.text});
  }
  return files;
}

/// Writes the files and prints what to do with them. Nothing is written if one is there already.
void write_files(const std::vector<CarriedFile>& files, const std::string& into) try {
  const std::filesystem::path folder = into;
  for (const CarriedFile& file : files) {
    const std::filesystem::path path = folder / file.path;
    if (file.path == next_steps || !std::filesystem::exists(path)) continue;
    refuse({}, "`{}` exists already, so nothing is written; name another folder", path.string());
  }
  std::string steps;
  for (const CarriedFile& file : files) {
    if (file.path == next_steps) {
      const std::string line = into == "." ? "" : fmt::format("cd {}\n    ", shell_quoted(into));
      steps = boost::replace_first_copy(std::string(file.text), "@CD@", line);
      continue;
    }
    const std::filesystem::path path = folder / file.path;
    std::filesystem::create_directories(path.parent_path());
    write_whole(path, file.text);
    fmt::print("wrote {}\n", (into == "." ? path.lexically_normal() : path).string());
  }
  fmt::print("{}", steps);
} catch (const std::filesystem::filesystem_error& error) {
  refuse({}, "cannot write into `{}`: {}; name another folder", into, error.code().message());
}

}  // namespace

std::vector<std::string> kinds_of_example() {
  std::vector<std::string> kinds;
  for (const CarriedFile& file : carried_files()) {
    if (!file.path.starts_with(templates) || !file.path.ends_with(next_steps)) continue;
    const std::string_view below = file.path.substr(templates.size());
    kinds.emplace_back(below.substr(0, below.find('/')));
    std::ranges::replace(kinds.back(), '-', ' ');
  }
  return kinds;
}

int write_example(const InitArguments& arguments) {
  const std::vector<std::string> kinds = kinds_of_example();
  const std::vector<std::string>& words = arguments.words;
  std::string kind;
  std::size_t count = 0;
  const auto is_known = [&] { return std::ranges::find(kinds, kind) != kinds.end(); };
  while (count < words.size() && !is_known()) kind += (kind.empty() ? "" : " ") + words[count++];
  if (!is_known()) {
    refuse({}, "there is no example `{}`; there is {}{}", kind, listed(kinds),
           did_you_mean(kind, kinds));
  }
  if (words.size() > count + 1) refuse({}, "`{}` is one argument too many", words[count + 1]);
  std::ranges::replace(kind, ' ', '-');
  write_files(files_of(kind), count < words.size() ? words[count] : ".");
  return 0;
}

}  // namespace assay::harness
