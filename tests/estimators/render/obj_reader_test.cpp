
#include "estimators/core/value.h"
#include "render/triangle_mesh.h"
#include "tests/prelude.h"

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
  for (const auto& triangle : mesh.triangles) {
    EXPECT_EQ(triangle, (std::array<std::uint32_t, 3>{0, 1, 2}));
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
  EXPECT_THAT(refusal(corners + "l 1 2\n"), StartsWith("5: the statement `l`"));
  EXPECT_THAT(refusal("v 0 0\n"), StartsWith("1: a vertex needs three finite numbers"));
  EXPECT_THAT(refusal("v 0 0 0 1\n"), StartsWith("1: a vertex has exactly three"));
  EXPECT_THAT(refusal("v 0 nan 0\n"), StartsWith("1: a vertex needs three finite numbers"));
  EXPECT_THAT(refusal("v 0 inf 0\n"), StartsWith("1: a vertex needs three finite numbers"));
  EXPECT_THAT(refusal("v 0 1e999 0\n"), StartsWith("1: a vertex needs three finite numbers"));
  EXPECT_THAT(refusal("v 0 1x 0\n"), StartsWith("1: a vertex needs three finite numbers"));
  EXPECT_THAT(refusal(corners + "f 1 2\n"), StartsWith("5: a face needs three corners"));
  EXPECT_THAT(refusal(corners + "f 1 2 5\n"), StartsWith("5: there is no vertex 5 yet"));
  EXPECT_THAT(refusal(corners + "f 1 2 -5\n"), StartsWith("5: there is no vertex -5 yet"));
  EXPECT_THAT(refusal(corners + "f 0 1 2\n"), StartsWith("5: there is no vertex 0 yet"));
  EXPECT_THAT(refusal(corners + "f 1 2 2\n"), StartsWith("5: a face has no area"));
  for (const char* corner : {"3x", "3/", "3/1/", "3/x/1", "3/1/1/1", "/1", "3.0", "+3", "3//"}) {
    EXPECT_THAT(refusal(corners + "f 1 2 " + corner + "\n"), StartsWith("5: a corner must be"))
        << corner;
  }
}

TEST_F(ObjReader, RefusesAFileWithoutFacesOrThatIsNotThere) {
  EXPECT_EQ(refusal(corners), "0: the OBJ file holds no face");
  EXPECT_THROW(read_obj("/nowhere/lamp.obj"), InputError);
  EXPECT_THROW(read_obj(folder_.string()), InputError);
}

}  // namespace
}  // namespace assay::render
