#include "estimators/catalogue.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "estimators/core/mapped.h"

namespace assay {

namespace plugins {

/// Generated from the list in estimators/CMakeLists.txt: what every listed file contributes.
std::vector<Entry> all();

}  // namespace plugins

namespace {

[[noreturn]] void malformed(const Entry& entry, const std::string& why) {
  throw std::logic_error("the catalogue's entry `" + entry.information.name + "` " + why);
}

// Lower-case words of letters, digits and underscores, joined by slashes: luminaire/area, recorded.
bool well_formed(std::string_view name) {
  const auto is_word = [](const std::string& word) {
    return !word.empty() && word[0] >= 'a' && word[0] <= 'z' &&
           word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == word.npos;
  };
  return name.find(' ') == name.npos && std::ranges::all_of(pieces_of(name, '/'), is_word);
}

const std::string& name_of(const Entry& entry) { return entry.information.name; }

const Entry* lookup(const std::vector<Entry>& entries, std::string_view name) {
  const auto found = std::ranges::find(entries, name, name_of);
  return found == entries.end() ? nullptr : &*found;
}

void check(const Entry& entry, const std::vector<Entry>& entries) {
  const Information& information = entry.information;
  if (!well_formed(information.name)) malformed(entry, "is not named family/name");
  if (!entry.prepare) malformed(entry, "has no prepare()");
  std::set<std::string> names;
  for (const ParameterInformation& parameter : information.parameters) {
    if (!names.insert(parameter.name).second) {
      malformed(entry, "declares the parameter `" + parameter.name + "` twice");
    }
  }
  const bool mutant = information.name.starts_with("mutants/");
  if (mutant != !information.original.empty() || mutant != !information.defect.empty()) {
    malformed(entry, "must be under mutants/ exactly when it names an original and a defect");
  }
  if (mutant && !lookup(entries, information.original)) {
    malformed(entry, "is a mutant of `" + information.original + "`, which is not there");
  }
}

/// Gives a mutant what its original declares, so that the two draw from equal streams.
void inherit(Information& mutant, const Information& original) {
  std::vector<ParameterInformation> own = std::exchange(mutant.parameters, original.parameters);
  for (ParameterInformation& parameter : own) {
    const auto same =
        std::ranges::find(mutant.parameters, parameter.name, &ParameterInformation::name);
    if (same == mutant.parameters.end()) {
      mutant.parameters.push_back(std::move(parameter));
    } else {
      *same = std::move(parameter);
    }
  }
  mutant.bias = original.bias;
  mutant.averages = original.averages;
}

}  // namespace

std::vector<Entry> checked(std::vector<Entry> entries) {
  std::ranges::sort(entries, {}, name_of);
  for (const Entry& entry : entries) check(entry, entries);
  for (Entry& entry : entries) {
    const Information& mutant = entry.information;
    if (!mutant.original.empty())
      inherit(entry.information, lookup(entries, mutant.original)->information);
  }
  const auto twice = std::ranges::adjacent_find(entries, {}, name_of);
  if (twice != entries.end()) malformed(*twice, "is registered twice");
  return entries;
}

const std::vector<Entry>& catalogue() {
  static const std::vector<Entry> entries = checked(plugins::all());
  return entries;
}

const Entry& find_plugin(std::string_view name, const Location& where) {
  if (const Entry* entry = lookup(catalogue(), name)) return *entry;
  throw InputError(where, "there is no plugin `" + std::string(name) + "`" +
                              did_you_mean(name, mapped(catalogue(), name_of),
                                           "`assay list plugins` shows them all"));
}

}  // namespace assay
