#pragma once

#include <filesystem>
#include <string>

namespace assay {

/// The file of a program where a shell would find it: in the folders of PATH. A word with a slash
/// is relative to `folder`. Empty if there is none that may be executed.
std::filesystem::path program_path(const std::string& word, const std::filesystem::path& folder);

}  // namespace assay
