#pragma once

// A recipe lets another process draw blocks of a pool. It returns them as plain data.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "harness/sampling/packing.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

template <class Archive, maybe_const<ChannelPlan> T>
void parts(Archive& a, T& plan) {
  a(plan.histogram_low, plan.histogram_high, plan.keep, plan.cells, plan.powers);
}

template <class Archive, maybe_const<Recipe> T>
void parts(Archive& a, T& recipe) {
  a(recipe.key.bits, recipe.primaries, recipe.plan, recipe.grouped_channels,
    recipe.kept_observations, recipe.marks);
}

/// A pool that draws by the recipe. Throws Unpackable if the set-up cannot.
Pool pool_of(const Recipe& recipe, std::shared_ptr<const Setup> setup);

/// Packs a block that was drawn, or all that a pool has drawn.
std::string packed_block(const Pool::BlockParts& block);
/// Reads it as a block of the pool that begins at observation `first`. Throws Unpackable unless it
/// has the shape that the pool's plan says, so that it can be folded.
Pool::Block unpacked_block(std::string_view frame, const Pool& pool, std::uint64_t first);

}  // namespace assay::harness
