#include "estimators/core/program_path.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace assay {

namespace fs = std::filesystem;

namespace {

fs::path if_executable(const fs::path& file) {
  std::error_code ignored;
  const bool good = fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
  return good ? file : fs::path();
}

}  // namespace

fs::path program_path(const std::string& word, const fs::path& folder) {
  if (word.find('/') != word.npos) return if_executable(folder / word);
  const char* const variable = std::getenv("PATH");
  std::string rest = variable == nullptr ? "/usr/bin:/bin" : variable;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const fs::path found = if_executable(fs::path(rest.substr(0, colon)) / word);
    if (!found.empty()) return found;
    rest.erase(0, colon + 1);
  }
  return {};
}

}  // namespace assay
