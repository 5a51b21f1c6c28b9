/// Ground of several pieces: motion over their seams.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tests/constants.h"
#include "tests/mechanics/known_scene.h"
#include "tests/mechanics/seam_ground.h"
#include "tests/scenes/chance.h"

namespace taut::mechanics {
namespace {

using namespace taut::seams;

constexpr double kStepS = 1e-3;
constexpr Material kNoFriction{0, 0, 0};

/// Largest errors of several runs.
struct Worst {
  double position_m = 0, energy_j = 0;
  int not_good = 0;

  /// Compares with a reference world.
  void Run(WorldBatch world, WorldBatch right, int steps) {
    const double start_j = test::EnergyOf(world);
    for (int i = 0; i < steps; ++i) {
      world.Step(kStepS, 1);
      right.Step(kStepS, 1);
      position_m = std::max(
          position_m, test::Distance(world.Body(0, 0).position_m, right.Body(0, 0).position_m));
      energy_j = std::max(energy_j, test::EnergyOf(world) - start_j);
    }
    not_good += world.Status(0).bits == kStatusOk ? 0 : 1;
  }
};

void ReportTo(Report& report, const Worst& worst, double position_m, double energy_j) {
  report.AtMost("largest distance", "m", worst.position_m, position_m);
  report.AtMost("largest gain of energy", "J", worst.energy_j, energy_j);
  report.Near("runs with a status bit", "1", worst.not_good, 0, 0);
}

/// Three pieces of 1 m, all pairs of kinds, all bodies: uniform motion.
void FlushPieces(Report& report) {
  constexpr int kSteps = 1800;
  double aside_m = 0, energy_j = 0;
  int runs = 0;
  for (const Piece a : kPieces) {
    for (const Piece b : kPieces) {
      if (a == Piece::kPlane && b == Piece::kPlane) continue;
      for (const Guest guest : kGuests) {
        ModelDef def;
        const Vec3 from{0, 0.013, RestHeight(guest)}, velocity{1, 0.03, 0};
        AddGuest(def, guest, from, velocity, kNoFriction);
        AddPiece(def, a, {-0.5, 0.5, -0.5, 0.5}, kNoFriction);
        AddPiece(def, b, {0.5, 1.5, -0.5, 0.5}, kNoFriction);
        if (a != Piece::kPlane) AddPiece(def, a, {1.5, 2.5, -0.5, 0.5}, kNoFriction);
        WorldBatch world = test::MakeBatch(def);
        const double start_j = test::EnergyOf(world);
        for (int i = 1; i <= kSteps; ++i) {
          world.Step(kStepS, 1);
          const double t = i * kStepS;
          const Vec3 there{from.x + velocity.x * t, from.y + velocity.y * t, from.z};
          aside_m = std::max(aside_m, test::Distance(world.Body(0, 0).position_m, there));
          energy_j = std::max(energy_j, test::EnergyOf(world) - start_j);
        }
        ++runs;
      }
    }
  }
  report.Near("runs", "1", runs, 24 * 8, 0);
  report.AtMost("distance from uniform motion, 1.8 s", "m", aside_m, 1e-9);
  report.AtMost("largest gain of energy", "J", energy_j, 1e-9);
}

/// Runs three pieces of random kinds, cells, levels and order. `jolt_m`: misalignment of the
/// pieces.
Worst RandomPieces(int runs, double jolt_m) {
  Worst worst;
  for (int k = 0; k < runs; ++k) {
    scenes::Chance chance(1000 + static_cast<std::uint64_t>(k));
    const double level_m = chance.Within(-1, 1);
    const Guest guest = kGuests[static_cast<int>(chance.Within(0, 8))];
    const Vec3 at{chance.Within(-0.1, 0.1), chance.Within(-0.2, 0.2),
                  level_m + RestHeight(guest) + (k % 2 == 0 ? 0 : 1e-3)};
    ModelDef pieces;
    AddGuest(pieces, guest, at, {1, chance.Within(-0.1, 0.1), 0}, kNoFriction);
    if (k % 3 == 0) pieces.bodies[0].angular_velocity_rad_per_s.z = chance.Within(-2, 2);
    ModelDef one = pieces;
    AddPiece(one, Piece::kSheet, {-0.5, 2.5, -0.5, 0.5, 12, 4, level_m}, kNoFriction);
    const int first = static_cast<int>(chance.Within(0, 3));
    for (int n = 0; n < 3; ++n) {
      const int i = (first + (k % 2 == 0 ? n : 3 - n)) % 3, cells = 2 + (k + 3 * n) % 5;
      const double gap_m = jolt_m * chance.Within(-1, 1), step_m = jolt_m * chance.Within(-1, 1);
      AddPiece(pieces, kPieces[static_cast<int>(chance.Within(0, 4))],
               {i - 0.5 + gap_m, i + 0.5 + gap_m, -0.5, 0.5, cells, cells, level_m + step_m},
               kNoFriction);
    }
    worst.Run(test::MakeBatch(pieces), test::MakeBatch(one), 1800);
  }
  return worst;
}

void PiecesInAnyOrder(Report& report) {
  ReportTo(report, RandomPieces(report.IsFull() ? 300 : 30, 0), test::SolverError(1800), 1e-9);
}

/// Gaps, overlaps and steps of 5e-8 m, a fourth of the meeting distance: a step raises a body by as
/// much.
void PiecesThatMeetNearly(Report& report) {
  constexpr double kJoltM = 5e-8;
  ReportTo(report, RandomPieces(report.IsFull() ? 300 : 30, kJoltM),
           10 * kJoltM + test::SolverError(1800), 2 * kJoltM * kG + 1e-9);
}

/// Pieces of different sizes along a border, four at a corner; rotated or not. Compared with a
/// plane.
void PiecesInCorners(Report& report) {
  Worst worst;
  // In the last starts a box or hull tips over the border of a sheet, behind which a wall descends.
  std::vector<int> starts(report.IsFull() ? 200 : 24);
  std::iota(starts.begin(), starts.end(), 0);
  starts.insert(starts.end(), {170, 685, 686, 844, 1013, 1709, 1817});
  for (const int k : starts) {
    scenes::Chance chance(300 + static_cast<std::uint64_t>(k));
    const bool turned = k % 3 == 2;
    const Guest guest = kGuests[static_cast<int>(chance.Within(0, 8))];
    const double level_m = chance.Within(-1, 1);
    ModelDef pieces;
    AddGuest(pieces, guest,
             {chance.Within(-0.4, 0.4), chance.Within(-0.4, 0.4), level_m + RestHeight(guest)},
             {chance.Within(-0.8, 0.8), chance.Within(-0.8, 0.8), 0}, kNoFriction);
    if (k % 2 == 0) pieces.bodies[0].angular_velocity_rad_per_s.z = chance.Within(-2, 2);
    ModelDef one = pieces;
    one.planes.push_back({"plane", {0, 0, 1}, {0, 0, level_m}, kNoFriction});
    const auto add = [&](double x0, double x1, double y0, double y1) {
      Piece kind = kPieces[static_cast<int>(chance.Within(0, 4))];
      if (turned && kind == Piece::kField) kind = Piece::kSolid;
      int cells = 1 + static_cast<int>(chance.Within(0, 5));
      // A field has square cells.
      const double ratio = (y1 - y0) / (x1 - x0);
      while (kind == Piece::kField && std::abs(cells * ratio - std::round(cells * ratio)) > 1e-9) {
        ++cells;
      }
      AddPiece(pieces, kind, {x0, x1, y0, y1, cells, cells, level_m}, kNoFriction);
    };
    if (k % 3 == 0) {
      add(-2, 0, -2, 0), add(0, 2, -2, 0), add(-2, 0, 0, 2), add(0, 2, 0, 2);
    } else {
      add(-2, 0.05, -2, 2), add(0.05, 2, -2, 0.3), add(0.05, 2, 0.3, 2);
    }
    if (turned) TurnTerrain(pieces, 0.3);
    worst.Run(test::MakeBatch(pieces), test::MakeBatch(one), 1200);
  }
  ReportTo(report, worst, test::SolverError(1200), 1e-9);
}

/// Level ground, then a slope: pieces against one mesh. Contacts may be found a step earlier or
/// later, which lets a body fall by g h^2.
void Kinks(Report& report) {
  constexpr Piece kSurfaces[] = {Piece::kField, Piece::kSolid, Piece::kSheet};
  Worst worst;
  int count = 0;
  for (const double slope : {-0.2, -0.01, -1e-4, 1e-4, 0.01, 0.2}) {
    for (const Piece a : kSurfaces) {
      for (const Piece b : kSurfaces) {
        for (const Guest guest : kGuests) {
          if (!report.IsFull() && ++count % 5 != 0) continue;
          ModelDef pieces;
          AddGuest(pieces, guest, {0.1, 0.013, RestHeight(guest)}, {1, 0.03, 0}, kNoFriction);
          ModelDef one = pieces;
          const Patch level{-0.5, 0.5, -0.5, 0.5}, tilted{0.5, 1.5, -0.5, 0.5, 4, 4, 0, slope};
          AddPiece(pieces, a, level, kNoFriction);
          AddPiece(pieces, b, tilted, kNoFriction);
          TerrainMeshDef mesh = MeshOf({-0.5, 1.5, -0.5, 0.5, 8, 4}, true, kNoFriction);
          for (Vec3& p : mesh.corners_m) {
            if (p.x > 0.5 && p.z > -0.5) p.z = slope * (p.x - 0.5);
          }
          mesh.name = "one";
          one.terrain_meshes.push_back(mesh);
          worst.Run(test::MakeBatch(pieces), test::MakeBatch(one), 800);
        }
      }
    }
  }
  ReportTo(report, worst, 2 * kG * kStepS * kStepS, 2 * kG * kG * kStepS * kStepS);
}

/// Over the border of one piece into the void, with restitution 0: the energy never rises.
void TippingOverABorder(Report& report) {
  double rise_j = 0;
  const int runs = report.IsFull() ? 60 : 9;
  for (const Piece piece : {Piece::kBox, Piece::kField, Piece::kSolid, Piece::kSheet}) {
    for (const Guest guest : kGuests) {
      for (int k = 0; k < runs; ++k) {
        scenes::Chance chance(50 + static_cast<std::uint64_t>(k));
        // One in three hardly moves and tips over the border below it.
        const bool turns = k % 3 == 2;
        const double friction = turns ? 1 : k % 2 == 0 ? 0 : 0.3;
        const double v = turns ? chance.Within(0, 0.15) : chance.Within(0.05, 0.6);
        const double level_m = chance.Within(-1, 1);
        const Material material{friction, friction, 0};
        ModelDef def;
        AddGuest(def, guest,
                 {turns ? 0.504 : 0.48 - 0.25 * v, chance.Within(-0.3, 0.3),
                  level_m + RestHeight(guest)},
                 {turns ? v : v + 2 * friction, chance.Within(-0.1, 0.1), 0}, material);
        def.bodies[0].angular_velocity_rad_per_s.z = chance.Within(-1, 1);
        AddPiece(def, piece, {-0.5, 0.5, -0.5, 0.5, 4, 4, level_m}, material);
        WorldBatch world = test::MakeBatch(def);
        double before_j = test::EnergyOf(world), sum_j = 0;
        for (int i = 0; i < 1200 && world.Body(0, 0).position_m.z > level_m - 1; ++i) {
          world.Step(kStepS, 1);
          const double now_j = test::EnergyOf(world);
          sum_j += std::max(0.0, now_j - before_j);
          before_j = now_j;
        }
        rise_j = std::max(rise_j, sum_j);
      }
    }
  }
  // Energy gain of a body of 1 kg that falls for a step before its contact is detected.
  report.AtMost("sum of all energy increases, body of 1 kg", "J", rise_j,
                kG * kG * kStepS * kStepS);
}

/// A body pushed along a floor against a higher adjacent piece; the contacts at the floor must
/// hold, too.
void WallBesideAFloor(Report& report) {
  double off_m = 0;
  for (const Piece floor : kPieces) {
    for (const Piece wall : {Piece::kBox, Piece::kField, Piece::kSolid}) {
      for (const Guest guest : {Guest::kBox, Guest::kHull, Guest::kRodAlong, Guest::kRodAcross}) {
        ModelDef def;
        const double lift = RestHeight(guest);
        AddGuest(def, guest, {0.2, 0.013, lift}, {1, 0, 0}, kNoFriction);
        AddPiece(def, floor, {-0.5, 0.5, -0.5, 0.5}, kNoFriction);
        AddPiece(def, wall, {0.5, 1.5, -0.5, 0.5, 4, 4, 0.5}, kNoFriction);
        def.gravity_m_per_s2 = {3, 0, -kG};
        WorldBatch world = test::MakeBatch(def);
        const double reach = guest == Guest::kRodAcross  ? kRadiusM
                             : guest == Guest::kRodAlong ? kHalfM + kRadiusM
                                                         : kHalfM;
        for (int i = 0; i < 800; ++i) {
          world.Step(kStepS, 1);
          off_m = std::max(off_m, std::abs(world.Body(0, 0).position_m.z - lift));
        }
        off_m = std::max(off_m, std::abs(world.Body(0, 0).position_m.x - (0.5 - reach)));
      }
    }
  }
  report.AtMost("distance from the position in the corner", "m", off_m, 1e-9);
}

/// Rolling ball and sliding crate: their motion must be as on a plane and straight on.
void Friction(Report& report) {
  Worst worst;
  constexpr Material kRough{0.1, 0.1, 0};
  for (const Piece a : kPieces) {
    for (const Piece b : kPieces) {
      if (a == Piece::kPlane && b == Piece::kPlane) continue;
      for (const Guest guest : {Guest::kBall, Guest::kBox, Guest::kTurnedRod}) {
        ModelDef pieces;
        AddGuest(pieces, guest, {0.2, 0.013, RestHeight(guest)}, {1, 0, 0}, kRough);
        if (guest == Guest::kBall) pieces.bodies[0].angular_velocity_rad_per_s = {0, 10, 0};
        ModelDef one = pieces;
        one.planes.push_back({"plane", {0, 0, 1}, {}, kRough});
        AddPiece(pieces, a, {-0.5, 0.5, -0.5, 0.5}, kRough);
        AddPiece(pieces, b, {0.5, 1.5, -0.5, 0.5}, kRough);
        worst.Run(test::MakeBatch(pieces), test::MakeBatch(one), 1000);
      }
    }
  }
  ReportTo(report, worst, test::SolverError(1000), 1e-9);
}

const SceneEntry kFlushPieces("seams", "Bodies over three flush pieces of any two kinds",
                              "uniform motion", FlushPieces);
const SceneEntry kPiecesInAnyOrder("seams", "Pieces of random kinds, cells and order",
                                   "the same ground as one sheet", PiecesInAnyOrder);
const SceneEntry kPiecesThatMeetNearly("seams", "Pieces with gaps and steps of 5e-8 m",
                                       "the same ground as one sheet", PiecesThatMeetNearly);
const SceneEntry kPiecesInCorners("seams", "T-junctions, corners of four, turned pieces", "a plane",
                                  PiecesInCorners);
const SceneEntry kKinks("seams", "Level ground that meets a slope", "the same ground as one mesh",
                        Kinks);
const SceneEntry kTippingOverABorder("seams", "Bodies that slide and tip over a border",
                                     "energy does not increase", TippingOverABorder);
const SceneEntry kWallBesideAFloor("seams", "A floor beside a higher piece", "statics",
                                   WallBesideAFloor);
const SceneEntry kFriction("seams", "Rolling and sliding over a seam", "a plane", Friction);

}  // namespace
}  // namespace taut::mechanics
