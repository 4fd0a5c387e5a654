#pragma once

#include "estimators/estimator.h"

namespace assay {

/// An estimator with one defect. The catalogue adds all that its original declares. A parameter of
/// its own stands behind those, or in the place of the one of that name.
struct Mutant {
  std::string name;  ///< without "mutants/"
  std::string original;
  std::string defect;  ///< a verb phrase: "leaves out the cosine."
  std::vector<ParameterInformation> own = {};
};

/// The original's mean, which is the reference to be missed. Its variance and range are its own.
inline Channel only_mean(const Channel& original) {
  return {.name = original.name, .mean = original.mean, .mean_error = original.mean_error};
}

inline Entry mutant(const Mutant& its,
                    std::function<std::shared_ptr<const Setup>(Parameters&)> prepare) {
  return {{.name = "mutants/" + its.name,
           .summary = its.original + " that " + its.defect,
           .description = "The estimator " + its.original + " with one defect: it " + its.defect,
           .parameters = its.own,
           .original = its.original,
           .defect = its.defect},
          std::move(prepare)};
}

}  // namespace assay
