#include "estimators/foreign/reply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "estimators/foreign/words.h"

namespace assay::foreign {

static_assert(std::endian::native == std::endian::little, "doubles are sent as they lie in memory");

namespace {

// Text comes in pieces of this size; beyond the end of a binary reply so much is read to be shown.
constexpr std::size_t piece = 65536;
constexpr std::size_t surplus = 64;
// A line is one observation: no number takes more characters than this, with its blank.
constexpr std::size_t characters_a_number = 64;

std::string of(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

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

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
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
                        of(width_, "number") + ", but it is `" + shown(line) + "`");
  }
  for (const std::string_view word : words) {
    const std::optional<double> value = number_of(word);
    if (!value) {
      throw ProtocolError("observation " + std::to_string(index) + " has `" + shown(word) +
                          "`, which is not a number");
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
      throw ProtocolError(so_far() + ": the reply ended with observation " +
                          std::to_string(question_.first + numbers_.size() / width_) + " missing");
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
  return so_far() + ": the reply ended with observation " +
         std::to_string(question_.first + numbers / width_) + " missing";
}

std::string Reply::so_far() const {
  if (filled_ == 0) return "nothing of its reply came";
  std::size_t count = numbers_.size();
  if (kind_ == Numbers::binary) {
    const bool ended = std::string_view(bytes_.data(), filled_).ends_with(end_);
    count = std::min((filled_ - (ended ? end_.size() : 0)) / 8, wanted());
  }
  if (count == wanted()) {
    return "its " + of(count, "number") + " came, but not the question again, which ends a reply";
  }
  return of(count, "number") + " of " + std::to_string(wanted()) + " came";
}

}  // namespace assay::foreign
