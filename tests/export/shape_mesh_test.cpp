// Shape meshes against closed forms; STL files read back by the model reader
#include "taut/shape_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "description/assets/mesh_file.h"
#include "math/triangles.h"
#include "math/vec.h"
#include "mechanics/mass_properties.h"
#include "taut/spec.h"
#include "taut/statics.h"

namespace taut {
namespace {

double VolumeOf(const ShapeMesh& mesh) {
  return math::SixVolumes(mesh.corners_m, mesh.triangles) / 6;
}

void ExpectClosed(const ShapeMesh& mesh) {
  const auto faults = math::FindFaults(mesh.corners_m, mesh.triangles, true, 10);
  EXPECT_TRUE(faults.empty()) << mesh.name << ": " << faults.size();
  EXPECT_GT(VolumeOf(mesh), 0) << mesh.name;
  if (mesh.normals.empty()) return;
  ASSERT_EQ(mesh.normals.size(), mesh.corners_m.size());
  // Normals are on the outer side of the adjacent faces.
  std::vector<Vec3> faces(mesh.corners_m.size());
  for (const auto& t : mesh.triangles) {
    const auto at = [&](int k) { return mesh.corners_m[static_cast<std::size_t>(k)]; };
    const Vec3 n = Cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
    for (const int k : t) {
      Vec3& sum = faces[static_cast<std::size_t>(k)];
      sum = sum + n;
    }
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const double cosine = Dot(faces[i], mesh.normals[i]) / std::sqrt(Dot(faces[i], faces[i]));
    EXPECT_GT(cosine, 0.98) << mesh.name << " corner " << i;
    EXPECT_NEAR(Dot(mesh.normals[i], mesh.normals[i]), 1, 1e-12);
  }
}

Vec3 CentreOf(const ShapeMesh& mesh) { return SolidMesh(mesh.corners_m, mesh.triangles, 1).com_m; }

void ExpectNear(const Vec3& a, const Vec3& b, double within) {
  EXPECT_NEAR(a.x, b.x, within);
  EXPECT_NEAR(a.y, b.y, within);
  EXPECT_NEAR(a.z, b.z, within);
}

ModelDef AllKinds() {
  ModelDef def;
  def.bodies.resize(1);
  def.bodies[0].name = "thing";
  def.bodies[0].com_m = {1, 2, 3};
  CapsuleDef rod;
  rod.name = "rod", rod.from_m = {0.1, 0.2, 0.3}, rod.to_m = {0.5, -0.4, 1.1}, rod.radius_m = 0.03;
  def.capsules.push_back(rod);
  rod.name = "down", rod.from_m = {0, 0, 1}, rod.to_m = {0, 0, -1};
  def.capsules.push_back(rod);
  SphereDef sphere;
  sphere.name = "ball", sphere.center_m = {-1, 0.5, 2}, sphere.radius_m = 0.25;
  def.spheres.push_back(sphere);
  BoxDef box;
  box.name = "box", box.center_m = {3, 1, -2}, box.half_extents_m = {0.1, 0.2, 0.3};
  box.orientation = {std::cos(0.4), std::sin(0.4), 0, 0};
  def.boxes.push_back(box);
  HullDef hull;
  hull.name = "hull",
  hull.corners_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}};
  def.hulls.push_back(hull);
  CableDef cable;
  cable.name = "cable", cable.stiffness_n_per_m = 100, cable.rest_length_m = 1;
  cable.attachments = {{kWorld, {0, 0, 0}}, {0, {0, 0, 2}}, {0, {0, 0, 3}}, {0, {1, 0, 3}}};
  def.cables.push_back(cable);
  cable.name = "loose", cable.rest_length_m = 10;
  cable.attachments = {{kWorld, {0, 0, 0}}, {0, {0, 3, 4}}};
  def.cables.push_back(cable);
  return def;
}

TEST(ShapeMesh, EnclosesTheVolumeOfWhatItStandsFor) {
  const ModelDef def = AllKinds();
  const std::vector<ShapeMesh> shapes = ShapesOf(def, {0.004});
  ASSERT_EQ(shapes.size(), 7u);
  for (const ShapeMesh& mesh : shapes) ExpectClosed(mesh);
  const double rod_m = std::sqrt(0.16 + 0.36 + 0.64), r = 0.03;
  EXPECT_NEAR(VolumeOf(shapes[0]), std::numbers::pi * r * r * (rod_m + 4 * r / 3), 1e-15);
  EXPECT_NEAR(VolumeOf(shapes[1]), std::numbers::pi * r * r * (2 + 4 * r / 3), 1e-15);
  EXPECT_NEAR(VolumeOf(shapes[2]), 4 * std::numbers::pi / 3 * std::pow(0.25, 3), 1e-15);
  EXPECT_NEAR(VolumeOf(shapes[3]), 8 * 0.1 * 0.2 * 0.3, 1e-15);
  EXPECT_NEAR(VolumeOf(shapes[4]), 1.0 / 6, 1e-15);
  EXPECT_NEAR(VolumeOf(shapes[5]), std::numbers::pi * 0.004 * 0.004 * 4, 1e-15);
  EXPECT_NEAR(VolumeOf(shapes[6]), std::numbers::pi * 0.004 * 0.004 * 5, 1e-15);
  ExpectNear(CentreOf(shapes[0]), {0.3, -0.1, 0.7}, 1e-12);
  ExpectNear(CentreOf(shapes[2]), {-1, 0.5, 2}, 1e-12);
  ExpectNear(CentreOf(shapes[3]), {3, 1, -2}, 1e-12);
  ExpectNear(CentreOf(shapes[4]), {0.25, 0.25, 0.25}, 1e-12);
  ExpectNear(CentreOf(shapes[6]), {0, 1.5, 2}, 1e-12);
  EXPECT_EQ(shapes[5].kind, ShapeMesh::Kind::kCable);
  EXPECT_EQ(shapes[6].kind, ShapeMesh::Kind::kSlackCable);
}

TEST(ShapeMesh, IsNearTheSurfaceThatItStandsFor) {
  // The distance of the corners from the center is the radius, within 2 %.
  const ShapeMesh ball = ShapesOf(AllKinds(), {})[2];
  for (const Vec3& corner : ball.corners_m) {
    const Vec3 out = corner - Vec3{-1, 0.5, 2};
    EXPECT_NEAR(std::sqrt(Dot(out, out)), 0.25, 0.25 * 0.02);
  }
  const ShapeMesh box = ShapesOf(AllKinds(), {})[3];
  for (const Vec3& corner : box.corners_m) {
    const Vec3 own = Rotate({std::cos(0.4), -std::sin(0.4), 0, 0}, corner - Vec3{3, 1, -2});
    ExpectNear({std::fabs(own.x), std::fabs(own.y), std::fabs(own.z)}, {0.1, 0.2, 0.3}, 1e-12);
  }
}

TEST(ShapeMesh, CablesLieOnTheirWheels) {
  ModelDef def;
  def.bodies.resize(1);
  CableDef cable;
  cable.name = "round", cable.stiffness_n_per_m = 100, cable.rest_length_m = 1;
  AttachmentDef wheel{0, {0, 0, 0}};
  wheel.wheel = WheelDef{{0, 1, 0}, 0.1, false, 0};
  cable.attachments = {{kWorld, {-0.1, 0, -1}}, wheel, {kWorld, {0.1, 0, -1}}};
  def.cables.push_back(cable);
  int over = 0;
  for (const bool other_way : {false, true}) {
    def.cables[0].attachments[1].wheel->counterclockwise = other_way;
    const ShapeMesh mesh = ShapesOf(def, {0.001}).front();
    ExpectClosed(mesh);
    // The cable passes over the wheel, along half its circumference, or below it, straight. Chords
    // of ten degrees make the mesh shorter by a known share.
    const double length_m = CableLength(def.cables[0]);
    EXPECT_NEAR(VolumeOf(mesh), std::numbers::pi * 1e-6 * length_m,
                2e-3 * std::numbers::pi * 1e-6 * length_m);
    EXPECT_LT(VolumeOf(mesh), std::numbers::pi * 1e-6 * length_m * (1 + 1e-9));
    double highest = -2;
    for (const Vec3& corner : mesh.corners_m) highest = std::max(highest, corner.z);
    over += length_m > 2.2;
    // Straight up, over the wheel and down again; with the other direction the cable does not touch
    // the wheel.
    EXPECT_NEAR(length_m, length_m > 2.2 ? 2 + 0.1 * std::numbers::pi : 0.2, 1e-9);
    EXPECT_NEAR(highest, length_m > 2.2 ? 0.1 : -1, 2e-3);
  }
  EXPECT_EQ(over, 1);
}

TEST(ShapeMesh, EveryShippedModelIsClosedAndItsStlIsToo) {
  std::string pattern = (std::filesystem::temp_directory_path() / "taut_stl_XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(pattern.data());
  for (const auto& file : std::filesystem::directory_iterator(TAUT_SOURCE_DIR "/share/models")) {
    if (file.path().extension() != ".yaml") continue;
    Diagnostics found;
    const auto robot = LoadRobot(file.path(), {}, found);
    ASSERT_TRUE(robot) << found.Format();
    const std::vector<ShapeMesh> shapes = ShapesOf(robot->def);
    double volume = 0;
    std::size_t triangles = 0;
    for (const ShapeMesh& mesh : shapes) {
      ExpectClosed(mesh);
      volume += VolumeOf(mesh), triangles += mesh.triangles.size();
    }
    if (shapes.empty()) continue;
    const std::string path = folder / "out.stl";
    const std::string bytes = StlOf(robot->def, shapes, 1000);
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_EQ(bytes.size(), 84 + 50 * triangles);
    const auto read = description::ReadMeshFile(path, found);
    ASSERT_TRUE(read) << found.Format();
    EXPECT_EQ(read->triangles.size(), triangles);
    EXPECT_NEAR(math::SixVolumes(read->corners, read->triangles) / 6, 1e9 * volume, 1e4 * volume);
    // After merging equal corners, every edge of a shape belongs to two triangles. Several shapes
    // may share corners, such as two boxes with a common edge.
    for (const ShapeMesh& mesh : shapes) {
      std::ofstream(path, std::ios::binary) << StlOf(robot->def, {mesh}, 1000);
      const auto one = description::ReadMeshFile(path, found);
      ASSERT_TRUE(one) << found.Format();
      const auto faults = math::FindFaults(one->corners, one->triangles, true, 10);
      EXPECT_TRUE(faults.empty()) << file.path() << ' ' << mesh.name << ": " << faults.size();
    }
  }
  std::filesystem::remove_all(folder);
}

TEST(ShapeMesh, StlHasTheNormalsOfItsTriangles) {
  const ModelDef def = AllKinds();
  const std::string bytes = StlOf(def, ShapesOf(def), 2);
  ASSERT_NE(bytes.substr(0, 5), "solid");
  const auto number = [&](std::size_t at) {
    float x = 0;
    std::memcpy(&x, bytes.data() + at, sizeof x);
    return static_cast<double>(x);
  };
  const auto point = [&](std::size_t at) {
    return Vec3{number(at), number(at + 4), number(at + 8)};
  };
  for (std::size_t at = 84; at < bytes.size(); at += 50) {
    const Vec3 n = point(at), a = point(at + 12), b = point(at + 24), c = point(at + 36);
    Vec3 out = Cross(b - a, c - a);
    out = (1 / std::sqrt(Dot(out, out))) * out;
    EXPECT_GT(Dot(n, out), 0.999);
    EXPECT_NEAR(Dot(n, n), 1, 1e-5);
  }
}

}  // namespace
}  // namespace taut
