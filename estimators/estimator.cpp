#include "estimators/estimator.h"

namespace assay {

namespace {

class SetupOfParts final : public Setup {
 public:
  explicit SetupOfParts(SetupParts parts) : parts_(std::move(parts)) {}

  std::size_t channel_count() const override { return elements() + parts_.channels.size(); }
  Channel channel(std::size_t place) const override {
    if (place >= elements()) return parts_.channels.at(place - elements());
    Channel element = parts_.elements[place % parts_.elements.size()];
    element.name = element_name(*parts_.image, place);
    return element;
  }
  std::unique_ptr<Estimator> make() const override { return parts_.make(); }
  std::vector<NamedSampler> samplers() const override { return parts_.samplers; }
  std::optional<ImageShape> image() const override { return parts_.image; }
  std::optional<Nature> nature() const override { return parts_.nature; }
  Cost cost() const override { return parts_.cost; }

 private:
  std::size_t elements() const { return parts_.image ? parts_.image->elements() : 0; }

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

std::string element_place(const ImageShape& shape, std::size_t element) {
  const std::size_t pixel = element / shape.components.size();
  return "pixel x " + std::to_string(shape.left + static_cast<std::int64_t>(pixel % shape.width)) +
         ", y " + std::to_string(shape.top + static_cast<std::int64_t>(pixel / shape.width)) +
         " of " + shape.components[element % shape.components.size()];
}

std::vector<Channel> Setup::channels() const {
  std::vector<Channel> all(channel_count());
  for (std::size_t place = 0; place < all.size(); ++place) all[place] = channel(place);
  return all;
}

std::shared_ptr<const Setup> setup_of(SetupParts parts) {
  return std::make_shared<SetupOfParts>(std::move(parts));
}

}  // namespace assay

template class std::vector<assay::ParameterInformation>;
template class std::vector<assay::Channel>;
template class std::vector<assay::NamedSampler>;
