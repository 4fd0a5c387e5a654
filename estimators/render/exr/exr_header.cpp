#include "render/exr/exr_header.h"

#include <openexr.h>

#include "estimators/core/value.h"

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

void require_sound_headers(const std::string& file) {
  std::string trouble;
  exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
  settings.user_data = &trouble;
  settings.error_handler_fn = keep_message;
  exr_context_t context = nullptr;
  const exr_result_t result = exr_start_read(&context, file.c_str(), &settings);
  if (result == EXR_ERR_SUCCESS) exr_finish(&context);
  if (trouble.empty() && result == EXR_ERR_SUCCESS) return;
  if (trouble.empty()) trouble = exr_get_default_error_message(result);
  throw InputError({.file = file},
                   "it cannot be read as OpenEXR, damaged or cut short: " + trouble);
}

}  // namespace assay::render
