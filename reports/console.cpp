#include "reports/console.h"

#include <fmt/format.h>

#include <algorithm>

#include "reports/columns.h"
#include "reports/describe.h"
#include "reports/number.h"
#include "reports/text.h"

namespace assay::reports {
namespace {

constexpr int least_width = 60;
constexpr int label_width = 17;
constexpr int verdict_width = 12;
constexpr int number_width = 33;
constexpr int cost_width = 12;
constexpr std::size_t name_lines = 3;

// A terminal renders a no-break space in its own way: copied text should hold plain ones.
std::string plain_spaces(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const char32_t c = next_code_point(text, i);
    append_code_point(result, c == 0xA0 ? U' ' : c);
  }
  return result;
}

std::string plain(const std::string& text) { return plain_spaces(one_line(text)); }

const char* colour_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::passed:
      return "\x1b[32m";
    case Outcome::failed:
      return "\x1b[1;31m";
    case Outcome::inconclusive:
      return "\x1b[33m";
    case Outcome::skipped:
      break;
  }
  return "\x1b[2m";
}

class Screen {
 public:
  explicit Screen(ConsoleOptions options) : options_(options) {
    options_.width = std::max(options_.width, least_width);
  }

  void run(const Record& record) {
    for (const Suite& suite : record.suites) write(suite);
    if (!record.note.empty()) paragraph(record.note);
    summary(record);
  }
  std::string take() { return std::move(out_); }

 private:
  void line(const std::string& text) { out_ += shorten(text, options_.width) + "\n"; }

  void line(const std::string& text, const char* style) {
    out_ += options_.colour ? style + shorten(text, options_.width) + "\x1b[0m\n"
                            : shorten(text, options_.width) + "\n";
  }

  void paragraph(const std::string& text) {
    for (const std::string& part : wrapped(text, options_.width)) line(part);
  }

  // No-break spaces keep numbers and units together until the lines are made.
  static std::vector<std::string> wrapped(const std::string& text, int width) {
    std::vector<std::string> lines = wrap(clean(text), width);
    for (std::string& part : lines) part = plain_spaces(part);
    return lines;
  }

  // A label in a column of its own, then lines beside it.
  void beside(const std::string& label, const std::vector<std::string>& lines) {
    std::string first = pad_right("      " + label, label_width + 6);
    for (const std::string& part : lines) {
      line(first + part);
      first.assign(static_cast<std::size_t>(label_width + 6), ' ');
    }
  }

  int beside_width() const { return options_.width - label_width - 6; }

  void fact(const std::string& label, const std::string& text) {
    if (!text.empty()) beside(label, wrapped(text, beside_width()));
  }

  void write(const Suite& suite) {
    const std::string file = suite.file.empty() ? "" : " (" + suite.file + ")";
    line(plain(suite.name + file), "\x1b[1m");
    if (!suite.about.empty()) paragraph(suite.about);
    paragraph(levels_text(suite));
    out_ += "\n";
    if (options_.verbose) estimators(suite);
    for (const Test& test : suite.tests) write(test);
    out_ += "\n";
  }

  void write(const Test& test) {
    const Outcome result = outcome(test);
    std::string start = "  " + mark(result) + " ";
    start += pad_right(to_string(test.verdict), verdict_width) + " ";
    const int room = options_.width - columns(start) - number_width - cost_width - 2;
    std::vector<std::string> name = wrapped(one_line(test.name), std::max(room, 8));
    while (name.size() > name_lines) {
      name[name.size() - 2] = shorten(name[name.size() - 2] + " " + name.back(), std::max(room, 8));
      name.pop_back();
    }
    const std::string number =
        pad_right(shorten(plain(key_number(test)), number_width), number_width);
    const std::string cost = shorten(plain(cost_text(total_cost(test))), cost_width);
    std::string text = start + pad_right(name.front(), room) + " " + number + " " + cost;
    text.erase(text.find_last_not_of(' ') + 1);
    line(text, colour_of(result));
    const std::string below(static_cast<std::size_t>(columns(start)), ' ');
    for (std::size_t i = 1; i < name.size(); ++i) line(below + name[i], colour_of(result));
    if (result == Outcome::failed || result == Outcome::inconclusive || options_.verbose)
      explain(test);
  }

  void explain(const Test& test) {
    for (const auto& [label, sentence] : facts(test)) fact(label, sentence);
    fact("where", place(test));
    if (!test.replay.empty()) beside("replay", wrap_command(plain(test.replay), beside_width()));
    out_ += "\n";
  }

  void estimators(const Suite& suite) {
    for (const EstimatorSummary& estimator : suite.estimators) {
      line(plain("  " + estimator.name + "  " + estimator.plugin + "  " +
                 cost_text(estimator.cost)));
      for (const EstimatorChannel& channel : estimator.channels) {
        fact(one_line(shorten(clean(channel.name), label_width - 1)),
             fmt::format("mean {}, variance {}", interval(channel.mean),
                         interval(channel.variance)));
      }
    }
    if (!suite.estimators.empty()) out_ += "\n";
  }

  static std::string interval(const Estimate& estimate) {
    return fmt::format("{} [{}, {}]", human(estimate.value), human(estimate.low),
                       human(estimate.high));
  }

  void list(const Record& record, Outcome kind, const std::string& heading) {
    bool first = true;
    for (const Suite& suite : record.suites) {
      for (const Test& test : suite.tests) {
        if (outcome(test) != kind) continue;
        if (first) line(heading, colour_of(kind));
        first = false;
        line("  " + plain(verdict_text(test) + ": " + (test.id.empty() ? test.name : test.id)));
      }
    }
  }

  void summary(const Record& record) {
    const Tally counts = tally(record);
    list(record, Outcome::failed, "Not ok:");
    list(record, Outcome::inconclusive, "Undecided:");
    line(tally_sentence(counts) +
         (record.seconds > 0 ? " in " + plain(duration(record.seconds)) : ""));
    if (counts.inconclusive > 0)
      line(fmt::format("{} inconclusive (counted as skipped below)", counts.inconclusive));
    out_ += fmt::format("{} passed, {} failed, {} skipped\n", counts.passed, counts.failed,
                        counts.skipped + counts.inconclusive);
  }

  ConsoleOptions options_;
  std::string out_;
};

}  // namespace

std::string console(const Record& record, ConsoleOptions options) {
  Screen screen(options);
  screen.run(record);
  return screen.take();
}

}  // namespace assay::reports
