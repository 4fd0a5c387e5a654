#include "estimators/foreign/library_setup.h"

#include <array>
#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>

#include "estimators/core/thread_seconds.h"
#include "estimators/foreign/examination.h"
#include "estimators/foreign/library_sampler.h"
#include "estimators/foreign/streams_ahead.h"
#include "estimators/foreign/words.h"
#include "estimators/parameters.h"

namespace assay::foreign {

namespace {

constexpr std::size_t message_size = 512;
using Message = std::array<char, message_size>;

std::string text_of(const Message& message) {
  const std::string text(message.data(), strnlen(message.data(), message.size()));
  return text.empty() ? "it says no reason" : text;
}

std::string or_empty(const char* text) { return text != nullptr ? text : ""; }

bool has(std::uint32_t flags, int flag) { return (flags & static_cast<unsigned>(flag)) != 0; }

ParameterType type_of(const AssayParameter& parameter, const std::string& library) {
  switch (parameter.type) {
    case ASSAY_NUMBER:
      return ParameterType::number;
    case ASSAY_COUNT:
      return ParameterType::count;
    case ASSAY_BOOLEAN:
      return ParameterType::boolean;
    case ASSAY_TEXT:
      return ParameterType::string;
    default:
      throw LibraryError(library + " declares a parameter of type " +
                         std::to_string(parameter.type) + ", which is none");
  }
}

std::vector<ParameterInformation> declared(const AssayEstimator& estimator,
                                           const std::string& library) {
  std::vector<ParameterInformation> all;
  if (estimator.parameter_count == 0) return all;
  for (const AssayParameter& p : all_known(estimator.parameters, estimator.parameter_count)) {
    ParameterInformation parameter{.name = or_empty(p.name),
                                   .type = type_of(p, library),
                                   .summary = or_empty(p.summary),
                                   .fallback = or_empty(p.fallback)};
    if (has(p.flags, ASSAY_LOW)) parameter.low = p.low;
    if (has(p.flags, ASSAY_HIGH)) parameter.high = p.high;
    all.push_back(std::move(parameter));
  }
  return all;
}

/// The values as the library gets them, with the texts that they point to.
struct Values {
  std::vector<std::string> texts;
  std::vector<AssayValue> values;
};

double read(Parameters& given, const ParameterInformation& parameter, std::string& text) {
  double number = 0;
  switch (parameter.type) {
    case ParameterType::number:
      number = given.number(parameter.name);
      break;
    case ParameterType::count:
      number = static_cast<double>(given.count(parameter.name));
      break;
    case ParameterType::boolean:
      number = given.boolean(parameter.name) ? 1 : 0;
      text = number == 1 ? "true" : "false";
      return number;
    default:
      text = given.string(parameter.name);
      return 0;
  }
  text = foreign::text_of(number);
  return number;
}

Values values_of(const std::vector<ParameterInformation>& declared, Parameters& given) {
  Values all;
  all.texts.resize(declared.size());
  for (std::size_t i = 0; i < declared.size(); ++i) {
    const double number = read(given, declared[i], all.texts[i]);
    all.values.push_back({.size = sizeof(AssayValue),
                          .name = declared[i].name.c_str(),
                          .text = all.texts[i].c_str(),
                          .number = number});
  }
  return all;
}

Channel channel_of(const AssayChannel& theirs) {
  Channel channel{.name = or_empty(theirs.name), .mean_error = theirs.mean_error};
  if (has(theirs.flags, ASSAY_MEAN)) channel.mean = theirs.mean;
  if (has(theirs.flags, ASSAY_VARIANCE)) channel.variance = theirs.variance;
  if (has(theirs.flags, ASSAY_LOW)) channel.low = theirs.low;
  if (has(theirs.flags, ASSAY_HIGH)) channel.high = theirs.high;
  channel.rounding = theirs.rounding;
  channel.diagnostic = has(theirs.flags, ASSAY_DIAGNOSTIC);
  return channel;
}

ImageShape shape_of(const AssayImage& theirs) {
  ImageShape shape{.width = theirs.width,
                   .height = theirs.height,
                   .independent = has(theirs.flags, ASSAY_INDEPENDENT)};
  if (theirs.components == nullptr) return shape;
  shape.components.clear();
  for (std::size_t i = 0; i < theirs.component_count; ++i) {
    shape.components.push_back(or_empty(theirs.components[i]));
  }
  return shape;
}

/// The facts that all elements share.
Channel element_of(const AssayImage& theirs) {
  Channel element;
  if (has(theirs.flags, ASSAY_LOW)) element.low = theirs.low;
  if (has(theirs.flags, ASSAY_HIGH)) element.high = theirs.high;
  return element;
}

std::optional<BiasClass> bias_of(std::uint32_t theirs) {
  switch (theirs) {
    case ASSAY_BIAS_UNKNOWN:
      return std::nullopt;
    case ASSAY_UNBIASED:
      return BiasClass::unbiased;
    case ASSAY_BIAS_PRIMARIES:
      return BiasClass::inverse_primaries;
    case ASSAY_BIAS_BOOTSTRAP:
      return BiasClass::inverse_bootstrap;
    case ASSAY_BIAS_START_UP:
      return BiasClass::start_up;
    case ASSAY_BIAS_RECONSTRUCTION:
      return BiasClass::reconstruction;
    default:
      throw LibraryError("declares the bias " + std::to_string(theirs) + ", which is none");
  }
}

std::vector<AssaySampler> samplers_of(const AssayPreparation& prepared) {
  if (prepared.sampler_count == 0) return {};
  std::vector<AssaySampler> all = all_known(prepared.samplers, prepared.sampler_count);
  for (const AssaySampler& sampler : all) require_whole(sampler);
  return all;
}

/// The library's facts in the words of a program, so that the same rules read both.
std::string hello_text(const AssayEstimator& estimator, const AssayPreparation& prepared,
                       const std::vector<AssaySampler>& samplers) {
  std::string text = "assay " + std::to_string(protocol_version) + " binary\n";
  if (prepared.image != nullptr) {
    const AssayImage image = as_known(prepared.image);
    text += image_lines(shape_of(image), element_of(image));
  }
  if (prepared.channel_count > 0) {
    for (const AssayChannel& c : all_known(prepared.channels, prepared.channel_count)) {
      text += channel_line(channel_of(c));
    }
  }
  if (has(estimator.flags, ASSAY_AVERAGES)) text += "averages\n";
  if (has(estimator.flags, ASSAY_RAYS)) text += "rays\n";
  for (const AssaySampler& sampler : samplers) text += sampler_line(note_of(sampler));
  return text + bias_line(bias_of(estimator.bias)) + "ready\n";
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

PreparedLibrary::PreparedLibrary(const LibraryChoice& choice)
    : object_(choice.file), estimator_(object_.find(choice.estimator)) {
  AssayPreparation preparation{.size = sizeof preparation,
                               .channels = estimator_.channels,
                               .channel_count = estimator_.channel_count,
                               .image = estimator_.image,
                               .samplers = estimator_.samplers,
                               .sampler_count = estimator_.sampler_count};
  prepare(choice, preparation);
  try {
    samplers_ = samplers_of(preparation);
    hello_ = parse_hello(hello_text(estimator_, preparation, samplers_));
  } catch (...) {
    if (estimator_.release != nullptr) estimator_.release(state_);
    throw;
  }
}

PreparedLibrary::~PreparedLibrary() {
  if (estimator_.release != nullptr) estimator_.release(state_);
}

void PreparedLibrary::prepare(const LibraryChoice& choice, AssayPreparation& preparation) {
  const std::string name = "`" + choice.file + "`, estimator `" + estimator_.name + "`";
  const std::vector<ParameterInformation> known = declared(estimator_, name);
  std::vector<Value::Member> members;
  for (const auto& [key, text] : choice.parameters) members.emplace_back(key, Value::scalar(text));
  Parameters given(name, known, Value::map(std::move(members)), choice.folder);
  const Values values = values_of(known, given);
  if (estimator_.prepare == nullptr) return;
  Message message{};
  const std::string folder = std::filesystem::absolute(choice.folder).string();
  preparation.values = values.values.data();
  preparation.value_count = values.values.size();
  preparation.folder = folder.c_str();
  preparation.message = message.data();
  preparation.message_size = message.size();
  const int status = estimator_.prepare(&preparation);
  if (status != 0) {
    throw LibraryError(name + " refuses: " + text_of(message) + " (status " +
                       std::to_string(status) + " of prepare())");
  }
  state_ = preparation.setup;
}

std::uint64_t PreparedLibrary::observe(AssayStream& random, std::uint64_t primaries,
                                       std::span<double> out) const {
  Message message;
  message[0] = '\0';
  AssayCall call{.size = sizeof call,
                 .setup = state_,
                 .random = &random,
                 .primaries = primaries,
                 .out = out.data(),
                 .out_count = out.size(),
                 .message = message.data(),
                 .message_size = message.size(),
                 .rays = 0};
  const int status = estimator_.secondary(&call);
  if (status == 0) return call.rays;
  throw LibraryError("`" + object_.file() + "`, estimator `" + estimator_.name + "`: " +
                     text_of(message) + " (status " + std::to_string(status) + " of secondary())");
}

std::shared_ptr<const Setup> library_setup(std::shared_ptr<const PreparedLibrary> library) {
  return std::make_shared<LibrarySetup>(std::move(library));
}

}  // namespace assay::foreign
