// Convex shapes in model files: from corners, and from objects of a mesh file
#include <cmath>

#include "math/vec.h"
#include "taut/run.h"
#include "taut/world_batch.h"
#include "unit/description/experiment_fixture.h"
#include "unit/description/model_fixture.h"

namespace taut::test {
namespace {

/// A box of 2 x 1 x 1 file units from (x, 0, 0), with corner indices from `first`
std::string Box(double x, int first, const std::string& name) {
  std::string obj = "o " + name + "\n";
  for (int i = 0; i < 8; ++i) {
    obj += "v " + std::to_string(x + (i & 1 ? 2 : 0)) + (i & 2 ? " 1" : " 0") +
           (i & 4 ? " 1\n" : " 0\n");
  }
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& face : faces) {
    obj += "f";
    for (const int corner : face) obj += " " + std::to_string(first + corner);
    obj += "\n";
  }
  return obj;
}

class ConvexText : public ExperimentFolder {
 protected:
  /// Loads a model of one node with this convex shape.
  std::optional<RobotSpec> Load(const std::string& convex, Diagnostics& out) {
    Write("rock.yaml",
          "taut: 1\nkind: model\nname: rock\n"
          "parts: {rock: {nodes: {at: [0.1, 0, 0]}}}\n"
          "structure: [{part: rock, at_m: [0, 0, 1], rotate: {axis: z, angle_rad: pi / 2}}]\n"
          "builders:\n"
          "  - {match: at, convex: {" +
              convex + "}}\n");
    return LoadRobot(Path("rock.yaml"), {}, out);
  }
  RobotSpec With(const std::string& convex) {
    Diagnostics out;
    const auto robot = Load(convex, out);
    EXPECT_TRUE(robot) << out.Format();
    warnings_ = out.Format();
    return robot.value_or(RobotSpec{});
  }
  std::string Said(const std::string& convex) {
    Diagnostics out;
    EXPECT_FALSE(Load(convex, out)) << convex;
    return out.Format();
  }
  std::string warnings_;
};

/// The box of `Box` without its top
std::string OpenBox() {
  std::string obj = Box(0, 1, "open");
  obj.erase(obj.find("f 5 6 8 7\n"), std::string("f 5 6 8 7\n").size());
  return obj;
}

void ExpectHas(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks " << part;
}

TEST_F(ConvexText, ByCornersItIsWhatTheySpan) {
  // A pyramid of 0.2 x 0.2 x 0.3 on its node, with a corner inside that has no effect
  const RobotSpec robot = With(
      "corners_m: [[-0.1, -0.1, 0], [0.1, -0.1, 0], [0.1, 0.1, 0], [-0.1, 0.1, 0], [0, 0, 0.3], "
      "[0, 0, 0.1]], density_kg_per_m3: 500, friction: 0.3");
  ASSERT_EQ(robot.def.hulls.size(), 1u);
  const HullDef& hull = robot.def.hulls[0];
  EXPECT_EQ(hull.corners_m.size(), 5u);
  EXPECT_EQ(hull.material.kinetic_friction, 0.3);
  const BodyDef& body = robot.def.bodies[0];
  EXPECT_NEAR(body.mass_kg, 500 * 0.2 * 0.2 * 0.3 / 3, 1e-12);
  // The part is rotated by 90 degrees: its node is at (0, 0.1, 1).
  EXPECT_NEAR(body.com_m.x, 0, 1e-12);
  EXPECT_NEAR(body.com_m.y, 0.1, 1e-12);
  EXPECT_NEAR(body.com_m.z, 1 + 0.3 / 4, 1e-12);
  // Square pyramid about its center of mass: m a^2 / 10 about its axis
  EXPECT_NEAR(body.inertia_kg_m2.zz, body.mass_kg * 0.04 / 10, 1e-12);
  EXPECT_NEAR(body.inertia_kg_m2.xx, body.mass_kg * (0.04 / 20 + 3 * 0.09 / 80), 1e-12);
}

TEST_F(ConvexText, EveryObjectOfAFileIsAHullAndWeighs) {
  Write("l.obj", Box(0, 1, "one") + Box(2, 9, "two"));
  const RobotSpec robot = With("file: l.obj, scale_m: 0.05, mass_kg: 3");
  ASSERT_EQ(robot.def.hulls.size(), 2u);
  EXPECT_EQ(robot.def.hulls[0].name, "rock.at_0");
  EXPECT_EQ(robot.def.hulls[1].name, "rock.at_1");
  EXPECT_EQ(robot.def.bodies.size(), 1u);
  const BodyDef& body = robot.def.bodies[0];
  EXPECT_NEAR(body.mass_kg, 3, 1e-12);
  // 0.2 x 0.05 x 0.05 along the part's x, which is W's y, from the node
  EXPECT_NEAR(body.com_m.y, 0.1 + 0.1, 1e-12);
  EXPECT_NEAR(body.inertia_kg_m2.xx, 3 * (0.04 + 0.0025) / 12, 1e-12);
  EXPECT_NEAR(body.inertia_kg_m2.yy, 3 * 2 * 0.0025 / 12, 1e-12);
  ASSERT_EQ(robot.files.size(), 2u);
  ExpectHas(robot.files[1], "l.obj");
  EXPECT_EQ(warnings_, "");
}

TEST_F(ConvexText, WithAMassAMeshWithHolesIsItsHull) {
  Write("open.obj", OpenBox());
  const RobotSpec robot = With("file: open.obj, scale_m: 0.1, mass_kg: 3");
  ASSERT_EQ(robot.def.hulls.size(), 1u);
  const BodyDef& body = robot.def.bodies[0];
  EXPECT_NEAR(body.mass_kg, 3, 1e-12);
  EXPECT_NEAR(body.inertia_kg_m2.zz, 3 * (0.04 + 0.01) / 12, 1e-9);  // inertia of the closed box
  ExpectHas(warnings_, "open.obj");
  ExpectHas(warnings_, "is not closed");
  ExpectHas(warnings_, "the mass of the mesh of ");
  ExpectHas(warnings_, " is distributed as in its hull");
  // A density would require its volume.
  ExpectHas(Said("file: open.obj, scale_m: 0.1, density_kg_per_m3: 600"),
            "close the mesh, or give mass_kg, the mass of its hull");
}

TEST_F(ConvexText, AMeshThatIsInsideOutOrHasLinesForTrianglesIsItsHullToo) {
  std::string inside_out = Box(0, 1, "box"), line = Box(0, 1, "box") + "f 1 2 2\n";
  for (std::size_t at = inside_out.find("\nf "); at != inside_out.npos;
       at = inside_out.find("\nf ", at + 1)) {
    std::swap(inside_out[at + 5], inside_out[at + 9]);
  }
  for (const std::string& obj : {inside_out, line}) {
    Write("bad.obj", obj);
    EXPECT_NEAR(With("file: bad.obj, scale_m: 0.1, mass_kg: 3").def.bodies[0].mass_kg, 3, 1e-12);
    ExpectHas(warnings_, " is distributed as in its hull");
  }
}

TEST_F(ConvexText, SolidsOfAnStlAreItsObjects) {
  std::string stl;
  for (int solid = 0; solid < 2; ++solid) {
    const double at = 2 * solid;
    const double p[4][3] = {{at, 0, 0}, {at + 1, 0, 0}, {at, 1, 0}, {at, 0, 1}};
    const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    stl += "solid part\n";
    for (const auto& face : faces) {
      stl += "facet normal 0 0 0\nouter loop\n";
      for (const int c : face) {
        stl += "vertex " + std::to_string(p[c][0]) + " " + std::to_string(p[c][1]) + " " +
               std::to_string(p[c][2]) + "\n";
      }
      stl += "endloop\nendfacet\n";
    }
    stl += "endsolid part\n";
  }
  Write("two.stl", stl);
  const RobotSpec robot = With("file: two.stl, scale_m: 0.1, density_kg_per_m3: 600");
  ASSERT_EQ(robot.def.hulls.size(), 2u);
  EXPECT_NEAR(robot.def.bodies[0].mass_kg, 2 * 600 * 1e-3 / 6, 1e-12);
}

TEST_F(ConvexText, WhatIsHollowedOutIsSaid) {
  // An L-shaped object: two boxes whose common corner is cut out.
  std::string obj;
  const double p[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double z : {0.0, 1.0}) {
    for (const auto& c : p) {
      obj +=
          "v " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(z) + "\n";
    }
  }
  obj += "f 1 4 3 2\nf 1 6 5 4\nf 7 8 9 10\nf 7 10 11 12\n";
  for (int i = 0; i < 6; ++i) {
    const int a = i + 1, b = (i + 1) % 6 + 1;
    obj += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 6) + " " +
           std::to_string(a + 6) + "\n";
  }
  Write("l.obj", obj);
  const RobotSpec robot = With("file: l.obj, scale_m: 0.1, density_kg_per_m3: 1000");
  EXPECT_NEAR(robot.def.bodies[0].mass_kg, 3, 1e-12);
  ExpectHas(warnings_, "is not convex: its hull, which collides, has 1.167 times its volume");
}

TEST_F(ConvexText, WrongOnesAreNamed) {
  Write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  Write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
  Write("turned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n");
  ExpectHas(Said("file: open.obj, scale_m: 1, density_kg_per_m3: 1"),
            "open.obj:7: error: the mesh is not closed");
  ExpectHas(Said("file: flat.obj, scale_m: 1, density_kg_per_m3: 1"), "the mesh is inside out");
  ExpectHas(Said("file: turned.obj, scale_m: 1, density_kg_per_m3: 1"), "is inside out");
  ExpectHas(Said("file: none.obj, scale_m: 1, mass_kg: 1"), "none.obj");
  ExpectHas(Said("file: open.obj, mass_kg: 1"), "scale_m");
  ExpectHas(Said("corners_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], mass_kg: 1"),
            "rock.yaml:7:37: error: the hull has no volume");
  ExpectHas(Said("corners_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], scale_m: 2, mass_kg: 1"),
            "scale_m has no effect here");
  ExpectHas(Said("corners_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]"), "mass_kg");
  ExpectHas(Said("mass_kg: 1"), "corners_m");
  std::string many = "corners_m: [";
  for (int i = 0; i < 65; ++i) {
    const double a = 0.09666 * i;
    many += "[" + std::to_string(std::cos(a)) + ", " + std::to_string(std::sin(a)) + ", " +
            std::to_string(i % 2) + "], ";
  }
  ExpectHas(Said(many + "[0, 0, 3]], mass_kg: 1"), "has 66 corners, more than 64");
}

TEST_F(ConvexText, OfAFileWithMoreCornersTheHullHas64AndItIsSaid) {
  // Two cones with a common base: 102 corners, all of which are corners of the hull.
  std::string top, bottom, text;
  for (int i = 0; i < 100; ++i) {
    const double angle = 0.02 * std::acos(-1.0) * i;
    text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    const std::string a = std::to_string(1 + i), b = std::to_string(1 + (i + 1) % 100);
    top += "f " + a + " " + b + " 101\n";
    bottom += "f " + b + " " + a + " 102\n";
  }
  Write("cones.obj", text + "v 0 0 1\nv 0 0 -1\n" + top + bottom);
  const RobotSpec robot = With("file: cones.obj, scale_m: 1, density_kg_per_m3: 1");
  ASSERT_EQ(robot.def.hulls.size(), 1u);
  EXPECT_EQ(robot.def.hulls[0].corners_m.size(), 64u);
  ExpectHas(warnings_,
            "has 102 corners, but a hull has at most 64: the farthest corner left out is ");
}

TEST_F(ConvexText, AFileHas256ObjectsAtMost) {
  std::string many;
  for (int i = 0; i < 257; ++i) many += Box(3 * i, 1 + 8 * i, "box_" + std::to_string(i));
  Write("many.obj", many);
  ExpectHas(Said("file: many.obj, scale_m: 1, mass_kg: 1"),
            "many.obj has 257 objects, more than 256");
}

TEST_F(ConvexText, AResolvedExperimentHasItsCorners) {
  Write("l.obj", Box(0, 1, "one") + Box(2, 9, "two"));
  With("file: l.obj, scale_m: 0.05, mass_kg: 3");
  Write("drop.yaml",
        "taut: 1\nkind: experiment\nname: drop\nmodel: rock.yaml\nstart: as_described\n"
        "duration_s: 0.7\nterrain: [{name: ground, plane: {height_m: 0, friction: 0.5}}]\n");
  Diagnostics out;
  const auto experiment = LoadExperiment(Path("drop.yaml"), {}, out);
  ASSERT_TRUE(experiment) << out.Format();
  Write("resolved.yaml", ResolvedYaml(*experiment));
  const auto again = LoadExperiment(Path("resolved.yaml"), {}, out);
  ASSERT_TRUE(again) << out.Format();
  EXPECT_EQ(again->robot.def.hulls.size(), 2u);
  const auto first = RunExperiment(*experiment, {}, out);
  const auto second = RunExperiment(*again, {}, out);
  ASSERT_TRUE(first && second) << out.Format();
  EXPECT_EQ(first->state_hash, second->state_hash);
}

}  // namespace
}  // namespace taut::test
