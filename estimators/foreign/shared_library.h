#pragma once

// A shared library that keeps the interface of estimators/plugin_abi.h: opened, read with regard to
// the sizes of its structs, and called in this process.

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "estimators/foreign/protocol.h"
#include "estimators/plugin_abi.h"

namespace assay::foreign {

/// A sentence on what is wrong with a library, and how to mend it.
class LibraryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An open library: it stays loaded while this object lives.
class SharedObject {
 public:
  /// Throws LibraryError: no such file, no library, without the symbol, of another version, or a
  /// table that is no table.
  explicit SharedObject(const std::string& file);

  /// The estimator of this name; the only one where the name is empty. Throws LibraryError.
  const AssayEstimator& find(const std::string& name) const;
  const std::string& file() const { return file_; }

 private:
  void read_table(const AssayLibrary* table);

  std::string file_;
  std::shared_ptr<void> handle_;
  std::vector<AssayEstimator> estimators_;
};

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
  const std::string& file() const { return object_.file(); }
  /// The reply to a question, as a program gives it. Rays stand behind an observation's numbers, as
  /// doubles. Throws LibraryError where the library reports an error, or a sampler gives a number
  /// that is none.
  std::vector<double> answer(const Question& question, std::string_view items) const;

 private:
  void prepare(const LibraryChoice& choice, AssayPreparation& preparation);
  std::vector<double> observations(const Question& question) const;
  std::vector<double> draws(const AssaySampler& sampler, std::string_view items) const;
  std::vector<double> at_points(const AssaySampler& sampler, Asked what,
                                std::string_view items) const;

  SharedObject object_;
  AssayEstimator estimator_;
  void* state_ = nullptr;
  Hello hello_;
  std::vector<AssaySampler> samplers_;
};

}  // namespace assay::foreign
