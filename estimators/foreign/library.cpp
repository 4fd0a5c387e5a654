// Observations of an estimator in a shared library (plugin_abi.h): in a process of its own unless
// asked otherwise.

#include <array>
#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>

#include "estimators/core/thread_seconds.h"
#include "estimators/foreign/examination.h"
#include "estimators/foreign/setup.h"
#include "estimators/foreign/shared_library.h"
#include "estimators/library_host.h"

namespace assay::foreign {

namespace {

std::vector<double> numbers_of(const SamplerDraw& draw) {
  const auto& [x, y, z] = draw.point;
  return {x, y, z, draw.density, draw.weight, draw.valid ? 1.0 : 0.0};
}

/// A sampler that nobody else asks twice. It asks again for the first draw, density and evaluation.
/// Other bits are a LibraryError, then and at every later call.
class InProcessSampler final : public LibrarySampler {
 public:
  InProcessSampler(std::shared_ptr<const PreparedLibrary> library, const AssaySampler& sampler);

  SamplerDraw sample(Stream& random) const override;
  double density(const Point& point) const override;
  double evaluate(const Point& point) const override;

 private:
  template <class Ask>
  void look_at_first(Asked what, const Ask& ask) const;

  std::string name_;
  std::string file_;
  mutable std::array<FirstLook, 3> first_looks_;
};

InProcessSampler::InProcessSampler(std::shared_ptr<const PreparedLibrary> library,
                                   const AssaySampler& sampler)
    : LibrarySampler(library, sampler), name_(sampler.name), file_(library->file()) {}

template <class Ask>
void InProcessSampler::look_at_first(Asked what, const Ask& ask) const {
  first_looks_[static_cast<std::size_t>(what)].at([&] {
    const std::vector<double> numbers = ask();
    const Question question{.first = static_cast<std::uint64_t>(what), .primaries = 0};
    return same_bits(ask(), numbers) ? ""
                                     : "sampler `" + name_ + "`: " + other_numbers(file_, question);
  });
}

SamplerDraw InProcessSampler::sample(Stream& random) const {
  const std::uint64_t key = random();
  const std::uint64_t observation = random();
  look_at_first(Asked::draws, [&] { return numbers_of(draw(key, observation)); });
  return draw(key, observation);
}

double InProcessSampler::density(const Point& point) const {
  look_at_first(Asked::densities, [&] { return std::vector{LibrarySampler::density(point)}; });
  return LibrarySampler::density(point);
}

double InProcessSampler::evaluate(const Point& point) const {
  look_at_first(Asked::evaluations, [&] { return std::vector{LibrarySampler::evaluate(point)}; });
  return LibrarySampler::evaluate(point);
}

/// The observation's numbers as a program of the library would reply them.
std::vector<double> numbers_of(const PreparedLibrary& library, const Question& question) {
  AssayStream random = assay_stream(question.key, question.first);
  std::vector<double> numbers(library.hello().channels.size());
  const std::uint64_t rays = library.observe(random, question.primaries, numbers);
  if (library.hello().rays) numbers.push_back(static_cast<double>(rays));
  return numbers;
}

/// The result of asking again for observations of so many primaries.
struct Examined {
  FirstLook look;
  std::vector<double> usual;  ///< of observations that were all the same
  std::atomic<bool> varies = false;
};

/// Draws the first observations. What the library reports as an error is told by the observation
/// that has it.
std::string why_unfit(const PreparedLibrary& library, std::uint64_t key, std::uint64_t primaries,
                      Examined& examined) {
  const auto ask = [&](const Question& one) { return numbers_of(library, one); };
  const std::size_t width = library.hello().width();
  FirstObservations first{
      .question = {.key = key, .first = 0, .count = asked_twice(width), .primaries = primaries},
      .width = width};
  try {
    Question one = first.question;
    for (one.count = 1; one.first < first.question.count; ++one.first) {
      const std::vector<double> numbers = ask(one);
      first.numbers.insert(first.numbers.end(), numbers.begin(), numbers.end());
    }
    const std::string why = why_not_repeated(ask, first, library.file());
    if (!why.empty()) return why;
    examined.varies = !first.usual();
    if (!examined.varies) examined.usual = first.row(0);
    return why_unfit(ask, first, library.file(), library.hello().means());
  } catch (const LibraryError&) {
    examined.varies = true;
    return "";
  }
}

/// Holds those of one set-up, by primaries.
class Examinations {
 public:
  Examined& of(std::uint64_t primaries) {
    const std::scoped_lock lock(mutex_);
    return all_[primaries];
  }

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, Examined> all_;
};

class LibraryEstimator final : public Estimator {
 public:
  LibraryEstimator(std::shared_ptr<const PreparedLibrary> library,
                   std::shared_ptr<Examinations> examinations)
      : library_(std::move(library)),
        examinations_(std::move(examinations)),
        elements_(library_->hello().image ? library_->hello().image->elements() : 1) {}

  void announce(const Announcement& next) override { streams_.announce(next); }
  /// An examination's are not the estimator's.
  double seconds_elsewhere() const override { return -seconds_examining_; }

  void secondary(Stream& random, std::uint64_t primaries, std::span<double> out,
                 Cost& cost) override {
    if (examined_ == nullptr || primaries != primaries_) examine(random.key(), primaries);
    AssayStream theirs = streams_.of(random.key(), random.observation());
    cost.closest_hit_rays += library_->observe(theirs, primaries, out);
    cost.samples += primaries * elements_;
    if (!examined_->varies.load(std::memory_order_acquire)) {
      examine_unusual({.key = random.key().bits,
                       .first = random.observation(),
                       .count = 1,
                       .primaries = primaries},
                      out);
    }
  }

 private:
  void examine(StreamKey key, std::uint64_t primaries) {
    const double before = thread_seconds();
    Examined& examined = examinations_->of(primaries);
    examined.look.at([&] { return why_unfit(*library_, key.bits, primaries, examined); });
    seconds_examining_ += thread_seconds() - before;
    examined_ = &examined;
    primaries_ = primaries;
  }

  /// Draws the first other observation again. Rays are not compared.
  void examine_unusual(const Question& question, std::span<const double> out) {
    if (!first_unusual(out, std::span(examined_->usual).first(out.size()))) return;
    std::vector<double> again = numbers_of(*library_, question);
    again.resize(out.size());
    if (first_unusual(out, again)) throw LibraryError(other_numbers(library_->file(), question));
    examined_->varies = true;
  }

  std::shared_ptr<const PreparedLibrary> library_;
  std::shared_ptr<Examinations> examinations_;
  Examined* examined_ = nullptr;  ///< of so many primaries
  std::uint64_t primaries_ = 0;
  double seconds_examining_ = 0;
  std::uint64_t elements_;
  StreamsAhead streams_;
};

class LibrarySetup final : public Setup {
 public:
  explicit LibrarySetup(std::shared_ptr<const PreparedLibrary> library)
      : library_(std::move(library)) {
    for (const AssaySampler& sampler : library_->samplers()) {
      samplers_.push_back({sampler.name, std::make_shared<InProcessSampler>(library_, sampler)});
    }
  }

  std::vector<Channel> channels() const override { return library_->hello().channels; }
  std::unique_ptr<Estimator> make() const override {
    return std::make_unique<LibraryEstimator>(library_, examinations_);
  }
  std::optional<ImageShape> image() const override { return library_->hello().image; }
  std::optional<Nature> nature() const override { return library_->hello().nature; }
  std::vector<NamedSampler> samplers() const override { return samplers_; }

 private:
  std::shared_ptr<const PreparedLibrary> library_;
  std::shared_ptr<Examinations> examinations_ = std::make_shared<Examinations>();
  std::vector<NamedSampler> samplers_;
};

}  // namespace

}  // namespace assay::foreign

namespace assay::plugins {

namespace {

foreign::LibraryChoice choice_of(Parameters& parameters) {
  // Absolute: the host runs in the suite's folder.
  foreign::LibraryChoice choice{
      .file = std::filesystem::absolute(parameters.file("file")).lexically_normal().string(),
      .estimator = parameters.string("estimator"),
      .folder = parameters.folder()};
  if (!parameters.given("estimator")) choice.estimator.clear();
  const Value& given = parameters.structure("parameters");
  if (given.kind() != Value::Kind::map) {
    parameters.refuse("parameters", "must be a map of names to values: `{rate: 2}`");
  }
  for (const auto& [name, value] : given.members()) {
    choice.parameters.emplace_back(name, value.string("parameter `" + name + "` of the library"));
  }
  return choice;
}

std::shared_ptr<const Setup> isolated(foreign::Terms terms, const foreign::LibraryChoice& choice,
                                      const Parameters& parameters) {
  try {
    terms.launch.command = {library_host(), library_host_word, choice.file, choice.estimator,
                            std::filesystem::absolute(choice.folder).string()};
  } catch (const std::runtime_error& error) {
    parameters.refuse("isolated", error.what());
  }
  for (const auto& [name, text] : choice.parameters) {
    terms.launch.command.push_back(name);
    terms.launch.command.push_back(text);
  }
  terms.name = choice.file;
  return foreign::start(std::move(terms), parameters, "file");
}

std::shared_ptr<const Setup> in_process(const foreign::LibraryChoice& choice,
                                        const Parameters& parameters) {
  try {
    return std::make_shared<foreign::LibrarySetup>(
        std::make_shared<const foreign::PreparedLibrary>(choice));
  } catch (const std::runtime_error& error) {
    parameters.refuse("file", std::string("is of no use: ") + error.what());
  }
}

std::shared_ptr<const Setup> prepare(Parameters& parameters) {
  foreign::Terms terms = foreign::read_terms(parameters);
  const foreign::LibraryChoice choice = choice_of(parameters);
  if (parameters.boolean("isolated")) return isolated(std::move(terms), choice, parameters);
  return in_process(choice, parameters);
}

std::vector<ParameterInformation> parameters() {
  std::vector<ParameterInformation> all = {
      {.name = "file",
       .type = ParameterType::string,
       .summary = "the library, relative to the suite"},
      {.name = "estimator",
       .type = ParameterType::string,
       .summary = "which of its estimators; where it has one, that",
       .fallback = "only"},
      {.name = "parameters",
       .type = ParameterType::structure,
       .summary = "what the library declares, `{rate: 2}`",
       .fallback = "{}"},
      {.name = "isolated",
       .type = ParameterType::boolean,
       .summary = "run in a process of its own; if false a crash of the library ends the whole run",
       .fallback = "true",
       .shapes_draws = false}};
  for (const ParameterInformation& term : foreign::terms_parameters()) all.push_back(term);
  return all;
}

}  // namespace

std::vector<Entry> foreign_library() {
  return {
      {{.name = "library",
        .summary = "Observations of an estimator in a shared library.",
        .description =
            "The library exports assay_library(), as the header plugin_abi.h (C11, linked "
            "against nothing) declares it, and is compiled by `gcc -std=c11 -O2 -fPIC -shared`. "
            "Its random numbers are Assay's own streams: a C copy of an estimator draws the very "
            "numbers of the original under the same key.\n"
            "It runs in a process of its own, one a worker, with `timeout` and `memory` as those "
            "of `process`. A crash, a time-out, an error that it reports, a number that is not "
            "finite and a word on standard output are then errors of the tests that use it, with "
            "the index of the observation, and all other tests go on. With `isolated: false` it "
            "is called in the run's own process: faster for estimators that cost nothing, the "
            "same numbers to the last bit, but a crash ends the run, nothing times out, and "
            "secondary() is called by several threads at a time. All this is "
            "true of its samplers too; a message then names the draw, or the point of a density.",
        .parameters = parameters(),
        .averages = false,
        .says_nature = true},
       prepare}};
}

}  // namespace assay::plugins
