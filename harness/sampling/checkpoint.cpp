#include "harness/sampling/checkpoint.h"

#include <fmt/format.h>

#include <filesystem>

#include "estimators/core/value.h"
#include "harness/base/refuse.h"
#include "harness/base/terminal.h"
#include "harness/base/work.h"
#include "harness/sampling/packing.h"

namespace assay::harness {
namespace {

// Writing may take so small a part of the time.
constexpr int pauses_a_write = 20;

}  // namespace

template <class Archive, maybe_const<WrittenPool> T>
void parts(Archive& a, T& written) {
  a(written.sums, written.kept);
}

Checkpoint::Checkpoint(std::string file, std::chrono::duration<double> pause, Identity identity,
                       std::shared_ptr<Executor> inner)
    : file_(std::move(file)),
      pause_(std::chrono::duration_cast<Clock::duration>(pause)),
      identity_(std::move(identity)),
      inner_(std::move(inner)) {
  const bool is_resumed = std::filesystem::exists(file_);
  if (is_resumed) read();
  open_kept(is_resumed);
  write();
  soonest_ = Clock::now();
  due_ = soonest_ + pause_;
}

void Checkpoint::read() {
  const std::string bytes = bytes_of(file_).value_or("");
  Identity identity;
  try {
    unpack(bytes, identity, pools_);
  } catch (const Unpackable& refusal) {
    refuse({.file = file_}, "is no usable checkpoint: {}; remove it", refusal.what());
  }
  if (const auto other = difference(identity_, identity)) {
    refuse({.file = file_},
           "is the checkpoint of another run: {} was {} and is {}; remove it, or name another file",
           other->name, other->theirs, other->ours);
  }
}

/// Drops what was added when FILE was not written any more.
void Checkpoint::open_kept(bool is_resumed) {
  kept_ = std::make_unique<GrowingFile>(kept_file(file_));
  const Location where{.file = kept_->path()};
  std::uint64_t end = 0;
  for (const auto& [recipe, written] : pools_) {
    for (const KeptPart& part : written.kept) end = std::max(end, part.place + part.size);
  }
  if (kept_->size() < end) refuse(where, "is shorter than {} says; remove both", file_);
  if (!is_resumed && kept_->size() > 0 && kept_->read(0, magic.size()) != magic) {
    refuse(where, "was not written by Assay and would be lost; name another checkpoint");
  }
  kept_->cut(end);
}

void Checkpoint::write() {
  for (auto& [recipe, written] : pools_) {
    const std::shared_ptr<Pool> pool = written.pool.lock();
    const std::uint64_t count = written.sums.whole.count;
    if (pool && pool->drawn() > count && !pool->fault()) update(recipe, written, *pool);
  }
  kept_->flush();
  write_whole(file_, packed(identity_, pools_));
}

void Checkpoint::update(const std::string& recipe, WrittenPool& written, const Pool& pool) {
  const std::uint64_t hash = text_hash(recipe);
  WrittenPool next{pool.drawn_sums(), written.kept, written.pool};
  std::uint64_t first = written.sums.whole.count;
  for (; first < pool.kept_end(); first += pool.block_size()) {
    const std::uint64_t last = std::min(first + pool.block_size(), pool.kept_end());
    const std::string part = packed(hash, pool.kept_block(first, last));
    next.kept.push_back({kept_->size(), part.size()});
    kept_->append(part);
  }
  written = std::move(next);
}

bool Checkpoint::try_to_write() {
  const Clock::time_point start = Clock::now();
  bool written = false;
  try {
    write();
    written = true;
  } catch (const std::runtime_error& error) {
    say_beside_progress(error.what());
  }
  const Clock::time_point end = Clock::now();
  soonest_ = end + pauses_a_write * (end - start);
  due_ = std::max(soonest_, end + pause_);
  return written;
}

void Checkpoint::introduce(const NamedSetups& setups) {
  for (const auto& [name, setup] : setups) names_.emplace(setup, name);
  inner_->introduce(setups);
}

void Checkpoint::recall(const SomePools& pools) {
  inner_->recall(pools);
  for (const auto& pool : pools) {
    const auto name = names_.find(pool->setup());
    if (name == names_.end() || pool->drawn() > 0 || pool->fault() ||
        !pool->can_be_drawn_elsewhere()) {
      continue;
    }
    const std::string recipe = packed(name->second, pool->recipe());
    WrittenPool& written = pools_[recipe];
    if (!written.pool.expired()) continue;
    written.pool = pool;
    if (written.sums.whole.count > 0) resume(recipe, written, *pool);
  }
}

void Checkpoint::resume(const std::string& recipe, const WrittenPool& written, Pool& pool) const {
  const std::uint64_t expected = text_hash(recipe);
  Pool::Block block = written.sums;
  block.observations = std::make_shared<KeptObservations>();
  try {
    for (const KeptPart& part : written.kept) {
      std::uint64_t hash = 0;
      Pool::Block kept;
      unpack(kept_->read(part.place, part.size), hash, kept);
      Unpacker::require(hash == expected, "it holds other observations");
      block.append_kept(std::move(kept));
    }
  } catch (const Unpackable& refusal) {
    refuse({.file = kept_->path()}, "does not fit {}: {}; remove both", file_, refusal.what());
  }
  pool.fold(std::move(block));
}

void Checkpoint::draw(Round& round) {
  round.after_fold([this] {
    if (Clock::now() >= due_) try_to_write();
  });
  inner_->draw(round);
  if (!interrupted()) {
    if (Clock::now() >= soonest_) try_to_write();
  } else if (try_to_write()) {
    say_beside_progress(
        fmt::format("what was drawn is kept in {} and {}; the same command continues", file_,
                    kept_->path().string()));
  }
}

void Checkpoint::remove() const {
  std::filesystem::remove(file_);
  std::filesystem::remove(kept_->path());
}

}  // namespace assay::harness
