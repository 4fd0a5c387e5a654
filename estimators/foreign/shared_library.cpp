#include "estimators/foreign/shared_library.h"

#include <dlfcn.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>
#include <tuple>
#include <utility>

#include "estimators/core/flush_denormals.h"
#include "estimators/core/mapped.h"
#include "estimators/parameters.h"

namespace assay::foreign {

namespace {

/// A struct as a library of any age has it: members beyond its `size` are zero.
template <class Struct>
Struct as_known(const Struct* theirs) {
  Struct ours{};
  std::memcpy(&ours, theirs, theirs->size < sizeof ours ? theirs->size : sizeof ours);
  ours.size = sizeof ours;
  return ours;
}

/// An array of such structs, each as large as the first says.
template <class Struct>
std::vector<Struct> all_known(const Struct* first, std::size_t count) {
  const char* const bytes = reinterpret_cast<const char*>(first);
  return mapped_indices(count, [&](std::size_t i) {
    return as_known(reinterpret_cast<const Struct*>(bytes + i * first->size));
  });
}

constexpr const char* symbol = "assay_library";

// The members of the first published version: less cannot be.
constexpr std::size_t least_library =
    offsetof(AssayLibrary, estimator_count) + sizeof(AssayLibrary::estimator_count);
constexpr std::size_t least_estimator =
    offsetof(AssayEstimator, secondary) + sizeof(AssayEstimator::secondary);

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw LibraryError("`" + file + "` " + why);
}

void require(bool holds, const std::string& file, const std::string& why) {
  if (!holds) refuse(file, why);
}

/// dlopen's messages repeat the file's name.
std::string reason(const std::string& file) {
  const char* const text = dlerror();
  std::string why = text != nullptr ? text : "no reason is given";
  if (why.starts_with(file + ": ")) why.erase(0, file.size() + 2);
  return why;
}

std::shared_ptr<void> opened(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) {
    refuse(file, std::string("cannot be opened: ") + std::strerror(errno) +
                     "; the path starts at the suite's folder");
  }
  // With a slash the name is a file, not one to be sought in the system's folders.
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    refuse(file, "is no shared library that can be loaded: " + reason(path) +
                     "; compile it with -shared -fPIC");
  }
  return {handle, [](void* open) { dlclose(open); }};
}

std::string or_empty(const char* text) { return text != nullptr ? text : ""; }

/// Throws LibraryError where a function is missing or a domain is none.
void require_whole(const AssaySampler& sampler) {
  const std::string name = or_empty(sampler.name);
  const auto require = [&](bool holds, const std::string& why) {
    if (!holds) throw LibraryError("the sampler `" + name + "` " + why);
  };
  require(!name.empty() && sampler.sample && sampler.density && sampler.evaluate,
          "lacks its name, sample(), density() or evaluate()");
  require(sampler.domain <= ASSAY_SPHERE,
          "has the domain " + std::to_string(sampler.domain) + ", which is none");
  require(sampler.domain != ASSAY_INTERVAL || sampler.low < sampler.high,
          "has an empty interval: set `low` and `high`");
}

/// The sampler's facts. require_whole() has passed.
SamplerNote note_of(const AssaySampler& sampler) {
  // In the order of plugin_abi.h.
  static_assert(static_cast<int>(Domain::sphere) == ASSAY_SPHERE);
  SamplerNote note{.name = sampler.name, .domain = static_cast<Domain>(sampler.domain)};
  if (note.domain == Domain::interval) note.bounds = {sampler.low, sampler.high};
  if (sampler.rounding > 0) note.rounding = sampler.rounding;
  return note;
}

constexpr std::size_t message_size = 512;
using Message = std::array<char, message_size>;

std::string text_of(const Message& message) {
  const std::string text(message.data(), strnlen(message.data(), message.size()));
  return text.empty() ? "it says no reason" : text;
}

bool has(std::uint32_t flags, int flag) { return (flags & static_cast<unsigned>(flag)) != 0; }

ParameterType type_of(const AssayParameter& parameter, const std::string& library) {
  // In the order of plugin_abi.h.
  constexpr std::array types{ParameterType::number, ParameterType::count, ParameterType::boolean,
                             ParameterType::string};
  if (parameter.type < types.size()) return types[parameter.type];
  throw LibraryError(library + " declares a parameter of type " + std::to_string(parameter.type) +
                     ", which is none");
}

std::vector<ParameterInformation> declared(const AssayEstimator& estimator,
                                           const std::string& library) {
  const auto known = all_known(estimator.parameters, estimator.parameter_count);
  return mapped(known, [&](const AssayParameter& p) {
    ParameterInformation parameter{.name = or_empty(p.name),
                                   .type = type_of(p, library),
                                   .summary = or_empty(p.summary),
                                   .fallback = or_empty(p.fallback)};
    if (has(p.flags, ASSAY_LOW)) parameter.range.low = p.low;
    if (has(p.flags, ASSAY_HIGH)) parameter.range.high = p.high;
    return parameter;
  });
}

/// The values as the library gets them, with the texts that they point to.
struct Values {
  std::vector<std::string> texts;
  std::vector<AssayValue> values;
};

std::pair<std::string, double> read(Parameters& given, const ParameterInformation& parameter) {
  const std::string& name = parameter.name;
  if (parameter.type == ParameterType::string) return {given.string(name), 0};
  if (parameter.type == ParameterType::boolean) {
    return given.boolean(name) ? std::pair("true", 1.0) : std::pair("false", 0.0);
  }
  const double number = parameter.type == ParameterType::count
                            ? static_cast<double>(given.count(name))
                            : given.number(name);
  return {shortest_text(number), number};
}

Values values_of(const std::vector<ParameterInformation>& declared, Parameters& given) {
  Values all;
  all.texts.resize(declared.size());
  for (std::size_t i = 0; i < declared.size(); ++i) {
    double number = 0;
    std::tie(all.texts[i], number) = read(given, declared[i]);
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
  shape.components = mapped(std::span(theirs.components, theirs.component_count), or_empty);
  return shape;
}

std::optional<BiasClass> bias_of(std::uint32_t theirs) {
  // In the order of plugin_abi.h.
  static_assert(static_cast<int>(BiasClass::reconstruction) ==
                ASSAY_BIAS_RECONSTRUCTION - ASSAY_UNBIASED);
  if (theirs == ASSAY_BIAS_UNKNOWN) return {};
  if (theirs <= ASSAY_BIAS_RECONSTRUCTION) return static_cast<BiasClass>(theirs - ASSAY_UNBIASED);
  throw LibraryError("declares the bias " + std::to_string(theirs) + ", which is none");
}

/// The library's facts as a program says them, so that the same rules read both.
Hello hello_of(const AssayEstimator& estimator, const AssayPreparation& prepared,
               const std::vector<AssaySampler>& samplers) {
  Hello hello{
      .numbers = Numbers::binary,
      .channels = mapped(all_known(prepared.channels, prepared.channel_count), channel_of),
      .nature = {.averages = has(estimator.flags, ASSAY_AVERAGES), .bias = bias_of(estimator.bias)},
      .rays = has(estimator.flags, ASSAY_RAYS),
      .samplers = mapped(samplers, note_of)};
  if (prepared.image != nullptr) {
    const AssayImage image = as_known(prepared.image);
    hello.image = shape_of(image);
    if (has(image.flags, ASSAY_LOW)) hello.element.low = image.low;
    if (has(image.flags, ASSAY_HIGH)) hello.element.high = image.high;
  }
  return parse_hello(to_text(hello));
}

template <class Item>
std::vector<Item> items_of(std::string_view bytes) {
  std::vector<Item> items(bytes.size() / sizeof(Item));
  std::memcpy(items.data(), bytes.data(), bytes.size());
  return items;
}

}  // namespace

SharedObject::SharedObject(const std::string& file) : file_(file), handle_(opened(file)) {
  void* const found = dlsym(handle_.get(), symbol);
  require(found != nullptr, file,
          std::string("does not export ") + symbol +
              "(); estimators/plugin_abi.h declares it, and a C++ library needs it there");
  const auto table = reinterpret_cast<const AssayLibrary* (*)()>(found);
  read_table(table());
}

void SharedObject::read_table(const AssayLibrary* table) {
  require(table != nullptr && table->size >= least_library, file_,
          std::string("returns no table from ") + symbol + "()");
  require(table->version == ASSAY_ABI_VERSION, file_,
          "was compiled for version " + std::to_string(table->version) +
              " of the interface, this is version " + std::to_string(ASSAY_ABI_VERSION) +
              "; compile it again with this version's plugin_abi.h");
  const AssayLibrary known = as_known(table);
  require(known.estimators != nullptr && known.estimator_count > 0, file_,
          "has no estimators in its table");
  require(known.estimators->size >= least_estimator, file_,
          "has an estimator whose `size` is not the size of its struct; set it to "
          "sizeof(AssayEstimator)");
  estimators_ = all_known(known.estimators, known.estimator_count);
  for (const AssayEstimator& estimator : estimators_) {
    require(estimator.name != nullptr && estimator.secondary != nullptr, file_,
            "has an estimator without a name or without secondary()");
  }
}

const AssayEstimator& SharedObject::find(const std::string& name) const {
  std::vector<std::string> names;
  for (const AssayEstimator& estimator : estimators_) {
    if (estimator.name == name) return estimator;
    names.emplace_back(estimator.name);
  }
  if (name.empty() && estimators_.size() == 1) return estimators_.front();
  if (name.empty())
    refuse(file_, "has several estimators; set `estimator` to one of " + quoted(names));
  refuse(file_, "has no estimator `" + name + "`" +
                    did_you_mean(name, names, "there is " + quoted(names)));
}

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
    samplers_ = all_known(preparation.samplers, preparation.sampler_count);
    std::ranges::for_each(samplers_, require_whole);
    hello_ = hello_of(estimator_, preparation, samplers_);
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

std::vector<double> PreparedLibrary::answer(const Question& question,
                                            std::string_view items) const {
  // Tables of densities are made without.
  std::optional<FlushDenormals> flush;
  if (!question.is_to_sampler() || question.first >= denormals_flushed) flush.emplace();
  if (!question.is_to_sampler()) return observations(question);
  const AssaySampler& sampler = samplers_.at(question.key);
  const Asked what = question.asked();
  return what == Asked::draws ? draws(sampler, items) : at_points(sampler, what, items);
}

std::vector<double> PreparedLibrary::observations(const Question& question) const {
  const std::size_t width = hello_.width();
  std::vector<double> numbers(static_cast<std::size_t>(question.count) * width);
  Message message;
  for (std::uint64_t i = 0; i < question.count; ++i) {
    double* const row = numbers.data() + i * width;
    AssayStream random = assay_stream(question.key, question.first + i);
    message[0] = '\0';
    AssayCall call{.size = sizeof call,
                   .setup = state_,
                   .random = &random,
                   .primaries = question.primaries,
                   .out = row,
                   .out_count = hello_.channel_count(),
                   .message = message.data(),
                   .message_size = message.size(),
                   .rays = 0};
    const int status = estimator_.secondary(&call);
    if (status != 0) {
      throw LibraryError("`" + object_.file() + "`, estimator `" + estimator_.name +
                         "`: " + text_of(message) + " (status " + std::to_string(status) +
                         " of secondary())");
    }
    if (hello_.rays) row[width - 1] = static_cast<double>(call.rays);
  }
  return numbers;
}

/// Draws from streams whose keys and observations are the items.
std::vector<double> PreparedLibrary::draws(const AssaySampler& sampler,
                                           std::string_view items) const {
  const auto streams = items_of<std::array<std::uint64_t, 2>>(items);
  std::vector<double> numbers;
  numbers.reserve(numbers_of(Asked::draws) * streams.size());
  for (const auto& [key, observation] : streams) {
    AssayStream random = assay_stream(key, observation);
    AssayDraw drawn{.size = sizeof drawn};
    const int status = sampler.sample(state_, &random, &drawn);
    if (status != 0) throw LibraryError("status " + std::to_string(status) + " of sample()");
    const Point point{drawn.point[0], drawn.point[1], drawn.point[2]};
    const std::array draw{point[0],      point[1],     point[2],
                          drawn.density, drawn.weight, drawn.no_point == 0 ? 1.0 : 0.0};
    if (drawn.no_point == 0 && std::ranges::any_of(draw, [](double x) { return std::isnan(x); })) {
      throw LibraryError("sample() gave the point " + text_of(point, note_of(sampler).domain) +
                         ", density " + shortest_text(drawn.density) + " and weight " +
                         shortest_text(drawn.weight));
    }
    numbers.insert(numbers.end(), draw.begin(), draw.end());
  }
  return numbers;
}

std::vector<double> PreparedLibrary::at_points(const AssaySampler& sampler, Asked what,
                                               std::string_view items) const {
  const bool densities = what == Asked::densities;
  const auto points = items_of<Point>(items);
  const auto ask = densities ? sampler.density : sampler.evaluate;
  return mapped(points, [&](const Point& point) {
    const double number = ask(state_, point.data());
    if (!std::isnan(number)) return number;
    throw LibraryError(std::string(densities ? "density()" : "evaluate()") + " is " +
                       shortest_text(number));
  });
}

}  // namespace assay::foreign
