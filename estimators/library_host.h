#pragma once

// A program that hosts one estimator of a library and speaks the protocol of `process`. A library
// runs in such a process of its own, so that a crash is its own.

#include <string>
#include <vector>

namespace assay {

/// The word by which a program is told to be such a host, before its other arguments.
inline constexpr const char* library_host_word = "host-library";

/// Which program is the host: it calls host_library() with what stands after the word above. Where
/// none is set the environment variable ASSAY_PROGRAM names it.
void set_library_host(const std::string& program);
/// Throws std::runtime_error where no program is known.
std::string library_host();

/// Serves an estimator until standard input ends: file, estimator (empty: the only one), folder,
/// and names and values of parameters in turn. Returns the exit code; standard output is the
/// protocol's.
int host_library(const std::vector<std::string>& arguments);

}  // namespace assay
