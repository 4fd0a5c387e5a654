#include "recorded/npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <exception>
#include <string>

#include "estimators/core/value.h"

namespace assay::recorded {

namespace {

// numpy itself reads no header of more than 10000 bytes unless it is told to.
constexpr std::size_t longest_header = 10000;

[[noreturn]] void refuse_header(const ByteSource& source) {
  source.refuse(
      "its header is none of numpy's format .npy: the file is damaged; "
      "save the array again with `numpy.save`");
}

/// Says how to save the array, `a`, in another form.
std::string save_it(const std::string& as) {
  return " save it with `numpy.save(\"mine.npy\", " + as + ")`";
}

struct Header {
  std::string type;  ///< as `<f8`
  bool fortran = false;
  std::vector<std::size_t> shape;
};

/// Reads Python's dictionary of three entries. But for the brackets of its tuple it is YAML.
Header header_of(const ByteSource& source, std::string text) {
  const std::size_t type = text.find(':', text.find("descr"));
  if (type != text.npos && text.find_first_not_of(" :", type) == text.find('[')) {
    source.refuse("it is an array of records, and an observation is a row of numbers;" +
                  save_it("a[a.dtype.names[0]]"));
  }
  if (std::ranges::count(text, '(') != 1) refuse_header(source);
  std::ranges::replace(text, '(', '[');
  std::ranges::replace(text, ')', ']');
  try {
    const Value entries = parse_flow(text);
    require_keys(entries, "a header", {"descr", "fortran_order", "shape"});
    const std::string order = required_key(entries, "a header", "fortran_order").string("an order");
    if (order != "True" && order != "False") refuse_header(source);
    Header header{.type = required_key(entries, "a header", "descr").string("a type"),
                  .fortran = order == "True"};
    for (const Value& size : required_key(entries, "a header", "shape").items()) {
      header.shape.push_back(size.count("a size"));
    }
    return header;
  } catch (const std::exception&) {
    refuse_header(source);
  }
}

std::size_t byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

Header read_header(ByteSource& source) {
  constexpr std::size_t fixed = npy_magic.size() + 2;  // the version after the magic
  std::string_view bytes = source.look(fixed);
  if (bytes.size() < fixed) refuse_header(source);
  const std::size_t version = byte_at(bytes, npy_magic.size());
  if (version < 1 || version > 3 || byte_at(bytes, npy_magic.size() + 1) != 0) {
    source.refuse(
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
  const Header header = header_of(source, std::string(bytes.substr(fixed + digits, length)));
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
    source.refuse("its numbers are of the type " + (named ? "`" + text + "`" : "of a long name") +
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
      source.refuse("it is cut short: the array has " + std::to_string(count) + " numbers, and " +
                    std::to_string(values.size()) + " of them are there; copy or save it again");
    }
    for (std::size_t i = 0; i < whole; ++i) {
      values.push_back(number_of(type, bytes.data() + i * type.size));
    }
    source.take(whole * type.size);
  }
  if (!source.look().empty()) {
    source.refuse("bytes follow the array: save one array in a file");
  }
  return values;
}

}  // namespace

Matrix read_npy(ByteSource& source, std::size_t most) {
  const Header header = read_header(source);
  const Type type = type_of(source, header.type);
  if (header.shape.empty() || header.shape.size() > 2) {
    source.refuse(header.shape.empty()
                      ? "it holds one number; save an array, an observation an element"
                      : "its array has " + std::to_string(header.shape.size()) + " dimensions (" +
                            extents_of(header.shape) + "), and an observation is a row;" +
                            save_it("a.reshape(len(a), -1)"));
  }
  const std::size_t rows = header.shape[0];
  const std::size_t columns = header.shape.size() == 2 ? header.shape[1] : 1;
  if (rows == 0 || columns == 0) source.refuse("its array is empty: it has no observation");
  if (columns > most / rows) {
    source.refuse("its array of " + extents_of(header.shape) + " numbers does not fit into memory");
  }
  Matrix matrix{.columns = columns, .values = read_numbers(source, type, rows * columns)};
  if (header.fortran && rows > 1 && columns > 1) matrix.values = transposed(matrix.values, rows);
  return matrix;
}

}  // namespace assay::recorded
