#include "render/scene.h"

#include <oneapi/tbb/global_control.h>

#include "estimators/instruction_set.h"
#include "estimators/stream.h"
#include "render/hemisphere.h"
#include "tests/prelude.h"

namespace assay::render {
namespace {

const TriangleMesh floor_above = fan({{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
const TriangleMesh further = fan({{-9, -9, 2}, {9, -9, 2}, {9, 9, 2}, {-9, 9, 2}});

TEST(Scene, TheClosestShapeIsHit) {
  const Scene scene({further, floor_above});
  const Hit hit = scene.closest_hit({.origin = {}, .direction = {0.1, 0.2, 1}});
  EXPECT_EQ(hit.shape, 1u);
  EXPECT_NEAR(hit.t, 1, 1e-6);
  EXPECT_EQ(scene.closest_hit({.origin = {}, .direction = {1, 0, .6}}).shape, 0u);
  EXPECT_EQ(scene.closest_hit({.origin = {}, .direction = {0, 0, -1}}).shape, Hit::none);
  // From its other side.
  EXPECT_EQ(scene.closest_hit({.origin = {0, 0, 1.5}, .direction = {0, 0, -1}}).shape, 1u);
}

TEST(Scene, OcclusionEndsAtTheFarEnd) {
  const Scene scene({floor_above});
  EXPECT_TRUE(scene.occluded({.origin = {}, .direction = {0, 0, 1}, .near = 0, .far = 1.01}));
  EXPECT_FALSE(scene.occluded({.origin = {}, .direction = {0, 0, 1}, .near = 0, .far = .99}));
  EXPECT_FALSE(scene.occluded({.origin = {}, .direction = {0, 0, 1}, .near = 1.01}));
}

TEST(Scene, ARayRoundedBeforehandIsTheSameRay) {
  const Scene scene({floor_above});
  for (const double far : {.99, 1.01}) {
    const Ray ray = {.origin = {.1, 0, 0}, .direction = {0, .2, 1}, .near = .5, .far = far};
    EXPECT_EQ(scene.occluded(RoundedRay(ray)), far > 1);
    const Hit rounded = scene.closest_hit(RoundedRay(ray));
    EXPECT_EQ(rounded.shape, scene.closest_hit(ray).shape);
    EXPECT_EQ(rounded.t, scene.closest_hit(ray).t);
  }
}

TEST(Scene, AnEmptySceneIsEmpty) {
  const Scene scene({});
  EXPECT_FALSE(scene.occluded({.origin = {}, .direction = {0, 0, 1}}));
  EXPECT_EQ(scene.closest_hit({.origin = {}, .direction = {0, 0, 1}}).shape, Hit::none);
}

TEST(Scene, ADiscIsRoundAndTwoSided) {
  const Scene scene({Disc{{0, 0, 2}, {0, 0, 1}, 1}});
  EXPECT_TRUE(scene.occluded({.origin = {.99, 0, 0}, .direction = {0, 0, 1}}));
  EXPECT_TRUE(scene.occluded({.origin = {.7, .7, 0}, .direction = {0, 0, 1}}));
  EXPECT_FALSE(scene.occluded({.origin = {.72, .72, 0}, .direction = {0, 0, 1}}));
  EXPECT_TRUE(scene.occluded({.origin = {.5, 0, 4}, .direction = {0, 0, -1}}));
}

TEST(Scene, NoRaySlipsThroughTheEdgesOfAClosedMesh) {
  const std::vector<Vector3> v = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                  {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  const TriangleMesh octahedron{
      v, {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  const Scene scene({octahedron});
  Stream random({1}, 0);
  for (int i = 0; i < 100000; ++i) {
    // Half of the rays aim at the edges, where they would slip through.
    Vector3 w = uniform_hemisphere(random.uniform(), random.uniform());
    if (i % 2 == 0) w.x = 0;
    EXPECT_NE(scene.closest_hit({.origin = {}, .direction = w}).shape, Hit::none);
  }
}

TEST(Scene, LeavesTheThreadsToWhoeverDraws) {
  // Embree's own `threads` setting would limit oneTBB in the whole process.
  const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
  const Scene scene({floor_above});
  EXPECT_EQ(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism), 4u);
}

TEST(Scene, NamesTheInstructionSetItIsPinnedTo) {
  const std::string isa = ray_instruction_set();
  EXPECT_TRUE(isa == "avx2" || isa == "sse4.2" || isa == "sse2");
}

}  // namespace
}  // namespace assay::render
