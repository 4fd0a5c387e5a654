#include "estimators/mutant_information.h"

namespace assay {

Information mutant_information(Information mutant) {
  mutant.summary = mutant.original + " that " + mutant.defect;
  mutant.description = "The estimator " + mutant.original + " with one defect: it " + mutant.defect;
  return mutant;
}

}  // namespace assay
