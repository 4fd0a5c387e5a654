#pragma once

// An estimator of a shared library, called in this process.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "estimators/estimator.h"
#include "estimators/foreign/hello.h"
#include "estimators/foreign/shared_object.h"

namespace assay::foreign {

/// Which estimator of which library, with what parameters.
struct LibraryChoice {
  std::string file;
  std::string estimator;  ///< empty: the only one
  std::vector<std::pair<std::string, std::string>> parameters;
  std::string folder;  ///< what file names in them are relative to
};

/// An estimator that the library has prepared; released when it goes.
class PreparedLibrary {
 public:
  /// Throws LibraryError, ProtocolError (what the library says of its estimator) and InputError (a
  /// parameter).
  explicit PreparedLibrary(const LibraryChoice& choice);
  ~PreparedLibrary();
  PreparedLibrary(const PreparedLibrary&) = delete;
  PreparedLibrary& operator=(const PreparedLibrary&) = delete;

  /// The library's hello, as if it were a program.
  const Hello& hello() const { return hello_; }
  const std::vector<AssaySampler>& samplers() const { return samplers_; }
  const void* state() const { return state_; }
  const std::string& file() const { return object_.file(); }
  /// Writes an observation; returns its rays. Throws LibraryError where the library reports an
  /// error.
  std::uint64_t observe(AssayStream& random, std::uint64_t primaries, std::span<double> out) const;

 private:
  void prepare(const LibraryChoice& choice, AssayPreparation& preparation);

  SharedObject object_;
  AssayEstimator estimator_;
  void* state_ = nullptr;
  Hello hello_;
  std::vector<AssaySampler> samplers_;
};

/// Its estimator and its samplers as those of any set-up.
std::shared_ptr<const Setup> library_setup(std::shared_ptr<const PreparedLibrary> library);

}  // namespace assay::foreign
