#pragma once

#include <stdexcept>
#include <string_view>

#include "reports/record/record.h"

namespace assay::reports {

/// A saved run that cannot be read. what() is "FILE: sentence".
class ReadError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The record that json() wrote; `file_name` is for messages only. Throws ReadError that names the
/// file and the place inside it. It refuses other text than JSON, text that was cut short, and
/// another schema version. It also refuses a missing, unknown or repeated key, and a value of the
/// wrong type.
Record read_json(std::string_view text, std::string_view file_name);

}  // namespace assay::reports
