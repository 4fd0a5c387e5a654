#include "render/triangle_mesh.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "estimators/core/value.h"

namespace assay::render {

Box::Box(const TriangleMesh& mesh) : low(mesh.vertices.front()), high(low) {
  for (const Vector3& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
}

double Box::longest_side() const {
  const Vector3 size = high - low;
  return std::max({size.x, size.y, size.z});
}

TriangleMesh fan(const Polygon& polygon) {
  TriangleMesh mesh{polygon, {}};
  for (std::uint32_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vector3 across = cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
    if (squared_length(across) > 0) mesh.triangles.push_back({0, i, i + 1});
  }
  return mesh;
}

namespace {

class ObjReader {
 public:
  explicit ObjReader(const std::string& file) : file_(file), stream_(file) {
    if (!stream_) {
      const int why = errno;
      throw InputError({file_, 0, 0},
                       std::string("cannot open the OBJ file: ") + std::strerror(why));
    }
  }

  TriangleMesh read() {
    std::string text;
    while (std::getline(stream_, text)) {
      ++line_;
      statement(std::string_view(text).substr(0, text.find('#')));
    }
    if (stream_.bad()) throw InputError({file_, line_, 1}, "cannot read the OBJ file");
    if (mesh_.triangles.empty()) throw InputError({file_, 0, 0}, "the OBJ file holds no face");
    return std::move(mesh_);
  }

 private:
  void statement(std::string_view rest) {
    const std::string_view keyword = take_word(rest);
    if (keyword.empty()) return;
    if (keyword == "v") return vertex(rest);
    if (keyword == "f") return face(rest);
    for (const char* shapeless : {"vt", "vn", "g", "o", "s", "usemtl", "mtllib"}) {
      if (keyword == shapeless) return;
    }
    fail("the statement `" + std::string(keyword) +
         "` is not one of v f vt vn g o s usemtl mtllib");
  }

  void vertex(std::string_view rest) {
    Vector3 p;
    for (double* const coordinate : {&p.x, &p.y, &p.z}) {
      const std::string_view word = take_word(rest);
      const auto number = read_as<double>(word);
      if (!number || !std::isfinite(*number)) {
        fail("a vertex needs three finite numbers, but one is `" + std::string(word) + "`");
      }
      *coordinate = *number;
    }
    if (!take_word(rest).empty()) fail("a vertex has exactly three coordinates");
    mesh_.vertices.push_back(p);
  }

  void face(std::string_view rest) {
    std::vector<std::uint32_t> corners;
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) {
      corners.push_back(corner(word));
    }
    if (corners.size() < 3) fail("a face needs three corners or more");
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      mesh_.triangles.push_back({corners[0], corners[i], corners[i + 1]});
      const auto [a, b, c] = mesh_.corners(mesh_.triangles.size() - 1);
      if (!(length(cross(b - a, c - a)) > 0)) fail("a face has no area");
    }
  }

  // `v`, `v/vt`, `v//vn` or `v/vt/vn`; only v matters, the others must be numbers all the same.
  std::uint32_t corner(std::string_view word) {
    const std::vector<std::string> indices = pieces_of(word, '/');
    const auto is_number = [](const std::string& index) {
      return read_as<long>(index).has_value();
    };
    const bool no_texture = indices.size() == 3 && indices[1].empty();
    if (indices.size() > 3 ||
        std::ranges::count_if(indices, is_number) + no_texture != std::ssize(indices)) {
      fail("a corner must be v, v/vt, v//vn or v/vt/vn, but it is `" + std::string(word) + "`");
    }
    const long index = *read_as<long>(indices[0]);
    const long count = static_cast<long>(mesh_.vertices.size());
    if (index == 0 || index > count || index < -count) {
      fail("there is no vertex " + std::to_string(index) + " yet: " + std::to_string(count) +
           " are defined above");
    }
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
  }

  [[noreturn]] void fail(const std::string& why) const { throw InputError({file_, line_, 1}, why); }

  std::string file_;
  std::ifstream stream_;
  int line_ = 0;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_obj(const std::string& file) { return ObjReader(file).read(); }

}  // namespace assay::render
