#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <thread>

#include "estimators/core/program_path.h"
#include "estimators/estimator.h"
#include "estimators/foreign/renderings.h"
#include "estimators/foreign/setup.h"
#include "recorded/picture_setup.h"
#include "recorded/table.h"

namespace assay::plugins {

namespace {

/// The contents of a rendering's files, learnt from one of them.
struct Contents {
  recorded::PictureStack pictures = {};   ///< of pictures: size and channels, and no files
  std::vector<std::string> columns = {};  ///< of text
  std::optional<ImageShape> shape = {};
  std::size_t size() const { return shape ? shape->elements() : columns.size(); }
};

[[noreturn]] void throw_useless(const InputError& error) {
  throw std::runtime_error("what the program wrote is of no use: " + to_string(error.where()) +
                           ": " + error.message() + "; mend the program and delete the file");
}

/// One observation from its file. A file that cannot be read is the program's failure.
void read_file(const Contents& contents, const std::string& file, std::vector<float>& texels,
               std::span<double> out) {
  try {
    if (contents.shape) {
      recorded::PictureStack picture = contents.pictures;
      picture.files = {file};
      texels.resize(contents.size());
      picture.read(0, texels);
      recorded::write_observation(texels, out);
      return;
    }
    const recorded::Table table = recorded::read_table(file, recorded::Rows::one_is_fine);
    if (table.rows() != 1 || table.columns.size() != contents.size()) {
      throw InputError({.file = file}, "one row of " + std::to_string(contents.size()) +
                                           " numbers was expected, as in the first file");
    }
    std::ranges::copy(table.values, out.begin());
  } catch (const InputError& error) {
    throw_useless(error);
  }
}

class Command final : public Estimator {
 public:
  Command(std::shared_ptr<foreign::Renderings> renderings, std::shared_ptr<const Contents> contents)
      : renderings_(std::move(renderings)), contents_(std::move(contents)) {}

  void announce(const Announcement& what) override { announced_ = what; }
  double seconds_elsewhere() const override { return seconds_; }

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    if (primaries != 1 && !renderings_->takes_samples()) {
      throw std::runtime_error(
          "its command has no place `{samples}`: `primaries: " + std::to_string(primaries) +
          "` would change nothing; give it the place, or leave it out");
    }
    const std::uint64_t index = random.observation();
    const std::uint64_t last = announced_.end_from(random.key(), index);
    seconds_ += renderings_->make(
        {.key = random.key(), .first = index, .last = last, .samples = primaries});
    if (last > index + 1) announced_ = {};  // once a block
    read_file(*contents_, renderings_->file(random.key(), index, primaries), texels_, out);
    cost.samples += primaries * (contents_->shape ? contents_->shape->pixels() : 1);
  }

 private:
  std::shared_ptr<foreign::Renderings> renderings_;
  std::shared_ptr<const Contents> contents_;
  Announcement announced_;
  double seconds_ = 0;         // of programs
  std::vector<float> texels_;  // scratch
};

class CommandSetup final : public Setup, public foreign::Rendered {
 public:
  CommandSetup(std::shared_ptr<foreign::Renderings> renderings, Contents contents)
      : renderings_(std::move(renderings)),
        contents_(std::make_shared<const Contents>(std::move(contents))) {}

  std::size_t channel_count() const override {
    return contents_->size() + (contents_->shape ? 1 : 0);
  }
  Channel channel(std::size_t place) const override {
    if (!contents_->shape) return {.name = contents_->columns[place]};
    return recorded::picture_channel(*contents_->shape, place);
  }
  std::optional<ImageShape> image() const override { return contents_->shape; }
  std::unique_ptr<Estimator> make() const override {
    return std::make_unique<Command>(renderings_, contents_);
  }
  std::string place_of(const WhichObservation& which) const override {
    return renderings_->path_of(which.key, which.index, which.primaries);
  }
  bool keeps_files() const override { return true; }
  std::vector<foreign::MissingFile> missing(StreamKey key, std::uint64_t count,
                                            std::uint64_t primaries) const override {
    return renderings_->missing(key, count, primaries);
  }
  std::vector<foreign::Retry> retries() const override { return renderings_->retries(); }

 private:
  std::shared_ptr<foreign::Renderings> renderings_;
  std::shared_ptr<const Contents> contents_;
};

struct Look {
  std::string channels;
  bool independent;
};

/// Renders one picture of one sample a pixel, with a seed of its own. Returns its file.
std::string make_one(foreign::Renderings& renderings) {
  const StreamKey key = stream_key(0, "command", "size", 0);
  renderings.make({.key = key, .first = 0, .last = 1, .samples = 1});
  return renderings.file(key, 0, 1);
}

/// Why no channels of a picture can be chosen; "" where they can.
std::string why_no_channels(const std::string& file, const std::string& channels) {
  if (!is_picture(file)) return "";
  const std::unique_ptr<const PictureFile> picture = open_picture(file);
  try {
    recorded::choose_channels(*picture, channels);
  } catch (const InputError& error) {
    return error.message();
  }
  return "";
}

Contents look_at(const std::string& file, const Look& look) {
  Contents contents;
  if (is_picture(file)) {
    contents.pictures = recorded::open_stack({file}, look.channels, {});
    contents.shape = contents.pictures.view.shape(look.independent);
    contents.pictures.files.clear();
  } else {
    contents.columns = recorded::read_table(file, recorded::Rows::one_is_fine).columns;
  }
  return contents;
}

/// A place that is nearly one of ours is a slip of the pen; other braces are the program's.
void check_places(const Parameters& parameters, const std::string& word) {
  static const std::vector<std::string> places{"{seed}", "{seeds}", "{samples}", "{out}"};
  for (std::size_t at = word.find('{'); at != word.npos; at = word.find('{', at + 1)) {
    const std::string place = word.substr(at, word.find('}', at) - at + 1);
    if (std::ranges::find(places, place) != places.end()) continue;
    const std::string near = nearest(place, places);
    if (near.empty()) continue;
    parameters.refuse("command", "has the place `" + place + "`; did you mean `" + near + "`?");
  }
}

void check_command(const Parameters& parameters, const std::vector<std::string>& command) {
  if (command.empty() || command[0].empty()) {
    parameters.refuse("command",
                      "names no program; as in `[render, --seed, \"{seed}\", \"{out}\"]`");
  }
  if (!foreign::has_place(command, "{seed}") && !foreign::has_place(command, "{seeds}")) {
    parameters.refuse("command", "has no place `{seed}`: every observation would be the same");
  }
  if (foreign::has_place(command, "{seed}") && foreign::has_place(command, "{seeds}")) {
    parameters.refuse("command", "has `{seed}` and `{seeds}`: one picture a program, or several");
  }
  if (!foreign::has_place(command, "{out}")) {
    parameters.refuse("command", "has no place `{out}` for the file to write");
  }
  for (const std::string& word : command) check_places(parameters, word);
  if (program_path(command[0], parameters.folder()).empty()) {
    parameters.refuse("command", "names the program `" + command[0] +
                                     "`, which cannot be started: there is none" +
                                     foreign::mend_of_program(command[0]));
  }
}

std::string ending_of(const std::string& output) { return output == "text" ? "txt" : output; }

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  foreign::Rendering rendering{.command = parameters.texts("command"),
                               .depends = parameters.texts("depends"),
                               .folder = parameters.folder().empty() ? "." : parameters.folder(),
                               .cache = parameters.file("cache"),
                               .ending = ending_of(parameters.string("output")),
                               .timeout = parameters.number("timeout"),
                               .retries = parameters.count("retries"),
                               .memory = parameters.number("memory"),
                               .jobs = parameters.count("jobs")};
  check_command(parameters, rendering.command);
  if (rendering.jobs == 0) {
    rendering.jobs = std::max(1U, std::thread::hardware_concurrency());
  }
  const Look look{parameters.string("channels"), parameters.string("pixels") == "independent"};
  rendering.cache = std::filesystem::absolute(rendering.cache).string();
  std::string why;
  std::string file;
  try {
    auto renderings = std::make_shared<foreign::Renderings>(std::move(rendering));
    file = make_one(*renderings);
    why = why_no_channels(file, look.channels);
    if (why.empty()) {
      return std::make_shared<CommandSetup>(std::move(renderings), look_at(file, look));
    }
  } catch (const foreign::RenderingError& error) {
    parameters.refuse(error.member(), std::string("cannot be used: ") + error.what());
  } catch (const InputError& error) {
    throw_useless(error);
  }
  // The suite chooses the channels: the program is not to blame.
  parameters.refuse("channels",
                    (parameters.given("channels") ? "does not fit" : "must choose from") +
                        (" the picture `" + file + "`: " + why));
}

}  // namespace

std::vector<Entry> foreign_command() {
  return {
      {{.name = "command",
        .summary = "A renderer run once an observation, its pictures kept on disk.",
        .description =
            "In the words of `command` `{seed}`, `{samples}` and `{out}` stand for a seed, the "
            "number of `primaries` and the file to write; it runs in the suite's folder. The file "
            "is a picture, an image, or a text of one row. With `{seeds}` one program makes "
            "several: it gets seeds with commas between and writes SEED.exr, or SEED.pfm, in the "
            "folder `{out}`.\n"
            "A seed is 1 + 630360016 (key + observation) mod (2^31 - 1), key the stream's: no two "
            "observations of a stream have the same, and where two streams of a run would meet, "
            "that is an error.\n"
            "What was made is kept in `cache`, in a folder for each command, number of samples "
            "and contents of the files that the command or `depends` names: an interrupted run "
            "goes on where it stopped. A file counts once its program has ended with status 0. "
            "A program that fails, takes too long or writes nothing, and so at each of its "
            "`retries`, is an error with its exit status and the end of its standard error. The "
            "size is learnt from one picture of one sample. A test is planned on a pilot of 32 "
            "pictures or 512 texts, which it does not judge.",
        .parameters =
            {{.name = "command",
              .type = ParameterType::texts,
              .summary = "the program and its arguments, with the places `{seed}` or `{seeds}`, "
                         "`{samples}` and `{out}`"},
             text_parameter("output", "what it writes: a picture of this kind, or text", "exr",
                            {"exr", "pfm", "png", "text"}),
             text_parameter(
                 "channels",
                 "of pictures: the channels to use, patterns with commas between; R, G and "
                 "B, or what stands for them, when absent",
                 "usual"),
             text_parameter("pixels",
                            "of pictures: whether the pixels of one are independent, as they are "
                            "under a box filter one pixel wide",
                            "dependent", {"dependent", "independent"}),
             {.name = "depends",
              .type = ParameterType::texts,
              .summary = "files that change the pictures, beside those that the command names",
              .fallback = "[]"},
             beside_draws(text_parameter(
                 "cache", "the folder of what was made, relative to the suite", ".assay-cache")),
             beside_draws(count_parameter("jobs", "programs at a time; 0 for one each core", "0",
                                          {.high = 1024})),
             foreign::timeout_parameter(
                 "how long one picture may take, from the start of its program", "600"),
             beside_draws(count_parameter(
                 "retries",
                 "how many times a program that fails, takes too long or writes nothing is "
                 "started again, with the same seed; each is told on standard error",
                 "0", {.high = 100})),
             foreign::memory_parameter()},
        .averages = false},
       prepare}};
}

}  // namespace assay::plugins
