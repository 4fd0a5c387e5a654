#pragma once

// A shared library that keeps the interface of estimators/plugin_abi.h, opened and read with regard
// to the sizes of its structs.

#include <cstddef>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "estimators/plugin_abi.h"

namespace assay::foreign {

/// A sentence on what is wrong with a library, and how to mend it.
class LibraryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A struct as a library of any age has it: members beyond its `size` are zero.
template <class Struct>
Struct as_known(const Struct* theirs) {
  Struct ours{};
  std::memcpy(&ours, theirs, theirs->size < sizeof ours ? theirs->size : sizeof ours);
  ours.size = sizeof ours;
  return ours;
}

/// An array of such structs, each as large as the first says.
template <class Struct>
std::vector<Struct> all_known(const Struct* first, std::size_t count) {
  std::vector<Struct> all;
  const char* at = reinterpret_cast<const char*>(first);
  for (std::size_t i = 0; i < count; ++i, at += first->size) {
    all.push_back(as_known(reinterpret_cast<const Struct*>(at)));
  }
  return all;
}

/// An open library: it stays loaded while this object lives.
class SharedObject {
 public:
  /// Throws LibraryError: no such file, no library, without the symbol, of another version, or a
  /// table that is no table.
  explicit SharedObject(const std::string& file);

  const std::vector<AssayEstimator>& estimators() const { return estimators_; }
  /// The estimator of this name; the only one where the name is empty. Throws LibraryError.
  const AssayEstimator& find(const std::string& name) const;
  const std::string& file() const { return file_; }

 private:
  void read_table(const AssayLibrary* table);

  std::string file_;
  std::shared_ptr<void> handle_;
  std::vector<AssayEstimator> estimators_;
};

}  // namespace assay::foreign
