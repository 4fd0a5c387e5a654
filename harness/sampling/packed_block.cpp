#include "harness/sampling/packed_block.h"

#include <algorithm>

namespace assay::harness {

template <class Archive, maybe_const<Cost> T>
void parts(Archive& a, T& cost) {
  a(cost.camera_rays, cost.closest_hit_rays, cost.shadow_rays, cost.samples);
}

template <class Archive, maybe_const<stats::Moments> T>
void parts(Archive& a, T& moments) {
  a(moments.count, moments.mean, moments.m2, moments.m3, moments.m4, moments.minimum,
    moments.maximum, moments.nonzero, moments.rest);
}

template <class Archive, maybe_const<stats::JointMoments::Coordinate> T>
void parts(Archive& a, T& coordinate) {
  a(coordinate.mean, coordinate.rest, coordinate.minimum, coordinate.maximum);
}

template <class Archive, maybe_const<stats::JointMoments> T>
void parts(Archive& a, T& joint) {
  a(joint.count, joint.known, joint.of_x, joint.of_cost);
  a.fixed(joint.sums);
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

ChannelDetails& details_of(ChannelSummary& channel) { return channel.rare.made(); }
const ChannelDetails& details_of(const ChannelSummary& channel) { return *channel.rare; }

template <class Archive, maybe_const<ChannelSummary> T>
void parts(Archive& a, T& channel) {
  a(channel.moments, channel.nonfinite, channel.first_nonfinite);
  if (channel.rare) a(details_of(channel));
}

template <class Archive, maybe_const<Summary> T>
void parts(Archive& a, T& summary) {
  a(summary.count, summary.group_variances, summary.cost, summary.seconds);
  a.fixed(summary.channels);
}

template <class Archive, maybe_const<Fault> T>
void parts(Archive& a, T& fault) {
  a(fault.observation, fault.words);
}

namespace {

constexpr std::size_t most_cells = std::size_t{1} << 24;

/// The number of observations [first, first + count) that lie below `end`.
std::uint64_t below(std::uint64_t end, std::uint64_t first, std::uint64_t count) {
  return std::min(std::max(end, first) - first, count);
}

/// Everything in a block is sized by the plan and by how many observations it has.
void require_shape(const Pool::Block& block, const Recipe& recipe, const Pool& pool,
                   std::uint64_t first) {
  const std::uint64_t count = block.whole.count;
  const auto require = Unpacker::require;
  require(block.values.size() == (most_kept(recipe.plan) > 0 ? pool.channels() : 0),
          "values of other channels than the pool has");
  for (std::size_t c = 0; c < block.values.size(); ++c) {
    require(block.values[c].size() == below(recipe.plan[c].keep, first, count),
            "other values than its plan says");
  }
  require(block.observations.costs.size() == below(recipe.kept_observations, first, count) &&
              block.observations.values.size() == block.observations.costs.size(),
          "other observations than its plan says");
  for (const std::vector<double>& values : block.observations.values) {
    require(values.size() == pool.channels(), "an observation of other channels than the pool has");
  }
}

}  // namespace

Pool pool_of(const Recipe& recipe, std::shared_ptr<const Setup> setup) {
  Unpacker::require(setup != nullptr, "there is no such set-up");
  Unpacker::require(recipe.primaries > 0, "observations of no primaries");
  Pool pool(std::move(setup), recipe.key, recipe.primaries);
  Unpacker::require(recipe.plan.empty() || recipe.plan.size() == pool.channels(),
                    "a plan of other channels than the set-up has");
  for (const ChannelPlan& channel : recipe.plan) {
    Unpacker::require(channel.cells <= most_cells && channel.powers <= Powers::with_costs,
                      "a plan that no pool has");
  }
  for (const std::size_t channel : recipe.grouped_channels) {
    Unpacker::require(channel < pool.channels(), "a channel that the set-up does not have");
  }
  pool.plan(recipe.plan);
  pool.keep_group_variances(recipe.grouped_channels);
  pool.keep_observations(recipe.kept_observations);
  for (const std::uint64_t mark : recipe.marks) pool.mark(mark);
  return pool;
}

std::string packed_block(const Pool::BlockParts& block) {
  Packer pack;
  pack(block.whole, block.fault, block.values, block.observations.values, block.observations.costs);
  pack(static_cast<std::uint64_t>(block.partial.size()));
  for (const auto& [count, sums] : block.partial) pack(count, *sums);
  return framed(pack.bytes());
}

Pool::Block unpacked_block(std::string_view frame, const Pool& pool, std::uint64_t first) {
  Unpacker unpack(unframed(frame));
  const Recipe recipe = pool.recipe();
  Pool::Block block{.whole = Summary(pool.channels(), recipe.plan)};
  unpack(block.whole, block.fault, block.values, block.observations.values,
         block.observations.costs);
  require_shape(block, recipe, pool, first);
  const std::uint64_t end = first + block.whole.count;
  const auto begin = std::ranges::upper_bound(recipe.marks, first);
  const std::vector<std::uint64_t> marks(begin, std::ranges::upper_bound(recipe.marks, end));
  std::uint64_t partials = 0;
  unpack(partials);
  unpack.require(partials == marks.size(), "other marks than its plan says");
  for (const std::uint64_t mark : marks) {
    auto& [count, sums] = block.partial.emplace_back(0, Summary(pool.channels(), recipe.plan));
    unpack(count, sums);
    unpack.require(count == mark && sums.count == mark - first, "other marks than its plan says");
  }
  unpack.end();
  return block;
}

}  // namespace assay::harness
