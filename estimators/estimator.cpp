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
  std::optional<Nature> nature() const override { return parts_.nature; }
  Cost cost() const override { return parts_.cost; }

 private:
  SetupParts parts_;
};

}  // namespace

std::string element_name(const ImageShape& shape, std::size_t element) {
  const std::size_t components = shape.components.size();
  const std::size_t pixel = element / components;
  std::string name =
      "x" + std::to_string(shape.left + static_cast<std::int64_t>(pixel % shape.width)) + "y" +
      std::to_string(shape.top + static_cast<std::int64_t>(pixel / shape.width));
  if (components > 1) name += "." + shape.components[element % components];
  return name;
}

std::vector<Channel> element_channels(const ImageShape& shape, const Channel& element) {
  std::vector<Channel> channels(shape.elements(), element);
  for (std::size_t e = 0; e < channels.size(); ++e) channels[e].name = element_name(shape, e);
  return channels;
}

std::shared_ptr<const Setup> setup_of(SetupParts parts) {
  return std::make_shared<SetupOfParts>(std::move(parts));
}

}  // namespace assay

template class std::vector<assay::ParameterInformation>;
template class std::vector<assay::Channel>;
template class std::vector<assay::NamedSampler>;
