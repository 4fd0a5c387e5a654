#pragma once

// Estimators whose observations are drawn by another program.

#include <memory>

#include "estimators/estimator.h"
#include "estimators/foreign/children.h"

namespace assay::foreign {

/// An observation is a function of the stream's key and its index: what the program answers for
/// them. Nothing is drawn from the stream itself.
class ForeignSetup final : public Setup {
 public:
  explicit ForeignSetup(std::shared_ptr<Children> children);

  std::vector<Channel> channels() const override { return children_->hello().channels; }
  std::unique_ptr<Estimator> make() const override;
  std::optional<ImageShape> image() const override { return children_->hello().image; }
  std::optional<Nature> nature() const override { return children_->hello().nature; }
  std::vector<NamedSampler> samplers() const override { return samplers_; }

 private:
  std::shared_ptr<Children> children_;
  std::vector<NamedSampler> samplers_;
};

/// Starts the program. InputError at the parameter `name`, whose value says which program it is,
/// where it cannot be started or refuses; NoAnswer where it ends, or says what is no hello.
std::shared_ptr<const Setup> start(Terms terms, const Parameters& parameters,
                                   std::string_view name);

/// The limits of any program that is run. `timeout` is in seconds, of what `summary` says.
ParameterInformation timeout_parameter(const std::string& summary, const std::string& fallback);
ParameterInformation memory_parameter();

/// The common parameters of `process` and `library`.
std::vector<ParameterInformation> terms_parameters();
Terms read_terms(Parameters& parameters);

}  // namespace assay::foreign
