#include "estimators/core/value.h"
#include "render/triangle_mesh.h"
#include "tests/estimators/table.h"

namespace assay::render {
namespace {

class ObjReader : public InFolder {
 protected:
  TriangleMesh read(const std::string& text) { return read_obj(write("a.obj", text)); }
  // The message about a text, behind its line.
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      EXPECT_EQ(error.where().file, file("a.obj"));
      return std::to_string(error.where().line) + ": " + error.message();
    }
    return "";
  }
};

const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ObjReader, ReadsVerticesAndFaces) {
  const TriangleMesh mesh = read("# a square\n\no lamp\n" + corners + "f 1 2 3 4 # whole\n");
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.vertices[2], (Vector3{1, 1, 0}));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST_F(ObjReader, ReadsEveryFormOfACorner) {
  const TriangleMesh mesh =
      read(corners + "vt 0 0\nvn 0 0 1\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\n");
  for (const auto& indices : mesh.triangles) {
    EXPECT_EQ(indices, (std::array<std::uint32_t, 3>{0, 1, 2}));
  }
}

TEST_F(ObjReader, NegativeIndicesCountFromTheLastVertexSoFar) {
  const TriangleMesh mesh = read(corners + "f -4 -3 -2\nv 9 9 9\nf -4 -3 -2\n");
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{1, 2, 3}));
}

TEST_F(ObjReader, TakesCarriageReturnsAndTabs) {
  EXPECT_EQ(read("v\t0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n").triangles.size(), 1u);
}

TEST_F(ObjReader, RefusesWhatIsWrongAtItsLine) {
  for (const auto& [text, said] : refused_texts("meshes")) {
    EXPECT_THAT(refusal(text), StartsWith(said)) << text;
  }
  EXPECT_THROW(read_obj("/nowhere/lamp.obj"), InputError);
  EXPECT_THROW(read_obj(folder_.string()), InputError);
}

}  // namespace
}  // namespace assay::render
