#include "harness/sampling/packing.h"

namespace assay::harness {
namespace {

constexpr std::string_view head = "assay 8\n";  // Another one for each change of what is packed.

std::uint64_t checksum_of(std::string_view bytes) { return text_hash(bytes); }

}  // namespace

std::string framed(std::string_view bytes) {
  const std::uint64_t checksum = checksum_of(bytes);
  std::string frame;
  frame.reserve(head.size() + bytes.size() + sizeof checksum);
  frame += head;
  frame += bytes;
  return frame.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
}

std::string_view unframed(std::string_view frame) {
  std::uint64_t checksum = 0;
  Unpacker::require(frame.starts_with(magic) && frame.size() >= head.size() + sizeof checksum,
                    "it was not written by Assay");
  Unpacker::require(frame.starts_with(head), "it is of another version of Assay");
  frame.remove_prefix(head.size());
  std::memcpy(&checksum, frame.data() + frame.size() - sizeof checksum, sizeof checksum);
  frame.remove_suffix(sizeof checksum);
  Unpacker::require(checksum == checksum_of(frame),
                    "it is cut short or damaged: its checksum differs");
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
