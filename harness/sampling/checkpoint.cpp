#include "harness/sampling/checkpoint.h"

#include <fmt/format.h>

#include <filesystem>

#include "estimators/core/value.h"
#include "harness/base/interrupt.h"
#include "harness/base/refuse.h"
#include "harness/base/terminal.h"
#include "harness/base/text_file.h"
#include "harness/base/whole_file.h"
#include "harness/sampling/packing.h"

namespace assay::harness {
namespace {

// Writing may take so small a part of the time.
constexpr int pauses_a_write = 20;

}  // namespace

Checkpoint::Checkpoint(std::string file, std::chrono::duration<double> pause, Identity identity,
                       std::shared_ptr<Executor> inner)
    : file_(std::move(file)),
      pause_(std::chrono::duration_cast<std::chrono::steady_clock::duration>(pause)),
      identity_(std::move(identity)),
      inner_(std::move(inner)) {
  if (std::filesystem::exists(file_)) read();
  write();
  due_ = std::chrono::steady_clock::now() + pause_;
}

void Checkpoint::read() {
  const std::string bytes = bytes_of(file_).value_or("");
  Identity identity;
  std::vector<std::pair<std::string, std::string>> entries;
  try {
    unpack(bytes, identity, entries);
  } catch (const Unpackable& refusal) {
    refuse({.file = file_}, "is no checkpoint to go on from: {}; remove it", refusal.what());
  }
  if (const auto other = difference(identity_, identity)) {
    refuse({.file = file_},
           "is the checkpoint of another run: {} was {} and is {}; remove it, or name another file",
           other->name, other->theirs, other->ours);
  }
  for (auto& [recipe, block] : entries) read_.emplace(std::move(recipe), std::move(block));
}

void Checkpoint::write() const {
  std::vector<std::pair<std::string, std::string>> entries(read_.begin(), read_.end());
  for (const auto& [recipe, pool] : pools_) {
    if (pool->drawn() == 0 || pool->fault()) continue;
    entries.emplace_back(recipe, packed_block(pool->drawn_block()));
  }
  write_whole(file_, packed(identity_, entries));
}

void Checkpoint::write_if_due() {
  const auto start = std::chrono::steady_clock::now();
  if (start < due_) return;
  try {
    write();
  } catch (const std::runtime_error& error) {  // a full disk must not end a long run
    say_beside_progress(error.what());
  }
  const auto end = std::chrono::steady_clock::now();
  due_ = end + std::max(pause_, pauses_a_write * (end - start));
}

void Checkpoint::introduce(const NamedSetups& setups) {
  for (const auto& [name, setup] : setups) names_.emplace(setup.get(), name);
  inner_->introduce(setups);
}

void Checkpoint::recall(const SomePools& pools) {
  inner_->recall(pools);
  for (const auto& pool : pools) {
    const auto name = names_.find(pool->setup().get());
    if (name == names_.end() || pool->drawn() > 0 || pool->fault() ||
        !pool->can_be_drawn_elsewhere()) {
      continue;
    }
    const std::string recipe = packed(name->second, pool->recipe());
    pools_.try_emplace(recipe, pool);
    const auto block = read_.find(recipe);
    if (block == read_.end()) continue;
    pool->fold(unpacked_block(block->second, *pool, 0));
    read_.erase(block);
  }
}

void Checkpoint::draw(Round& round) {
  round.after_fold([this] { write_if_due(); });
  inner_->draw(round);
  if (!interrupted()) return;
  write();
  say_beside_progress(fmt::format("what was drawn is kept in {}; the same command goes on", file_));
}

void Checkpoint::remove() const { std::filesystem::remove(file_); }

}  // namespace assay::harness
