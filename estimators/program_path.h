#pragma once

#include <filesystem>
#include <string>

namespace assay {

/// The file of a program where a shell would find it: in the folders of PATH, or relative to
/// `folder` where the word has a slash. Empty where there is none that may be executed.
std::filesystem::path program_path(const std::string& word, const std::filesystem::path& folder);

}  // namespace assay
