#include "description/experiment/terrain_boxes.h"

#include <cmath>
#include <numbers>

#include "math/elementary.h"
#include "math/random.h"
#include "math/vec.h"

namespace taut::description {
namespace {

/// Random number stream of scattered blocks. The streams of other modules are in
/// plant/random_streams.h.
constexpr std::uint32_t kScatterStream = 100;

}  // namespace

void Check(const MapReader& map, ScatterText& scatter) {
  scatter.material = ToMaterial(map, scatter.surface);
  scatter.low_m = scatter.high_m = {NAN, NAN, NAN};
  const Value* const within = scatter.within.value;
  if (within == nullptr) return;
  const std::string path = map.Path("within_m");
  const auto& corners = Items(within, path, map.scope());
  if (within->kind != Value::Kind::kSequence) return;
  const char* const hint = "[[x, y, z], [x, y, z]], the lower numbers first";
  if (corners.size() != 2) {
    map.Error("terrain.bad_region", "within_m",
              path + " must be two points, got " + std::to_string(corners.size()), hint);
    return;
  }
  scatter.low_m = ReadVec3(*corners[0], path, map.scope());
  scatter.high_m = ReadVec3(*corners[1], path, map.scope());
  const Vec3 &low = scatter.low_m, &high = scatter.high_m;
  if (low.x > high.x || low.y > high.y || low.z > high.z) {
    map.Error("terrain.empty_region", "within_m",
              path + " has a first point with a larger coordinate than the second", hint);
  }
}

void Check(const MapReader& map, StairsText& stairs) {
  stairs.material = ToMaterial(map, stairs.surface);
}

std::vector<TerrainBoxDef> Boxes(const ScatterText& s) {
  std::vector<TerrainBoxDef> boxes;
  const Vec3 half = 0.5 * s.box_m;
  for (int i = 0; i < s.count; ++i) {
    math::Random random(static_cast<std::uint64_t>(s.seed), kScatterStream,
                        static_cast<std::uint64_t>(i));
    const double x = random.Uniform(s.low_m.x, s.high_m.x);
    const double y = random.Uniform(s.low_m.y, s.high_m.y);
    const double z = random.Uniform(s.low_m.z, s.high_m.z);
    const double half_heading = 0.5 * random.Uniform(-std::numbers::pi, std::numbers::pi);
    const Quat q{math::Cos(half_heading), 0, 0, math::Sin(half_heading)};
    boxes.push_back({{}, {x, y, z}, q, half, s.material});
  }
  return boxes;
}

std::vector<TerrainBoxDef> Boxes(const StairsText& s) {
  std::vector<TerrainBoxDef> boxes;
  for (int i = 0; i < s.steps; ++i) {
    const Vec3 half{0.5 * s.tread_m, 0.5 * s.width_m, 0.5 * (i + 1) * s.rise_m};
    const Vec3 center{(i + 0.5) * s.tread_m, 0, half.z};
    boxes.push_back({{}, s.at_m + Rotate(s.rotate, center), s.rotate, half, s.material});
  }
  return boxes;
}

}  // namespace taut::description
