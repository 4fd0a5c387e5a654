#include "harness/ranks/ranks.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <ranges>
#include <stdexcept>
#include <thread>

#include "estimators/core/value.h"
#include "harness/base/refuse.h"
#include "harness/base/work.h"
#include "harness/draws/sampler_setup.h"
#include "harness/sampling/packing.h"

namespace assay::harness {
namespace {

using Clock = std::chrono::steady_clock;

enum class Kind : std::uint8_t { begin, batch, end, hello, reply, failed, goodbye };

// A rank has one batch to draw and one that waits.
constexpr std::size_t most_batches = 2;
constexpr double seconds_of_batch = .005;
constexpr double most_blocks = 64;
// Limits in seconds, and how many times the usual time a rank may take.
constexpr double patience = 60;
constexpr double least_wait = 1;
constexpr double unknown_wait = 10;
constexpr double usual_waits = 4;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Waiting in a receive would take a whole core.
void sleep_briefly() { std::this_thread::sleep_for(std::chrono::microseconds(300)); }

std::string host_name() {
  std::string name(256, '\0');
  if (gethostname(name.data(), name.size() - 1) != 0) return "an unknown host";
  return name.c_str();
}

/// Adds what was prepared to the identity of a run.
void add_names(const NamedSetups& setups, Identity& identity) {
  for (const auto& [name, setup] : setups) identity.emplace_back("`" + name + "`", "prepared");
}

/// The names of pools' set-ups and their recipes, by the pools' places in a round.
using Recipes = std::map<std::size_t, std::pair<std::string, Recipe>>;

/// A rank's answers to rank 0.
class Servant {
 public:
  Servant(Messages& messages,
          const std::function<PreparedRank(std::optional<std::uint64_t>)>& prepare)
      : messages_(messages), prepare_(prepare) {}

  /// False when it is dismissed.
  bool obey(const std::string& bytes) {
    Unpacker unpack(unframed(bytes));
    Kind kind{};
    unpack(kind);
    if (kind == Kind::begin) begin(unpack);
    if (kind == Kind::batch) draw(unpack);
    if (kind == Kind::end) messages_.send(0, packed(Kind::goodbye));
    return kind != Kind::end;
  }

 private:
  /// Pools of a round by rank 0's recipes, and who draws their blocks.
  struct DrawnRound {
    std::uint64_t number;
    SomePools pools = {};
    DrawBlock draw = drawing_of(pools);
  };

  void begin(Unpacker& unpack) {
    std::optional<std::uint64_t> seed;
    unpack(seed);
    std::string fault;
    try {
      prepared_ = prepare_(seed);
    } catch (const std::exception&) {
      fault = "cannot prepare the run: " + words_of(std::current_exception());
    }
    Identity identity = prepared_.identity;
    add_names(prepared_.setups, identity);
    messages_.send(0, packed(Kind::hello, host_name(), fault, identity, prepared_.threads));
  }

  void draw(Unpacker& unpack) {
    std::uint64_t number = 0;
    std::uint64_t round = 0;
    Recipes recipes;
    std::vector<Task> orders;
    unpack(number, round, recipes, orders);
    unpack.end();
    const Clock::time_point start = Clock::now();
    if (!round_ || round_->number != round) round_ = std::make_unique<DrawnRound>(round);
    for (const auto& [pool, named] : recipes) add(pool, named.first, named.second);
    const std::vector<Pool::Block> blocks = drawn(orders);
    // Programs may have stopped for the same signal.
    if (interrupted()) return;
    messages_.send(0, packed(Kind::reply, number, seconds_since(start), blocks));
  }

  /// Rank 0 has seen that its set-ups are those of this rank.
  void add(std::size_t pool, const std::string& name, const Recipe& recipe) {
    const auto setup = std::ranges::find(prepared_.setups, name, &NamedSetups::value_type::first);
    // Estimators count in cells that are there when they are made (run/looks.cpp).
    const auto* const draws = dynamic_cast<const SamplerSetup*>(setup->second.get());
    const bool counts =
        std::ranges::any_of(recipe.plan, [](const auto& each) { return each.cells > 0; });
    if (draws != nullptr && counts) draws->cell_numbers();
    SomePools& pools = round_->pools;
    pools.resize(std::max(pools.size(), pool + 1));
    pools[pool] = std::make_shared<Pool>(setup->second, recipe);
  }

  std::vector<Pool::Block> drawn(const std::vector<Task>& orders) {
    std::vector<Pool::Block> blocks(orders.size());
    with_threads(prepared_.threads, [&] {
      on_all_threads(orders.size(), [&](std::size_t i) { blocks[i] = round_->draw(orders[i]); });
    });
    return blocks;
  }

  Messages& messages_;
  const std::function<PreparedRank(std::optional<std::uint64_t>)>& prepare_;
  PreparedRank prepared_ = {};
  std::unique_ptr<DrawnRound> round_;
};

}  // namespace

/// Blocks of a round from their hand-out to their fold. Ranks keep what they drew while too many
/// bytes wait here: only the next block's holder may then send.
class Ranks::Window {
 public:
  struct Slot {
    Task task;
    int holder = 0;
    Clock::time_point given = {};
    std::unique_ptr<Pool::Block> drawn = {};
  };

  Window(Ranks& ranks, Round& round)
      : ranks_(ranks),
        round_(round),
        draw_(drawing_of(round.pools())),
        usual_(round.pools().size()) {}

  bool empty() const { return slots_.empty(); }
  const Slot& at(std::uint64_t number) const { return slots_[number - front_]; }
  const Pool& pool(const Slot& slot) const { return *round_.pools()[slot.task.pool]; }
  /// The rank that has the next block.
  int holder() const { return slots_.front().holder; }
  bool is_full(std::size_t arriving) const {
    return !empty() && waiting_bytes_ + arriving >= ranks_.window_bytes_;
  }

  /// Takes slots for a rank with so many threads, of `workers` in all.
  std::vector<std::uint64_t> some_for(int rank, unsigned threads, unsigned workers) {
    std::vector<std::uint64_t> some;
    std::size_t most = 1;
    while (some.size() < most) {
      const std::optional<std::uint64_t> number = next_elsewhere();
      if (!number) break;
      if (some.empty()) {
        const double seconds = usual_[at(*number).task.pool].block;
        const double blocks =
            seconds > 0 ? std::clamp(seconds_of_batch / seconds, 1.0, most_blocks) : 1;
        most = std::max<std::size_t>(threads, std::min(static_cast<std::size_t>(threads * blocks),
                                                       round_.blocks_left() / (2 * workers)));
      }
      give_to(rank, *number);
      some.push_back(*number);
    }
    return some;
  }

  /// Takes a reply's block, unless it was drawn again meanwhile.
  void put(std::uint64_t number, Pool::Block&& block, double block_seconds, double waited) {
    if (number < front_) return;
    Slot& slot = slots_[number - front_];
    if (!slot.drawn) note(slot, std::move(block), block_seconds, waited);
  }

  /// Draws blocks on this rank's threads; false if there are none to draw.
  bool draw_some(unsigned threads, std::size_t arriving) {
    std::vector<std::uint64_t> some;
    while (some.size() < threads && skip_failed()) {
      if (is_full(arriving) && own_.front() != front_) break;
      some.push_back(own_.front());
      own_.pop_front();
    }
    while (some.size() < threads && !is_full(arriving)) {
      const std::optional<std::uint64_t> number = next();
      if (!number) break;
      some.push_back(*number);
    }
    if (some.empty()) some = overdue();
    for (const std::uint64_t number : some) give_to(0, number);
    const Clock::time_point start = Clock::now();
    std::vector<Pool::Block> blocks(some.size());
    on_all_threads(some.size(), [&](std::size_t i) { blocks[i] = draw_(at(some[i]).task); });
    const double seconds = seconds_since(start);
    for (std::size_t i = 0; i < some.size(); ++i) {
      note(slots_[some[i] - front_], std::move(blocks[i]), seconds, seconds);
    }
    return !some.empty();
  }

  /// Folds the blocks that are next.
  bool fold() {
    bool folded = false;
    for (; !empty() && slots_.front().drawn; slots_.pop_front(), ++front_) {
      const Slot& slot = slots_.front();
      waiting_bytes_ -= bytes_of(*slot.drawn);
      round_.fold(slot.task, std::move(*slot.drawn));
      folded = true;
    }
    return folded;
  }

 private:
  /// Seconds that a block of a pool took last, and the most that a rank took to answer.
  struct Usual {
    double block = 0;
    double wait = 0;
  };

  static std::size_t bytes_of(const Pool::Block& block) {
    std::size_t bytes = block.whole.channels.size() * sizeof(ChannelSummary);
    for (const auto& [channel, details] : block.whole.detailed)
      bytes += 8 * (details.cells.size() + details.histogram.counts.size());
    bytes *= 1 + block.partial.size();
    const auto add = [&](const auto& lists) {
      for (const auto& list : lists) bytes += list.size() * sizeof list[0];
    };
    add(block.observations->images);
    add(block.observations->values);
    add(block.values | std::views::values);
    return bytes;
  }

  void note(Slot& slot, Pool::Block&& block, double block_seconds, double waited) {
    Usual& usual = usual_[slot.task.pool];
    usual = {block_seconds, std::max(usual.wait, waited)};
    waiting_bytes_ += bytes_of(block);
    slot.drawn = std::make_unique<Pool::Block>(std::move(block));
  }

  void give_to(int rank, std::uint64_t number) {
    Slot& slot = slots_[number - front_];
    slot.holder = rank;
    slot.given = Clock::now();
  }

  std::optional<std::uint64_t> next() {
    const std::optional<Task> task = round_.next();
    if (!task) return std::nullopt;
    slots_.push_back({*task});
    return front_ + slots_.size() - 1;
  }

  /// The next block that another rank can draw. Those before it are left to this one.
  std::optional<std::uint64_t> next_elsewhere() {
    while (const std::optional<std::uint64_t> number = next()) {
      const Pool& drawn = pool(at(*number));
      if (drawn.can_be_drawn_elsewhere() && ranks_.names_.contains(drawn.setup())) return number;
      own_.push_back(*number);
    }
    return std::nullopt;
  }

  /// Drops this rank's next blocks of pools that failed; false if no block remains.
  bool skip_failed() {
    for (; !own_.empty() && pool(at(own_.front())).fault(); own_.pop_front()) {
      slots_[own_.front() - front_].drawn = std::make_unique<Pool::Block>();
    }
    return !own_.empty();
  }

  /// The next block, if a rank has had it for much longer than usual.
  std::vector<std::uint64_t> overdue() const {
    if (empty() || slots_.front().drawn) return {};
    const double usual = usual_[slots_.front().task.pool].wait;
    const double limit = usual > 0 ? std::max(least_wait, usual_waits * usual) : unknown_wait;
    if (seconds_since(slots_.front().given) < limit) return {};
    return {front_};
  }

  Ranks& ranks_;
  Round& round_;
  DrawBlock draw_;
  std::vector<Usual> usual_;
  std::deque<Slot> slots_;
  std::uint64_t front_ = 0;        ///< number of the first slot
  std::deque<std::uint64_t> own_;  ///< not begun, of pools that this rank alone can draw
  std::size_t waiting_bytes_ = 0;  ///< of drawn blocks that wait for an earlier one
};

Ranks::Ranks(Messages& messages, std::optional<std::uint64_t> seed, Identity identity,
             unsigned threads, std::size_t window_bytes)
    : messages_(messages),
      identity_(std::move(identity)),
      threads_(threads),
      window_bytes_(window_bytes),
      ranks_(static_cast<std::size_t>(messages.size())) {
  for (int rank = 1; rank < messages.size(); ++rank) messages.send(rank, packed(Kind::begin, seed));
}

std::string Ranks::name_of(int rank) const {
  const std::string& host = ranks_[static_cast<std::size_t>(rank)].host;
  return fmt::format("rank {}{}", rank, host.empty() ? "" : " on " + host);
}

void Ranks::greet(const Messages::Message& message) {
  Rank& rank = ranks_[static_cast<std::size_t>(message.from)];
  Unpacker unpack(unframed(message.bytes));
  Kind kind{};
  Identity identity;
  std::string fault;
  unpack(kind, rank.host, fault, identity, rank.threads);
  unpack.end();
  if (const auto other = difference(identity_, identity); other && fault.empty()) {
    fault = fmt::format("is of another run: {} is {} there and {} here", other->name, other->theirs,
                        other->ours);
  }
  if (!fault.empty()) refuse({}, "{} {}", name_of(message.from), fault);
}

void Ranks::introduce(const NamedSetups& setups) {
  for (const auto& [name, setup] : setups) names_.emplace(setup, name);
  add_names(setups, identity_);
  const double limit = std::max(patience, 10 * seconds_since(begun_));
  for (std::size_t missing = ranks_.size() - 1; missing > 0;) {
    stop_if_interrupted();
    if (const auto message = messages_.receive(Messages::anyone)) {
      try {
        greet(*message);
      } catch (const Unpackable& refusal) {
        refuse({}, "{} sent no greeting: {}", name_of(message->from), refusal.what());
      }
      --missing;
      continue;
    }
    if (seconds_since(begun_) > limit) {
      throw std::runtime_error(
          fmt::format("{} of {} ranks did not answer in {:.0f} s", missing, ranks_.size(), limit));
    }
    sleep_briefly();
  }
}

void Ranks::take_reply(const Messages::Message& message, Window& window) {
  Unpacker unpack(unframed(message.bytes));
  Kind kind{};
  unpack(kind);
  if (kind == Kind::failed) {
    std::string words;
    unpack(words);
    throw std::runtime_error(name_of(message.from) + " " + words);
  }
  std::uint64_t number = 0;
  double seconds = 0;
  std::vector<Pool::Block> blocks;
  unpack(number, seconds, blocks);
  unpack.end();
  const auto found = batches_.find(number);
  Unpacker::require(kind == Kind::reply && found != batches_.end() &&
                        found->second.rank == message.from &&
                        found->second.slots.size() == blocks.size(),
                    "an answer to nothing");
  const Batch batch = std::move(found->second);
  batches_.erase(found);
  --ranks_[static_cast<std::size_t>(message.from)].batches;
  if (batch.round != round_) return;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    window.put(batch.slots[i], std::move(blocks[i]), seconds / static_cast<double>(blocks.size()),
               seconds_since(batch.sent));
  }
}

bool Ranks::take_replies(Window& window) {
  bool taken = window.fold();
  for (;;) {
    const bool full = window.is_full(messages_.arriving());
    const auto message = messages_.receive(full ? window.holder() : Messages::anyone);
    if (!message) return taken;
    try {
      take_reply(*message, window);
    } catch (const Unpackable& refusal) {
      throw std::runtime_error(
          fmt::format("{} sent what cannot be read: {}", name_of(message->from), refusal.what()));
    }
    window.fold();
    taken = true;
  }
}

void Ranks::give(Window& window) {
  unsigned workers = threads_;
  for (const Rank& rank : ranks_) workers += rank.threads;
  for (std::size_t room = 1; room <= most_batches; ++room) {  // first those that have nothing
    for (int rank = 1; rank < messages_.size(); ++rank) {
      Rank& to = ranks_[static_cast<std::size_t>(rank)];
      if (to.threads == 0 || to.batches >= room) continue;
      std::vector<std::uint64_t> slots = window.some_for(rank, to.threads, workers);
      if (slots.empty()) return;
      Recipes recipes;
      std::vector<Task> orders;
      for (const std::uint64_t number : slots) {
        const Window::Slot& slot = window.at(number);
        const Pool& pool = window.pool(slot);
        orders.push_back(slot.task);
        if (!to.recipes.insert(slot.task.pool).second) continue;
        recipes[slot.task.pool] = {names_.at(pool.setup()), pool.recipe()};
      }
      messages_.send(rank, packed(Kind::batch, next_batch_, round_, recipes, orders));
      batches_[next_batch_++] = {rank, round_, std::move(slots), Clock::now()};
      ++to.batches;
    }
  }
}

void Ranks::draw(Round& round) {
  ++round_;
  for (Rank& each : ranks_) each.recipes.clear();
  with_threads(threads_, [&] {
    Window window(*this, round);
    for (;;) {
      const bool taken = take_replies(window);
      if (interrupted()) break;
      give(window);
      const bool drawn = window.draw_some(threads_, messages_.arriving());
      if (window.empty()) break;
      if (!drawn && !taken) sleep_briefly();
    }
    for (const auto& pool : round.pools()) pool->end_drawing();
  });
}

bool dismiss(Messages& messages) try {
  for (int rank = 1; rank < messages.size(); ++rank) messages.send(rank, packed(Kind::end));
  const Clock::time_point start = Clock::now();
  for (int present = messages.size() - 1; present > 0;) {
    if (const auto message = messages.receive(Messages::anyone)) {  // late answers go unread
      Unpacker unpack(unframed(message->bytes));
      Kind kind{};
      unpack(kind);
      if (kind == Kind::goodbye) --present;
    } else if (seconds_since(start) > unknown_wait) {
      return false;
    } else {
      sleep_briefly();
    }
  }
  return true;
} catch (const Unpackable&) {  // of another version, which did not understand either
  return false;
}

void serve(Messages& messages,
           const std::function<PreparedRank(std::optional<std::uint64_t> seed)>& prepare) {
  Servant servant(messages, prepare);
  for (bool present = true; present;) {
    const auto message = messages.receive(Messages::anyone);
    if (!message) {
      sleep_briefly();
      continue;
    }
    try {
      present = servant.obey(message->bytes);
    } catch (const std::exception&) {
      messages.send(0, packed(Kind::failed, "stopped: " + words_of(std::current_exception())));
    }
  }
}

}  // namespace assay::harness
