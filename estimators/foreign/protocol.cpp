#include "estimators/foreign/protocol.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "estimators/core/mapped.h"

namespace assay::foreign {

static_assert(std::endian::native == std::endian::little, "doubles are sent as they lie in memory");

namespace {

using Words = std::vector<std::string_view>;

struct BiasWord {
  std::string_view word;
  std::optional<BiasClass> bias;
};
constexpr std::array<BiasWord, 6> bias_words = {{{"unknown", std::nullopt},
                                                 {"unbiased", BiasClass::unbiased},
                                                 {"primaries", BiasClass::inverse_primaries},
                                                 {"bootstrap", BiasClass::inverse_bootstrap},
                                                 {"start-up", BiasClass::start_up},
                                                 {"reconstruction", BiasClass::reconstruction}}};

// In the order of Domain.
constexpr std::array<std::string_view, 5> domain_words = {"interval", "square", "triangle",
                                                          "hemisphere", "sphere"};

constexpr const char* to_standard_error = "; print everything else to standard error";

[[noreturn]] void wrong(std::string_view line, const std::string& why) {
  throw ProtocolError("its hello has the line `" + shown(line) + "`: " + why);
}

// True if a claim can use the word as a name.
bool is_name(std::string_view word) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !word.empty() && letter(word[0]) &&
         std::ranges::all_of(word, [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

class Reader {
 public:
  explicit Reader(std::uint64_t most) : most_(most) {}

  void line(std::string_view text) {
    const Words words = words_of(text);
    if (words.empty()) return;
    if (!greeted_) return greet(text, words);
    const auto found = meanings_.find(words[0]);
    if (found == meanings_.end()) {
      wrong(text,
            "a line begins with channel, image, range, independent, averages, bias, rays, sampler, "
            "ready or error");
    }
    line_ = text;
    found->second(words);
  }

  bool ready() const { return ready_; }

  Hello finish() {
    if (!greeted_) throw ProtocolError("it printed nothing; the first line is `assay 1 text`");
    if (!ready_) throw ProtocolError("its hello does not end with `ready`");
    if (hello_.image) unequal(hello_.image->components, "component");
    if (!hello_.image && !needs_image_.empty()) wrong(needs_image_, "there is no `image`");
    if (hello_.channel_count() == 0) {
      throw ProtocolError("its hello names neither a `channel` nor an `image`");
    }
    refuse_doubles();
    unequal(mapped(hello_.samplers, &SamplerNote::name), "sampler");
    if (!hello_.samplers.empty() && hello_.numbers == Numbers::text) {
      throw ProtocolError("its hello has a `sampler`, whose numbers are binary only");
    }
    return hello_;
  }

 private:
  void greet(std::string_view text, const Words& words) {
    if (words[0] != "assay" || words.size() != 3) {
      wrong(text, parse_number(words[0])
                      ? "test rows of numbers by `PROGRAM | assay check 'mean(x) == 1' "
                        "--estimator x=recorded,file=-`"
                      : "the first line is `assay 1 text` or `assay 1 binary`; print everything "
                        "else to standard error");
    }
    if (read_as<unsigned>(words[1]) != protocol_version) {
      wrong(text, "it speaks version " + std::string(words[1]) +
                      " of the protocol, this is version " + std::to_string(protocol_version));
    }
    if (words[2] != "text" && words[2] != "binary") wrong(text, "numbers are `text` or `binary`");
    hello_.numbers = words[2] == "text" ? Numbers::text : Numbers::binary;
    greeted_ = true;
  }

  [[noreturn]] void wrong_here(const std::string& why) const { wrong(line_, why); }

  double number(std::string_view word) const {
    const std::optional<double> value = parse_number(word);
    if (!value || std::isnan(*value)) wrong_here("`" + shown(word) + "` is not a number");
    return *value;
  }

  void take_range(double low, double high, Channel& channel) const {
    if (!(low <= high)) wrong_here("the range is empty");
    channel.low = low;
    channel.high = high;
  }

  void channel(const Words& words) {
    if (words.size() < 2 || !is_name(words[1])) {
      wrong_here("a channel has a name of letters, digits and `_`");
    }
    Channel channel{.name = std::string(words[1])};
    double low = channel.low;
    double high = channel.high;
    for (std::size_t i = 2; i < words.size(); ++i) {
      if (words[i] == "diagnostic") {
        channel.diagnostic = true;
        continue;
      }
      if (i + 1 == words.size()) wrong_here("`" + shown(words[i]) + "` needs a number");
      const std::string_view what = words[i++];
      const double value = number(words[i]);
      const bool bound = what == "low" || what == "high";
      if (!bound && !std::isfinite(value)) wrong_here("`" + shown(words[i]) + "` is not finite");
      const bool spread = what == "error" || what == "variance" || what == "rounding";
      if (spread && value < 0) wrong_here("`" + std::string(what) + "` cannot be negative");
      if (bound)
        (what == "low" ? low : high) = value;
      else if (what == "mean")
        channel.mean = value;
      else if (what == "error")
        channel.mean_error = value;
      else if (what == "variance")
        channel.variance = value;
      else if (what == "rounding")
        channel.rounding = value;
      else
        wrong_here(
            "of a channel mean, error, variance, low, high, rounding and diagnostic are known");
    }
    take_range(low, high, channel);
    hello_.channels.push_back(std::move(channel));
  }

  void image(const Words& words) {
    if (hello_.image) wrong_here("there is one image");
    if (words.size() < 3) wrong_here("an image has a width and a height in pixels");
    const std::uint64_t width = read_as<std::uint64_t>(words[1]).value_or(0);
    const std::uint64_t height = read_as<std::uint64_t>(words[2]).value_or(0);
    const std::uint64_t components = words.size() == 3 ? 1 : words.size() - 3;
    if (width == 0 || height == 0) wrong_here("width and height are whole numbers above 0");
    if (width > most_ || height > most_ / width / components) {
      wrong_here("an observation has " + std::to_string(most_) + " numbers at most");
    }
    hello_.image = ImageShape{.width = width, .height = height, .independent = false};
    if (words.size() > 3) hello_.image->components.clear();
    for (std::size_t i = 3; i < words.size(); ++i) {
      if (!is_name(words[i])) wrong_here("a component has a name of letters, digits and `_`");
      hello_.image->components.emplace_back(words[i]);
    }
  }

  void range(const Words& words) {
    if (words.size() != 3) wrong_here("a range is two numbers");
    take_range(number(words[1]), number(words[2]), hello_.element);
    needs_image_ = line_;
  }

  void bias(const Words& words) {
    const std::string_view word = words.size() == 2 ? words[1] : "";
    const auto* const known = std::ranges::find(bias_words, word, &BiasWord::word);
    if (known == bias_words.end()) {
      wrong_here("bias is unknown, unbiased, primaries, bootstrap, start-up or reconstruction");
    }
    hello_.nature.bias = known->bias;
  }

  void sampler(const Words& words) {
    if (words.size() < 3 || words.size() % 2 == 0 || !is_name(words[1])) {
      wrong_here(
          "a sampler has a name of letters, digits and `_`, a domain, and pairs of a word and a "
          "number");
    }
    const auto domain = std::ranges::find(domain_words, words[2]);
    if (domain == domain_words.end()) {
      wrong_here("a domain is interval, square, triangle, hemisphere or sphere");
    }
    SamplerNote note{.name = std::string(words[1]),
                     .domain = static_cast<Domain>(domain - domain_words.begin())};
    const bool bounded = note.domain == Domain::interval;
    for (std::size_t i = 3; i < words.size(); i += 2) {
      const double value = number(words[i + 1]);
      if (bounded && words[i] == "low")
        note.bounds[0] = value;
      else if (bounded && words[i] == "high")
        note.bounds[1] = value;
      else if (words[i] == "rounding" && value >= 0 && value < 1)
        note.rounding = value;
      else
        wrong_here(
            "of a sampler rounding is known, from 0 and below 1, and of an interval low and "
            "high");
    }
    if (!(note.bounds[0] < note.bounds[1])) wrong_here("the interval is empty");
    hello_.samplers.push_back(std::move(note));
  }

  void alone(const Words& words) const {
    if (words.size() != 1) wrong_here("nothing follows this word");
  }

  /// The meaning of a word that stands alone.
  std::function<void(const Words&)> sets(bool& flag) {
    return [this, &flag](const Words& words) {
      alone(words);
      flag = true;
    };
  }

  /// The names, none of which stands twice.
  static std::set<std::string> unequal(const std::vector<std::string>& all, const char* what) {
    std::set<std::string> names;
    for (const std::string& name : all) {
      if (names.insert(name).second) continue;
      throw ProtocolError("its hello names the " + std::string(what) + " `" + name + "` twice");
    }
    return names;
  }

  void refuse_doubles() const {
    const auto names = unequal(mapped(hello_.channels, &Channel::name), "channel");
    if (names.empty() || !hello_.image) return;
    for (std::size_t element = 0; element < hello_.image->elements(); ++element) {
      const std::string name = element_name(*hello_.image, element);
      if (!names.contains(name)) continue;
      throw ProtocolError("its hello names `" + name +
                          "`, an element of its image: leave such channels out");
    }
    for (const Channel& channel : hello_.channels) {
      if (channel.diagnostic) continue;
      throw ProtocolError("its hello has the channel `" + channel.name +
                          "` beside an image: such a channel is `diagnostic`");
    }
  }

  std::map<std::string_view, std::function<void(const Words&)>> meanings_{
      {"channel", [this](const Words& words) { channel(words); }},
      {"image", [this](const Words& words) { image(words); }},
      {"range", [this](const Words& words) { range(words); }},
      {"bias", [this](const Words& words) { bias(words); }},
      {"sampler", [this](const Words& words) { sampler(words); }},
      {"error",
       [this](const Words&) {
         throw Refusal(std::string(line_.substr(std::min(line_.find("error") + 6, line_.size()))));
       }},
      {"averages", sets(hello_.nature.averages)},
      {"rays", sets(hello_.rays)},
      {"ready", sets(ready_)},
      {"independent", [this](const Words& words) {
         alone(words);
         if (!hello_.image) wrong_here("it stands after the `image` whose pixels it is about");
         hello_.image->independent = true;
       }}};
  std::uint64_t most_;
  Hello hello_;
  std::string_view line_;
  std::string_view needs_image_;
  bool greeted_ = false;
  bool ready_ = false;
};

// Text comes in pieces of this size; beyond the end of a binary reply so much is read to be shown.
constexpr std::size_t piece = 65536;
constexpr std::size_t surplus = 64;
// A line is one observation: no number takes more characters than this, with its blank.
constexpr std::size_t characters_a_number = 64;

std::string of(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// Lines of a hello, each with its end.

std::string channel_line(const Channel& channel) {
  std::string line = "channel " + channel.name;
  if (channel.mean) line += " mean " + shortest_text(*channel.mean);
  if (channel.mean_error != 0) line += " error " + shortest_text(channel.mean_error);
  if (channel.variance) line += " variance " + shortest_text(*channel.variance);
  if (std::isfinite(channel.low)) line += " low " + shortest_text(channel.low);
  if (std::isfinite(channel.high)) line += " high " + shortest_text(channel.high);
  if (channel.rounding != 0) line += " rounding " + shortest_text(channel.rounding);
  return line + (channel.diagnostic ? " diagnostic\n" : "\n");
}

std::string image_lines(const ImageShape& image, const Channel& element) {
  std::string lines = "image " + std::to_string(image.width) + " " + std::to_string(image.height);
  for (const std::string& component : image.components) lines += " " + component;
  lines += image.independent ? "\nindependent\n" : "\n";
  const Channel unknown;
  if (element.low == unknown.low && element.high == unknown.high) return lines;
  return lines + "range " + shortest_text(element.low) + " " + shortest_text(element.high) + "\n";
}

std::string sampler_line(const SamplerNote& sampler) {
  const std::string_view domain = domain_words[static_cast<std::size_t>(sampler.domain)];
  std::string line = "sampler " + sampler.name + " " + std::string(domain);
  if (sampler.domain == Domain::interval) {
    line +=
        " low " + shortest_text(sampler.bounds[0]) + " high " + shortest_text(sampler.bounds[1]);
  }
  if (sampler.rounding != 0) line += " rounding " + shortest_text(sampler.rounding);
  return line + "\n";
}

}  // namespace

bool is_whole_hello(std::string_view text) {
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    const auto words = words_of(text.substr(0, end));
    if (!words.empty() && (words[0] == "ready" || words[0] == "error")) return true;
    text.remove_prefix(end + 1);
  }
  return false;
}

Hello parse_hello(std::string_view text, std::uint64_t most) {
  Reader reader(most);
  while (!text.empty() && !reader.ready()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    reader.line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (reader.ready() && !text.empty()) {
    throw ProtocolError("it says `" + shown(text) +
                        "` after `ready`, before it was asked anything");
  }
  return reader.finish();
}

std::string to_text(const Hello& hello) {
  std::string text = "assay " + std::to_string(protocol_version) +
                     (hello.numbers == Numbers::binary ? " binary\n" : " text\n");
  if (hello.image) text += image_lines(*hello.image, hello.element);
  for (const Channel& channel : hello.channels) text += channel_line(channel);
  if (hello.nature.averages) text += "averages\n";
  const auto* const bias = std::ranges::find(bias_words, hello.nature.bias, &BiasWord::bias);
  text += "bias " + std::string(bias->word) + "\n";
  if (hello.rays) text += "rays\n";
  for (const SamplerNote& sampler : hello.samplers) text += sampler_line(sampler);
  return text + "ready\n";
}

// ---- Questions and replies

std::string to_bytes(const Question& q, Numbers numbers) {
  if (numbers == Numbers::text) {
    return std::to_string(q.key >> 32) + " " + std::to_string(q.key & 0xffffffffu) + " " +
           std::to_string(q.first) + " " + std::to_string(q.count) + " " +
           std::to_string(q.primaries) + "\n";
  }
  const std::uint64_t words[4] = {q.key, q.first, q.count, q.primaries};
  return {reinterpret_cast<const char*>(words), sizeof words};
}

std::string to_text(const Question& q) {
  constexpr std::array<const char*, 3> items = {"draw", "density", "evaluation"};
  if (q.is_to_sampler()) {
    if (q.asked() == Asked::densities && q.count > 1) return of(q.count, "densitie");
    return of(q.count, items.at(static_cast<std::size_t>(q.asked())));
  }
  if (q.count == 1) return "observation " + std::to_string(q.first);
  return "observations " + std::to_string(q.first) + " to " + std::to_string(q.first + q.count - 1);
}

bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

Reply::Reply(const Question& question, std::size_t width, Numbers numbers)
    : question_(question), width_(width), kind_(numbers), end_(to_bytes(question, numbers)) {
  if (kind_ == Numbers::binary) bytes_.resize(8 * wanted() + end_.size() + surplus);
}

std::span<char> Reply::space() {
  if (kind_ == Numbers::text && bytes_.size() - filled_ < piece) bytes_.resize(filled_ + piece);
  return std::span(bytes_).subspan(filled_);
}

bool Reply::take(std::size_t count) {
  filled_ += count;
  return kind_ == Numbers::binary ? take_binary() : take_text();
}

void Reply::refuse_surplus(std::string_view bytes) const {
  if (bytes.empty()) return;
  throw ProtocolError("after the reply for " + to_text(question_) + " it wrote more: `" +
                      shown(bytes) + "`");
}

bool Reply::take_binary() {
  const std::size_t size = 8 * wanted() + end_.size();
  if (filled_ < size) return false;
  const std::string_view all(bytes_.data(), filled_);
  if (all.substr(size - end_.size(), end_.size()) != end_) {
    throw ProtocolError("its reply for " + to_text(question_) +
                        " does not end with the question after " + of(wanted(), "number") +
                        ": something else was written to standard output, or more numbers; the "
                        "reply begins with `" +
                        shown(all) + "`");
  }
  refuse_surplus(all.substr(size));
  return true;
}

void Reply::take_line(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  const std::uint64_t index = question_.first + numbers_.size() / width_;
  if (words.size() != width_) {
    throw ProtocolError("observation " + std::to_string(index) + " should be a line of " +
                        of(width_, "number") + ", but it is `" + shown(line) + "`" +
                        to_standard_error);
  }
  for (const std::string_view word : words) {
    const std::optional<double> value = parse_number(word);
    if (!value) {
      throw ProtocolError("observation " + std::to_string(index) + " has `" + shown(word) +
                          "`, which is not a number" + to_standard_error);
    }
    numbers_.push_back(*value);
  }
}

bool Reply::take_text() {
  while (true) {
    const std::string_view rest(bytes_.data() + parsed_, filled_ - parsed_);
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) {
      if (rest.size() <= characters_a_number * (width_ + 1)) return false;
      throw ProtocolError("its reply for " + to_text(question_) + " has a line without end: `" +
                          shown(rest) + "`");
    }
    const std::string_view line = rest.substr(0, end);
    parsed_ += end + 1;
    if (numbers_.size() == wanted()) {
      if (words_of(line) != words_of(std::string_view(end_).substr(0, end_.size() - 1))) {
        throw ProtocolError("after " + of(question_.count, "observation") +
                            " its reply should end with the question, but it goes on with `" +
                            shown(line) + "`");
      }
      refuse_surplus(rest.substr(end + 1));
      return true;
    }
    if (line.size() + 1 == end_.size() && end_.starts_with(line)) {
      throw ProtocolError(so_far() + " and lacks observation " +
                          std::to_string(question_.first + numbers_.size() / width_));
    }
    take_line(line);
  }
}

std::vector<double> Reply::numbers() {
  if (kind_ == Numbers::binary) {
    numbers_.resize(wanted());
    if (!numbers_.empty()) std::memcpy(numbers_.data(), bytes_.data(), 8 * numbers_.size());
  }
  return std::move(numbers_);
}

std::string Reply::ends_early() const {
  if (kind_ == Numbers::text || filled_ < end_.size()) return "";
  const std::string_view all(bytes_.data(), filled_);
  if (!all.ends_with(end_)) return "";
  const std::size_t numbers = (filled_ - end_.size()) / 8;
  return so_far() + " and lacks observation " + std::to_string(question_.first + numbers / width_);
}

std::string Reply::so_far() const {
  if (filled_ == 0) return "";
  std::size_t count = numbers_.size();
  if (kind_ == Numbers::binary) {
    const bool ended = std::string_view(bytes_.data(), filled_).ends_with(end_);
    count = std::min((filled_ - (ended ? end_.size() : 0)) / 8, wanted());
  }
  if (count == wanted()) {
    return "its reply has all " + of(count, "number") + ", but not the question again at its end";
  }
  return "its reply has " + std::to_string(count) + " of " + of(wanted(), "number");
}

}  // namespace assay::foreign
