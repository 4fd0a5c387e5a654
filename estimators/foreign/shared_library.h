#pragma once

// A shared library that keeps the interface of estimators/plugin_abi.h: opened, read with regard to
// the sizes of its structs, and called in this process.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "estimators/foreign/protocol.h"
#include "estimators/plugin_abi.h"
#include "estimators/sampler.h"

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
  /// The reply to a question for observations. Where that throws LibraryError, `at` is the one that
  /// has the error. Rays stand behind an observation's numbers, as doubles.
  std::vector<double> answer(const Question& question, std::uint64_t& at) const;

 private:
  void prepare(const LibraryChoice& choice, AssayPreparation& preparation);

  SharedObject object_;
  AssayEstimator estimator_;
  void* state_ = nullptr;
  Hello hello_;
  std::vector<AssaySampler> samplers_;
};

/// A sampler as Assay's. It throws LibraryError where the library reports an error or gives a
/// number that is none. Its draws are of streams whose key and observation are the next two words
/// of Assay's.
class LibrarySampler : public Sampler {
 public:
  LibrarySampler(std::shared_ptr<const PreparedLibrary> library, const AssaySampler& sampler);

  Domain domain() const override { return note_.domain; }
  std::array<double, 2> bounds() const override { return note_.bounds; }
  SamplerDraw sample(Stream& random) const override;
  /// The draw of that stream of the library's.
  SamplerDraw draw(std::uint64_t key, std::uint64_t observation) const;
  double density(const Point& point) const override;
  double evaluate(const Point& point) const override;
  double rounding() const override;

 private:
  double number(double value, const char* function, const Point& point) const;

  std::shared_ptr<const PreparedLibrary> library_;
  AssaySampler sampler_;
  SamplerNote note_;
};

}  // namespace assay::foreign
