#include "harness/sampling/packing.h"

#include <array>

#include "harness/base/text_hash.h"

namespace assay::harness {
namespace {

constexpr std::string_view magic = "assay ";
constexpr char format = '1';  // Another one for each change of what is packed.

struct Head {
  std::array<char, 8> name{'a', 's', 's', 'a', 'y', ' ', format, '\n'};
  std::uint64_t byte_order = 0x0102030405060708U;
  std::uint64_t size = 0;
};

}  // namespace

std::string framed(std::string_view bytes) {
  const Head head{.size = bytes.size()};
  const std::uint64_t checksum = text_hash(bytes);
  std::string frame;
  frame.reserve(sizeof head + bytes.size() + sizeof checksum);
  frame.append(reinterpret_cast<const char*>(&head), sizeof head);
  frame += bytes;
  frame.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  return frame;
}

std::string_view unframed(std::string_view frame) {
  Head head;
  if (!frame.starts_with(magic) || frame.size() < sizeof head) {
    throw Unpackable("it is nothing that Assay packed");
  }
  std::memcpy(&head, frame.data(), sizeof head);
  if (head.name != Head().name) {
    throw Unpackable("it is of another version of Assay");
  }
  if (head.byte_order != Head().byte_order) {
    throw Unpackable("it is of a machine with another order of bytes");
  }
  frame.remove_prefix(sizeof head);
  std::uint64_t checksum = 0;
  if (frame.size() < sizeof checksum || frame.size() - sizeof checksum != head.size) {
    throw Unpackable("it is cut short, or more follows it");
  }
  std::memcpy(&checksum, frame.data() + head.size, sizeof checksum);
  frame.remove_suffix(sizeof checksum);
  if (checksum != text_hash(frame)) throw Unpackable("it is damaged: its checksum differs");
  return frame;
}

}  // namespace assay::harness
