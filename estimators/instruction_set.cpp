#include "estimators/instruction_set.h"

#include "render/scene.h"

namespace assay {

std::string ray_instruction_set() { return render::isa(); }

}  // namespace assay
