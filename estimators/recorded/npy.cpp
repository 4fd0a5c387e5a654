#include "recorded/npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <string>

#include "estimators/core/value.h"

namespace assay::recorded {

namespace {

// numpy itself reads no header of more than 10000 bytes unless it is told to.
constexpr std::size_t longest_header = 10000;

[[noreturn]] void refuse(const ByteSource& source, const std::string& why) {
  throw InputError({.file = source.name()}, why);
}

[[noreturn]] void refuse_header(const ByteSource& source) {
  refuse(source,
         "its header is none of numpy's format .npy: the file is damaged;\n"
         "  save the array again with `numpy.save`");
}

/// Says how to save the array, `a`, in another form.
std::string save_it(const std::string& as) {
  return "\n  save it with `numpy.save(\"mine.npy\", " + as + ")`";
}

struct Header {
  std::string type;  ///< as `<f8`; empty for records
  bool fortran = false;
  std::vector<std::size_t> shape;
};

/// Python's dictionary of three entries, as numpy writes it.
class HeaderReader {
 public:
  HeaderReader(const ByteSource& source, std::string_view text) : source_(source), text_(text) {}

  Header read() {
    Header header;
    std::array<bool, 3> seen{};
    expect('{');
    while (!accept('}')) {
      const std::string key = string();
      expect(':');
      const std::array<std::string_view, 3> keys{"descr", "fortran_order", "shape"};
      const auto which = static_cast<std::size_t>(std::ranges::find(keys, key) - keys.begin());
      if (which == keys.size() || seen[which]) fail();
      seen[which] = true;
      if (which == 0) header.type = type();
      if (which == 1) header.fortran = boolean();
      if (which == 2) header.shape = shape();
      if (!accept(',') && next() != '}') fail();
    }
    if (next() != '\0' || std::ranges::find(seen, false) != seen.end()) fail();
    return header;
  }

 private:
  [[noreturn]] void fail() const { refuse_header(source_); }

  /// The next character that is no blank; '\0' at the end.
  char next() {
    const std::size_t first = text_.find_first_not_of(" \t\n");
    text_.remove_prefix(std::min(first, text_.size()));
    return text_.empty() ? '\0' : text_.front();
  }
  bool accept(char c) {
    if (next() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail();
  }
  bool accept(std::string_view word) {
    next();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }

  std::string string() {
    const char quote = next();
    if (quote != '\'' && quote != '"') fail();
    const std::size_t end = text_.find(quote, 1);
    if (end == text_.npos) fail();
    const std::string_view inside = text_.substr(1, end - 1);
    text_.remove_prefix(end + 1);
    return std::string(inside);
  }

  std::string type() {
    if (next() != '[') return string();
    refuse(source_, "it is an array of records, and an observation is a row of numbers;" +
                        save_it("a[a.dtype.names[0]]"));
  }

  bool boolean() {
    if (accept("True")) return true;
    if (!accept("False")) fail();
    return false;
  }

  std::vector<std::size_t> shape() {
    std::vector<std::size_t> sizes;
    expect('(');
    while (!accept(')')) {
      next();
      std::size_t size = 0;
      const auto [end, problem] = std::from_chars(text_.data(), text_.data() + text_.size(), size);
      if (problem != std::errc{}) fail();
      text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
      sizes.push_back(size);
      if (!accept(',') && next() != ')') fail();
    }
    return sizes;
  }

  const ByteSource& source_;
  std::string_view text_;
};

std::size_t byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

Header read_header(ByteSource& source) {
  constexpr std::size_t fixed = npy_magic.size() + 2;  // the version after the magic
  std::string_view bytes = source.look(fixed);
  if (bytes.size() < fixed) refuse_header(source);
  const std::size_t version = byte_at(bytes, npy_magic.size());
  if (version < 1 || version > 3 || byte_at(bytes, npy_magic.size() + 1) != 0) {
    refuse(source,
           "it is of a format .npy that Assay does not know;\n"
           "  save the array again with `numpy.save`");
  }
  const std::size_t digits = version == 1 ? 2 : 4;  // bytes of the header's length
  bytes = source.look(fixed + digits);
  if (bytes.size() < fixed + digits) refuse_header(source);
  std::size_t length = 0;
  for (std::size_t i = digits; i-- > 0;) length = length * 256 + byte_at(bytes, fixed + i);
  const std::size_t whole = fixed + digits + length;
  if (length > longest_header) refuse_header(source);
  bytes = source.look(whole);
  if (bytes.size() < whole) refuse_header(source);
  const Header header = HeaderReader(source, bytes.substr(fixed + digits, length)).read();
  source.take(whole);
  return header;
}

/// The bytes of one number, and what they mean.
struct Type {
  char kind = 'f';  ///< numpy's: b, i, u or f
  std::size_t size = 8;
  bool big_endian = false;
};

Type type_of(const ByteSource& source, const std::string& text) {
  constexpr std::array known{"b1", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8", "f4", "f8"};
  const bool has_order =
      !text.empty() && std::string_view("<>|=").find(text[0]) != std::string::npos;
  const std::string plain = has_order ? text.substr(1) : "";
  if (std::ranges::find(known, plain) == known.end()) {
    const bool named = text.size() < 16;
    const bool complex = plain.starts_with('c');
    refuse(source, "its numbers are of the type " + (named ? "`" + text + "`" : "of a long name") +
                       ", and not float32, float64 or whole;" +
                       save_it(complex ? "a.real" : "a.astype(\"f8\")"));
  }
  return {.kind = plain[0],
          .size = static_cast<std::size_t>(plain[1] - '0'),
          .big_endian = text[0] == '>'};
}

template <class Number>
double as(std::uint64_t bits) {
  if constexpr (sizeof(Number) == 8) {
    return static_cast<double>(std::bit_cast<Number>(bits));
  } else if constexpr (sizeof(Number) == 4) {
    return static_cast<double>(std::bit_cast<Number>(static_cast<std::uint32_t>(bits)));
  } else {
    return static_cast<double>(static_cast<Number>(bits));
  }
}

double number_of(const Type& type, const char* bytes) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < type.size; ++i) {
    const std::size_t at = type.big_endian ? i : type.size - 1 - i;
    bits = bits << 8U | static_cast<unsigned char>(bytes[at]);
  }
  switch (type.kind) {
    case 'f':
      return type.size == 4 ? as<float>(bits) : as<double>(bits);
    case 'i':
      return type.size == 1   ? as<std::int8_t>(bits)
             : type.size == 2 ? as<std::int16_t>(bits)
             : type.size == 4 ? as<std::int32_t>(bits)
                              : as<std::int64_t>(bits);
    case 'b':
      return bits != 0 ? 1 : 0;
    default:
      return static_cast<double>(bits);
  }
}

std::string extents_of(const std::vector<std::size_t>& shape) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(shape.size(), 4); ++i) {
    text += (i > 0 ? " x " : "") + std::to_string(shape[i]);
  }
  return text + (shape.size() > 4 ? " x …" : "");
}

/// Row after row what came column after column.
std::vector<double> transposed(const std::vector<double>& values, std::size_t rows) {
  const std::size_t columns = values.size() / rows;
  std::vector<double> turned(values.size());
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) turned[i * columns + j] = values[j * rows + i];
  }
  return turned;
}

/// Nothing is taken for granted of the size: memory grows with what is there.
std::vector<double> read_numbers(ByteSource& source, const Type& type, std::size_t count) {
  std::vector<double> values;
  while (values.size() < count) {
    const std::string_view bytes = source.look(type.size);
    const std::size_t whole = std::min(bytes.size() / type.size, count - values.size());
    if (whole == 0) {
      refuse(source, "it is cut short: the array has " + std::to_string(count) +
                         " numbers,\n  and " + std::to_string(values.size()) +
                         " of them are there; copy or save it again");
    }
    for (std::size_t i = 0; i < whole; ++i) {
      values.push_back(number_of(type, bytes.data() + i * type.size));
    }
    source.take(whole * type.size);
  }
  if (!source.look().empty()) {
    refuse(source, "bytes follow the array: save one array in a file");
  }
  return values;
}

}  // namespace

Matrix read_npy(ByteSource& source, std::size_t most) {
  const Header header = read_header(source);
  const Type type = type_of(source, header.type);
  if (header.shape.empty() || header.shape.size() > 2) {
    refuse(source, header.shape.empty()
                       ? "it holds one number; save an array, an observation an element"
                       : "its array has " + std::to_string(header.shape.size()) + " dimensions (" +
                             extents_of(header.shape) + "), and an observation is a row;" +
                             save_it("a.reshape(len(a), -1)"));
  }
  const std::size_t rows = header.shape[0];
  const std::size_t columns = header.shape.size() == 2 ? header.shape[1] : 1;
  if (rows == 0 || columns == 0) refuse(source, "its array is empty: it has no observation");
  if (columns > most / rows) {
    refuse(source,
           "its array of " + extents_of(header.shape) + " numbers does not fit into memory");
  }
  Matrix matrix{.columns = columns, .values = read_numbers(source, type, rows * columns)};
  if (header.fortran && rows > 1 && columns > 1) matrix.values = transposed(matrix.values, rows);
  return matrix;
}

}  // namespace assay::recorded
