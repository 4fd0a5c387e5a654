#include "estimators/estimator.h"

#include <utility>

namespace assay {

Entry::Entry(Information what, Prepare how)
    : information(std::move(what)), prepare(std::move(how)) {}
Entry::Entry(const Entry&) = default;
Entry::Entry(Entry&&) noexcept = default;
Entry& Entry::operator=(const Entry&) = default;
Entry& Entry::operator=(Entry&&) noexcept = default;
Entry::~Entry() = default;

}  // namespace assay

template class std::vector<assay::ParameterInformation>;
template class std::vector<assay::Channel>;
template class std::vector<assay::NamedSampler>;
template class std::vector<assay::Entry>;
