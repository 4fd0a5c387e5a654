#include "harness/sampling/sample.h"

#include <fmt/format.h>

#include <new>

#include "estimators/core/value.h"
#include "harness/sampling/pool.h"

namespace assay::harness {

std::string sentence_of(const Fault& fault, const std::string& estimator, const std::string& when) {
  const std::string at =
      fault.observation ? fmt::format(" at observation {}", *fault.observation) : "";
  return fmt::format("`{}` stopped{}{}: {}", estimator, when, at, fault.words);
}

std::string words_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    const std::string place = assay::to_string(error.where());
    return place.empty() ? error.message() : place + ": " + error.message();
  } catch (const std::bad_alloc&) {
    return "there is not enough memory (std::bad_alloc)";
  } catch (const std::exception& error) {
    const std::string words = error.what();
    return words.empty() ? "it threw an exception without words" : words;
  } catch (...) {
    return "it threw something that is no std::exception";
  }
}

std::span<const double> Drawn::values(std::size_t channel) const {
  return pool_->values(channel, count_);
}

const std::vector<stats::Gate>& Drawn::order_gates(std::size_t channel) const {
  return pool_->order_gates(channel, count_);
}

Observations Drawn::observations(std::uint64_t most) const {
  return pool_->observations(std::min(count_, most));
}

std::span<const BlockSums> Drawn::blocks() const { return pool_->blocks(); }

}  // namespace assay::harness
