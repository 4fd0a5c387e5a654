#pragma once

#include <openexr.h>

#include <string>

namespace assay::render {

/// A file that the core has open, and the first fault that it found.
class CoreFile {
 public:
  explicit CoreFile(const std::string& file);
  ~CoreFile();
  CoreFile(const CoreFile&) = delete;  // the core knows where it is
  CoreFile& operator=(const CoreFile&) = delete;

  exr_const_context_t context() const { return context_; }
  /// "" where nothing is wrong.
  std::string trouble() const;

 private:
  std::string message_;
  exr_result_t result_;
  exr_context_t context_ = nullptr;
};

}  // namespace assay::render
