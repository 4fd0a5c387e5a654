// Observations that another program made, or Assay itself earlier: observation i is row i of a text
// file (recorded/table.h). Nothing is known of their mean. `primaries` is 1: what one row was made
// from is the other program's affair.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>

#include "estimators/estimator.h"
#include "recorded/table.h"

namespace assay::plugins {

namespace {

using SharedTable = std::shared_ptr<const recorded::Table>;

/// Which columns are channels: `count` of them from `first`.
struct Selection {
  std::size_t first = 0;
  std::size_t count = 1;
};

class Recorded final : public Estimator {
 public:
  Recorded(SharedTable table, Selection selection)
      : table_(std::move(table)), selection_(selection) {}

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    if (primaries != 1) throw std::invalid_argument("recorded: `primaries` must be 1");
    const std::uint64_t row = random.observation();
    if (row >= table_->rows()) {
      throw std::out_of_range("recorded: there is no observation " + std::to_string(row) +
                              ", the file has " + std::to_string(table_->rows()) + " rows");
    }
    const double* const begin =
        table_->values.data() + row * table_->columns.size() + selection_.first;
    std::copy_n(begin, selection_.count, out.begin());
    cost.samples += 1;
  }

 private:
  SharedTable table_;
  Selection selection_;
};

class RecordedSetup final : public Setup {
 public:
  RecordedSetup(SharedTable table, Selection selection, std::string file)
      : table_(std::move(table)), selection_(selection), file_(std::move(file)) {}

  std::vector<Channel> channels() const override {
    std::vector<Channel> channels;
    for (std::size_t i = 0; i < selection_.count; ++i) {
      channels.push_back({.name = table_->columns[selection_.first + i]});
    }
    return channels;
  }
  std::unique_ptr<Estimator> make() const override {
    return std::make_unique<Recorded>(table_, selection_);
  }
  std::optional<std::uint64_t> observations() const override { return table_->rows(); }
  std::string data_file() const override { return file_; }
  std::optional<StreamKey> data_stream() const override {
    if (!table_->stream) return {};
    return StreamKey{*table_->stream};
  }

 private:
  SharedTable table_;
  Selection selection_;
  std::string file_;
};

Selection select(const recorded::Table& table, Parameters& parameters) {
  const std::string column = parameters.string("column");
  if (!parameters.given("column")) return {0, table.columns.size()};
  const auto found = std::ranges::find(table.columns, column);
  if (found == table.columns.end()) {
    std::string known;
    for (const std::string& name : table.columns) {
      known += (known.empty() ? "`" : ", `") + name + "`";
    }
    const std::string near = nearest(column, table.columns);
    parameters.refuse("column",
                      "must be a column of the file, but it is `" + column + "`; " +
                          (near.empty() ? "there is: " + known : "did you mean `" + near + "`?"));
  }
  return {static_cast<std::size_t>(found - table.columns.begin()), 1};
}

recorded::Table read(Parameters& parameters) {
  const std::string file = parameters.file("file");
  try {
    return recorded::read_table(file);
  } catch (const InputError& error) {
    // A file that cannot be used at all is a mistake of the suite; what stands in it, of the file.
    if (error.where().line != 0) throw;
    parameters.refuse("file", "is `" + file + "`: " + error.message());
  }
}

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  for (const char* of_run : {"run", "estimator"}) {
    parameters.string(of_run);
    if (parameters.given(of_run)) {
      parameters.refuse(of_run, "is of moments of a run, which have no rows");
    }
  }
  if (!parameters.given("file")) {
    parameters.refuse("file", "is missing; give it, or `run` and `estimator`");
  }
  const auto table = std::make_shared<const recorded::Table>(read(parameters));
  return std::make_shared<RecordedSetup>(
      table, select(*table, parameters),
      std::filesystem::weakly_canonical(parameters.file("file")).string());
}

}  // namespace

std::vector<Entry> recorded_recorded() {
  return {{{.name = "recorded",
            .summary = "Observations from a text file, one a line, or moments of a saved run.",
            .description =
                "Observation i is row i of `file`. Numbers are separated by white space or commas, "
                "`#` begins a comment, and `# columns: a b c` names the columns, each of which is "
                "a channel unless `column` picks one. Every row needs the same number of numbers; "
                "`nan` and `inf` are read as such. What a row was made from is not known here: "
                "`primaries` stays 1.\n\n"
                "With `run`, a saved run's record, and `estimator` nothing is drawn: the source is "
                "the moments that a test of the run kept of that estimator, with its primaries. "
                "They answer claims on mean, bias, variance, cost and efficiency, so that a run is "
                "the reference of the next one. The other side takes as many observations as the "
                "run has, from a stream that the run has not used.",
            .parameters = {{.name = "file",
                            .type = ParameterType::string,
                            .summary = "the file of rows, relative to the suite",
                            .fallback = "none"},
                           {.name = "column",
                            .type = ParameterType::string,
                            .summary = "the one column to use; all of them when absent",
                            .fallback = "all"},
                           {.name = "run",
                            .type = ParameterType::string,
                            .summary = "instead of a file of rows: a saved run, whose moments are "
                                       "used",
                            .fallback = "none"},
                           {.name = "estimator",
                            .type = ParameterType::string,
                            .summary = "which of the run's estimators; may be left out where it "
                                       "has one",
                            .fallback = "the only one"}},
            .averages = false},
           prepare}};
}

}  // namespace assay::plugins
