#include "render/exr/exr_header.h"

#include "estimators/core/value.h"
#include "render/exr/core_file.h"

namespace assay::render {

namespace {

// Keeps the first message, that of the cause.
void keep_message(exr_const_context_t context, exr_result_t, const char* message) {
  void* first = nullptr;
  if (exr_get_user_data(context, &first) != EXR_ERR_SUCCESS || first == nullptr) return;
  std::string& kept = *static_cast<std::string*>(first);
  if (kept.empty()) kept = message;
}

}  // namespace

CoreFile::CoreFile(const std::string& file) {
  exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
  settings.user_data = &message_;
  settings.error_handler_fn = keep_message;
  result_ = exr_start_read(&context_, file.c_str(), &settings);
}

CoreFile::~CoreFile() {
  if (result_ == EXR_ERR_SUCCESS) exr_finish(&context_);
}

std::string CoreFile::trouble() const {
  if (!message_.empty() || result_ == EXR_ERR_SUCCESS) return message_;
  return exr_get_default_error_message(result_);
}

std::shared_ptr<CoreFile> open_sound_file(const std::string& file) {
  auto opened = std::make_shared<CoreFile>(file);
  const std::string trouble = opened->trouble();
  if (trouble.empty()) return opened;
  throw InputError({.file = file},
                   "it cannot be read as OpenEXR, damaged or cut short: " + trouble);
}

}  // namespace assay::render
