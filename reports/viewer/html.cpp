#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "reports/formats/base64.h"
#include "reports/report_formats.h"
#include "reports/viewer/page.h"
#include "reports/words/display.h"
#include "reports/words/text.h"

namespace assay::reports {
namespace {

constexpr std::size_t small = std::size_t{1} << 14;  // numbers of a map that is kept as it is
constexpr int most = 32767;                          // of a code

/// The way a map's numbers become codes.
struct Coding {
  const char* name;
  double step;
  bool differences;  ///< Codes are stored less their left neighbours, which are alike in pictures.
  int (*code)(double value, double step);
};

int linear(double value, double step) {
  if (std::isnan(value)) return 0;
  return static_cast<int>(std::lround(std::clamp(value / step, -1.0 * most, 1.0 * most)));
}

/// 1 and above; 0 where there is no logarithm.
int logarithmic(double value, double step) {
  if (!(value > 0)) return 0;
  const double code = std::log2(std::min(value, 1e38)) / step + most / 4.0;
  return static_cast<int>(std::lround(std::clamp(code, 1.0, most / 2.0)));
}

constexpr std::array codings = {Coding{"linear", 0.125, false, linear},
                                Coding{"logarithm", 1.0 / 24, true, logarithmic}};

/// The low bytes of all codes, then the high ones, component by component: both compress well.
std::string plane(const Map& map, const Coding& coding) {
  const std::size_t components = map.components.size();
  const std::size_t pixels = map.texels.values.size() / components;
  std::string bytes(2 * map.texels.values.size(), '\0');
  for (std::size_t c = 0, at = 0; c < components; ++c) {
    int before = 0;
    for (std::size_t i = 0; i < pixels; ++i, ++at) {
      const double value = static_cast<double>(map.texels.values[i * components + c]);
      const int code = coding.code(value, coding.step);
      const int change = coding.differences ? code - before : code;
      // Small numbers of either sign become small numbers.
      const auto stored = static_cast<std::uint16_t>(change < 0 ? -2 * change - 1 : 2 * change);
      before = code;
      bytes[at] = static_cast<char>(stored & 255);
      bytes[map.texels.values.size() + at] = static_cast<char>(stored >> 8);
    }
  }
  return bytes;
}

/// The record's JSON with six significant digits: the viewer shows no more.
nlohmann::ordered_json brief(const Record& record) {
  using Json = nlohmann::ordered_json;
  return Json::parse(compact_json(record), [](int, Json::parse_event_t, Json& value) {
    if (value.is_number_float()) {
      const std::string digits = fmt::format("{:.6g}", value.get<double>());
      value = std::strtod(digits.c_str(), nullptr);
    }
    return true;
  });
}

/// How many pixels a side become one, so that a page stays small.
std::uint64_t reduction(const Map& map) {
  constexpr std::uint64_t most_pixels = std::uint64_t{1} << 21;
  std::uint64_t factor = 1;
  while (map.width * map.height > most_pixels * factor * factor) ++factor;
  return factor;
}

/// Means over squares of pixels, cut at the edges. A mean of z is scaled to have z's own spread.
Map reduced(const Map& map, std::uint64_t factor) {
  if (factor == 1) return map;
  Map means = map;
  means.width = (map.width + factor - 1) / factor;
  means.height = (map.height + factor - 1) / factor;
  const std::size_t components = map.components.size();
  std::vector<double> sums(means.width * means.height * components), counts(sums.size());
  for (std::size_t i = 0; i < map.texels.values.size(); ++i) {
    const std::size_t pixel = i / components;
    const std::size_t x = pixel % map.width / factor, y = pixel / map.width / factor;
    const std::size_t at = (y * means.width + x) * components + i % components;
    sums[at] += static_cast<double>(map.texels.values[i]);
    ++counts[at];
  }
  means.texels.values.resize(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double divisor = map.name == "z" ? std::sqrt(counts[i]) : counts[i];
    means.texels.values[i] = static_cast<float>(sums[i] / divisor);
  }
  return means;
}

/// The title of a map that the viewer shows; it does not show variances.
std::string title_of(const Map& map) {
  if (map.name == "mean" || map.name == "other_mean") return "mean of " + map.source;
  static const std::map<std::string_view, const char*> titles{
      {"z", "signed z"},
      {"reference", "reference"},
      {"cells_observed", "Draws in each cell"},
      {"cells_expected", "Draws expected"},
      {"cells_z", "Drawn - expected, in standard deviations"}};
  const auto title = titles.find(map.name);
  return title == titles.end() ? "" : title->second;
}

std::string bytes_of_length(std::size_t length) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(length >> shift & 255);
  return bytes;
}

/// The bytes as zlib data: the same bytes give the same text.
std::vector<std::uint8_t> compressed(std::string_view bytes) {
  uLongf length = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(length);
  if (compress2(out.data(), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib has no memory to compress the page");
  out.resize(length);
  return out;
}

/// The viewer's page of these bytes. `title` and `tables` are plain text.
std::string page_of(const std::string& title, const std::string& tables, std::string_view bytes) {
  std::string page;
  std::string_view rest = viewer_page;
  // The places of the page's own text, in their order.
  const auto put = [&](std::string_view place, const std::string& text) {
    const std::size_t at = rest.find(place);
    page += rest.substr(0, at);
    page += text;
    rest.remove_prefix(at + place.size());
  };
  put("{{title}}", escape_xml(one_line(title)));
  put("{{markdown}}", escape_xml(tables));
  put("{{record}}", base64(compressed(bytes)));
  return page + std::string(rest);
}

}  // namespace

std::string packed(Record record) {
  nlohmann::ordered_json pictures = nlohmann::ordered_json::array();
  std::string planes;
  for (Suite& suite : record.suites) {
    for (Test& test : suite.tests) {
      for (const Map& whole_map : test.maps) {
        const std::string title = title_of(whole_map);
        if (title.empty() || whole_map.components.empty()) continue;
        const std::uint64_t factor = reduction(whole_map);
        const Map map = reduced(whole_map, factor);
        const bool whole = map.texels.values.size() <= small;
        const Coding& coding = codings[map.name == "z" ? 0 : 1];
        const auto floats = bytes_of(map.texels.values);
        const std::string bytes =
            whole ? std::string(floats.begin(), floats.end()) : plane(map, coding);
        std::vector<std::string> components;
        for (const std::string& name : map.components) components.push_back(clean(name));
        pictures.push_back({{"test", clean(test.id)},
                            {"name", clean(map.name)},
                            {"title", clean(title)},
                            {"width", map.width},
                            {"height", map.height},
                            {"reduced", factor},
                            {"components", components},
                            {"coding", whole ? "float" : coding.name},
                            {"step", coding.step},
                            {"zero", most / 4.0},
                            {"start", planes.size()},
                            {"length", bytes.size()}});
        planes += bytes;
      }
      test.maps.clear();
    }
  }
  record.shard.reset();
  const std::string text =
      "{\"record\":" + brief(record).dump() + ",\"pictures\":" + pictures.dump() + "}";
  return bytes_of_length(text.size()) + text + planes;
}

std::string packed(const Calibration& calibration) {
  const std::string text =
      fmt::format("{{\"calibration\":{},\"title\":{},\"sound\":{},\"text\":{}}}", json(calibration),
                  nlohmann::json(clean(verdict_sentence(calibration))).dump(),
                  defects(calibration) == 0, nlohmann::json(clean(console(calibration))).dump());
  return bytes_of_length(text.size()) + text;
}

std::string html(const Record& record) {
  return page_of("Assay: " + run_sentence(record), markdown(record), packed(record));
}

std::string html(const Calibration& calibration) {
  return page_of("Assay: calibration, " + verdict_sentence(calibration), console(calibration),
                 packed(calibration));
}

}  // namespace assay::reports
