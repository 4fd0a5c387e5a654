#pragma once

// A sampler of a shared library, called in this process.

#include <memory>

#include "estimators/foreign/examination.h"
#include "estimators/foreign/hello.h"
#include "estimators/plugin_abi.h"
#include "estimators/sampler.h"

namespace assay::foreign {

class PreparedLibrary;

/// Throws LibraryError where a function is missing or a domain is none.
void require_whole(const AssaySampler& sampler);

/// The sampler's facts. require_whole() has passed.
SamplerNote note_of(const AssaySampler& sampler);

/// A sampler as Assay's. It throws LibraryError where the library reports an error or gives a
/// number that is none. Its draws are of streams whose key and observation are the next two words
/// of Assay's.
class LibrarySampler : public Sampler {
 public:
  LibrarySampler(std::shared_ptr<const PreparedLibrary> library, const AssaySampler& sampler);

  Domain domain() const override { return note_.domain; }
  std::array<double, 2> bounds() const override { return note_.bounds; }
  SamplerDraw sample(Stream& random) const override;
  /// The draw of that stream of the library's.
  SamplerDraw draw(std::uint64_t key, std::uint64_t observation) const;
  double density(const Point& point) const override;
  double evaluate(const Point& point) const override;
  double rounding() const override;

 private:
  double number(double value, const char* function, const Point& point) const;

  std::shared_ptr<const PreparedLibrary> library_;
  AssaySampler sampler_;
  SamplerNote note_;
};

/// A sampler that nobody else asks twice. It asks again for the first draw, density and evaluation.
/// Other bits are a LibraryError, then and at every later call.
class InProcessSampler final : public LibrarySampler {
 public:
  InProcessSampler(std::shared_ptr<const PreparedLibrary> library, const AssaySampler& sampler);

  SamplerDraw sample(Stream& random) const override;
  double density(const Point& point) const override;
  double evaluate(const Point& point) const override;

 private:
  template <class Ask>
  void look_at_first(Asked what, const Ask& ask) const;

  std::string name_;
  std::string file_;
  mutable std::array<FirstLook, 3> first_looks_;
};

}  // namespace assay::foreign
