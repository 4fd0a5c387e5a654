#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <thread>

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
  throw std::runtime_error("the program wrote an unusable file: " + to_string(error.where()) +
                           ": " + error.message() + "; correct the program and delete the file");
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
          "its command lacks `{samples}`: `primaries: " + std::to_string(primaries) +
          "` would change nothing; add `{samples}`, or leave `primaries` out");
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

Contents look_at(const std::string& file, const std::string& channels, bool independent) {
  Contents contents;
  if (is_picture(file)) {
    contents.pictures = recorded::open_stack({file}, channels, {});
    contents.shape = contents.pictures.view.shape(independent);
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
  const auto require = [&](bool holds, const std::string& why) {
    parameters.require(holds, "command", why);
  };
  const bool seed = foreign::has_place(command, "{seed}");
  const bool seeds = foreign::has_place(command, "{seeds}");
  require(!command.empty() && !command[0].empty(),
          "names no program; as in `[render, --seed, \"{seed}\", \"{out}\"]`");
  require(seed || seeds, "lacks `{seed}`: every observation would be the same");
  require(!seed || !seeds, "has `{seed}` and `{seeds}`; use one of them");
  require(foreign::has_place(command, "{out}"), "lacks `{out}`, the file to write");
  for (const std::string& word : command) check_places(parameters, word);
  require(!foreign::program_path(command[0], parameters.folder()).empty(),
          "names the program `" + command[0] + "`, which does not exist or may not be run" +
              foreign::mend_of_program(command[0]));
}

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  foreign::Rendering rendering{.command = parameters.texts("command"),
                               .depends = parameters.texts("depends"),
                               .folder = parameters.folder().empty() ? "." : parameters.folder(),
                               .cache = parameters.file("cache"),
                               .ending = parameters.string("output"),
                               .timeout = parameters.number("timeout"),
                               .retries = parameters.count("retries"),
                               .memory = parameters.number("memory"),
                               .jobs = parameters.count("jobs")};
  if (rendering.ending == "text") rendering.ending = "txt";
  check_command(parameters, rendering.command);
  if (rendering.jobs == 0) {
    rendering.jobs = std::max(1U, std::thread::hardware_concurrency());
  }
  const std::string channels = parameters.string("channels");
  const bool independent = parameters.string("pixels") == "independent";
  rendering.cache = std::filesystem::absolute(rendering.cache).string();
  std::string why;
  std::string file;
  try {
    auto renderings = std::make_shared<foreign::Renderings>(std::move(rendering));
    // One picture of one sample a pixel, with a seed of its own.
    const StreamKey key = stream_key(0, "command", "size", 0);
    renderings->make({.key = key, .first = 0, .last = 1, .samples = 1});
    file = renderings->file(key, 0, 1);
    why = why_no_channels(file, channels);
    if (why.empty()) {
      return std::make_shared<CommandSetup>(std::move(renderings),
                                            look_at(file, channels, independent));
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
        .summary = "A renderer that runs once for each observation; its pictures stay on disk.",
        .description =
            "In `command`, `{seed}`, `{samples}` and `{out}` stand for a seed, the number of "
            "`primaries` and the file to write. The command runs in the suite's folder. The file "
            "is a picture, which makes the observation an image, or a text of one row. With "
            "`{seeds}` a program makes several pictures: it gets seeds separated by commas and "
            "writes SEED.exr, or SEED.pfm, into the folder `{out}`.\n"
            "A seed is 1 + 630360016 (key + observation) mod (2^31 - 1), where the key is the "
            "stream's. No two observations of a stream have the same seed. A seed that two streams "
            "of a run share is an error.\n"
            "The files stay in `cache`. It has a folder for each command, number of samples, and "
            "contents of the files that the command or `depends` names. So an interrupted run "
            "continues where it stopped. A file counts once its program has ended with status 0. A "
            "program that fails, takes too long or writes nothing, also at each of its `retries`, "
            "is an error with its exit status and the end of its standard error. Assay learns the "
            "size from one picture of one sample. A pilot of 32 pictures or 512 texts plans a "
            "test, which does not judge them.",
        .parameters =
            {{.name = "command",
              .type = ParameterType::texts,
              .summary = "the program and its arguments, with `{seed}` or `{seeds}`, `{samples}` "
                         "and `{out}`"},
             text_parameter("output", "what the program writes: a picture of this kind, or text",
                            "exr", {"exr", "pfm", "png", "text"}),
             text_parameter("channels",
                            "the channels of pictures to use, as patterns separated by commas; "
                            "without it R, G and B, or what stands for them",
                            "usual"),
             text_parameter("pixels",
                            "whether the pixels of a picture are independent, as under a box "
                            "filter one pixel wide",
                            "dependent", {"dependent", "independent"}),
             {.name = "depends",
              .type = ParameterType::texts,
              .summary = "files that change the pictures, besides those that the command names",
              .fallback = "[]"},
             beside_draws(text_parameter(
                 "cache", "the folder that keeps the files; its path starts at the suite's folder",
                 ".assay-cache")),
             beside_draws(count_parameter("jobs", "programs at a time; 0 is one for each core", "0",
                                          {.high = 1024})),
             foreign::timeout_parameter(
                 "how long one picture may take, from the start of its program", "600"),
             beside_draws(count_parameter(
                 "retries",
                 "how often to restart a program that fails, takes too long or writes nothing, "
                 "with the same seed; standard error shows each restart",
                 "0", {.high = 100})),
             foreign::memory_parameter()},
        .averages = false},
       prepare}};
}

}  // namespace assay::plugins
