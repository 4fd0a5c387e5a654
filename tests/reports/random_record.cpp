#include "tests/reports/random_record.h"

#include <limits>
#include <vector>

#include "reports/record/record.h"

namespace assay::reports {

rc::Gen<double> any_double() {
  using Limits = std::numeric_limits<double>;
  return rc::gen::oneOf(
      rc::gen::arbitrary<double>(),
      rc::gen::element(0.0, -0.0, 1.0, 0.1, 1e-300, -3e305, Limits::max(), Limits::lowest(),
                       Limits::min(), Limits::denorm_min(), Limits::infinity(), -Limits::infinity(),
                       Limits::quiet_NaN()));
}

rc::Gen<std::string> any_text() {
  return rc::gen::oneOf(rc::gen::container<std::string>(rc::gen::arbitrary<char>()),
                        rc::gen::element<std::string>(
                            "", "area", "a/b", std::string("\0\x1b[2J\r\n\t", 8), "光線追跡",
                            "e\u0301", "\xF0\x9F\x8E\xB2", "\xED\xA0\x80", "\xC3", "]]>", "<!--",
                            "\"'&<>", "| a | * _ ` ~~~ ```", "\u202Eabc", std::string(300, 'x'),
                            std::string(90, ' '), "'quote \"in", "ln variance ratio"));
}

namespace {

/// Fills every member of a record that the JSON form has.
class Randomise {
 public:
  template <has_fields T>
  static void fill(T& value) {
    for_each_field(value, [](std::string_view, auto& field) { fill(field); });
  }

 private:
  static void fill(double& value) { value = *any_double(); }
  static void fill(std::string& value) { value = *any_text(); }
  static void fill(bool& value) { value = *rc::gen::arbitrary<bool>(); }
  static void fill(int& value) { value = *rc::gen::arbitrary<int>(); }
  static void fill(std::uint64_t& value) { value = *rc::gen::arbitrary<std::uint64_t>(); }
  static void fill(Verdict& value) {
    value = *rc::gen::element(Verdict::pass, Verdict::fail, Verdict::inconclusive, Verdict::invalid,
                              Verdict::error, Verdict::skipped);
  }
  static void fill(Number& value) {
    value.reset();
    if (*rc::gen::arbitrary<bool>()) value = *any_double();
  }
  template <class T>
  static void fill(std::vector<T>& values) {
    values.resize(*rc::gen::inRange<std::size_t>(0, 3));
    for (T& value : values) fill(value);
  }
  // Gives a map as many numbers as elements.
  static void fill(Map& map) {
    fill<Map>(map);
    map.width = *rc::gen::inRange<std::uint64_t>(0, 4);
    map.height = *rc::gen::inRange<std::uint64_t>(0, 4);
    map.texels.values.resize(map.width * map.height * map.components.size());
    for (float& value : map.texels.values) value = static_cast<float>(*any_double());
  }
  static void fill(Texels&) {}
  template <class T>
  static void fill(std::optional<T>& value) {
    value.reset();
    if (*rc::gen::arbitrary<bool>()) fill(value.emplace());
  }
};

}  // namespace

Record random_record() {
  Record record;
  Randomise::fill(record);
  record.schema = schema_version;
  return record;
}

}  // namespace assay::reports
