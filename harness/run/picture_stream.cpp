#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "estimators/core/thread_seconds.h"
#include "estimators/ready_made.h"
#include "harness/base/large_vector.h"
#include "harness/run/planned_run.h"
#include "stats/images/image_equivalence.h"
#include "stats/images/image_moments.h"
#include "stats/pyramids/image_pyramid.h"

namespace assay::harness {
namespace {

using Stack = stats::ImageStack;
using Pyramid = stats::RowPyramid;

constexpr std::size_t row_unit = Pyramid::row_unit;
// Row counts are multiples of it: files compress 16 or 32 rows together.
constexpr std::size_t read_unit = 32;
// Limit of texels read at a time, unless one unit of rows has more.
constexpr std::size_t most_texels = std::size_t{1} << 22;

std::size_t rounded_up(std::size_t count, std::size_t unit) {
  return (count + unit - 1) / unit * unit;
}

std::size_t rows_at_a_time(const stats::ImageExtent& extent, std::size_t pictures) {
  const std::size_t rows = most_texels / (extent.row() * pictures) / row_unit * row_unit;
  return std::clamp(rows, row_unit, rounded_up(extent.height, row_unit));
}

std::size_t rows_there(const stats::ImageExtent& extent, std::size_t pictures) {
  return std::min(rows_at_a_time(extent, pictures) + rounded_up(Pyramid::rows_ahead, read_unit),
                  extent.height);
}

std::uint64_t pictures_of(const Subject& side) { return side.setup->observations().value_or(0); }

/// The channels' sums of pictures, those of a picture together.
std::vector<double> sums_of(const std::vector<stats::ChannelSums>& pictures) {
  std::vector<double> all;
  for (const stats::ChannelSums& each : pictures) {
    std::ranges::copy(each.sums(), std::back_inserter(all));
  }
  return all;
}

/// One side's pictures, some rows at a time.
class Side {
 public:
  explicit Side(const Subject& side)
      : setup_(*side.setup),
        extent_(extent_of(*side.image)),
        reader_(side.setup->pictures()->rows()),
        pictures_(pictures_of(side)),
        size_(rows_there(extent_, 2 * pictures_) * extent_.row()),
        texels_(pictures_ * size_),
        of_channels_(pictures_, stats::ChannelSums(extent_.channels)),
        extremes_(pictures_),
        seconds_(pictures_) {}

  /// Drops rows before the range and reads on to its last.
  void move_to(stats::RowRange rows) {
    on_all_threads(pictures_, [&](std::size_t i) {
      const double start = thread_seconds();
      move_to(rows, i);
      seconds_[i] += thread_seconds() - start;
    });
    there_ = rows;
  }

  Stack stack() const {
    Stack stack{extent_, {}, there_.elements(extent_)};
    for (std::size_t i = 0; i < pictures_; ++i) {
      stack.images.emplace_back(texels_.data() + i * size_, stack.there.size());
    }
    return stack;
  }

  void end() {
    LargeVector<float>().swap(texels_);
    there_ = {};
  }

  /// Sums of each picture's channels over the rows read so far.
  std::vector<double> channel_sums() const { return sums_of(of_channels_); }
  std::vector<double> averages() const {
    return mapped(of_channels_, [&](const stats::ChannelSums& each) {
      const std::vector<double> sums = each.sums();
      return std::accumulate(sums.begin(), sums.end(), 0.0) /
             static_cast<double>(extent_.elements());
    });
  }
  stats::Extremes extremes() const {
    stats::Extremes all;
    for (const stats::Extremes& each : extremes_) all.merge(each);
    return all;
  }
  double seconds() const { return std::accumulate(seconds_.begin(), seconds_.end(), 0.0); }

  /// Names a non-finite number in the current rows; "" if all are finite.
  std::string not_finite() const {
    const Stack rows = stack();
    for (std::size_t i = 0; i < pictures_; ++i) {
      const auto texels = rows.images[i];
      const auto found = std::ranges::find_if_not(texels, [](float x) { return std::isfinite(x); });
      if (found == texels.end()) continue;
      const auto element = rows.there.first + static_cast<std::size_t>(found - texels.begin());
      return fmt::format("`{}` is not finite at {}{}", setup_.place_of({.index = i}),
                         element_place(*setup_.image(), element), leave_out_nonfinite);
    }
    return "";
  }

 private:
  void move_to(stats::RowRange rows, std::size_t picture) {
    float* const begin = texels_.data() + picture * size_;
    const std::size_t kept = (there_.last - rows.first) * extent_.row();
    std::memmove(begin, begin + (rows.first - there_.first) * extent_.row(), kept * sizeof(float));
    const std::span<float> read(begin + kept, (rows.last - there_.last) * extent_.row());
    if (read.empty()) return;
    reader_->read(picture, read);
    extremes_[picture].add(read);
    of_channels_[picture].add(read);
  }

  const Setup& setup_;
  stats::ImageExtent extent_;
  std::unique_ptr<recorded::PictureRows> reader_;
  std::size_t pictures_;
  std::size_t size_;  // capacity in texels of a picture
  LargeVector<float> texels_;
  std::vector<stats::ChannelSums> of_channels_;  // of each picture
  std::vector<stats::Extremes> extremes_;        // of each picture
  std::vector<double> seconds_;
  stats::RowRange there_;
};

class Looking {
 public:
  explicit Looking(const Question& question)
      : question_(question),
        extent_(extent_of(*question.subjects[0].image)),
        pictures_(pictures_of(question.subjects[0])),
        sums_(2, {.count = pictures_}) {
    look_->pictures = pictures_;
    look_->z.resize(extent_.elements());
    for (const Subject& subject : question.subjects) sides_.emplace_back(subject);
    if (!question.is().of_pairs) return;
    zeros_.resize(extent_.elements());
    of_differences_.resize(pictures_, stats::ChannelSums(extent_.channels));
  }

  StreamedPictures take_all(Progress& progress) {
    try {
      return {.pilots = take_rows(progress) ? pilots() : Pilots()};
    } catch (const std::domain_error&) {  // texels or their sums are not finite
      return {.fault = fault()};
    } catch (const Unread& unread) {
      StreamedPictures found;
      found.pilots.add(pilot_name(question_.subjects[unread.side]), unread.fault);
      return found;
    }
  }

 private:
  struct Unread {
    std::size_t side;
    Fault fault;
  };

  /// False if the user interrupts.
  bool take_rows(Progress& progress) {
    const std::size_t step = rows_at_a_time(extent_, 2 * pictures_);
    for (std::size_t row = 0; row < extent_.height; row += step) {
      const stats::RowRange rows{row, std::min(row + step, extent_.height)};
      if (interrupted()) return false;
      move_to(rows);
      take(rows);
      progress.advance(2 * pictures_ * rows.last / extent_.height);
    }
    return true;
  }

  std::string fault() const {
    for (const Side& side : sides_) {
      if (std::string found = side.not_finite(); !found.empty()) return found;
    }
    return "the squares of their numbers are too large";
  }

  /// Call it after the last rows.
  Pilots pilots() {
    finish();
    Pilots pilots;
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      sums_[s].look = look_;
      sums_[s].extremes = sides_[s].extremes();
      for (const double average : sides_[s].averages()) sums_[s].average.add(average);
      auto summary = std::make_shared<Summary>();
      summary->count = pictures_;
      summary->cost.samples = pictures_;
      summary->seconds = sides_[s].seconds();
      summary->elements = std::make_shared<const ElementSums>(std::move(sums_[s]));
      auto kept = std::make_shared<KeptObservations>();
      kept->costs.assign(pictures_, Cost{.samples = 1});
      kept->sums[pictures_] = summary;
      pilots.add(pilot_name(question_.subjects[s]),
                 Pilot{.sums = std::move(summary), .kept = std::move(kept)});
    }
    return pilots;
  }

  void move_to(stats::RowRange rows) {
    const std::size_t ahead = rounded_up(rows.last + Pyramid::rows_ahead, read_unit);
    const stats::RowRange there{rows.first, std::min(ahead, extent_.height)};
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      try {
        sides_[s].move_to(there);
      } catch (...) {
        throw Unread{s, {.words = words_of(std::current_exception())}};
      }
    }
  }

  void take(stats::RowRange rows) {
    const Stack stacks[] = {sides_[0].stack(), sides_[1].stack()};
    if (question_.is().of_pairs) {
      for (std::size_t s = 0; s < sides_.size(); ++s) sums_[s].take(stacks[s], rows);
      const Stack differences =
          stats::difference(stacks[0], stacks[1], differences_, on_all_threads);
      const stats::ImageReference zero{extent_, zeros_};
      const stats::ElementRange range = rows.elements(extent_);
      on_all_threads(pictures_, [&](std::size_t i) {
        of_differences_[i].add({differences.at(i, range.first), range.size()});
      });
      take({differences, zero}, rows);
      norm_.take({stacks[1], zero}, rows, on_all_threads);
    } else {
      take({stacks[0], stacks[1]}, rows,
           {sums_[0].room_for(stacks[0], rows), sums_[1].room_for(stacks[1], rows)});
    }
  }

  void take(const stats::ImagePair& pair, stats::RowRange rows,
            const stats::MomentsOfSides& moments = {}) {
    if (rows.first == 0) {
      pyramid_.emplace(pair, stats::PyramidOptions{.z = look_->z, .for_each = on_all_threads});
    }
    distance_.take(pair, rows, on_all_threads, moments);
    dependence_.take(pair, rows, on_all_threads);
    pyramid_->take(pair, rows);
  }

  void finish() {
    for (Side& side : sides_) side.end();
    look_->distance = distance_.distance();
    look_->dependence = dependence_.found();
    if (question_.is().of_pairs) {
      look_->distance = stats::relative_to(look_->distance, norm_.distance());
    }
    look_->family = pyramid_->family();
    const std::vector<double> of_first =
        question_.is().of_pairs ? sums_of(of_differences_) : sides_[0].channel_sums();
    look_->means = {stats::channel_means(of_first, extent_),
                    stats::channel_means(sides_[1].channel_sums(), extent_)};
    if (question_.is().of_pairs) drop_errors(look_->means[1]);
  }

  const Question& question_;
  stats::ImageExtent extent_;
  std::size_t pictures_;
  std::vector<Side> sides_;
  std::shared_ptr<PictureLook> look_ = std::make_shared<PictureLook>();
  std::vector<ElementSums> sums_;
  std::vector<stats::ChannelSums> of_differences_;  // of each pair
  stats::RowDistance distance_;
  stats::RowDependence dependence_;
  std::optional<Pyramid> pyramid_;
  // A paired claim alone has these.
  std::vector<float> differences_;
  std::vector<double> zeros_;
  stats::RowDistance norm_;
};

bool is_streamed(const Subject& side, const Subject& other) {
  const std::size_t channels = side.setup->channel_count();
  return side.setup->pictures() && channels > most_kept_channels && side.image && !side.averages &&
         side.channels.size() + 1 == channels && pictures_of(side) == pictures_of(other) &&
         pictures_of(side) >= stats::least_replicates;
}

// For each number of a picture: itself, and its share of a sum over a block of 4 x 4.
constexpr double bytes_of_number = 4;
constexpr double bytes_of_block = .25;
// For each element: moments of pilot, test and blocks in flight, weights and maps. A streamed
// picture takes less.
constexpr double bytes_of_element = 143;
constexpr double bytes_of_streamed_element = 43;
constexpr double gigabyte = 1e9;

constexpr double unknown = std::numeric_limits<double>::infinity();

bool is_streamed(const Question& question) {
  return question.is().of_images && question.of_two() && question.factor == 1 &&
         question.offset == 0 && !has_planned_size(question) && !question.test->secondaries &&
         !question.test->budget &&
         question.subjects[0].estimator != question.subjects[1].estimator &&
         is_streamed(question.subjects[0], question.subjects[1]) &&
         is_streamed(question.subjects[1], question.subjects[0]);
}

/// The side of a streamed claim that this estimator is, or null.
const Subject* streamed_side(const PreparedEstimator& estimator, const StreamedClaims& streamed) {
  for (const Question* const question : streamed) {
    for (const Subject& side : question->subjects) {
      if (side.estimator->name == estimator.name) return &side;
    }
  }
  return nullptr;
}

double bytes_of(const PreparedEstimator& estimator, const StreamedClaims& streamed) {
  const auto image = estimator.setup->image();
  const auto pictures = estimator.setup->observations();
  if (!image || !pictures || *pictures == 0) return 0;
  const auto elements = static_cast<double>(image->elements());
  const auto numbers = elements * static_cast<double>(*pictures);
  if (const Subject* const side = streamed_side(estimator, streamed)) {
    const stats::ImageExtent extent = extent_of(*side->image);
    const std::size_t rows = rows_there(extent, 2 * *pictures);
    return static_cast<double>(*pictures * rows * extent.row() * sizeof(float)) +
           numbers * bytes_of_block + elements * bytes_of_streamed_element;
  }
  return numbers * (bytes_of_number + bytes_of_block) + elements * bytes_of_element;
}

double number_in(const char* file) {
  double value = unknown;
  std::ifstream stream(file);
  return stream >> value ? value : unknown;
}

double of_system() {
  std::ifstream stream("/proc/meminfo");
  for (std::string word; stream >> word;) {
    double kibibytes = 0;
    if (word == "MemAvailable:" && stream >> kibibytes) return 1024 * kibibytes;
  }
  return unknown;
}

}  // namespace

StreamedClaims streamed(const std::vector<Question>& questions) {
  StreamedClaims found;
  for (const Question& question : questions) {
    if (!is_streamed(question)) continue;
    const auto is_drawn_by = [](const Question& other, const Subject& side) {
      return std::ranges::count(other.subjects, side.estimator, &Subject::estimator) > 0;
    };
    const bool alone = std::ranges::all_of(questions, [&](const Question& other) {
      return &other == &question || (!is_drawn_by(other, question.subjects[0]) &&
                                     !is_drawn_by(other, question.subjects[1]));
    });
    if (alone) found.push_back(&question);
  }
  return found;
}

StreamedPictures stream_pictures(const Question& question, Progress& progress) {
  progress.begin({.name = "pictures", .total = 2 * pictures_of(question.subjects[0])});
  StreamedPictures found = Looking(question).take_all(progress);
  progress.end();
  return found;
}

double picture_bytes(const std::map<std::string, PreparedEstimator>& estimators,
                     const StreamedClaims& streamed) {
  double bytes = 0;
  for (const auto& [name, estimator] : estimators) bytes += bytes_of(estimator, streamed);
  return bytes;
}

double available_bytes() {
  const double most = number_in("/sys/fs/cgroup/memory.max");
  const double taken = number_in("/sys/fs/cgroup/memory.current");
  return std::min(of_system(), most < unknown && taken < unknown ? most - taken : unknown);
}

void require_memory(const std::map<std::string, PreparedEstimator>& estimators,
                    const StreamedClaims& streamed, double available, const std::string& fault) {
  const double needed = picture_bytes(estimators, streamed);
  if (needed <= available) return;
  const auto largest = std::ranges::max_element(
      estimators, {}, [&](const auto& each) { return bytes_of(each.second, streamed); });
  const PreparedEstimator& estimator = largest->second;
  const ImageShape shape = *estimator.setup->image();
  const std::string why = fault.empty() ? "" : fault + ", so that all are to be kept: ";
  refuse(estimator.where,
         "{}{} pictures of {} x {} pixels of {} components and the other side take about {:.1f} GB "
         "to test, and {:.1f} GB are free; take fewer pictures (16 a side or more), one of their "
         "channels at a time, or smaller pictures",
         why, *estimator.setup->observations(), shape.width, shape.height, shape.components.size(),
         needed / gigabyte, available / gigabyte);
}

}  // namespace assay::harness
