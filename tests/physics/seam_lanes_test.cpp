// Seams between terrain pieces in SIMD lanes, and terrain pieces that do not meet
// (docs/theory/ground.md, section 9).
#include <gtest/gtest.h>

#include "tests/mechanics/seam_ground.h"
#include "tests/physics/lanes_alike.h"

namespace taut::test {
namespace {

using namespace seams;

/// Returns all kinds of bodies in a row across three pieces of terrain.
ModelDef Crossing(Piece a, Piece b, double apart_m) {
  const Material material{0.2, 0.2, 0};
  ModelDef def;
  double y = -1.2;
  for (const Guest guest : {Guest::kTurnedBox, Guest::kTurnedHull, Guest::kTurnedRod,
                            Guest::kRodAcross, Guest::kBall}) {
    AddGuest(def, guest, {0.3, y, RestHeight(guest) + 1e-3}, {1, 0.1, 0}, material);
    y += 0.55;
  }
  AddPiece(def, a, {-0.5, 0.5, -1.5, 1.5}, material);
  AddPiece(def, b, {0.5 + apart_m, 1.5 + apart_m, -1.5, 1.5}, material);
  return def;
}

TEST(SeamLanes, EachWorldHasItsBitsInAnyRegister) {
  for (const Piece a : kPieces) {
    for (const Piece b : kPieces) {
      if (b < a || a == Piece::kPlane) continue;
      SCOPED_TRACE(std::string(NameOf(a)) + " " + NameOf(b));
      ExpectLanesLikeWorldsAlone(Crossing(a, b, 0), {3e-3, 1e-3, 0}, 150);
    }
  }
}

TEST(SeamLanes, APieceBeyondReachChangesNoBit) {
  for (const Piece a : {Piece::kField, Piece::kSolid, Piece::kSheet}) {
    // The second piece begins beyond all bodies.
    ModelDef two = Crossing(a, Piece::kSolid, 40), one = two;
    one.terrain_meshes.pop_back();
    WorldBatch with = MakeBatch(two), without = MakeBatch(one);
    with.Step(1e-3, 150);
    without.Step(1e-3, 150);
    for (int body = 0; body < 5; ++body) {
      EXPECT_EQ(Distance(with.Body(0, body).position_m, without.Body(0, body).position_m), 0)
          << NameOf(a) << " " << body;
    }
  }
}

}  // namespace
}  // namespace taut::test
