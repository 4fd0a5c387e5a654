#pragma once

// A user may interrupt while this program waits for another one, and hears of long waits.

#include <string>

namespace assay {

/// Sets what tells whether to stop waiting, as a user asks by Ctrl-C; nullptr for never. Whoever
/// waits calls it some times a second, from any thread.
void set_stop_question(bool (*stop)());
/// Throws std::runtime_error where waiting is to stop.
void stop_if_asked();

/// Sets what takes sentences that no result depends on, from any thread; nullptr for nothing.
void set_notice(void (*say)(const std::string& sentence));
void notice(const std::string& sentence);

}  // namespace assay
