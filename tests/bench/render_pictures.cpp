// Renders pictures of the plugin path_tracing/image or of one of its mutants into a folder, for
// `assay images` and for studies. Picture INDEX is a function of the seed, the index and the
// parameters.
//
//   render_pictures SCENE INTEGRATOR MUTANT WIDTH HEIGHT PRIMARIES SEED FIRST COUNT DIR
//                   [--half] [--raw FILE]
//
// MUTANT is none, or a name after mutants/path_ as light_density. DIR gets NNNN.exr, NNNN the
// index;
// `-` writes none. --half writes 16 bits instead of 32. --raw appends each picture to FILE as
// 32-bit floats, row by row, three a pixel.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "estimators/catalogue.h"

namespace {

using namespace assay;

struct Wish {
  std::string scene, integrator, mutant, width, height;
  std::uint64_t primaries, seed, first, count;
  std::string folder;
  bool half = false;
  std::string raw;
};

Wish read_wish(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 10) {
    throw std::invalid_argument(
        "render_pictures SCENE INTEGRATOR MUTANT WIDTH HEIGHT PRIMARIES SEED FIRST COUNT DIR "
        "[--half] [--raw FILE]");
  }
  Wish wish{words[0],
            words[1],
            words[2],
            words[3],
            words[4],
            std::stoull(words[5]),
            std::stoull(words[6]),
            std::stoull(words[7]),
            std::stoull(words[8]),
            words[9]};
  for (std::size_t i = 10; i < words.size(); ++i) {
    if (words[i] == "--half") {
      wish.half = true;
    } else if (words[i] == "--raw" && i + 1 < words.size()) {
      wish.raw = words[++i];
    } else {
      throw std::invalid_argument("unknown word " + words[i]);
    }
  }
  return wish;
}

template <class Texel>
void write_exr(const std::string& file, const ImageShape& shape, Imf::PixelType type,
               std::vector<Texel> texels) {
  Imf::Header header(static_cast<int>(shape.width), static_cast<int>(shape.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  const char* const names[] = {"R", "G", "B"};
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < 3; ++c) {
    header.channels().insert(names[c], Imf::Channel(type));
    buffer.insert(names[c], Imf::Slice::Make(type, texels.data() + c, header.dataWindow(),
                                             3 * sizeof(Texel), 3 * sizeof(Texel) * shape.width));
  }
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(buffer);
  output.writePixels(static_cast<int>(shape.height));
}

void render(const Wish& wish) {
  const std::string original = "path_tracing/image";
  const std::string plugin = wish.mutant == "none" ? original : "mutants/path_" + wish.mutant;
  const Entry& entry = find_plugin(plugin, {});
  const Value given = Value::map({{"scene", Value::scalar(wish.scene)},
                                  {"integrator", Value::scalar(wish.integrator)},
                                  {"width", Value::scalar(wish.width)},
                                  {"height", Value::scalar(wish.height)}});
  Parameters parameters(plugin, entry.information.parameters, given, ".");
  const std::shared_ptr<const Setup> setup = entry.prepare(parameters);
  const ImageShape shape = *setup->image();
  const std::unique_ptr<Estimator> estimator = setup->make();
  const StreamKey key = stream_key(wish.seed, original, parameters.canonical(), 0);
  std::ofstream raw;
  if (!wish.raw.empty()) raw.open(wish.raw, std::ios::binary | std::ios::app);
  if (wish.folder != "-") std::filesystem::create_directories(wish.folder);

  std::vector<double> values(shape.elements());
  for (std::uint64_t index = wish.first; index < wish.first + wish.count; ++index) {
    Stream random(key, index);
    Cost cost;
    estimator->secondary(random, wish.primaries, values, cost);
    const std::vector<float> texels(values.begin(), values.end());
    if (raw.is_open()) {
      raw.write(reinterpret_cast<const char*>(texels.data()),
                static_cast<std::streamsize>(texels.size() * sizeof(float)));
    }
    if (wish.folder == "-") continue;
    std::string name = std::to_string(index);
    name.insert(0, name.size() < 4 ? 4 - name.size() : 0, '0');
    const std::string file = wish.folder + "/" + name + ".exr";
    if (wish.half) {
      write_exr(file, shape, Imf::HALF, std::vector<half>(texels.begin(), texels.end()));
    } else {
      write_exr(file, shape, Imf::FLOAT, texels);
    }
  }
  if (raw.is_open() && !raw.flush()) throw std::runtime_error("cannot write " + wish.raw);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    render(read_wish(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
