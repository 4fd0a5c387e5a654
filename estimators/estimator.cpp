#include "estimators/estimator.h"

template class std::vector<assay::ParameterInformation>;
template class std::vector<assay::Channel>;
template class std::vector<assay::NamedSampler>;
