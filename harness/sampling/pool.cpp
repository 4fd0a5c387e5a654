#include "harness/sampling/pool.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <iterator>
#include <new>
#include <stdexcept>

#include "estimators/core/flush_denormals.h"
#include "estimators/core/thread_seconds.h"
#include "estimators/core/value.h"
#include "estimators/ready_made.h"
#include "harness/sampling/prepare.h"
#include "stats/gates/dependence.h"
#include "stats/images/image_moments.h"
#include "stats/variances/group_variance.h"

namespace assay::harness {
namespace {

// A block takes milliseconds at a microsecond a primary: long against handing it out, short against
// a run.
constexpr std::uint64_t primaries_per_block = 16384;
constexpr std::uint64_t least_block = 8;
static_assert(least_block % stats::variance_group == 0);  // No group spans two blocks.
constexpr std::uint64_t most_block = 4096;

/// Places [first, last) of a list, as far as they are there.
template <class T>
std::span<const T> part_of(const std::vector<T>& list, std::uint64_t first, std::uint64_t last) {
  const std::size_t end = std::min<std::size_t>(list.size(), last);
  const std::size_t begin = std::min<std::size_t>(first, end);
  return std::span(list).subspan(begin, end - begin);
}

/// Appends the values of observations that follow to those of each channel.
void append(KeptValues& all, const KeptValues& next) {
  for (const auto& [channel, values] : next) {
    all[channel].insert(all[channel].end(), values.begin(), values.end());
  }
}

/// A copy without what end_drawing() makes again.
std::shared_ptr<const Summary> without_sums(const Summary& of) {
  auto summary = std::make_shared<Summary>();
  summary->count = of.count;
  summary->cost = of.cost;
  summary->seconds = of.seconds;
  return summary;
}

std::size_t elements_of(const Setup& setup) {
  const std::optional<ImageShape> image = setup.image();
  return image ? image->elements() : 0;
}

}  // namespace

std::string sentence_of(const Fault& fault, const std::string& estimator, const std::string& when) {
  const std::string at =
      fault.observation ? fmt::format(" at observation {}", *fault.observation) : "";
  return fmt::format("`{}` stopped{}{}: {}", estimator, when, at, fault.words);
}

std::string words_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    return "there is not enough memory (std::bad_alloc)";
  } catch (const std::exception& error) {
    const std::string words = error.what();
    return words.empty() ? "it threw an exception without words" : words;
  } catch (...) {
    return "it threw something that is no std::exception";
  }
}

std::span<const double> Drawn::values(std::size_t channel) const {
  const auto kept = pool_->values_.find(channel);
  return kept == pool_->values_.end() ? std::span<const double>()
                                      : part_of(kept->second, 0, count_);
}

const std::vector<stats::Gate>& Drawn::order_gates(std::size_t channel) const {
  std::span<const double> first = values(channel);
  first = first.first(std::min<std::size_t>(first.size(), ordered_values));
  const auto [found, added] = pool_->order_gates_.try_emplace({channel, first.size()});
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (added && std::ranges::all_of(first, is_finite)) {
    found->second = stats::drawn_order_gates(first);
  }
  return found->second;
}

Images Drawn::images(std::uint64_t most) const {
  return part_of(pool_->all_kept().images, 0, std::min(count_, most));
}

std::uint64_t primaries_of_observation(const Setup& setup, std::uint64_t primaries) {
  return primaries * std::max<std::size_t>(elements_of(setup), 1);
}

std::uint64_t block_size_of(std::uint64_t primaries) {
  return std::bit_floor(std::clamp(primaries_per_block / primaries, least_block, most_block));
}

Pool::Pool(std::shared_ptr<const Setup> setup, Recipe recipe)
    : setup_(std::move(setup)),
      recipe_(std::move(recipe)),
      block_size_(block_size_of(primaries_of_observation(*setup_, recipe_.primaries))),
      channels_(setup_->channel_count()),
      elements_(elements_of(*setup_)) {
  if (const RecordedRun* run = as_recorded_run(*setup_)) ready_made_ = &run->summary;
  // Files of pictures are read once.
  if (setup_->image()) keep_observations(setup_->observations().value_or(0));
  for (const std::uint64_t count : std::exchange(recipe_.marks, {})) mark(count);
}

std::vector<ChannelPlan>& Pool::plans() {
  recipe_.plan.resize(channels_);
  return recipe_.plan;
}

Summary Pool::no_sums() const {
  return sums_later() ? Summary() : Summary(channels_, recipe_.plan);
}

void Pool::mark(std::uint64_t count) {
  const bool known = !prefixes_.try_emplace(count, std::make_shared<const Summary>()).second;
  if (!known && count <= drawn()) throw std::logic_error("a prefix was marked after it was drawn");
}

void Pool::request(std::uint64_t count) {
  mark(count);
  if (!is_ready_made()) requested_ = std::max(requested_, count);
}

Sample Pool::sample(std::uint64_t count) const {
  // An earlier run's moments live as long as their set-up.
  if (is_ready_made()) return Drawn(*this, count, {setup_, ready_made_});
  if (count <= drawn()) return Drawn(*this, count, prefixes_.at(count));
  if (fault_) return *fault_;
  throw std::logic_error("observations were asked for before they were drawn");
}

double Pool::seconds() const {
  if (is_ready_made()) return ready_made_->seconds;
  const auto beyond = prefixes_.upper_bound(std::min(drawn(), requested_));
  return beyond == prefixes_.begin() ? 0 : std::prev(beyond)->second->seconds;
}

std::uint64_t Pool::block_end(std::uint64_t first) const {
  const std::uint64_t most = most_marked();
  return std::min({first + block_size_, most, setup_->observations().value_or(most)});
}

/// Reads a picture to where it is kept. Its average follows it.
void Pool::read_picture(std::uint64_t index, Block& block) const {
  std::vector<float>& picture = block.observations->images.emplace_back(elements_);
  setup_->pictures()->read(index, picture, block.whole.cost);
  stats::ChannelSums sum(1);
  sum.add(picture);
  block.observations->values.push_back({sum.sums()[0] / static_cast<double>(elements_)});
}

/// Draws one observation; an image in single precision.
void Pool::draw_one(Estimator& estimator, std::uint64_t index, std::span<double> out,
                    Cost& cost) const {
  Stream random(recipe_.key, index);
  estimator.secondary(random, recipe_.primaries, out, cost);
  for (double& number : out.first(elements_)) number = static_cast<float>(number);
}

/// One observation. Pictures need not stand in `out`.
void Pool::observe(Estimator& estimator, std::uint64_t index, std::span<double> out,
                   Block& block) const {
  if (known_ && index < known_->size()) {
    block.whole.cost += known_->costs[index];
    if (!out.empty()) known_->whole(index, out);
    return;
  }
  if (known_ || index >= recipe_.kept_observations) {
    draw_one(estimator, index, out, block.whole.cost);
    return;
  }
  const Cost before = block.whole.cost;
  KeptObservations& kept = *block.observations;
  if (setup_->pictures()) {
    read_picture(index, block);
    if (!out.empty()) kept.whole(kept.images.size() - 1, out);
  } else {
    draw_one(estimator, index, out, block.whole.cost);
    const std::span<const double> image = out.first(elements_);
    const std::span<const double> rest = out.subspan(elements_);
    kept.images.emplace_back(image.begin(), image.end());
    kept.values.emplace_back(rest.begin(), rest.end());
  }
  kept.costs.push_back(block.whole.cost - before);
}

Pool::Block Pool::draw(const std::function<Estimator&()>& estimator, std::uint64_t first,
                       std::uint64_t last) const {
  const bool later = sums_later();
  Block block{.whole = no_sums()};
  for (std::size_t c = 0; c < recipe_.plan.size(); ++c) {
    if (first < recipe_.plan[c].keep) block.values[c];
  }
  std::vector<double> row(later && setup_->pictures() && block.values.empty() ? 0 : channels_);
  auto mark = prefixes_.upper_bound(first);
  Estimator* source = nullptr;
  const auto seconds = [&source] {
    return thread_seconds() + (source == nullptr ? 0 : source->seconds_elsewhere());
  };
  double start = seconds();
  std::uint64_t index = first;
  stats::GroupVariance groups(later ? std::vector<std::size_t>() : recipe_.grouped_channels);
  const bool with_costs =
      !later && std::ranges::count(recipe_.plan, Powers::with_costs, &ChannelPlan::powers) > 0;
  ObservationCost cost{};
  const FlushDenormals flush;
  try {
    source = &estimator();
    start = seconds();
    source->announce({.key = recipe_.key, .first = first, .last = last});
    for (; index < last; ++index) {
      Cost before;
      if (with_costs) before = block.whole.cost;
      observe(*source, index, row, block);
      if (with_costs) cost = counted(block.whole.cost - before);
      if (!later) block.whole.add_observation(row, index, cost);
      for (auto& [channel, values] : block.values) {
        if (index < recipe_.plan[channel].keep) values.push_back(row[channel]);
      }
      if (const auto variance = groups.add(row)) block.whole.group_variances.add(*variance);
      ++block.whole.count;
      if (mark != prefixes_.end() && index + 1 == mark->first) {
        auto partial = std::make_shared<Summary>(block.whole);
        partial->seconds = seconds() - start;
        block.partial.emplace_back(mark->first, std::move(partial));
        ++mark;
      }
    }
  } catch (...) {
    block.fault = {.observation = index, .words = words_of(std::current_exception())};
  }
  block.whole.seconds = seconds() - start;
  return block;
}

/// Summed once for all pools that share the observations.
std::shared_ptr<const Summary> Pool::sums_of_first(std::uint64_t count, const Summary& drawn) {
  const auto shared = all_kept().sums.find(count);
  if (shared != all_kept().sums.end()) return shared->second;
  auto summed = std::make_shared<Summary>(drawn);
  summed->channels = all_kept().sums_of(0, count);
  if (!known_) kept_->sums[count] = summed;
  return summed;
}

/// Takes what is kept beside moments of kept observations, as draw() does of others.
void Pool::take_details(Summary& summary) const {
  summary.detailed = Summary(channels_, recipe_.plan).detailed;
  stats::GroupVariance groups(recipe_.grouped_channels);
  std::vector<double> out(channels_);
  for (std::uint64_t index = 0; index < summary.count; ++index) {
    all_kept().whole(index, out);
    const ObservationCost cost = counted(all_kept().costs[index]);
    for (auto& [channel, details] : summary.detailed) add_details(details, out[channel], cost);
    if (const auto variance = groups.add(out)) summary.group_variances.add(*variance);
  }
}

void Pool::end_drawing() {
  if (!sums_later()) return;
  const bool plain = recipe_.grouped_channels.empty() &&
                     std::ranges::none_of(recipe_.plan, &ChannelPlan::has_details);
  for (auto& [count, prefix] : prefixes_) {
    if (count > drawn() || count == 0 || !prefix->channels.empty()) continue;
    std::shared_ptr<const Summary> sums = sums_of_first(count, *prefix);
    if (!plain) {
      auto with_details = std::make_shared<Summary>(*sums);
      take_details(*with_details);
      sums = std::move(with_details);
    }
    prefix = std::move(sums);
  }
}

Recipe Pool::recipe() const {
  Recipe recipe = recipe_;
  for (const auto& [count, unused] : prefixes_) recipe.marks.push_back(count);
  return recipe;
}

bool Pool::can_be_drawn_elsewhere() const {
  return !known_ && !keeps_blocks_ && !setup_->observations() && !setup_->pictures() &&
         !setup_->keeps_files();
}

Pool::Block Pool::drawn_sums() const {
  Block block{.whole = running_, .fault = fault_};
  for (const auto& [count, sums] : prefixes_) {
    if (count == 0 || count > drawn()) continue;
    block.partial.emplace_back(count, sums_later() ? without_sums(*sums) : sums);
  }
  return block;
}

std::uint64_t Pool::kept_end() const {
  std::uint64_t most = recipe_.kept_observations;
  for (const ChannelPlan& channel : recipe_.plan) most = std::max(most, channel.keep);
  return std::min(drawn(), most);
}

Pool::Block Pool::kept_block(std::uint64_t first, std::uint64_t last) const {
  const auto copy = [&]<class T>(const std::vector<T>& list) {
    const std::span<const T> part = part_of(list, first, last);
    return std::vector<T>(part.begin(), part.end());
  };
  Block block;
  *block.observations = {copy(kept_->images), copy(kept_->values), copy(kept_->costs)};
  for (const auto& [channel, values] : values_) block.values[channel] = copy(values);
  return block;
}

void Pool::Block::append_kept(Block&& next) {
  append(values, next.values);
  observations->append(std::move(*next.observations));
}

void Pool::fold(Block&& block) {
  if (drawn() == 0) running_ = no_sums();
  if (fault_) return;
  for (auto& [count, partial] : block.partial) {
    auto prefix = std::make_shared<Summary>(running_);
    prefix->append(*partial);
    prefixes_.at(count) = std::move(prefix);
  }
  const std::uint64_t before = running_.count;
  running_.append(block.whole);
  append(values_, block.values);
  kept_->append(std::move(*block.observations));
  if (keeps_blocks_ && block.whole.count > 0) {  // its first observation may have failed
    block.whole.detailed.clear();
    if (sums_later()) block.whole.channels = all_kept().sums_of(before, drawn());
    blocks_.push_back(std::move(block.whole));
  }
  fault_ = std::move(block.fault);
}

void Pool::draw_again(Estimator& estimator, std::uint64_t index, std::span<double> out) const {
  const FlushDenormals flush;
  Cost unused;
  draw_one(estimator, index, out, unused);
}

void KeptObservations::whole(std::size_t index, std::span<double> out) const {
  std::ranges::copy(values[index], std::ranges::copy(images[index], out.begin()).out);
}

std::vector<ChannelSummary> KeptObservations::sums_of(std::uint64_t begin,
                                                      std::uint64_t end) const {
  std::vector<ChannelSummary> all = sums_of_images(part_of(images, begin, end));
  const std::size_t elements = all.size();
  all.resize(elements + values[begin].size());
  for (std::uint64_t index = begin; index < end; ++index) {
    for (std::size_t i = 0; i < values[index].size(); ++i) {
      all[elements + i].add(values[index][i], index - begin);
    }
  }
  return all;
}

void KeptObservations::append(KeptObservations&& next) {
  std::ranges::move(next.images, std::back_inserter(images));
  std::ranges::move(next.values, std::back_inserter(values));
  std::ranges::move(next.costs, std::back_inserter(costs));
}

}  // namespace assay::harness
