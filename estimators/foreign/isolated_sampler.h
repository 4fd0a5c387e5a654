#pragma once

// A sampler inside another program.

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "estimators/foreign/children.h"
#include "estimators/sampler.h"

namespace assay::foreign {

/// Asks whichever program is idle. Its draws are of streams whose key and observation are the next
/// two words of Assay's. NoAnswer, with the point in question, if the program ends, takes too long
/// or says something else. NoAnswer, too, if it answers differently when it is asked again.
class IsolatedSampler final : public Sampler {
 public:
  /// The sampler that stands at this place in the hello.
  IsolatedSampler(std::shared_ptr<Children> children, std::size_t index);

  Domain domain() const override { return note_.domain; }
  std::array<double, 2> bounds() const override { return note_.bounds; }
  SamplerDraw sample(Stream& random) const override;
  double density(const Point& point) const override;
  double evaluate(const Point& point) const override;
  double rounding() const override;

  std::size_t samples(std::span<const Stream> random, std::span<SamplerDraw> draws) const override;
  std::size_t densities(std::span<const Point> points, std::span<double> out) const override;
  std::size_t lobe_densities(int lobe, std::span<const Point> points,
                             std::span<double> out) const override;
  std::size_t evaluations(std::span<const Point> points, std::span<double> out) const override;
  double seconds_elsewhere() const override;

 private:
  struct Items;

  std::size_t at_points(Asked what, std::span<const Point> points, std::span<double> out) const;
  std::vector<double> ask(const Items& items) const;
  std::vector<double> ask_once(Items& items) const;
  void witness(Dialogue& dialogue, const Question& question, const Items& items) const;
  void require_alone(Dialogue& dialogue, const Question& question, const Items& items,
                     std::span<const double> numbers) const;
  void require_whole(const Items& items, std::span<const double> numbers) const;
  std::vector<double> narrowed(const Items& items, const NoAnswer& failure) const;

  std::shared_ptr<Children> children_;
  std::size_t index_;
  SamplerNote note_;
  /// The first question of each kind, about one item, and its answer.
  struct Witness {
    Question question;
    std::string item;
    std::vector<double> numbers;
  };
  mutable std::mutex mutex_;
  mutable std::map<Asked, Witness> witnesses_;
  mutable std::set<Asked> asked_alone_;
};

}  // namespace assay::foreign
