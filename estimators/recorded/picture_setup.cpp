#include "estimators/recorded/picture_setup.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

namespace assay::recorded {

namespace {

/// Fowler, Noll and Vo's hash (FNV-1a, 64 bits), a word at a time.
std::uint64_t step(std::uint64_t digest, std::uint64_t value) {
  digest = (digest ^ value) * 0x100000001b3;
  return digest ^ digest >> 32;  // the product alone never carries a high bit down
}

/// Products of texels of one half and of the other, summed up. Each is first disguised by its
/// place, so that no zero hides another.
std::uint64_t digest_of_bits(std::span<const float> texels) {
  const std::size_t half = texels.size() / 2;
  const float* const others = texels.data() + half;
  std::uint32_t key = 0x9e3779b9;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < half; ++i, key += 0xc2b2ae35) {
    const std::uint64_t one = std::bit_cast<std::uint32_t>(texels[i]) ^ key;
    sum += one * (std::bit_cast<std::uint32_t>(others[i]) ^ ~key);
  }
  return texels.size() == 2 * half ? sum : step(sum, std::bit_cast<std::uint32_t>(texels.back()));
}

/// A stack of pictures, and which of them have been seen, by whoever reads them.
class SeenStack {
 public:
  explicit SeenStack(PictureStack stack) : stack_(std::move(stack)) {}

  const PictureStack& stack() const { return stack_; }
  std::size_t row() const { return stack_.view.row(); }
  const SeenPictures& seen() const { return seen_; }

  /// Copies are no independent observations: they would make the variance too small.
  void refuse_a_copy(std::uint64_t index, const PictureDigest& digest) {
    const auto same = seen_.note(index, digest);
    if (!same) return;
    throw InputError({}, "`" + stack_.files[same->second] + "` is the same picture as `" +
                             stack_.files[same->first] +
                             "`, bit for bit: give each render a seed of its own, or leave it out");
  }

  void read(std::uint64_t index, std::span<float> texels, Cost& cost) {
    if (index >= stack_.files.size()) {
      throw std::out_of_range("recorded: there is no observation " + std::to_string(index) +
                              ", there are " + std::to_string(stack_.files.size()) + " files");
    }
    stack_.read(index, texels);
    PictureDigest digest(row());
    digest.add(texels);
    refuse_a_copy(index, digest);
    cost.samples += 1;
  }

 private:
  PictureStack stack_;
  SeenPictures seen_;
};
using SharedStack = std::shared_ptr<SeenStack>;

class StackRows final : public PictureRows {
 public:
  explicit StackRows(SharedStack shared)
      : shared_(std::move(shared)),
        readings_(shared_->stack().files.size(), {nullptr, PictureDigest(shared_->row()), 0}) {}

  void read(std::uint64_t index, std::span<float> texels) override {
    const PictureStack& stack = shared_->stack();
    Reading& picture = readings_.at(index);
    if (!picture.file) picture.file = stack.open(index);
    stack.view.read(*picture.file, texels, picture.rows);
    picture.digest.add(texels);
    picture.rows += texels.size() / shared_->row();
    const bool last = picture.rows == stack.view.window.height;
    if (last) shared_->refuse_a_copy(index, picture.digest);
    if (last || readings_.size() > most_open) picture.file.reset();
  }

 private:
  // Limit of one stack. A process may have a thousand descriptors, and each picture takes one.
  static constexpr std::size_t most_open = 128;

  struct Reading {
    std::shared_ptr<const PictureFile> file;
    PictureDigest digest;
    std::size_t rows = 0;
  };

  SharedStack shared_;
  std::vector<Reading> readings_;
};

class PictureSetup final : public Setup, public Pictures {
 public:
  PictureSetup(PictureStack stack, bool independent, std::string data_file)
      : shared_(std::make_shared<SeenStack>(std::move(stack))),
        shape_(shared_->stack().view.shape(independent)),
        data_file_(std::move(data_file)) {}

  std::size_t channel_count() const override { return shape_.elements() + 1; }
  Channel channel(std::size_t place) const override { return picture_channel(shape_, place); }
  std::optional<ImageShape> image() const override { return shape_; }
  std::unique_ptr<Estimator> make() const override {
    return estimating(
        [shared = shared_, texels = std::vector<float>()](
            Stream& random, std::uint64_t primaries, std::span<double> out, Cost& cost) mutable {
          if (primaries != 1) throw std::invalid_argument("recorded: `primaries` must be 1");
          texels.resize(out.size() - 1);
          shared->read(random.observation(), texels, cost);
          write_observation(texels, out);
        })();
  }
  std::optional<std::uint64_t> observations() const override {
    return shared_->stack().files.size();
  }
  std::string data_file() const override { return data_file_; }
  std::string place_of(const WhichObservation& which) const override { return file(which.index); }
  const Pictures* pictures() const override { return this; }

  void read(std::uint64_t index, std::span<float> texels, Cost& cost) const override {
    shared_->read(index, texels, cost);
  }
  std::unique_ptr<PictureRows> rows() const override {
    return std::make_unique<StackRows>(shared_);
  }
  std::optional<std::pair<std::string, std::string>> shared_with(
      const Pictures& others, std::uint64_t count) const override {
    const auto& other = dynamic_cast<const PictureSetup&>(others);
    // One render in two precisions is no copy: rounding has made it so.
    const bool alike = shared_->stack().view.of_files == other.shared_->stack().view.of_files;
    if (shared_ == other.shared_ || !alike) return {};
    const auto indices = shared_->seen().shared_with(other.shared_->seen(), count);
    if (!indices) return {};
    return std::pair(file(indices->first), other.file(indices->second));
  }

 private:
  std::string file(std::uint64_t index) const {
    const std::vector<std::string>& files = shared_->stack().files;
    return index < files.size() ? files[index] : "";
  }

  SharedStack shared_;
  ImageShape shape_;
  std::string data_file_;
};

class ReferenceSetup final : public Setup {
 public:
  explicit ReferenceSetup(PictureMoments moments) : moments_(std::move(moments)) {}

  std::size_t channel_count() const override { return moments_.shape.elements(); }
  Channel channel(std::size_t place) const override {
    const std::vector<double>& errors = moments_.standard_error;
    return {.name = element_name(moments_.shape, place),
            .mean = moments_.mean[place],
            .mean_error = errors.empty() ? 0 : errors[place]};
  }
  std::optional<ImageShape> image() const override { return moments_.shape; }
  std::unique_ptr<Estimator> make() const override {
    throw std::logic_error("a reference picture has no observations");
  }
  std::optional<std::uint64_t> observations() const override { return 0; }
  bool is_reference() const override { return true; }

 private:
  PictureMoments moments_;
};

}  // namespace

// By rows, which stay in the cache from one question to the next.
void PictureDigest::add(std::span<const float> texels) {
  if (!first_ && !texels.empty()) first_ = texels[0];
  for (std::size_t begin = 0; begin < texels.size(); begin += row_) {
    const std::span<const float> some = texels.subspan(begin, row_);
    value_ = step(value_, digest_of_bits(some));
    std::uint32_t beyond = 0;
    for (const float texel : some) {
      constexpr std::uint32_t exponent = 0x7f800000;
      const auto bits = std::bit_cast<std::uint32_t>(texel);
      beyond |= (bits & exponent) == exponent ? 1U : 0U;
    }
    finite_ &= beyond == 0;
    one_value_ = one_value_ && std::ranges::all_of(some, [&](float x) { return x == *first_; });
  }
}

std::optional<TwoPictures> SeenPictures::note(std::uint64_t index, const PictureDigest& digest) {
  if (!digest.finite() || digest.one_value()) return {};
  const std::scoped_lock lock(mutex_);
  const std::uint64_t first = by_digest_.try_emplace(digest.value(), index).first->second;
  if (first != index && !repeated_) repeated_ = std::minmax({first, index});
  return all_alike() ? std::nullopt : repeated_;
}

std::optional<TwoPictures> SeenPictures::shared_with(const SeenPictures& other,
                                                     std::uint64_t count) const {
  const std::scoped_lock lock(mutex_, other.mutex_);
  std::optional<TwoPictures> found;
  if (all_alike() || other.all_alike()) return found;
  for (const auto& [digest, index] : other.by_digest_) {
    const auto mine = by_digest_.find(digest);
    if (mine == by_digest_.end() || mine->second >= count || index >= count) continue;
    if (found && found->second < index) continue;
    found.emplace(mine->second, index);
  }
  return found;
}

Channel picture_channel(const ImageShape& shape, std::size_t place) {
  if (place == shape.elements()) return {.name = "average", .diagnostic = true};
  return {.name = element_name(shape, place)};
}

void write_observation(std::span<const float> texels, std::span<double> out) {
  double sum = 0;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    out[i] = double{texels[i]};
    sum += out[i];
  }
  out[texels.size()] = sum / static_cast<double>(texels.size());
}

std::shared_ptr<const Setup> picture_setup(PictureStack stack, bool independent,
                                           std::string data_file) {
  return std::make_shared<PictureSetup>(std::move(stack), independent, std::move(data_file));
}

std::shared_ptr<const Setup> reference_setup(PictureMoments moments) {
  return std::make_shared<ReferenceSetup>(std::move(moments));
}

}  // namespace assay::recorded
