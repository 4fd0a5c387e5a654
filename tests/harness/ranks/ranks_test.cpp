#include "harness/ranks/ranks.h"

#include <deque>
#include <mutex>

#include "harness/run/planned_run.h"
#include "tests/harness/prelude.h"

namespace assay::harness {
namespace {

/// Letter boxes of ranks that are threads of this process.
class Post {
 public:
  explicit Post(int size) : boxes_(static_cast<std::size_t>(size)) {}
  int size() const { return static_cast<int>(boxes_.size()); }
  void send(int to, Messages::Message message) {
    const std::scoped_lock lock(mutex_);
    boxes_[static_cast<std::size_t>(to)].push_back(std::move(message));
  }
  std::optional<Messages::Message> receive(int rank, int from) {
    const std::scoped_lock lock(mutex_);
    auto& box = boxes_[static_cast<std::size_t>(rank)];
    const auto first = std::ranges::find_if(box, [&](const Messages::Message& each) {
      return from == Messages::anyone || each.from == from;
    });
    if (first == box.end()) return std::nullopt;
    Messages::Message message = std::move(*first);
    box.erase(first);
    return message;
  }

 private:
  std::mutex mutex_;
  std::vector<std::deque<Messages::Message>> boxes_;
};

/// The bytes that arrive of the k-th message of a rank, from 0; none: it is lost.
using Fate = std::function<std::optional<std::string>(int rank, std::size_t k, std::string bytes)>;

class Posted : public Messages {
 public:
  Posted(Post& post, int rank, Fate fate = {}) : post_(post), rank_(rank), fate_(std::move(fate)) {}
  int size() const override { return post_.size(); }
  void send(int to, std::string bytes) override {
    std::optional<std::string> arrives(std::move(bytes));
    if (fate_) arrives = fate_(rank_, sent_++, std::move(*arrives));
    if (arrives) post_.send(to, {rank_, std::move(*arrives)});
  }
  std::optional<Message> receive(int from) override { return post_.receive(rank_, from); }
  std::size_t arriving() const override { return 0; }

 private:
  Post& post_;
  int rank_;
  Fate fate_;
  std::size_t sent_ = 0;
};

/// Rank 0's box. After the greetings, letters of rank 1 come only if they are asked for by name.
class Reluctant final : public Posted {
 public:
  explicit Reluctant(Post& post) : Posted(post, 0) {}
  std::optional<Message> receive(int from) override {
    if (from == 1) ++asked_;
    auto message = Posted::receive(from == anyone && greetings_ >= 2 ? 2 : from);
    if (message) ++greetings_;
    return message;
  }
  int asked() const { return asked_; }

 private:
  int greetings_ = 0;
  int asked_ = 0;
};

struct Job {
  int ranks = 3;
  unsigned threads = 1;
  Fate fate = {};
  Identity identity_there = {};
  std::string suite_there = "";  ///< "": the same
  std::size_t window = Ranks::usual_window;
};

PreparedRank prepared(const std::string& suite, const Job& job) {
  const RunOptions options{.threads = 1, .coarsen = 8};
  const auto run = std::make_shared<const PlannedRun>(prepare_run({load_suite(suite)}, options));
  return {job.identity_there, setups_of(*run), job.threads, run};
}

/// The record of rank 0, which has these messages.
reports::Record run_in_ranks(const std::string& suite, const Job& job, Post& post,
                             Messages& messages) {
  std::vector<std::jthread> others;
  for (int rank = 1; rank < job.ranks; ++rank) {
    others.emplace_back([&, rank] {
      Posted theirs(post, rank, job.fate);
      serve(theirs, [&](std::optional<std::uint64_t>) {
        return prepared(job.suite_there.empty() ? suite : job.suite_there, job);
      });
    });
  }
  struct AtEnd {
    Posted messages;
    ~AtEnd() { EXPECT_TRUE(dismiss(messages)); }
  } at_end{Posted(post, 0)};
  return run_files({suite}, {.threads = 1,
                             .executor = std::make_shared<Ranks>(messages, std::nullopt, Identity{},
                                                                 1U, job.window),
                             .coarsen = 8});
}

reports::Record run_in_ranks(const std::string& suite, const Job& job) {
  Post post(job.ranks);
  Posted messages(post, 0);
  return run_in_ranks(suite, job, post, messages);
}

const std::string kinds = ASSAY_SOURCE_DIR "/tests/suites/kinds.yaml";
const std::string process = ASSAY_SOURCE_DIR "/suites/process.yaml";

std::string alone(const std::string& suite) {
  return numbers_of(run_files({suite}, {.threads = 1, .coarsen = 8}));
}

TEST(Ranks, GiveTheRecordOfOneProcess) {
  for (const std::string& suite : {kinds, process}) {
    const std::string one = alone(suite);
    EXPECT_EQ(numbers_of(run_in_ranks(suite, {.ranks = 1})), one);
    EXPECT_EQ(numbers_of(run_in_ranks(suite, {.ranks = 3})), one);
    EXPECT_EQ(numbers_of(run_in_ranks(suite, {.ranks = 2, .threads = 2})), one);
  }
}

TEST(Ranks, KeepWhatTheyDrewWhileTheWindowIsFull) {
  Post post(3);
  Reluctant messages(post);
  const reports::Record record = run_in_ranks(kinds, {.window = 1}, post, messages);
  EXPECT_EQ(numbers_of(record), alone(kinds));
  EXPECT_GT(messages.asked(), 0);
}

// The greeting and four answers arrive, and what the rank says at the end.
TEST(Ranks, ThatNoLongerAnswerAreDoneWithout) {
  const auto falls_silent = [](int rank, std::size_t k,
                               std::string bytes) -> std::optional<std::string> {
    if (rank == 1 && k > 4 && bytes.size() > 40) return std::nullopt;
    return bytes;
  };
  EXPECT_EQ(numbers_of(run_in_ranks(kinds, {.ranks = 3, .fate = falls_silent})), alone(kinds));
}

TEST(Ranks, ThatSendDamagedAnswersAreNamed) {
  const auto damages = [](int, std::size_t k, std::string bytes) -> std::optional<std::string> {
    if (k == 1) bytes.back() = static_cast<char>(bytes.back() ^ 1);
    return bytes;
  };
  EXPECT_THAT(
      thrown([&] { run_in_ranks(kinds, {.ranks = 2, .fate = damages}); }),
      AllOf(HasSubstr("rank 1 on "), HasSubstr("sent what cannot be read: it is cut short")));
}

TEST(Ranks, OfAnotherRunAreRefusedByName) {
  EXPECT_THAT(refusal([&] {
                run_in_ranks(kinds, {.ranks = 2, .identity_there = {{"the version", "0.0.1"}}});
              }),
              HasSubstr(" is of another run: the version is 0.0.1 there and missing here"));
  EXPECT_THAT(refusal([&] { run_in_ranks(kinds, {.ranks = 2, .suite_there = process}); }),
              HasSubstr("` is missing there and prepared here"));
  EXPECT_THAT(refusal([&] { run_in_ranks(kinds, {.ranks = 2, .suite_there = "none.yaml"}); }),
              HasSubstr("cannot prepare the run: cannot read `none.yaml`"));
}

// They cannot read that the run ends.
TEST(Ranks, ThatCannotBeReadAreNotDismissed) {
  Post post(2);
  post.send(0, {.from = 1, .bytes = "assay 1"});
  Posted messages(post, 0);
  EXPECT_FALSE(dismiss(messages));
}

}  // namespace
}  // namespace assay::harness
