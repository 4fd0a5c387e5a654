#pragma once

// A sampler of a shared library, called in this process.

#include <memory>

#include "estimators/plugin_abi.h"
#include "estimators/sampler.h"

namespace assay::foreign {

class PreparedLibrary;

/// Throws LibraryError where a function is missing, a domain is none or an interval is empty.
void require_whole(const AssaySampler& sampler);

/// The sampler as Assay's. It throws LibraryError where the library reports an error. Its numbers
/// are of a stream whose key and observation are the next two words of Assay's.
std::shared_ptr<const Sampler> library_sampler(std::shared_ptr<const PreparedLibrary> library,
                                               const AssaySampler& sampler);

}  // namespace assay::foreign
