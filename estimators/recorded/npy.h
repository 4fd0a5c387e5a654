#pragma once

// Arrays that numpy saved (`numpy.save`, .npy).

#include <cstddef>
#include <string_view>
#include <vector>

#include "recorded/byte_source.h"

namespace assay::recorded {

/// The first bytes of every .npy file.
inline constexpr std::string_view npy_magic = "\x93NUMPY";

/// A matrix, row after row.
struct Matrix {
  std::size_t columns = 1;
  std::vector<double> values = {};
};

/// Reads an array of one dimension, a column, or two, of format 1.0, 2.0 or 3.0 (numpy.lib.format),
/// in C's or Fortran's order. Numbers are bool, whole (1 to 8 bytes) or floating-point (4 or 8),
/// little- or big-endian. A whole number beyond 2^53 becomes the nearest double.
/// InputError at the source for anything else, and for an array without numbers or with more than
/// `most`. The same for a file that is cut short or goes on after the array.
Matrix read_npy(ByteSource& source, std::size_t most);

}  // namespace assay::recorded
