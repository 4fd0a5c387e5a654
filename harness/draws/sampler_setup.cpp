#include "harness/draws/sampler_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/core/flush_denormals.h"
#include "harness/sampling/pool.h"

namespace assay::harness {
namespace {

constexpr std::uint64_t most_fetched = 4096;

/// True if the density at its point is about the draw.
bool has_density(const Sampler& sampler, const SamplerDraw& draw) {
  return draw.valid && sampler.point_mass(draw.lobe) == 0;
}

/// A draw, and what its sampler says of its point when it is asked.
struct AskedDraw {
  SamplerDraw draw;
  std::optional<double> density = {};  ///< None if no density is about the draw.
  double evaluation = 0;
};

enum class PointNumbers { none, densities, densities_and_evaluations };

/// Its observations are what `write` makes of a sampler's draws. Announced ones are fetched many at
/// a time: a sampler in another program takes longer to be asked than to answer.
class DrawsEstimator final : public Estimator {
 public:
  using Write = std::function<void(const AskedDraw&, std::span<double>)>;
  DrawsEstimator(const NamedSampler& named, PointNumbers asked, Write write)
      : named_(named), asked_(asked), write_(std::move(write)) {}

  void announce(const Announcement& next) override { announced_ = next; }
  double seconds_elsewhere() const override { return named_.sampler->seconds_elsewhere(); }
  void secondary(Stream& random, std::uint64_t, std::span<double> out, Cost& cost) override {
    write_(draw_of(random), out);
    cost.samples += 1;
  }

 private:
  /// The draw of an observation. Throws if a density is asked for and there is none, or the draw is
  /// unsound. If several cannot be fetched, each is fetched alone, and the one at fault throws.
  const AskedDraw& draw_of(const Stream& random) {
    const std::uint64_t index = random.observation();
    if (random.key() != key_ || index < first_ || index - first_ >= fetched_.size()) {
      fetched_.clear();
      std::vector<Stream> streams;
      const std::uint64_t end = announced_.end_from(random.key(), index);
      for (std::uint64_t i = index; i < std::min(end, index + most_fetched); ++i) {
        streams.emplace_back(random.key(), i);
      }
      try {
        fetched_ = fetched(streams);
      } catch (const std::exception&) {
        if (streams.size() == 1) throw;
        announced_ = {};
        fetched_ = fetched(std::span(streams).first(1));
      }
      key_ = random.key();
      first_ = index;
    }
    return fetched_[index - first_];
  }

  std::vector<AskedDraw> fetched(std::span<const Stream> streams) const {
    const Sampler& sampler = *named_.sampler;
    std::vector<AskedDraw> all;
    for (const SamplerDraw& draw : draws_of(sampler, streams)) all.push_back({draw});
    if (asked_ == PointNumbers::none) return all;
    std::vector<std::size_t> places;
    std::vector<Point> points;
    for (std::size_t i = 0; i < all.size(); ++i) {
      sound(named_, all[i].draw);
      if (!has_density(sampler, all[i].draw)) continue;
      places.push_back(i);
      points.push_back(all[i].draw.point);
    }
    std::vector<double> numbers(points.size());
    const auto ask = [&](const Densities& of_points, auto number) {
      write_all(of_points, points, numbers);
      for (std::size_t i = 0; i < numbers.size(); ++i) all[places[i]].*number = numbers[i];
    };
    ask([&](auto some, auto out) { return sampler.densities(some, out); }, &AskedDraw::density);
    if (asked_ == PointNumbers::densities) return all;
    ask([&](auto some, auto out) { return sampler.evaluations(some, out); },
        &AskedDraw::evaluation);
    return all;
  }

  const NamedSampler& named_;
  PointNumbers asked_;
  Write write_;
  Announcement announced_{};
  StreamKey key_{};
  std::uint64_t first_ = 0;
  std::vector<AskedDraw> fetched_;
};

std::size_t number_of(const NamedSampler& named, const DrawCells& cells, const AskedDraw& asked,
                      const SamplerDraw& draw) {
  const Point& point = asked.draw.point;
  const bool impossible =
      asked.density &&
      is_impossible(*named.sampler, point, sound_density(named, point, *asked.density));
  return cells.index(draw) + (impossible ? cells.size() : 0);
}

double relative_difference(double a, double b) {
  if (a == b) return 0;
  return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

double farther(double one, double other) { return std::isnan(one) || one > other ? one : other; }

/// The larger of two relative differences |a - b| / max(|a|, |b|), 0 if a = b. One compares the
/// draw's density with density(point), the other weight x density(point) with evaluate(point). It
/// is infinite for a draw without a point whose weight is not 0. Point masses have no density and
/// give 0. It is NaN if one of the numbers is NaN.
double difference_of(const AskedDraw& asked) {
  const SamplerDraw& draw = asked.draw;
  if (!asked.density)
    return draw.valid || draw.weight == 0 ? 0 : std::numeric_limits<double>::infinity();
  return farther(relative_difference(draw.density, *asked.density),
                 relative_difference(draw.weight * *asked.density, asked.evaluation));
}

/// The two numbers that are farthest from each other, in words.
std::string contradiction(const AskedDraw& asked) {
  const double weight = asked.draw.weight, density = asked.density.value_or(0);
  if (!asked.density) return fmt::format("the weight without a point is {}, not 0", weight);
  const double far = difference_of(asked);
  const double apart = relative_difference(asked.draw.density, density);
  const int digits = far > 1e-6 ? 9 : 17;
  if (std::isnan(apart) || apart == far)
    return fmt::format("the draw has density {:.{}g}, but density(point) is {:.{}g}",
                       asked.draw.density, digits, density, digits);
  return fmt::format("weight x density is {:.{}g}, but evaluate is {:.{}g}", weight * density,
                     digits, asked.evaluation, digits);
}

}  // namespace

std::vector<SamplerDraw> draws_of(const Sampler& sampler, std::span<const Stream> streams) {
  std::vector<SamplerDraw> draws(streams.size());
  draws.resize(sampler.samples(streams, draws));
  return draws;
}

double no_point(const Marginal& marginal) { return marginal.low - 1; }

SamplerSetup::SamplerSetup(NamedSampler named, const Location& where, StreamKey key)
    : named_(std::move(named)), key_(key) {
  const auto [low, high] = sampler().bounds();
  if (sampler().domain() == Domain::interval &&
      !(std::isfinite(low) && std::isfinite(high) && low < high)) {
    refuse(where, "sampler `{}` draws on [{}, {}]: no interval to divide into cells", name(), low,
           high);
  }
  if (sampler().lobes() < 1) refuse(where, "sampler `{}` has no lobe to draw from", name());
}

std::vector<Marginal> SamplerSetup::marginals() const { return marginals_of(sampler()); }

Channel SamplerSetup::channel(std::size_t place) const {
  const std::vector<Marginal> all = marginals();
  if (place == all.size()) return {.name = cell_channel, .diagnostic = true};
  const Marginal& marginal = all[place];
  return {.name = marginal.name, .low = no_point(marginal), .high = marginal.high};
}

std::unique_ptr<Estimator> SamplerSetup::make() const {
  // Only a claim that counts in cells asks for the density at each draw.
  const std::shared_ptr<const DensityCells> counted = cells_asked_for();
  const PointNumbers numbers = counted ? PointNumbers::densities : PointNumbers::none;
  const auto write = [this, counted, all = marginals()](const AskedDraw& asked,
                                                        std::span<double> out) {
    const SamplerDraw draw = sound(named_, asked.draw);
    const bool point = has_density(sampler(), draw);
    for (std::size_t i = 0; i < all.size(); ++i) {
      out[i] = point ? all[i].coordinate(draw.point) : no_point(all[i]);
    }
    out[all.size()] =
        counted ? static_cast<double>(number_of(named_, counted->cells, asked, draw)) : no_cell;
  };
  return std::make_unique<DrawsEstimator>(named_, numbers, write);
}

/// A density that failed is not asked for again: each time may take a time-out.
auto SamplerSetup::integrated(auto table) const {
  if (!no_density_.empty()) throw NoDensity(no_density_);
  try {
    return table();
  } catch (const std::domain_error&) {
    throw;  // the density exists but allows no cells
  } catch (...) {
    no_density_ = words_of(std::current_exception());
    throw NoDensity(no_density_);
  }
}

/// Points of a few draws. A sampler that cannot draw them says so when a test draws.
const std::vector<Point>& SamplerSetup::drawn() const {
  constexpr std::uint64_t count = 4096;
  if (drawn_) return *drawn_;
  drawn_.emplace();
  const auto streams = mapped_indices(count, [&](std::size_t i) { return Stream(key_, i + 1); });
  const FlushDenormals flush;
  try {
    for (std::span<const Stream> rest = streams; !rest.empty();) {
      const std::vector<SamplerDraw> draws = draws_of(sampler(), rest);
      for (const SamplerDraw& draw : draws)
        if (has_density(sampler(), draw)) drawn_->push_back(sound(named_, draw).point);
      rest = rest.subspan(draws.size());
    }
  } catch (const std::exception&) {
    drawn_->clear();
  }
  return *drawn_;
}

const DensityCells& SamplerSetup::density_cells() const {
  const std::scoped_lock lock(once_);
  if (!cells_) {
    cells_ = integrated([&] {
      return std::make_shared<const DensityCells>(harness::density_cells(named_, key_, drawn()));
    });
  }
  return *cells_;
}

std::shared_ptr<const DensityCells> SamplerSetup::cells_asked_for() const {
  const std::scoped_lock lock(once_);
  return cells_;
}

const stats::TabulatedLaw& SamplerSetup::marginal_law(const std::string& marginal) const {
  const std::scoped_lock lock(once_);
  const auto found = laws_.find(marginal);
  if (found != laws_.end()) return found->second;
  const std::vector<Marginal> all = marginals();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name != marginal) continue;
    auto law = integrated([&] { return law_of(named_, i, drawn()); });
    return laws_.emplace(marginal, std::move(law)).first->second;
  }
  throw std::logic_error("no marginal " + marginal);
}

std::shared_ptr<const SamplerSetup> sampler_setup(const NamedSampler& named, const Location& where,
                                                  StreamKey key) {
  static std::mutex once;
  static std::map<std::pair<const Sampler*, std::uint64_t>, std::weak_ptr<const SamplerSetup>>
      known;
  const std::scoped_lock lock(once);
  std::weak_ptr<const SamplerSetup>& place = known[{named.sampler.get(), key.bits}];
  if (const auto setup = place.lock()) return setup;
  const auto setup = std::make_shared<const SamplerSetup>(named, where, key);
  place = setup;
  return setup;
}

std::string draw_text(const Sampler& sampler, StreamKey key, std::uint64_t index) {
  const FlushDenormals flush;
  Stream random(key, index);
  const SamplerDraw draw = draws_of(sampler, std::span(&random, 1)).at(0);
  if (!draw.valid) return fmt::format("no point; weight {}", draw.weight);
  const std::span point = std::span(draw.point).first(coordinates(sampler.domain()));
  std::string text = fmt::format("point ({}); weight {}", fmt::join(point, ", "), draw.weight);
  if (sampler.lobes() > 1) text += fmt::format("; lobe {}", draw.lobe);
  if (sampler.point_mass(draw.lobe) > 0) return text + "; a point mass, which has no density";
  return text + fmt::format("; density {} with the draw, {} at its point; evaluate there {}",
                            draw.density, sampler.density(draw.point),
                            sampler.evaluate(draw.point));
}

ConsistencySetup::ConsistencySetup(const NamedSampler& named, const Location& where)
    : SamplerSetup(named, where), cells_(sampler()) {}

Channel ConsistencySetup::channel(std::size_t place) const {
  if (place == 0) return {.name = inconsistent_channel};
  return {.name = "difference", .diagnostic = true};
}

std::unique_ptr<Estimator> ConsistencySetup::make() const {
  const auto write = [this](const AskedDraw& asked, std::span<double> out) {
    if (asked.density.value_or(0) < 0) sound_density(named(), asked.draw.point, *asked.density);
    out[1] = difference_of(asked);
    const bool consistent = out[1] <= sampler().rounding();
    out[0] = consistent ? 0 : 1 + static_cast<double>(cells_.index(sound(named(), asked.draw)));
  };
  return std::make_unique<DrawsEstimator>(named(), PointNumbers::densities_and_evaluations, write);
}

std::optional<std::pair<std::uint64_t, std::string>> first_inconsistent(const Pool& pool,
                                                                        std::uint64_t count) {
  const auto& setup = dynamic_cast<const ConsistencySetup&>(*pool.setup());
  std::string found;
  const auto look = [&](const AskedDraw& asked, std::span<double>) {
    if (!(difference_of(asked) <= setup.sampler().rounding())) found = contradiction(asked);
  };
  DrawsEstimator draws(setup.named(), PointNumbers::densities_and_evaluations, look);
  draws.announce({.key = pool.key(), .first = 0, .last = count});
  for (std::uint64_t i = 0; i < count; ++i) {
    pool.draw_again(draws, i, {});
    if (!found.empty()) return std::pair(i, found);
  }
  return std::nullopt;
}

}  // namespace assay::harness
