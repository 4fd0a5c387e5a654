#pragma once

// Bytes as text: base64 (RFC 4648, section 4).

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace assay::reports {

std::string base64(std::span<const std::uint8_t> bytes);

/// nullopt for anything but whole groups of four with their padding.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

/// The little-endian bytes of floats, and floats of bytes.
std::span<const std::uint8_t> bytes_of(std::span<const float> values);
std::vector<float> floats_of(std::span<const std::uint8_t> bytes);

}  // namespace assay::reports
