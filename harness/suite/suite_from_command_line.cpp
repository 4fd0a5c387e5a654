// Suites from the command line: `assay check`, `assay images`, `--estimator`, `--set`.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cctype>
#include <filesystem>
#include <memory>
#include <set>
#include <span>

#include "estimators/catalogue.h"
#include "estimators/core/quoting.h"
#include "estimators/pictures.h"
#include "harness/suite/suite.h"
#include "harness/suite/yaml.h"
#include "stats/images/image.h"

namespace assay::harness {

namespace {

/// `text` before and after the first `separator`; nullopt without one.
std::optional<std::pair<std::string, std::string>> cut(const std::string& text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) return {};
  return std::pair{text.substr(0, at), text.substr(at + 1)};
}

/// Null if no entry has the name.
const EstimatorEntry* entry_named(const std::vector<EstimatorEntry>& entries,
                                  const std::string& name) {
  const auto found = std::ranges::find(entries, name, &EstimatorEntry::name);
  return found == entries.end() ? nullptr : &*found;
}

/// Says how an estimator is made of a file. `command` stands before its option.
[[noreturn]] void refuse_file(const Location& where, const std::string& name,
                              const std::string& file, const std::string& command = "") {
  refuse(where, "`{}` is a file: {}", file,
         file.ends_with(".so")
             ? fmt::format("`{}--estimator {}=library,file={}` loads it", command, name, file)
         : file.ends_with(".py")
             ? fmt::format("`{}--estimator '{}=process,command=[python3, {}]'` runs it", command,
                           name, file)
             : fmt::format("`{3}--estimator {0}=recorded,file={1}` reads numbers, and `--estimator "
                           "'{0}=process,command=[{2}{1}]'` runs a program",
                           name, file, file.find('/') == file.npos ? "./" : "", command));
}

EstimatorEntry entry_for(const Source& source, const std::vector<EstimatorEntry>& given,
                         const std::string& command) {
  if (const auto* entry = entry_named(given, source.estimator)) return *entry;
  const std::string file = source.estimator + "." + source.part;
  if (std::filesystem::is_regular_file(file)) {
    const std::string name = std::filesystem::path(source.estimator).filename().string();
    refuse_file(source.where, name, file, boost::replace_all_copy(command, file, name) + " ");
  }
  const std::string near = nearest(source.estimator, mapped(given, &EstimatorEntry::name));
  if (!near.empty()) {
    refuse(source.where, "no --estimator is named `{}`; did you mean `{}`?", source.estimator,
           near);
  }
  try {
    return {.name = source.estimator,
            .plugin = find_plugin(source.estimator, source.where).information.name,
            .parameters = Value::map({}, source.where),
            .where = source.where};
  } catch (const InputError& error) {
    if (given.empty() || source.estimator.find('/') != std::string::npos) throw;
    refuse(error.where(), "{}; --estimator names {}", error.message(),
           quoted(mapped(given, &EstimatorEntry::name)));
  }
}

// ---- `assay images`

/// The place of an option, as messages show it.
Location place(const std::string& option, const std::string& text) {
  return {fmt::format("{} {}", option, text), 0, 0};
}

/// The pictures of one side, of which the first stands for the rest.
struct Pictures {
  Location where;
  std::vector<std::string> files;
  std::unique_ptr<const PictureFile> first = {};
};

Pictures pictures_of(const std::string& option, const std::string& pattern) {
  const Location where = place(option, pattern);
  try {
    return {where, recorded::files_of(pattern)};
  } catch (const InputError& error) {
    refuse(where, error.message());
  }
}

void require_enough(const Pictures& side) {
  const std::size_t count = side.files.size();
  if (count >= stats::least_replicates) return;
  refuse(side.where,
         "{} {}, and the test needs {} or more to know how much a pixel varies; render more, each "
         "with a seed of its own",
         count, count == 1 ? "picture matches" : "pictures match", stats::least_replicates);
}

Value::Member member(const char* key, const std::string& text, const Location& where) {
  return {key, Value::scalar(text, where)};
}

/// A layer that has a claim of its own.
struct Layer {
  std::string suffix;    ///< of the estimators' names; "" if there is no other
  std::string channels;  ///< patterns
  recorded::PictureChannels of_candidate;
  recorded::PictureChannels of_reference;
};

/// The patterns of the usual channels, with alpha if it tells anything: if it is not 1 throughout.
std::string usual_with_alpha(const Pictures& candidate, const Pictures& reference) {
  const recorded::PictureChannels usual = recorded::choose_channels(*candidate.first, "usual");
  if (recorded::choose_channels(*reference.first, "usual").names != usual.names) return "usual";
  const std::string layer = recorded::layer_of(usual.names[0]);
  const std::string alpha = layer.empty() ? "A" : layer + ".A";
  const auto tells = [&](const PictureFile& file) {
    if (!file.has({alpha})) return false;
    const PictureWindow window = file.window(std::span(&alpha, 1));
    std::vector<float> texels(window.width * window.height);
    file.read(std::span(&alpha, 1), texels);
    return std::ranges::any_of(texels, [](float x) { return x != 1; });
  };
  if (!tells(*candidate.first) && !tells(*reference.first)) return "usual";
  if (recorded::usual_moments(*reference.first, usual).any()) return "usual";
  const std::string names = fmt::format("{}", fmt::join(usual.names, ","));
  for (const Pictures* side : {&candidate, &reference}) {
    if (side->first->has({alpha})) continue;
    refuse(
        side->where,
        "its pictures have no alpha, and the other side's alpha is not 1 everywhere; --channels '" +
            names + "' compares without it");
  }
  return names + "," + alpha;
}

std::string as_name(const std::string& layer) {
  std::string name = "_" + (layer.empty() ? "picture" : layer);
  const auto is_other = [](unsigned char c) { return std::isalnum(c) == 0; };
  std::ranges::replace_if(name, is_other, '_');
  return name;
}

std::vector<Layer> layers_of(const std::string& patterns, const Pictures& candidate,
                             const Pictures& reference) {
  const auto layer = [&](const std::string& suffix, const std::string& channels) {
    return Layer{suffix, channels, recorded::choose_channels(*candidate.first, channels),
                 recorded::choose_channels(*reference.first, channels)};
  };
  if (patterns == "usual") return {layer("", usual_with_alpha(candidate, reference))};
  std::vector<std::pair<std::string, std::string>> found;  // layers and their channels
  for (const std::string& name : recorded::choose_channels(*candidate.first, patterns).names) {
    const std::string of = recorded::layer_of(name);
    if (found.empty() || found.back().first != of) {
      found.emplace_back(of, name);
    } else {
      found.back().second += "," + name;
    }
  }
  if (found.size() == 1) return {layer("", patterns)};
  return mapped(found, [&](const auto& each) { return layer(as_name(each.first), each.second); });
}

/// The window that both sides have on one canvas. nullopt if their windows are equal.
std::optional<PictureWindow> common_window(const Pictures& candidate, const Pictures& reference,
                                           const Layer& layer) {
  const PictureWindow a = candidate.first->window(layer.of_candidate.names);
  const PictureWindow b = reference.first->window(layer.of_reference.names);
  if (a == b) return {};
  const auto end = [](std::int64_t begin, std::size_t size) {
    return begin + static_cast<std::int64_t>(size);
  };
  const std::int64_t left = std::max(a.left, b.left);
  const std::int64_t top = std::max(a.top, b.top);
  const std::int64_t right = std::min(end(a.left, a.width), end(b.left, b.width));
  const std::int64_t bottom = std::min(end(a.top, a.height), end(b.top, b.height));
  if (candidate.first->canvas() == reference.first->canvas() && left < right && top < bottom) {
    return PictureWindow{left, top, static_cast<std::size_t>(right - left),
                         static_cast<std::size_t>(bottom - top)};
  }
  refuse(reference.where,
         "its pictures have {} x {} pixels at x {}, y {}, those of --candidate {} x {} at x {}, y "
         "{}; render the same part on both, at one size",
         b.width, b.height, b.left, b.top, a.width, a.height, a.left, a.top);
}

const char* rounding_of(const Pictures& candidate, const Pictures& reference, const Layer& layer) {
  std::set<Rounding> all;
  for (const auto& [side, channels] :
       {std::pair(&candidate, &layer.of_candidate), std::pair(&reference, &layer.of_reference)}) {
    for (const std::string& name : channels->names) {
      all.insert(side->first->channel(name).rounding);
    }
  }
  if (all.size() == 1) return "none";
  constexpr const char* words[] = {"none", "half", "png16", "png8"};
  return words[static_cast<std::size_t>(*all.rbegin())];
}

/// The parameters of either side's estimator.
std::vector<Value::Member> members_of(const ImagesArguments& arguments, const Pictures& candidate,
                                      const Pictures& reference, const Layer& layer,
                                      const std::string& file, const Location& where) {
  std::vector<Value::Member> members{member("file", file, where),
                                     member("channels", layer.channels, where)};
  if (const std::string rounding = rounding_of(candidate, reference, layer); rounding != "none") {
    members.push_back(member("rounded", rounding, where));
  }
  if (const auto crop = common_window(candidate, reference, layer)) {
    members.push_back(
        member("crop", fmt::format("{} {} {} {}", crop->left, crop->top, crop->width, crop->height),
               where));
  }
  if (arguments.mask) {
    members.push_back(member("mask", *arguments.mask, place("--mask", *arguments.mask)));
  }
  if (arguments.ignores_nonfinite) {
    members.push_back(member("finite", arguments.candidate + "," + arguments.reference, where));
  }
  return members;
}

/// Adds the error of one reference file that its channels tell.
void add_error(std::vector<Value::Member>& members, const ImagesArguments& arguments,
               const PictureFile& picture, const recorded::PictureChannels& channels,
               const Location& where) {
  const recorded::MomentChannels errors = recorded::usual_moments(picture, channels);
  if (errors.any()) {
    if (!arguments.samples && !picture.samples_per_pixel()) {
      refuse(where,
             "the picture has its variance but not its number of samples; give --samples, a number "
             "or the channel that counts them");
    }
    if (!errors.variance.empty()) members.push_back(member("variance", errors.variance, where));
    if (!errors.second_moment.empty()) {
      members.push_back(member("second_moment", errors.second_moment, where));
    }
    if (arguments.samples) members.push_back(member("samples", *arguments.samples, where));
  } else {
    if (arguments.samples) {
      refuse(place("--samples", *arguments.samples),
             "the reference has no channels `Variance.*` or `m2_*`, which it would be for");
    }
    members.push_back(member("exact", "true", where));
  }
}

TestEntry test_of(const ImagesArguments& arguments, const std::string& suffix) {
  std::string relation = "==";
  Margin margin;
  if (arguments.within) {
    margin = parse_margin(*arguments.within, place("--within", *arguments.within), "--within");
    relation = fmt::format("within {} of", *arguments.within);
  }
  const std::string claim =
      fmt::format("{0}(candidate{1}) {2} {0}(reference{1})", arguments.quantity, suffix, relation);
  TestEntry test = harness::test_of("images", claim, arguments.keys);
  test.claim.margin = margin;
  return test;
}

std::unique_ptr<const PictureFile> opened(const std::string& file, const Location& where) {
  try {
    return open_picture(file);
  } catch (const InputError& error) {
    refuse(where, "`" + file + "`: " + error.message());
  }
}

}  // namespace

void set_parameter(std::vector<Suite>& suites, const std::string& assignment) {
  for (const std::string& piece : split_outside_brackets(assignment)) {
    const Location where{"--set " + piece, 0, 0};
    const auto sides = cut(piece, '=');
    const auto path = sides ? cut(sides->first, '.') : std::nullopt;
    if (!path || path->first.empty() || path->second.empty()) {
      refuse(where, "expected estimator.key=value; put a value with commas in brackets or quotes");
    }
    const auto& [name, key] = *path;
    const Value value = read_flow(sides->second, where);
    std::vector<std::string> names;
    for (Suite& suite : suites) {
      for (EstimatorEntry& estimator : suite.estimators) {
        names.push_back(estimator.name);
        if (estimator.name == name) set_parameter(estimator, key, value, suite.scenes);
      }
    }
    if (std::ranges::count(names, name) > 0) continue;
    refuse(where, "no suite has an estimator `{}`{}", name, suggestion(name, names));
  }
}

EstimatorEntry parse_estimator_option(const std::string& text) {
  const Location where{"--estimator " + text, 0, 0};
  const std::vector<std::string> pieces = split_outside_brackets(text);
  const auto head = cut(pieces[0], '=');
  if (!head) {
    refuse(where, "the plugin needs a name, which the claim uses: `--estimator {}`",
           shell_quoted("x=" + text));
  }
  require_estimator_name(head->first, where);
  if (std::filesystem::is_regular_file(head->second)) refuse_file(where, head->first, head->second);
  std::vector<Value::Member> members{{"plugin", Value::scalar(head->second, where)}};
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const auto sides = cut(pieces[i], '=');
    if (!sides) {
      refuse(
          where,
          "`{}` is not key=value, as `file=a.txt`; put a value with commas in brackets or quotes",
          pieces[i]);
    }
    if (std::ranges::count(members, sides->first, &Value::Member::first) > 0) {
      refuse(where, "`{}` is given twice", sides->first);
    }
    members.emplace_back(sides->first, read_flow(sides->second, where));
  }
  return read_estimator({}, head->first, Value::map(std::move(members), where), {});
}

std::vector<EstimatorEntry> estimators_of(const std::vector<Source>& sources,
                                          const std::vector<std::string>& options,
                                          std::optional<std::uint64_t> primaries,
                                          const std::string& command) {
  std::vector<EstimatorEntry> given;
  std::string repeated = command;
  for (const std::string& option : options) {
    EstimatorEntry entry = parse_estimator_option(option);
    if (entry_named(given, entry.name)) {
      refuse(entry.where, "a second estimator named `{}`", entry.name);
    }
    given.push_back(std::move(entry));
    repeated += " --estimator " + shell_quoted(option);
  }
  std::vector<EstimatorEntry> used;
  for (const Source& source : sources) {
    if (entry_named(used, source.estimator)) continue;
    used.push_back(entry_for(source, given, repeated));
    if (primaries) used.back().primaries = primaries;
  }
  for (const EstimatorEntry& entry : given) {
    if (entry_named(used, entry.name)) continue;
    refuse(entry.where, "the claim names {1}, not `{0}`: name `{0}` there, or leave the option out",
           entry.name, quoted(mapped(used, &EstimatorEntry::name)));
  }
  return used;
}

TestEntry test_of(const std::string& command, const std::string& claim, const TestKeys& keys) {
  const Location where{"claim", 1, 1};
  TestEntry test{.claim = parse_claim(claim, where), .where = where};
  test.name = test.claim.text;
  test.id = command + "/" + test.name;
  std::vector<Value::Member> given;
  for (const auto& [key, text] : keys) {
    const Location place{fmt::format("--{} {}", key, text), 0, 0};
    given.emplace_back(key, key == "over" ? read_flow(text, place) : Value::scalar(text, place));
  }
  read_test_keys({}, Value::map(std::move(given)), test);
  return test;
}

Suite suite_of_claim(const CheckArguments& arguments) {
  TestEntry test = test_of("check", arguments.claim, arguments.keys);
  Suite suite{.name = "check", .stem = "check", .folder = "."};
  suite.estimators = estimators_of(sources_of(test), arguments.estimators, arguments.primaries,
                                   "assay check " + shell_quoted(arguments.claim));
  suite.tests.push_back(std::move(test));
  return suite;
}

Suite suite_of_images(const ImagesArguments& arguments) {
  test_of(arguments, "");
  Pictures candidate = pictures_of("--candidate", arguments.candidate);
  require_enough(candidate);
  Pictures reference = pictures_of("--reference", arguments.reference);
  const bool one = reference.files.size() == 1;
  if (!one && arguments.samples) {
    refuse(place("--samples", *arguments.samples),
           "is for a single reference picture with its variance; several pictures show their own");
  }
  if (!one) require_enough(reference);
  if (one && (arguments.quantity != "mean" || arguments.keys.contains("paired"))) {
    refuse(reference.where,
           "a single picture is a mean, so its pairs and its law are unknown; give as many "
           "pictures as of the candidate");
  }
  if (arguments.mask) opened(*arguments.mask, place("--mask", *arguments.mask));
  for (Pictures* side : {&candidate, &reference}) side->first = opened(side->files[0], side->where);
  Suite suite{.name = "images", .stem = "images", .folder = "."};
  for (const Layer& layer : layers_of(arguments.channels, candidate, reference)) {
    const auto add = [&](const char* name, const std::string& file, const Location& where,
                         bool is_mean) {
      std::vector<Value::Member> members =
          members_of(arguments, candidate, reference, layer, file, where);
      if (is_mean) {
        add_error(members, arguments, *reference.first, layer.of_reference, where);
      } else if (arguments.independent_pixels) {
        members.push_back(member("pixels", "independent", where));
      }
      suite.estimators.push_back({.name = name + layer.suffix,
                                  .plugin = "recorded",
                                  .parameters = Value::map(std::move(members), where),
                                  .where = where});
    };
    add("candidate", arguments.candidate, candidate.where, false);
    add("reference", one ? reference.files[0] : arguments.reference, reference.where, one);
    suite.tests.push_back(test_of(arguments, layer.suffix));
  }
  return suite;
}

}  // namespace assay::harness
