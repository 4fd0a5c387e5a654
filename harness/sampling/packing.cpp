#include "harness/sampling/packing.h"

#include <algorithm>
#include <array>

namespace assay::harness {
namespace {

constexpr char format = '7';  // Another one for each change of what is packed.

struct Head {
  std::array<char, 8> name{'a', 's', 's', 'a', 'y', ' ', format, '\n'};
  std::uint64_t byte_order = 0x0102030405060708U;
  std::uint64_t size = 0;
};

constexpr std::size_t most_cells = std::size_t{1} << 24;

/// Takes words of 8 bytes. Data that differ in one word have another checksum.
std::uint64_t checksum_of(std::string_view bytes) {
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;
  std::uint64_t sum = bytes.size();
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t size = std::min(bytes.size(), sizeof word);
    std::memcpy(&word, bytes.data(), size);
    bytes.remove_prefix(size);
    sum = (sum ^ word) * odd;
    sum ^= sum >> 32;
  }
  return sum;
}

/// The number of observations [first, first + count) that lie below `end`.
std::uint64_t below(std::uint64_t end, std::uint64_t first, std::uint64_t count) {
  return std::min(std::max(end, first) - first, count);
}

/// Everything in a block is sized by the plan and by how many observations it has.
void require_shape(const Pool::Block& block, const Recipe& recipe, const Pool& pool,
                   std::uint64_t first) {
  const std::uint64_t count = block.whole.count;
  const auto require = Unpacker::require;
  const bool has_values = !pool.sums_later() && most_kept(recipe.plan) > 0;
  require(block.values.size() == (has_values ? pool.channels() : 0),
          "values of other channels than the pool has");
  for (std::size_t c = 0; c < block.values.size(); ++c) {
    require(block.values[c].size() == below(recipe.plan[c].keep, first, count),
            "other values than its plan says");
  }
  const KeptObservations& kept = *block.observations;
  const std::size_t elements = pool.elements();
  const std::size_t whole = below(recipe.kept_observations, first, count);
  require(kept.costs.size() == whole && kept.values.size() == whole && kept.images.size() == whole,
          "other observations than its plan says");
  for (std::size_t i = 0; i < whole; ++i) {
    require(
        elements + kept.values[i].size() == pool.channels() && kept.images[i].size() == elements,
        "an observation of other channels than the pool has");
  }
}

void unpack_sums(Unpacker& unpack, const Pool& pool, std::uint64_t first, Pool::Block& block) {
  const Recipe recipe = pool.recipe();
  std::uint64_t partials = 0;
  block.whole = pool.no_sums();
  unpack(block.fault, block.whole, partials);
  require_shape(block, recipe, pool, first);
  const std::uint64_t end = first + block.whole.count;
  const auto begin = std::ranges::upper_bound(recipe.marks, first);
  const std::vector<std::uint64_t> marks(begin, std::ranges::upper_bound(recipe.marks, end));
  Unpacker::require(partials == marks.size(), "other marks than its plan says");
  for (const std::uint64_t mark : marks) {
    std::uint64_t count = 0;
    auto sums = std::make_shared<Summary>(pool.no_sums());
    unpack(count, *sums);
    Unpacker::require(count == mark && sums->count == mark - first,
                      "other marks than its plan says");
    block.partial.emplace_back(mark, std::move(sums));
  }
  unpack.end();
}

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

template <class Archive, maybe_const<ChannelDetails> T>
void parts(Archive& a, T& details) {
  a(details.histogram.below, details.histogram.above);
  a.fixed(details.histogram.counts);
  a.fixed(details.cells);
  a.fixed(details.joint);
}

template <class Archive, maybe_const<Summary> T>
void parts(Archive& a, T& summary) {
  a(summary.count, summary.group_variances, summary.cost, summary.seconds);
  a.fixed(summary.channels);
  for (auto& [channel, details] : summary.detailed) a(details);
}

template <class Archive, maybe_const<KeptObservations> T>
void parts(Archive& a, T& kept) {
  a(kept.images, kept.values, kept.costs);
}

template <class Archive, maybe_const<Fault> T>
void parts(Archive& a, T& fault) {
  a(fault.observation, fault.words);
}

Pool pool_of(const Recipe& recipe, std::shared_ptr<const Setup> setup) {
  Unpacker::require(setup != nullptr, "there is no such set-up");
  Unpacker::require(recipe.primaries > 0, "observations of no primaries");
  Unpacker::require(std::ranges::count(recipe.marks, 0U) == 0, "a mark at no observation");
  Pool pool(std::move(setup), recipe);
  Unpacker::require(recipe.plan.empty() || recipe.plan.size() == pool.channels(),
                    "a plan of other channels than the set-up has");
  for (const ChannelPlan& channel : recipe.plan) {
    Unpacker::require(channel.cells <= most_cells && channel.powers <= Powers::with_costs,
                      "a plan that no pool has");
  }
  for (const std::size_t channel : recipe.grouped_channels) {
    Unpacker::require(channel < pool.channels(), "a channel that the set-up does not have");
  }
  return pool;
}

std::string packed_kept(const Pool::Block& block) {
  Packer pack;
  pack(block.values, *block.observations);
  return std::move(pack).bytes();
}

std::string packed_sums(const Pool::Block& block) {
  Packer pack;
  pack(block.fault, block.whole, static_cast<std::uint64_t>(block.partial.size()));
  for (const auto& [count, sums] : block.partial) pack(count, *sums);
  return std::move(pack).bytes();
}

std::string packed_block(const Pool::Block& block) {
  return packed_kept(block) + packed_sums(block);
}

void add_kept(std::string_view bytes, Pool::Block& block) {
  Unpacker unpack(bytes);
  Pool::Block next;
  unpack(next.values, *next.observations);
  unpack.end();
  block.append_kept(std::move(next));
}

Pool::Block unpacked_block(std::string_view bytes, const Pool& pool, std::uint64_t first) {
  Unpacker unpack(bytes);
  Pool::Block block;
  unpack(block.values, *block.observations);
  unpack_sums(unpack, pool, first, block);
  return block;
}

Pool::Block unpacked_drawn(std::string_view sums, Pool::Block&& kept, const Pool& pool) {
  Unpacker unpack(sums);
  unpack_sums(unpack, pool, 0, kept);
  return std::move(kept);
}

}  // namespace assay::harness
