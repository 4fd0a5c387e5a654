#include "estimators/estimator.h"

namespace assay {

namespace {

class SetupOfParts final : public Setup {
 public:
  explicit SetupOfParts(SetupParts parts) : parts_(std::move(parts)) {}

  std::vector<Channel> channels() const override { return parts_.channels; }
  std::unique_ptr<Estimator> make() const override { return parts_.make(); }
  std::vector<NamedSampler> samplers() const override { return parts_.samplers; }
  std::optional<ImageShape> image() const override { return parts_.image; }
  Cost cost() const override { return parts_.cost; }

 private:
  SetupParts parts_;
};

}  // namespace

std::shared_ptr<const Setup> setup_of(SetupParts parts) {
  return std::make_shared<SetupOfParts>(std::move(parts));
}

}  // namespace assay

template class std::vector<assay::ParameterInformation>;
template class std::vector<assay::Channel>;
template class std::vector<assay::NamedSampler>;
