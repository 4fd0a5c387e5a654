#include "estimators/foreign/hello.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "estimators/foreign/words.h"

namespace assay::foreign {

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

[[noreturn]] void wrong(std::string_view line, const std::string& why) {
  throw ProtocolError("its hello has the line `" + shown(line) + "`: " + why);
}

// True if a claim can use the word as a name.
bool is_name(std::string_view word) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  if (word.empty() || !letter(word[0])) return false;
  for (const char c : word) {
    if (!letter(c) && !(c >= '0' && c <= '9')) return false;
  }
  return true;
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
    if (!greeted_) throw ProtocolError("it says nothing; the first line is `assay 1 text`");
    if (!ready_) throw ProtocolError("its hello does not end with `ready`");
    refuse_double_components();
    std::vector<Channel> all = elements();
    all.insert(all.end(), hello_.channels.begin(), hello_.channels.end());
    if (all.empty()) throw ProtocolError("its hello names neither a `channel` nor an `image`");
    hello_.channels = std::move(all);
    refuse_doubles();
    require_sound_samplers();
    return hello_;
  }

 private:
  void greet(std::string_view text, const Words& words) {
    if (words[0] != "assay" || words.size() != 3) {
      wrong(text, "the first is `assay 1 text` or `assay 1 binary`");
    }
    if (whole_of(words[1]) != protocol_version) {
      wrong(text, "it speaks version " + std::string(words[1]) +
                      " of the protocol, this is version " + std::to_string(protocol_version));
    }
    if (words[2] != "text" && words[2] != "binary") wrong(text, "numbers are `text` or `binary`");
    hello_.numbers = words[2] == "text" ? Numbers::text : Numbers::binary;
    greeted_ = true;
  }

  [[noreturn]] void wrong_here(const std::string& why) const { wrong(line_, why); }

  double number(std::string_view word) const {
    const std::optional<double> value = number_of(word);
    if (!value || std::isnan(*value)) wrong_here("`" + shown(word) + "` is not a number");
    return *value;
  }

  double finite(std::string_view word) const {
    const double value = number(word);
    if (!std::isfinite(value)) wrong_here("`" + shown(word) + "` is not finite");
    return value;
  }

  void take_range(double low, double high, Channel& channel) const {
    if (!(low <= high)) wrong_here("the range is empty");
    channel.low = low;
    channel.high = high;
  }

  void take_fact(std::string_view what, double value, Channel& channel) const {
    const bool spread = what == "error" || what == "variance" || what == "rounding";
    if (spread && value < 0) wrong_here("`" + std::string(what) + "` cannot be negative");
    if (what == "mean")
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
      if (what == "low")
        low = number(words[i]);
      else if (what == "high")
        high = number(words[i]);
      else
        take_fact(what, finite(words[i]), channel);
    }
    take_range(low, high, channel);
    hello_.channels.push_back(std::move(channel));
  }

  void image(const Words& words) {
    if (hello_.image) wrong_here("there is one image");
    if (words.size() < 3) wrong_here("an image has a width and a height in pixels");
    const std::uint64_t width = whole_of(words[1]).value_or(0);
    const std::uint64_t height = whole_of(words[2]).value_or(0);
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
    take_range(number(words[1]), number(words[2]), element_);
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

  Domain domain(std::string_view word) const {
    const auto found = std::ranges::find(domain_words, word);
    if (found == domain_words.end()) {
      wrong_here("a domain is interval, square, triangle, hemisphere or sphere");
    }
    return static_cast<Domain>(found - domain_words.begin());
  }

  void sampler(const Words& words) {
    if (words.size() < 3 || words.size() % 2 == 0 || !is_name(words[1])) {
      wrong_here(
          "a sampler has a name of letters, digits and `_`, a domain, and pairs of a word and a "
          "number");
    }
    SamplerNote note{.name = std::string(words[1]), .domain = domain(words[2])};
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

  [[noreturn]] void error() const {
    const std::size_t words = std::min(line_.find("error") + 6, line_.size());
    throw Refusal(std::string(line_.substr(words)));
  }

  void alone(const Words& words) const {
    if (words.size() != 1) wrong_here("nothing follows this word");
  }

  std::vector<Channel> elements() const {
    if (!hello_.image) {
      if (!needs_image_.empty()) wrong(needs_image_, "there is no `image`");
      return {};
    }
    return element_channels(*hello_.image, element_);
  }

  void refuse_double_components() const {
    if (!hello_.image) return;
    const std::vector<std::string>& all = hello_.image->components;
    if (std::set<std::string>(all.begin(), all.end()).size() < all.size()) {
      throw ProtocolError("its hello names a component twice");
    }
  }

  void refuse_doubles() const {
    std::set<std::string_view> names;
    for (const Channel& channel : hello_.channels) {
      if (names.insert(channel.name).second) continue;
      const std::string mend =
          hello_.image ? "; the elements of an image have their names, leave such channels out"
                       : "";
      throw ProtocolError("its hello names `" + channel.name + "` twice" + mend);
    }
    if (!hello_.image) return;
    for (std::size_t i = hello_.image->elements(); i < hello_.channels.size(); ++i) {
      if (hello_.channels[i].diagnostic) continue;
      throw ProtocolError("its hello has the channel `" + hello_.channels[i].name +
                          "` beside an image: such a channel is `diagnostic`");
    }
  }

  void require_sound_samplers() const {
    std::set<std::string_view> names;
    for (const SamplerNote& sampler : hello_.samplers) {
      if (names.insert(sampler.name).second) continue;
      throw ProtocolError("its hello names the sampler `" + sampler.name + "` twice");
    }
    if (!hello_.samplers.empty() && hello_.numbers == Numbers::text) {
      throw ProtocolError("its hello has a `sampler`, whose numbers are binary only");
    }
  }

  std::map<std::string_view, std::function<void(const Words&)>> meanings_{
      {"channel", [this](const Words& words) { channel(words); }},
      {"image", [this](const Words& words) { image(words); }},
      {"range", [this](const Words& words) { range(words); }},
      {"bias", [this](const Words& words) { bias(words); }},
      {"sampler", [this](const Words& words) { sampler(words); }},
      {"error", [this](const Words&) { error(); }},
      {"averages",
       [this](const Words& words) {
         alone(words);
         hello_.nature.averages = true;
       }},
      {"rays",
       [this](const Words& words) {
         alone(words);
         hello_.rays = true;
       }},
      {"ready",
       [this](const Words& words) {
         alone(words);
         ready_ = true;
       }},
      {"independent", [this](const Words& words) {
         alone(words);
         if (!hello_.image) wrong_here("it stands after the `image` whose pixels it is about");
         hello_.image->independent = true;
       }}};
  std::uint64_t most_;
  Hello hello_;
  Channel element_;
  std::string_view line_;
  std::string_view needs_image_;
  bool greeted_ = false;
  bool ready_ = false;
};

}  // namespace

std::string channel_line(const Channel& channel) {
  std::string line = "channel " + channel.name;
  if (channel.mean) line += " mean " + text_of(*channel.mean);
  if (channel.mean_error != 0) line += " error " + text_of(channel.mean_error);
  if (channel.variance) line += " variance " + text_of(*channel.variance);
  if (std::isfinite(channel.low)) line += " low " + text_of(channel.low);
  if (std::isfinite(channel.high)) line += " high " + text_of(channel.high);
  if (channel.rounding != 0) line += " rounding " + text_of(channel.rounding);
  return line + (channel.diagnostic ? " diagnostic\n" : "\n");
}

std::string image_lines(const ImageShape& image, const Channel& element) {
  std::string lines = "image " + std::to_string(image.width) + " " + std::to_string(image.height);
  for (const std::string& component : image.components) lines += " " + component;
  lines += image.independent ? "\nindependent\n" : "\n";
  const Channel unknown;
  if (element.low == unknown.low && element.high == unknown.high) return lines;
  return lines + "range " + text_of(element.low) + " " + text_of(element.high) + "\n";
}

std::string bias_line(std::optional<BiasClass> bias) {
  const auto* const known = std::ranges::find(bias_words, bias, &BiasWord::bias);
  return "bias " + std::string(known->word) + "\n";
}

std::string sampler_line(const SamplerNote& sampler) {
  const std::string_view domain = domain_words[static_cast<std::size_t>(sampler.domain)];
  std::string line = "sampler " + sampler.name + " " + std::string(domain);
  if (sampler.domain == Domain::interval) {
    line += " low " + text_of(sampler.bounds[0]) + " high " + text_of(sampler.bounds[1]);
  }
  if (sampler.rounding != 0) line += " rounding " + text_of(sampler.rounding);
  return line + "\n";
}

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
  if (hello.image) text += image_lines(*hello.image, hello.channels.front());
  for (std::size_t i = hello.image ? hello.image->elements() : 0; i < hello.channels.size(); ++i) {
    text += channel_line(hello.channels[i]);
  }
  if (hello.nature.averages) text += "averages\n";
  text += bias_line(hello.nature.bias);
  if (hello.rays) text += "rays\n";
  for (const SamplerNote& sampler : hello.samplers) text += sampler_line(sampler);
  return text + "ready\n";
}

}  // namespace assay::foreign
