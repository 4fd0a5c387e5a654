// Pictures of other programs (estimators/picture_file.h, estimators/pictures.h). Every file is
// read, or refused with its name.

#include <vector>

#include "estimators/core/value.h"
#include "estimators/pictures.h"
#include "tests/fuzz/case.h"

namespace {

using namespace assay;

void read_all(const std::string& file) {
  const auto picture = open_picture(file);
  for (const FileChannel& channel : picture->channels()) {
    const std::vector<std::string> names{channel.name};
    const PictureWindow window = picture->window(names);
    // The format lets a file of 4 KiB hold more than a case may take.
    if (window.width * window.height > 1 << 16) continue;
    std::vector<float> texels(window.width * window.height);
    picture->read(names, texels);
  }
}

/// A refusal names the file and a reason.
template <class Work>
void guarded(const std::string& file, const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    if (error.where().file != file || error.message().empty()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file = fuzz::written(data, size, ".exr");
  guarded(file, [&] { read_all(file); });
  guarded(file, [&] { recorded::open_stack({file}, "usual", {}); });
  guarded(file, [&] { recorded::open_stack({file}, "*.R,?", {}); });
  return 0;
}
