#include "estimators/core/flow.h"

#include <stdexcept>

namespace assay {

namespace {

class FlowParser {
 public:
  explicit FlowParser(std::string_view text) : text_(text) {}

  Value document() {
    Value value = node("");
    skip_blanks();
    if (at_ != text_.size()) fail("text after the value");
    return value;
  }

 private:
  Value node(std::string_view stops) {
    skip_blanks();
    if (accept('[')) return list();
    if (accept('{')) return map();
    const std::string text = plain(stops);
    return text == "null" ? Value{} : Value::scalar(text);
  }

  Value list() {
    std::vector<Value> items;
    while (!accept(']')) {
      items.push_back(node(",]"));
      separate(']');
    }
    return Value::list(std::move(items));
  }

  Value map() {
    std::vector<Value::Member> members;
    while (!accept('}')) {
      std::string key = plain(":");
      if (!accept(':')) fail("a key without `:`");
      members.emplace_back(std::move(key), node(",}"));
      separate('}');
    }
    return Value::map(std::move(members));
  }

  std::string plain(std::string_view stops) {
    skip_blanks();
    std::size_t end = std::min(text_.find_first_of(stops, at_), text_.size());
    const std::size_t next = end;
    while (end > at_ && text_[end - 1] == ' ') --end;
    const std::string found(text_.substr(at_, end - at_));
    at_ = next;
    if (found.empty()) fail("a value is missing");
    return found;
  }

  void separate(char close) {
    if (!accept(',') && (skip_blanks(), at_ == text_.size() || text_[at_] != close)) {
      fail("expected a comma");
    }
  }

  bool accept(char c) {
    skip_blanks();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  [[noreturn]] void fail(const char* why) const {
    throw std::logic_error("the fallback `" + std::string(text_) + "`: " + why);
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Value parse_flow(std::string_view text) { return FlowParser(text).document(); }

}  // namespace assay
