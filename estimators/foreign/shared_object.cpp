#include "estimators/foreign/shared_object.h"

#include <dlfcn.h>
#include <sys/stat.h>

#include <cerrno>

#include "estimators/core/value.h"

namespace assay::foreign {

namespace {

constexpr const char* symbol = "assay_library";

// The members of the first published version: less cannot be.
constexpr std::size_t least_library =
    offsetof(AssayLibrary, estimator_count) + sizeof(AssayLibrary::estimator_count);
constexpr std::size_t least_estimator =
    offsetof(AssayEstimator, secondary) + sizeof(AssayEstimator::secondary);

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw LibraryError("`" + file + "` " + why);
}

/// dlopen's messages repeat the file's name.
std::string reason(const std::string& file) {
  const char* const text = dlerror();
  std::string why = text != nullptr ? text : "no reason is given";
  if (why.starts_with(file + ": ")) why.erase(0, file.size() + 2);
  return why;
}

std::shared_ptr<void> opened(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) {
    refuse(file, std::string("cannot be opened: ") + std::strerror(errno) +
                     "; a file is sought in the suite's folder");
  }
  // With a slash the name is a file, not one to be sought in the system's folders.
  const std::string path = file.find('/') == std::string::npos ? "./" + file : file;
  void* const handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    refuse(file, "is no shared library that can be loaded: " + reason(path) +
                     "; compile it with -shared -fPIC");
  }
  return {handle, [](void* open) { dlclose(open); }};
}

}  // namespace

SharedObject::SharedObject(const std::string& file) : file_(file), handle_(opened(file)) {
  void* const found = dlsym(handle_.get(), symbol);
  if (found == nullptr) {
    refuse(file, std::string("does not export ") + symbol +
                     "(); estimators/plugin_abi.h declares it, and a C++ library needs it there");
  }
  const auto table = reinterpret_cast<const AssayLibrary* (*)()>(found);
  read_table(table());
}

void SharedObject::read_table(const AssayLibrary* table) {
  if (table == nullptr || table->size < least_library) {
    refuse(file_, std::string("returns no table from ") + symbol + "()");
  }
  if (table->version != ASSAY_ABI_VERSION) {
    refuse(file_, "was compiled for version " + std::to_string(table->version) +
                      " of the interface, this is version " + std::to_string(ASSAY_ABI_VERSION) +
                      "; compile it again with this version's plugin_abi.h");
  }
  const AssayLibrary known = as_known(table);
  if (known.estimators == nullptr || known.estimator_count == 0) {
    refuse(file_, "has no estimators in its table");
  }
  if (known.estimators->size < least_estimator) {
    refuse(file_,
           "has an estimator whose `size` is not the size of its struct; set it to "
           "sizeof(AssayEstimator)");
  }
  estimators_ = all_known(known.estimators, known.estimator_count);
  for (const AssayEstimator& estimator : estimators_) {
    if (estimator.name == nullptr || estimator.secondary == nullptr) {
      refuse(file_, "has an estimator without a name or without secondary()");
    }
  }
}

const AssayEstimator& SharedObject::find(const std::string& name) const {
  std::vector<std::string> names;
  for (const AssayEstimator& estimator : estimators_) {
    if (estimator.name == name) return estimator;
    names.emplace_back(estimator.name);
  }
  if (name.empty() && estimators_.size() == 1) return estimators_.front();
  if (name.empty())
    refuse(file_, "has several estimators; set `estimator` to one of " + quoted(names));
  refuse(file_, "has no estimator `" + name + "`" +
                    did_you_mean(name, names, "there is " + quoted(names)));
}

}  // namespace assay::foreign
