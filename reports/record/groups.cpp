#include "reports/record/groups.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

namespace assay::reports {
namespace {

// Union-find over the places of the estimators in their suite.
class Partition {
 public:
  explicit Partition(const Suite& suite) : parent_(suite.estimators.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t i = 0; i < parent_.size(); ++i) place_.emplace(suite.estimators[i].name, i);
  }

  void join(const std::string& first, const std::string& second) {
    const auto a = place_.find(first), b = place_.find(second);
    if (a != place_.end() && b != place_.end()) join(a->second, b->second);
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t first = root(a), second = root(b);
    parent_[std::max(first, second)] = std::min(first, second);
  }

  std::size_t root(std::size_t i) const {
    while (parent_[i] != i) i = parent_[i];
    return i;
  }

 private:
  std::vector<std::size_t> parent_;
  std::map<std::string, std::size_t> place_;
};

void join_mutants(const Suite& suite, Partition& partition) {
  for (std::size_t i = 0; i < suite.estimators.size(); ++i) {
    const EstimatorSummary& mutant = suite.estimators[i];
    if (mutant.original.empty()) continue;
    for (std::size_t j = 0; j < suite.estimators.size(); ++j) {
      const EstimatorSummary& other = suite.estimators[j];
      const bool original = other.plugin == mutant.original;
      const bool sibling = other.original == mutant.original;
      if ((original || sibling) && other.parameters == mutant.parameters) partition.join(i, j);
    }
  }
}

Partition partition_of(const Suite& suite) {
  Partition partition(suite);
  for (const Comparison& pair : suite.comparisons) partition.join(pair.first, pair.second);
  for (const Test& test : suite.tests) {
    for (const Sample& sample : test.samples)
      partition.join(test.samples.front().estimator, sample.estimator);
  }
  join_mutants(suite, partition);
  return partition;
}

bool has(const Suite& suite, const std::string& name) {
  for (const EstimatorSummary& estimator : suite.estimators) {
    if (estimator.name == name) return true;
  }
  return false;
}

}  // namespace

std::vector<Suite> groups(const Suite& suite) {
  const Partition partition = partition_of(suite);
  std::map<std::size_t, Suite> by_root;
  for (std::size_t i = 0; i < suite.estimators.size(); ++i) {
    Suite& group = by_root[partition.root(i)];
    group.name = suite.name;
    group.alpha = suite.alpha;
    group.estimators.push_back(suite.estimators[i]);
  }
  std::vector<Suite> result;
  for (auto& [root, group] : by_root) {
    for (const Comparison& pair : suite.comparisons) {
      if (has(group, pair.first) && has(group, pair.second)) group.comparisons.push_back(pair);
    }
    result.push_back(std::move(group));
  }
  return result;
}

}  // namespace assay::reports
