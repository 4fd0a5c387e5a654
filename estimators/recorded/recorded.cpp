#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "estimators/estimator.h"
#include "estimators/ready_made.h"
#include "recorded/byte_source.h"
#include "recorded/picture_setup.h"
#include "recorded/table.h"

namespace assay::plugins {

namespace {

using SharedTable = std::shared_ptr<const recorded::Table>;

/// A table and where it came from.
struct Reading {
  SharedTable table;
  std::string source;
};

/// Which columns are channels: `count` of them from `first`.
struct Selection {
  std::size_t first = 0;
  std::size_t count = 1;
};

class RecordedSetup final : public Setup {
 public:
  RecordedSetup(Reading reading, Selection selection)
      : table_(std::move(reading.table)), selection_(selection), file_(std::move(reading.source)) {}

  std::size_t channel_count() const override { return selection_.count; }
  Channel channel(std::size_t place) const override {
    return {.name = table_->columns[selection_.first + place]};
  }
  std::unique_ptr<Estimator> make() const override {
    return estimating([table = table_, selection = selection_](Stream& random,
                                                               std::uint64_t primaries,
                                                               std::span<double> out, Cost& cost) {
      if (primaries != 1) throw std::invalid_argument("recorded: `primaries` must be 1");
      const std::uint64_t row = random.observation();
      if (row >= table->rows()) {
        throw std::out_of_range("recorded: there is no observation " + std::to_string(row) +
                                ", the file has " + std::to_string(table->rows()) + " rows");
      }
      const double* const begin =
          table->values.data() + row * table->columns.size() + selection.first;
      std::copy_n(begin, selection.count, out.begin());
      cost.samples += 1;
    })();
  }
  std::optional<std::uint64_t> observations() const override { return table_->rows(); }
  std::string data_file() const override { return file_; }
  std::string place_of(const WhichObservation& which) const override {
    if (which.index >= table_->rows()) return "";
    // An array has no lines: its rows are counted as numpy does.
    return table_->lines.empty() ? file_ + "[" + std::to_string(which.index) + "]"
                                 : file_ + ":" + std::to_string(table_->lines[which.index]);
  }
  std::optional<std::uint64_t> data_digest() const override { return table_->digest(); }
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
    parameters.refuse(
        "column", "must be a column of the file, but it is `" + column + "`" +
                      did_you_mean(column, table.columns, "there is: " + quoted(table.columns)));
  }
  return {static_cast<std::size_t>(found - table.columns.begin()), 1};
}

/// `-` is no file of the suite's folder.
std::string named_file(Parameters& parameters) {
  const std::string file = parameters.string("file");
  return recorded::is_standard_input(file) ? file : parameters.file("file");
}

/// Reads a table; what can be read but once, once for all estimators that name it.
Reading read(const std::string& file) {
  const auto table_of = [&] {
    return std::make_shared<const recorded::Table>(
        recorded::read_table(file, recorded::Rows::several));
  };
  struct stat status {};
  const bool standard = recorded::is_standard_input(file);
  const int failed = standard ? fstat(0, &status) : stat(file.c_str(), &status);
  if (failed != 0 || !recorded::is_read_once(file)) {
    return {table_of(), std::filesystem::weakly_canonical(file).string()};
  }
  static std::mutex mutex;
  static std::map<std::pair<dev_t, ino_t>, Reading> readings;
  const std::lock_guard lock(mutex);
  Reading& reading = readings[{status.st_dev, status.st_ino}];
  if (reading.table == nullptr) {
    reading = {table_of(), standard && S_ISREG(status.st_mode)
                               ? std::filesystem::weakly_canonical("/dev/stdin").string()
                               : recorded::called(file)};
  }
  return reading;
}

Reading read(Parameters& parameters) {
  const std::string file = named_file(parameters);
  try {
    return read(file);
  } catch (const InputError& error) {
    // A file that cannot be used at all is a mistake of the suite; what stands in it, of the file.
    if (error.where().line != 0) throw;
    throw InputError(parameters.where("file"),
                     "`" + recorded::called(file) + "`: " + error.message());
  }
}

// ---- Pictures

struct PictureRequest {
  std::string pattern;
  std::string channels;
  bool independent;
  bool exact;
  recorded::MomentChannels errors;
  recorded::PictureTreatment treatment;
};

/// "LEFT TOP WIDTH HEIGHT".
std::optional<PictureWindow> crop_of(Parameters& parameters) {
  std::istringstream text(parameters.string("crop"));
  if (!parameters.given("crop")) return {};
  PictureWindow crop;
  std::string more;
  if (!(text >> crop.left >> crop.top >> crop.width >> crop.height) || text >> more) {
    parameters.refuse("crop", "must be left, top, width and height, as in `crop: 64 32 640 480`");
  }
  return crop;
}

PictureRequest picture_request(Parameters& parameters) {
  const auto given = [&](const char* name) {
    const std::string text = parameters.string(name);
    return parameters.given(name) ? text : std::string();
  };
  return {.pattern = named_file(parameters),
          .channels = parameters.string("channels"),
          .independent = parameters.string("pixels") == "independent",
          .exact = parameters.boolean("exact"),
          .errors = {.variance = given("variance"),
                     .second_moment = given("second_moment"),
                     .samples = given("samples")},
          .treatment = {.rounding = parameters.choice<Rounding>("rounded"),
                        .crop = crop_of(parameters),
                        .mask = given("mask").empty() ? "" : parameters.file("mask"),
                        .finite = given("finite")}};
}

/// Reports an error of a file at the parameter that names it.
template <class Read>
auto reading(const Parameters& parameters, const PictureRequest& request, const Read& read) {
  try {
    return read();
  } catch (const InputError& error) {
    const bool of_mask = error.where().file == request.treatment.mask;
    parameters.refuse(of_mask ? "mask" : "file",
                      "is `" + error.where().file + "`: " + error.message());
  }
}

/// One file that is a mean with its error.
std::shared_ptr<const Setup> prepare_reference(const Parameters& parameters,
                                               const PictureRequest& request,
                                               const std::vector<std::string>& files) {
  const recorded::MomentChannels& errors = request.errors;
  parameters.require(files.size() == 1, "file",
                     "names " + std::to_string(files.size()) +
                         " files, but a mean with its error must be one file");
  parameters.require(errors.variance.empty() || errors.second_moment.empty(), "second_moment",
                     "is given beside `variance`; leave one of them out");
  parameters.require(!request.exact || !errors.any(), "exact",
                     "is given beside a variance: a mean is exact or has an error");
  return recorded::reference_setup(reading(parameters, request, [&] {
    return recorded::read_moments(files[0], request.channels, errors, request.treatment);
  }));
}

std::shared_ptr<const Setup> prepare_pictures(const Parameters& parameters,
                                              const PictureRequest& request) {
  parameters.require(!parameters.given("column"), "column",
                     "is for text files; for pictures use `channels`");
  std::vector<std::string> files =
      reading(parameters, request, [&] { return recorded::files_of(request.pattern); });
  if (request.exact || request.errors.any()) return prepare_reference(parameters, request, files);
  parameters.require(request.errors.samples.empty(), "samples",
                     "needs `variance` or `second_moment` beside it");
  recorded::PictureStack stack = reading(parameters, request, [&] {
    return recorded::open_stack(std::move(files), request.channels, request.treatment);
  });
  return recorded::picture_setup(std::move(stack), request.independent,
                                 std::filesystem::weakly_canonical(request.pattern).string());
}

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  for (const char* of_run : {"run", "estimator"}) {
    parameters.string(of_run);
    parameters.require(!parameters.given(of_run), of_run,
                       "is for moments of a run, which have no rows");
  }
  parameters.require(parameters.given("file"), "file", "is needed, or `run` and `estimator`");
  const PictureRequest request = picture_request(parameters);
  parameters.string("column");
  if (recorded::names_pictures(request.pattern)) return prepare_pictures(parameters, request);
  for (const char* const name : {"channels", "pixels", "exact", "variance", "second_moment",
                                 "samples", "rounded", "crop", "mask", "finite"}) {
    parameters.require(!parameters.given(name), name, "is for pictures, and `file` names none");
  }
  const Reading reading = read(parameters);
  return std::make_shared<RecordedSetup>(reading, select(*reading.table, parameters));
}

}  // namespace

std::vector<Entry> recorded_recorded() {
  return {
      {{.name = "recorded",
        .summary = "Observations from rows of text, an array of numpy or pictures, or moments of a "
                   "saved run.",
        .description =
            "Observation i is row i of `file`: a text, a CSV, or an array that numpy saved (.npy), "
            "also packed by gzip. `-` is standard input. A pipe, `<(program)`, or a device works "
            "too. These are read once, for all estimators that name them, and cannot be replayed. "
            "Each column is a channel unless `column` chooses one. Files of unequal length are "
            "compared whole. An estimator beside a file takes as many observations as the file has "
            "rows. `primaries` stays 1, as Assay does not know how an observation was made.\n"
            "\n"
            "In a text `;`, commas, tabs or white space separate numbers. If `;` separates, a "
            "comma is a decimal point. A first line without numbers names the columns, and so does "
            "`# columns: a b c`. A first column of words names the rows and is left out. `#` "
            "begins a comment. Every row needs the same number of numbers, which may be `nan` and "
            "`inf`. An array has one or two dimensions, of float32, float64 or whole numbers.\n"
            "\n"
            "If `file` is a pattern, `out/*.exr`, observation i is the i-th picture by name, an "
            "image: OpenEXR of one part or several, scan lines or tiles, PFM or PNG. `channels` "
            "chooses among its channels; a layer or a part stands before a dot. PNG is converted "
            "from sRGB to linear light. Where a depth `Z` is infinite it counts as 0, and as 1 in "
            "a component `Z_infinite`. A picture of a mean that has its error, or is `exact`, is a "
            "reference: it can stand on the right of `mean(x) ==`. Its error is sqrt(variance / "
            "samples), from the channels that `variance` names (`Variance.*` of pbrt), or "
            "`second_moment` (`m2_*` of Mitsuba).\n"
            "\n"
            "With `run`, a saved run's record, and `estimator` nothing is drawn. The source is the "
            "moments that a test of the run kept of that estimator, with its primaries. They "
            "suffice for claims on mean, bias, variance, cost and efficiency, so a run can be the "
            "reference of the next one. The other side takes as many observations as the run has, "
            "from a stream that the run has not used.",
        .parameters =
            {text_parameter("file",
                            "the file of rows, `-` for standard input, or a pattern of pictures; "
                            "its path starts at the suite's folder",
                            "none"),
             text_parameter("column", "the column to use; without it all columns", "all"),
             text_parameter("channels",
                            "the channels of pictures to use, as patterns separated by commas; "
                            "without it R, G and B, or what stands for them",
                            "usual"),
             text_parameter("pixels",
                            "whether the pixels of a picture are independent, as under a box "
                            "filter one pixel wide",
                            "dependent", {"dependent", "independent"}),
             boolean_parameter("exact", "the picture is a reference that has no error", false),
             text_parameter("variance",
                            "the channels of a reference that hold the variance of a sample; `*` "
                            "stands for the channel's name",
                            "none"),
             text_parameter("second_moment", "the channels of a reference that hold second moments",
                            "none"),
             text_parameter("samples",
                            "how many samples a reference averages, a number or the channel that "
                            "counts them; without it what the file says",
                            "none"),
             text_parameter("rounded",
                            "round the numbers of pictures like the files that they are compared "
                            "with; PNG also clips to [0, 1]",
                            "none", {"none", "half", "png16", "png8"}),
             text_parameter("crop",
                            "left, top, width and height of the part of pictures to use, in pixels "
                            "of the whole",
                            "none"),
             text_parameter("mask",
                            "a picture of the pixels to use; where it is 0, pixels are left out",
                            "none"),
             text_parameter("finite",
                            "patterns of picture files, separated by commas; pixels that are not "
                            "finite in one of them are left out",
                            "none"),
             text_parameter("run", "a saved run whose moments are used, instead of a file", "none"),
             text_parameter("estimator", "which of the run's estimators to use, if it has several",
                            "the only one")},
        .averages = false},
       prepare}};
}

}  // namespace assay::plugins
