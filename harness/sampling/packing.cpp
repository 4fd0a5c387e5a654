#include "harness/sampling/packing.h"

#include <array>
#include <functional>

namespace assay::harness {
namespace {

constexpr char format = '8';  // Another one for each change of what is packed.

struct Head {
  std::array<char, 8> name{'a', 's', 's', 'a', 'y', ' ', format, '\n'};
  std::uint64_t byte_order = 0x0102030405060708U;
  std::uint64_t size = 0;
};

/// Processes of one identity have the same standard library.
std::uint64_t checksum_of(std::string_view bytes) { return std::hash<std::string_view>()(bytes); }

}  // namespace

std::string framed(std::string_view bytes) {
  const Head head{.size = bytes.size()};
  const std::uint64_t checksum = checksum_of(bytes);
  std::string frame;
  frame.reserve(sizeof head + bytes.size() + sizeof checksum);
  frame.append(reinterpret_cast<const char*>(&head), sizeof head);
  frame += bytes;
  frame.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  return frame;
}

std::string_view unframed(std::string_view frame) {
  Head head;
  Unpacker::require(frame.starts_with(magic) && frame.size() >= sizeof head,
                    "it was not written by Assay");
  std::memcpy(&head, frame.data(), sizeof head);
  Unpacker::require(head.name == Head().name, "it is of another version of Assay");
  Unpacker::require(head.byte_order == Head().byte_order,
                    "it is of a machine with another order of bytes");
  frame.remove_prefix(sizeof head);
  std::uint64_t checksum = 0;
  Unpacker::require(frame.size() >= sizeof checksum && frame.size() - sizeof checksum == head.size,
                    "it is cut short, or more follows it");
  std::memcpy(&checksum, frame.data() + head.size, sizeof checksum);
  frame.remove_suffix(sizeof checksum);
  Unpacker::require(checksum == checksum_of(frame), "it is damaged: its checksum differs");
  return frame;
}

void parts(Packer& a, const stats::JointSums& sums) { a(sums.moments()); }
void parts(Unpacker& a, stats::JointSums& sums) {
  stats::JointMoments moments;
  a(moments);
  a.require(moments.known <= stats::JointMoments::weight, "joint moments of unknown weight");
  sums = stats::JointSums(moments);
}

template <class Archive, maybe_const<Histogram> T>
void parts(Archive& a, T& histogram) {
  a(histogram.low, histogram.high, histogram.counts, histogram.below, histogram.above);
}

template <class Archive, maybe_const<ChannelDetails> T>
void parts(Archive& a, T& details) {
  a(details.histogram, details.cells, details.joint);
}

template <class Archive, maybe_const<Summary> T>
void parts(Archive& a, T& summary) {
  a(summary.count, summary.channels, summary.detailed, summary.group_variances, summary.cost,
    summary.seconds);
}

template <class Archive, maybe_const<KeptObservations> T>
void parts(Archive& a, T& kept) {
  a(kept.images, kept.values, kept.costs);
}

template <class Archive, maybe_const<Fault> T>
void parts(Archive& a, T& fault) {
  a(fault.observation, fault.words);
}

template <class Archive, maybe_const<Pool::Block> T>
void block_parts(Archive& a, T& block) {
  a(block.whole, block.values, block.observations, block.partial, block.fault);
}
void parts(Packer& a, const Pool::Block& block) { block_parts(a, block); }
void parts(Unpacker& a, Pool::Block& block) { block_parts(a, block); }

}  // namespace assay::harness
