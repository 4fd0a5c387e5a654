#include "harness/sampling/checkpoint.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

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
// Numbers of a part, or those of one observation.
constexpr std::size_t most_numbers = std::size_t{1} << 21;

}  // namespace

template <class Archive, maybe_const<FilePart> T>
void parts(Archive& a, T& part) {
  a(part.first, part.size);
}

template <class Archive, maybe_const<DrawnPool> T>
void parts(Archive& a, T& drawn) {
  a(drawn.sums, drawn.kept);
}

Checkpoint::Checkpoint(std::string file, std::chrono::duration<double> pause, Identity identity,
                       std::shared_ptr<Executor> inner)
    : file_(std::move(file)),
      pause_(std::chrono::duration_cast<std::chrono::steady_clock::duration>(pause)),
      identity_(std::move(identity)),
      inner_(std::move(inner)),
      kept_file_(file_ + ".kept") {
  if (std::filesystem::exists(file_)) read();
  write();
  due_ = std::chrono::steady_clock::now() + pause_;
}

void Checkpoint::read() {
  const std::string bytes = harness::bytes_of(file_).value_or("");
  Identity identity;
  std::vector<std::pair<std::string, DrawnPool>> entries;
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
  for (auto& [recipe, drawn] : entries) {
    for (const FilePart& part : drawn.kept) {
      kept_size_ = std::max(kept_size_, part.first + part.size);
    }
    pools_[recipe].drawn = std::move(drawn);
  }
}

void Checkpoint::write() {
  const std::uint64_t size = kept_size_;
  std::vector<std::pair<std::string, DrawnPool>> entries;
  for (auto& [recipe, known] : pools_) {
    const std::shared_ptr<Pool> pool = known.pool.lock();
    if (pool && pool->drawn() > 0 && !pool->fault()) update(known, *pool);
    if (!known.drawn.sums.empty()) entries.emplace_back(recipe, known.drawn);
  }
  if (kept_size_ > size) flush(kept_file_);
  write_whole(file_, packed(identity_, entries));
}

void Checkpoint::update(Known& known, const Pool& pool) {
  const std::uint64_t most = std::max<std::uint64_t>(1, most_numbers / pool.channels());
  std::vector<FilePart> kept = known.drawn.kept;
  for (std::uint64_t first = known.kept_end; first < pool.kept_end(); first += most) {
    const std::uint64_t last = std::min(first + most, pool.kept_end());
    const std::string part = framed(packed_kept(pool.kept_block(first, last)));
    write_end(kept_file_, kept_size_, part);
    kept.push_back({kept_size_, part.size()});
    kept_size_ += part.size();
  }
  known.kept_end = pool.kept_end();
  known.drawn = {packed_sums(pool.drawn_sums()), std::move(kept)};
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
    Known& known = pools_[recipe];
    if (!known.pool.expired()) continue;
    known.pool = pool;
    if (!known.drawn.sums.empty()) resume(known, *pool);
  }
}

void Checkpoint::resume(Known& known, Pool& pool) const {
  Pool::Block block;
  try {
    for (const FilePart& part : known.drawn.kept) {
      add_kept(unframed(bytes_of(part)), block);
    }
    pool.fold(unpacked_drawn(known.drawn.sums, std::move(block), pool));
  } catch (const Unpackable& refusal) {
    refuse({.file = kept_file_}, "does not go with {}: {}; remove both", file_, refusal.what());
  }
  known.kept_end = pool.kept_end();
}

void Checkpoint::draw(Round& round) {
  round.after_fold([this] { write_if_due(); });
  inner_->draw(round);
  if (!interrupted()) return;
  write();
  say_beside_progress(fmt::format("what was drawn is kept in {}; the same command goes on", file_));
}

std::string Checkpoint::bytes_of(const FilePart& part) const {
  std::ifstream stream(kept_file_, std::ios::binary);
  std::string bytes(part.size, '\0');
  stream.seekg(static_cast<std::streamoff>(part.first));
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(part.size))) bytes.clear();
  return bytes;
}

void Checkpoint::remove() const {
  std::filesystem::remove(file_);
  std::filesystem::remove(kept_file_);
}

}  // namespace assay::harness
