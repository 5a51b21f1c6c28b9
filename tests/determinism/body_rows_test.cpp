// Rows of bodies, and the memory layout of groups: the values of `WorldBatch::Body` and
// `WorldBatch::Cable` at the documented places.
#include "taut/body_rows.h"

#include <gtest/gtest.h>

#include "tests/physics/world.h"
#include "tests/scenes/prism3.h"

namespace taut::test {
namespace {

void ExpectTheSame(WorldBatch& batch) {
  const int bodies = static_cast<int>(batch.model().def().bodies.size());
  const int cables = static_cast<int>(batch.model().def().cables.size());
  const BodyRows first = RowsOfBodies(batch, 0);
  const CableRows first_cables = batch.Cables(0);
  for (int g = 0; g < batch.groups(); ++g) {
    const BodyRows rows = RowsOfBodies(batch, g);
    EXPECT_EQ(rows.lanes, batch.lanes());
    EXPECT_EQ(rows.first_world, g * batch.lanes());
    EXPECT_EQ(rows.position_m, first.position_m + g * GroupStride(batch));
    EXPECT_EQ(rows.velocity_m_per_s, first.velocity_m_per_s + g * GroupStride(batch));
    const CableRows tensions = batch.Cables(g);
    EXPECT_EQ(tensions.tension_n, first_cables.tension_n + g * GroupStride(batch));
    EXPECT_EQ(tensions.rest_length_target_m,
              first_cables.rest_length_target_m + g * GroupStride(batch));
    for (int j = 0; j < rows.lanes && rows.first_world + j < batch.worlds(); ++j) {
      const auto at = [&](const double* row, int b) {
        const double* const x = row + 3 * b * rows.lanes + j;
        return Vec3{x[0], x[rows.lanes], x[2 * rows.lanes]};
      };
      for (int b = 0; b < bodies; ++b) {
        const BodyState body = batch.Body(rows.first_world + j, b);
        const Vec3 p = at(rows.position_m, b), v = at(rows.velocity_m_per_s, b);
        EXPECT_TRUE(p.x == body.position_m.x && p.y == body.position_m.y &&
                    p.z == body.position_m.z);
        EXPECT_TRUE(v.x == body.velocity_m_per_s.x && v.y == body.velocity_m_per_s.y &&
                    v.z == body.velocity_m_per_s.z);
      }
      for (int c = 0; c < cables; ++c) {
        EXPECT_EQ(tensions.tension_n[c * rows.lanes + j],
                  batch.Cable(rows.first_world + j, c).tension_n);
      }
    }
  }
}

TEST(BodyRows, AreWhatTheBatchSays) {
  for (const Simd simd : {Simd::kScalar, Simd::kSse2, Simd::kAvx2, Simd::kAvx512}) {
    WorldBatchOptions options;
    options.worlds = 2 * static_cast<int>(simd) + 1;
    options.simd = simd;
    WorldBatch batch = MakeBatch(scenes::Prism3().Def(), options);
    for (int w = 0; w < batch.worlds(); ++w) {
      BodyState state = batch.Body(w, 1);
      state.velocity_m_per_s = {0.1 * w, 0.2, -0.3};
      batch.SetBodyState(w, 1, state);
    }
    ExpectTheSame(batch);
    const BodyRows before = RowsOfBodies(batch, 0);
    batch.Step(1e-3, 20);
    EXPECT_EQ(RowsOfBodies(batch, 0).position_m, before.position_m);
    ExpectTheSame(batch);
  }
}

TEST(BodyRows, OneGroupHasNoNext) {
  WorldBatch batch = MakeBatch(scenes::Prism3().Def(), {});
  EXPECT_EQ(GroupStride(batch), 0);
  ExpectTheSame(batch);
}

TEST(BodyRowsDeathTest, AGroupThatIsNotThereIsNamed) {
  WorldBatch batch = MakeBatch(scenes::Prism3().Def(), {});
  EXPECT_DEATH(RowsOfBodies(batch, 1), "RowsOfBodies: there is no group 1: valid are 0 to 0");
  EXPECT_DEATH(RowsOfBodies(batch, -1), "RowsOfBodies: there is no group -1");
}

}  // namespace
}  // namespace taut::test
