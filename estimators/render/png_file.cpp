#include <png.h>

#include <cmath>
#include <csetjmp>
#include <cstdio>

#include "render/picture_kinds.h"

namespace assay::render {

namespace {

/// One pass over a file, row by row. The library jumps out of its functions where it fails, so
/// each call of it stands alone, behind `guarded`.
class PngRows {
 public:
  explicit PngRows(const std::string& file)
      : file_(file), stream_(std::fopen(file.c_str(), "rb")), trouble_("it does not open") {
    if (stream_ == nullptr) fail();
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &trouble_, keep_message, ignore);
    if (png_ != nullptr) information_ = png_create_info_struct(png_);
    if (information_ == nullptr || !guarded([&] { begin(); })) {
      close();
      fail();
    }
  }
  ~PngRows() { close(); }
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  std::size_t width() const { return png_get_image_width(png_, information_); }
  std::size_t height() const { return png_get_image_height(png_, information_); }
  std::size_t channels() const { return png_get_channels(png_, information_); }
  bool deep() const { return png_get_bit_depth(png_, information_) == 16; }
  std::size_t row_bytes() const { return png_get_rowbytes(png_, information_); }
  /// The exponent of a file that states another curve than sRGB's; 0 of others.
  double other_gamma() const {
    constexpr double of_srgb = 1 / 2.2;
    double gamma = 0;
    if (png_get_valid(png_, information_, PNG_INFO_sRGB) != 0) return 0;
    if (png_get_gAMA(png_, information_, &gamma) == 0) return 0;
    return std::abs(gamma - of_srgb) < 0.01 ? 0 : gamma;
  }

  /// The row behind the one read last.
  std::size_t next() const { return next_; }
  void read(std::vector<unsigned char>& row) {
    if (passes_ > 1 && whole_.empty()) read_whole();
    row.resize(row_bytes());
    if (passes_ > 1) {
      row.assign(whole_.begin() + static_cast<std::ptrdiff_t>(next_ * row_bytes()),
                 whole_.begin() + static_cast<std::ptrdiff_t>((next_ + 1) * row_bytes()));
    } else if (!guarded([&] { png_read_row(png_, row.data(), nullptr); })) {
      fail();
    }
    ++next_;
  }

 private:
  /// False where the library jumped out. Nothing in `work` may need a destructor.
  template <class Work>
  bool guarded(const Work& work) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    work();
    return true;
  }

  void begin() {
    png_set_user_limits(png_, most_pixels, most_pixels);
    png_init_io(png_, stream_);
    png_read_info(png_, information_);
    png_set_expand(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, information_);
  }

  /// An interlaced picture comes in passes over all rows.
  void read_whole() {
    whole_.resize(height() * row_bytes());
    for (int pass = 0; pass < passes_; ++pass) {
      for (std::size_t y = 0; y < height(); ++y) {
        unsigned char* const row = whole_.data() + y * row_bytes();
        if (!guarded([&] { png_read_row(png_, row, nullptr); })) fail();
      }
    }
  }

  void close() {
    if (png_ != nullptr) png_destroy_read_struct(&png_, &information_, nullptr);
    if (stream_ != nullptr) std::fclose(stream_);
    stream_ = nullptr;
  }
  [[noreturn]] void fail() const {
    refuse_picture(file_, "it cannot be read as PNG, damaged or cut short: " + trouble_);
  }

  static void keep_message(png_structp png, png_const_charp message) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = message;
    png_longjmp(png, 1);
  }
  static void ignore(png_structp /*png*/, png_const_charp /*message*/) {}

  std::string file_;
  std::FILE* stream_;
  std::string trouble_;
  png_structp png_ = nullptr;
  png_infop information_ = nullptr;
  int passes_ = 1;
  std::size_t next_ = 0;
  std::vector<unsigned char> whole_;
};

class PngFile final : public PictureFile {
 public:
  explicit PngFile(const std::string& file)
      : PictureFile(file), rows_(std::make_unique<PngRows>(file)) {
    require_size(file, rows_->width(), rows_->height());
    if (rows_->other_gamma() != 0) {
      refuse_picture(file, "its numbers follow another curve than sRGB's; convert it to sRGB");
    }
    canvas_ = {.width = rows_->width(), .height = rows_->height()};
    const Rounding rounding = rows_->deep() ? Rounding::png16 : Rounding::png8;
    const std::vector<std::string> names[] = {
        {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    for (const std::string& name : names[rows_->channels() - 1]) {
      channels_.push_back({.name = name, .window = canvas_, .rounding = rounding});
    }
    const std::size_t levels = rows_->deep() ? 65535 : 255;
    for (std::size_t code = 0; code <= levels; ++code) {
      const auto part = static_cast<double>(code) / static_cast<double>(levels);
      alpha_.push_back(static_cast<float>(part));
      colour_.push_back(static_cast<float>(from_srgb(part)));
    }
  }

 private:
  void read_rows(std::span<const std::string> names, std::span<float> texels, std::size_t first,
                 std::size_t last) const override {
    if (!rows_ || rows_->next() > first) rows_ = std::make_unique<PngRows>(name_);
    while (rows_->next() < first) rows_->read(bytes_);
    const std::size_t size = channels_.size();
    const bool deep = channels_[0].rounding == Rounding::png16;
    float* out = texels.data();
    for (std::size_t y = first; y < last; ++y) {
      rows_->read(bytes_);
      for (std::size_t x = 0; x < canvas_.width; ++x) {
        for (const std::string& name : names) {
          const auto c = static_cast<std::size_t>(&channel(name) - channels_.data());
          const std::size_t at = x * size + c;
          const std::size_t code =
              deep ? bytes_[2 * at] * std::size_t{256} + bytes_[2 * at + 1] : bytes_[at];
          *out++ = name == "A" ? alpha_[code] : colour_[code];
        }
      }
    }
  }

  mutable std::unique_ptr<PngRows> rows_;
  mutable std::vector<unsigned char> bytes_;
  std::vector<float> alpha_;  // of each code
  std::vector<float> colour_;
};

}  // namespace

std::unique_ptr<const PictureFile> open_png(const std::string& file) {
  return std::make_unique<PngFile>(file);
}

}  // namespace assay::render
