#pragma once

// The list of all plugins, generated from estimators/CMakeLists.txt.

#include <string_view>
#include <vector>

#include "estimators/estimator.h"

namespace assay {

/// Every registered entry by name, sorted; built on first use, never before main. Throws
/// std::logic_error on a duplicate or malformed name.
const std::vector<Entry>& catalogue();

/// Sorts the generated list, and gives mutants what their originals declare. std::logic_error if a
/// name is used twice or is not of the form family/name. The same if an entry has no prepare() or
/// declares a parameter twice, and if a mutant's original is missing.
std::vector<Entry> checked(std::vector<Entry> entries);

/// The entry of that name. InputError at `where` with the nearest name when there is none.
const Entry& find_plugin(std::string_view name, const Location& where);

}  // namespace assay
