#include "estimators/core/waiting.h"

#include <atomic>
#include <stdexcept>

namespace assay {

namespace {

std::atomic<bool (*)()> stop_question{nullptr};
std::atomic<void (*)(const std::string&)> say_notice{nullptr};

}  // namespace

void set_stop_question(bool (*stop)()) { stop_question.store(stop); }

void stop_if_asked() {
  bool (*const asked)() = stop_question.load();
  if (asked != nullptr && asked()) throw std::runtime_error("interrupted");
}

void set_notice(void (*say)(const std::string& sentence)) { say_notice.store(say); }

void notice(const std::string& sentence) {
  if (auto* const say = say_notice.load(); say != nullptr) say(sentence);
}

}  // namespace assay
