// Portable float maps: `PF` or `Pf`, width, height and a scale as text, then floats from the bottom
// row up. A negative scale means little endian.

#include <bit>
#include <filesystem>
#include <fstream>

#include "render/picture_kinds.h"

namespace assay::render {

namespace {

class PfmFile final : public PictureFile {
 public:
  explicit PfmFile(const std::string& file) : PictureFile(file) {
    std::ifstream stream(file, std::ios::binary);
    std::string magic;
    std::size_t width = 0;
    std::size_t height = 0;
    double scale = 0;
    stream >> magic >> width >> height >> scale;
    stream.get();
    if (!stream || scale == 0) {
      refuse_picture(file, "it begins as a PFM picture, but width, height and scale do not follow");
    }
    require_size(file, width, height);
    begin_ = static_cast<std::size_t>(stream.tellg());
    swaps_ = (scale < 0) != (std::endian::native == std::endian::little);
    canvas_ = {.width = width, .height = height};
    const auto names =
        magic == "PF" ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
    for (const std::string& name : names) channels_.push_back({.name = name, .window = canvas_});
    if (std::filesystem::file_size(file) - begin_ < 4 * width * height * names.size()) {
      refuse_picture(file, "the picture is cut short; write it again");
    }
  }

 private:
  void read_rows(std::span<const std::string> names, std::span<float> texels, std::size_t first,
                 std::size_t last) const override {
    const std::size_t row = canvas_.width * channels_.size();
    std::vector<std::uint32_t> bits((last - first) * row);
    std::ifstream stream(name_, std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(begin_ + 4 * row * (canvas_.height - last)));
    stream.read(reinterpret_cast<char*>(bits.data()),
                static_cast<std::streamsize>(4 * bits.size()));
    if (!stream) refuse("the picture is cut short; write it again");
    for (std::size_t c = 0; c < names.size(); ++c) {
      const auto source = static_cast<std::size_t>(&channel(names[c]) - channels_.data());
      for (std::size_t i = 0; i < texels.size() / names.size(); ++i) {
        const std::size_t y = last - first - 1 - i / canvas_.width;
        const std::uint32_t word = bits[y * row + i % canvas_.width * channels_.size() + source];
        texels[i * names.size() + c] = std::bit_cast<float>(swaps_ ? swapped(word) : word);
      }
    }
  }

  static std::uint32_t swapped(std::uint32_t word) {
    return word >> 24U | (word >> 8U & 0xff00U) | (word << 8U & 0xff0000U) | word << 24U;
  }

  std::size_t begin_ = 0;
  bool swaps_ = false;
};

}  // namespace

std::unique_ptr<const PictureFile> open_pfm(const std::string& file) {
  return std::make_unique<PfmFile>(file);
}

}  // namespace assay::render
