// Height fields and meshes in experiment files: values, errors, and resolved experiments
#include <bit>
#include <cmath>
#include <cstdint>

#include "math/noise.h"
#include "math/random.h"
#include "math/vec.h"
#include "taut/run.h"
#include "taut/world_batch.h"
#include "unit/description/ground_fixture.h"

namespace taut::test {
namespace {

TEST_F(GroundText, AFormulaIsLookedAtInEveryCorner) {
  const RobotSpec robot = With(
      "- {name: hills, height_field: {columns: 5, rows: 3, cell_m: 0.25, origin_m: [1, 2, 3], "
      "height_m: push_n * x_m + 100 * y_m + 0.5 * i - j, split: shortest, friction: 0.3}}");
  ASSERT_EQ(robot.def.height_fields.size(), 1u);
  const HeightFieldDef& field = robot.def.height_fields[0];
  EXPECT_EQ(field.name, "hills");
  EXPECT_EQ(field.columns, 5);
  EXPECT_EQ(field.rows, 3);
  EXPECT_EQ(field.split, HeightFieldDef::Split::kShortest);
  EXPECT_EQ(field.material.kinetic_friction, 0.3);
  EXPECT_EQ(field.origin_m.z, 3);
  ASSERT_EQ(field.height_m.size(), 15u);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(field.height_m[static_cast<std::size_t>(5 * j + i)],
                  10 * 0.25 * (i - 2) + 100 * 0.25 * (j - 1) + 0.5 * i - j, 1e-12);
    }
  }
  EXPECT_EQ(robot.height_field_sources[0].line, 7);
}

TEST_F(GroundText, AFormulaIsRefusedWhereAllCornersWouldTakeTooLong) {
  // At 1.7 ms per corner, if each corner parsed the formula, 4,000,000 corners would take two
  // hours.
  std::string longer = "x_m";
  while (longer.size() < 9'990) longer += " + 1";
  const auto field = [&](int rows) {
    return "- {name: hills, height_field: {cell_m: 1, columns: 100, rows: " + std::to_string(rows) +
           ", height_m: " + longer + "}}";
  };
  const RobotSpec robot = With(field(100));
  ASSERT_EQ(robot.def.height_fields.size(), 1u);
  const double ones = static_cast<double>(longer.size() - 3) / 4;
  EXPECT_EQ(robot.def.height_fields[0].height_m[0], ones - 49.5);
  const std::string said = Said(field(10'000));
  EXPECT_NE(
      said.find(" operations and operands for each of 1e+06 corners, more than 400 000 000 in "
                "all (use a shorter formula"),
      std::string::npos)
      << said;
}

TEST_F(GroundText, NoiseIsSmoothAndHasARandomNumberAtWholePlaces) {
  const RobotSpec robot = With(
      "- {name: hills, height_field: {columns: 4, rows: 4, cell_m: 1, height_m: 'noise(5, i - 2, "
      "j)'}}");
  for (std::uint32_t j = 0; j < 4; ++j) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint64_t place = std::uint64_t{i - 2} << 32 >> 32 << 32 | j;
      const double drawn = math::Random(5, 0x6e6f6973, place).Uniform(-1.0, 1.0);
      EXPECT_EQ(robot.def.height_fields[0].height_m[4 * j + i], drawn);
    }
  }
  // No jump in value, slope or curvature at the borders of cells.
  const auto curve = [](double x) { return math::Noise(9, x, 0.3); };
  for (const double x : {-2.0, 0.0, 3.0}) {
    const double d = 1e-3;
    const double before = (curve(x) - 2 * curve(x - d) + curve(x - 2 * d)) / (d * d);
    const double after = (curve(x + 2 * d) - 2 * curve(x + d) + curve(x)) / (d * d);
    EXPECT_NEAR(before, after, 0.5);
    EXPECT_NEAR(curve(x + d) - curve(x), curve(x) - curve(x - d), 1e-6);
  }
}

TEST_F(GroundText, HeightsComeFromCsv) {
  Write("field.csv", "# least y first\n0, 1,2\n\n3,4.5,-1e-1\r\n");
  const RobotSpec robot = With("- {name: field, height_field: {file: field.csv, cell_m: 0.1}}");
  const HeightFieldDef& field = robot.def.height_fields[0];
  EXPECT_EQ(field.columns, 3);
  EXPECT_EQ(field.rows, 2);
  EXPECT_EQ(field.height_m, (std::vector<double>{0, 1, 2, 3, 4.5, -0.1}));
}

TEST_F(GroundText, GroundFarFromTheOriginIsRefused) {
  const auto has = [](const std::string& text, const std::string& what) {
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  has(Said("- {name: hills, height_field: {columns: 3, rows: 3, cell_m: 1, height_m: 0, origin_m: "
           "[1e9, 0, 0]}}"),
      "error: the height field \"hills\" is 1e+09 m from the origin, where positions are rounded "
      "to");
  has(Said("- {name: hills, height_field: {columns: 3, rows: 3, cell_m: 1, height_m: 1e9}}"),
      "error: the height field \"hills\" is 1e+09 m from the origin");
  Write("rock.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  has(Said("- {name: rock, mesh: {file: rock.obj, scale_m: 1, place: {at_m: [0, 1e9, 0]}}}"),
      "error: the mesh \"rock\" is 1e+09 m from the origin");
}

TEST_F(GroundText, ARunSaysWhoLeftTheGround) {
  Write("ball.yaml",
        "taut: 1\nkind: model\nname: ball\nnodes: {a: [0, 0, 0]}\n"
        "builders: [{match: a, sphere: {radius_m: 0.05, mass_kg: 1}}]\n");
  Write("fall.yaml",
        "taut: 1\nkind: experiment\nname: fall\nmodel: ball.yaml\nduration_s: 0.5\n"
        "start: as_described\nplace: {at_m: [3, 0, 0.2]}\n"
        "terrain: [{name: hills, height_field: {columns: 3, rows: 3, cell_m: 1, height_m: 0}}]\n");
  Diagnostics out;
  const auto experiment = LoadExperiment(Path("fall.yaml"), {}, out);
  ASSERT_TRUE(experiment) << out.Format();
  const auto summary = RunExperiment(*experiment, {}, out);
  ASSERT_TRUE(summary) << out.Format();
  EXPECT_EQ(summary->status.bits, kStatusFellOff);
  // Time of the step that contains sqrt(2 * 0.2 / 9.81) = 0.2019 s.
  EXPECT_EQ(summary->status_text,
            "body ball left the height field hills and is below all of the terrain at t = 0.201000 "
            "s");
}

/// A tetrahedron with corners at the origin and at 1 along each axis
constexpr const char* kObj =
    "# a tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1 3 2\nf 1/1 2/1 4/1\n"
    "f -4//1 -1//1 -2//1\nf 2 3 4\n";

std::string StlText() {
  std::string text = "solid rock\n";
  const char* const corners[] = {"0 0 0", "1 0 0", "0 1 0", "0 0 1"};
  for (const auto& [a, b, c] :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int k : {a, b, c}) text += std::string("  vertex ") + corners[k] + "\n";
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid rock\n";
}

std::string StlBinary() {
  std::string bytes(80, 's');
  const auto word = [&](std::uint32_t value) {
    for (int k = 0; k < 4; ++k) bytes += static_cast<char>(value >> (8 * k) & 0xff);
  };
  word(4);
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const auto& t :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    for (int k = 0; k < 3; ++k) word(0);
    for (const int corner : t) {
      for (const float x : corners[corner]) word(std::bit_cast<std::uint32_t>(x));
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

TEST_F(GroundText, MeshesComeFromObjAndStl) {
  Write("rock.obj", kObj);
  Write("text.stl", StlText());
  Write("bytes.STL", StlBinary());
  for (const std::string name : {"rock.obj", "text.stl", "bytes.STL"}) {
    const RobotSpec robot =
        With("- {name: rock, mesh: {file: " + name +
             ", scale_m: 0.5, place: {at_m: [10, 0, 0], rotate: {axis: z, angle_rad: pi / 2}}}}");
    ASSERT_EQ(robot.def.terrain_meshes.size(), 1u) << name;
    const TerrainMeshDef& mesh = robot.def.terrain_meshes[0];
    EXPECT_EQ(mesh.corners_m.size(), 4u) << name;
    EXPECT_EQ(mesh.triangles.size(), 4u) << name;
    EXPECT_TRUE(mesh.solid);
    double volume = 0;
    Vec3 middle;
    for (const auto& t : mesh.triangles) {
      const Vec3 shift{10, 0, 0};
      const Vec3 a = mesh.corners_m[static_cast<std::size_t>(t[0])] - shift;
      const Vec3 b = mesh.corners_m[static_cast<std::size_t>(t[1])] - shift;
      const Vec3 c = mesh.corners_m[static_cast<std::size_t>(t[2])] - shift;
      const double part = Dot(a, Cross(b, c)) / 6;
      volume += part;
      middle = middle + (part / 4) * (a + b + c);
    }
    EXPECT_NEAR(volume, 0.125 / 6, 1e-15) << name;
    // The corner along x is now along y.
    EXPECT_NEAR(middle.x / volume, -0.125, 1e-15) << name;
    EXPECT_NEAR(middle.y / volume, 0.125, 1e-15) << name;
    EXPECT_NEAR(middle.z / volume, 0.125, 1e-15) << name;
    Diagnostics out;
    EXPECT_TRUE(Model::Compile(robot.def, out)) << out.Format();
  }
}

TEST_F(GroundText, AResolvedExperimentHasTheSameGround) {
  Write("rock.obj", kObj);
  Diagnostics out;
  const auto experiment = Load(
      "- {name: hills, height_field: {columns: 30, rows: 20, cell_m: 0.1, height_m: 'noise(1, i / "
      "3, j / 3) / 3'}}\n  - {name: rock, mesh: {file: rock.obj, scale_m: 0.3, place: {at_m: [0, "
      "0, "
      "-4]}}}",
      out);
  ASSERT_TRUE(experiment) << out.Format();
  Write("resolved.yaml", ResolvedYaml(*experiment));
  const auto again = LoadExperiment(Path("resolved.yaml"), {}, out);
  ASSERT_TRUE(again) << out.Format();
  const ModelDef &first = experiment->robot.def, &second = again->robot.def;
  ASSERT_EQ(second.height_fields.size(), 1u);
  EXPECT_EQ(first.height_fields[0].height_m, second.height_fields[0].height_m);
  EXPECT_EQ(first.height_fields[0].columns, second.height_fields[0].columns);
  EXPECT_EQ(first.height_fields[0].split, second.height_fields[0].split);
  ASSERT_EQ(second.terrain_meshes.size(), 1u);
  EXPECT_EQ(first.terrain_meshes[0].triangles, second.terrain_meshes[0].triangles);
  for (std::size_t i = 0; i < first.terrain_meshes[0].corners_m.size(); ++i) {
    EXPECT_EQ(first.terrain_meshes[0].corners_m[i].z, second.terrain_meshes[0].corners_m[i].z);
  }
}

TEST_F(GroundText, WrongFieldsAreNamed) {
  const auto field = [&](const std::string& keys) {
    return Said("- {name: hills, height_field: {" + keys + "}}");
  };
  const auto has = [](const std::string& said, const std::string& what) {
    EXPECT_NE(said.find(what), std::string::npos) << said;
  };
  has(field("cell_m: 0.1"), "needs one of file, height_m");
  has(field("height_m: x_m, columns: 3, rows: 3"), "needs the key \"cell_m\"");
  has(field("height_m: x_m, cell_m: 0.1"), "needs the key \"columns\"");
  has(field("height_m: x_m, cell_m: -1, columns: 3, rows: 3"), "must be positive");
  has(field("height_m: x_m, cell_m: 1, columns: 3, rows: 1"),
      "rows must be a whole number within 2..100000");
  has(field("height_m: [1], cell_m: 1, columns: 3, rows: 3"), "must be a formula, got a list");
  has(field("height_m: 0, cell_m: 1, columns: 100000, rows: 50"), "at most 4 000 000 corners");
  has(field("height_m: x, cell_m: 1, columns: 3, rows: 3"), "unknown name \"x\"");
  has(field("height_m: 1 / i, cell_m: 1, columns: 3, rows: 3"), "at i = 0, j = 0");
  has(field("height_m: \"noise(0.5, i, j)\", cell_m: 1, columns: 3, rows: 3"),
      "not a whole number");
  has(field("height_m: \"noise(1, i)\", cell_m: 1, columns: 3, rows: 3"),
      "takes 3 arguments, got 2");
  has(field("file: none.csv, cell_m: 1"), "none.csv");
  Write("field.csv", "1,2\n3\n4,x\n5,nan\n");
  const std::string said = field("file: field.csv, cell_m: 1");
  has(said, "field.csv:2: error: this line has 1 heights, but the lines before have 2");
  has(said, "field.csv:3: error: value 2 of this line is not a number");
  has(said, "field.csv:4: error: value 2 of this line is not a number");
  Write("field.csv", "1,2\n");
  has(field("file: field.csv, cell_m: 1"),
      "the file must have at least two rows of at least two heights");
  Write("field.csv", "1,2\n3,4\n");
  has(field("file: field.csv, cell_m: 1, rows: 2"), "rows has no effect here");
}

TEST_F(GroundText, WrongMeshesAreNamed) {
  const auto mesh = [&](const std::string& name, const std::string& text) {
    Write(name, text);
    return Said("- {name: rock, mesh: {file: " + name + ", scale_m: 1}}");
  };
  const auto has = [](const std::string& said, const std::string& what) {
    EXPECT_NE(said.find(what), std::string::npos) << said;
  };
  has(Said("- {name: rock, mesh: {file: rock.obj}}"), "needs the key \"scale_m\"");
  has(mesh("rock.ply", ""), "unknown mesh format");
  has(mesh("rock.obj", "v 0 0\nv 0 0 0\nf 1 2 3\nf 1 2\n"),
      "rock.obj:1: error: a corner needs three finite numbers");
  has(mesh("rock.obj", "v 0 0 0\nv 0 1 0\nf 1 2 3\n"),
      "rock.obj:3: error: there is no corner \"3\"");
  has(mesh("rock.obj", "v 0 0 0\n"), "the mesh has no triangles");
  has(mesh("rock.stl", "solid\nfacet\nvertex 0 0 0\nendfacet\n"),
      "rock.stl:4: error: a facet must have three corners, got 1");
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 0 0\n";
  has(mesh("rock.obj", corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\n"),
      "rock.obj:6: error: the mesh is not closed: the edge from (0, 0, 0) to (0, 1, 0) has one "
      "triangle only (close the mesh, or write `solid: surface`)");
  has(mesh("rock.obj", corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 2 4\n"),
      "rock.obj:10: error: the edge from (0, 0, 0) to (1, 0, 0) has two triangles on one side, or "
      "more than two in all (list the corners");
  has(mesh("rock.obj", corners + "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n"),
      "rock.obj: error: the mesh is inside out (list the corners of all triangles "
      "counter-clockwise");
  has(mesh("rock.obj", corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 2 5\n"),
      "rock.obj:10: error: this triangle has no area (leave it out: its corners are on one line)");
  has(mesh("rock.stl", "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\nendfacet\n"),
      "rock.stl:6: error: this triangle has no area");
  std::string cut = StlBinary();
  cut.resize(cut.size() - 1);
  has(mesh("rock.stl", cut), "the mesh has no triangles");
}

/// Returns the errors of compiling an invalid ground.
std::string SaidOf(const ModelDef& def) {
  Diagnostics out;
  EXPECT_FALSE(Model::Compile(def, out));
  return out.Format();
}

TEST(GroundModel, GroundThatCannotBeIsRefused) {
  TerrainMeshDef tetrahedron;
  tetrahedron.name = "rock";
  tetrahedron.corners_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const auto with = [&](const auto& change) {
    ModelDef def;
    def.terrain_meshes.push_back(tetrahedron);
    change(def.terrain_meshes[0]);
    return SaidOf(def);
  };
  const auto has = [](const std::string& said, const std::string& what) {
    EXPECT_NE(said.find(what), std::string::npos) << said;
  };
  has(with([](auto& m) { m.triangles.pop_back(); }), "mesh rock is not closed: the edge between");
  has(with([](auto& m) { m.triangles.push_back({0, 2, 1}); }), "more than two in all");
  has(with([](auto& m) { std::swap(m.triangles[0][0], m.triangles[0][1]); }), "on one side");
  has(with([](auto& m) {
        for (auto& t : m.triangles) std::swap(t[0], t[1]);
      }),
      "inside out");
  has(with([](auto& m) { m.triangles[2][1] = 7; }), "a corner that does not exist");
  has(with([](auto& m) { m.triangles[2] = {0, 3, 3}; }), "triangle 2 has no area");
  has(with([](auto& m) { m.corners_m[1].x = NAN; }), "corner 1 must be finite");
  has(with([](auto& m) { m.triangles.clear(); }), "has no triangle");

  HeightFieldDef field;
  field.name = "hills";
  field.columns = 2, field.rows = 3, field.cell_m = 0.1;
  field.height_m = {0, 0, 0, 0, 0, 0};
  const auto of = [&](const auto& change) {
    ModelDef def;
    def.height_fields.push_back(field);
    change(def.height_fields[0]);
    return SaidOf(def);
  };
  has(of([](auto& f) { f.columns = 100'000, f.rows = 1001; }), "has more than 10^8 cells");
  ModelDef two;
  two.height_fields = {field, field};
  for (HeightFieldDef& f : two.height_fields) f.columns = 60'000, f.rows = 1000;
  has(SaidOf(two), "the height fields have more than 10^8 heights together");
  has(of([](auto& f) { f.height_m.pop_back(); }), "has 5 heights, but needs one for each");
  has(of([](auto& f) { f.height_m[4] = INFINITY; }), "height 4 must be finite");
  has(of([](auto& f) { f.cell_m = 0; }), "edge length of a cell must be a positive number");
  has(of([](auto& f) { f.rows = 1; }), "at least two corners along x");

  ModelDef boxed;
  BodyDef body;
  body.mass_kg = 1;
  body.inertia_kg_m2 = {1, 1, 1, 0, 0, 0};
  boxed.bodies.push_back(body);
  boxed.boxes.push_back({"payload", 0, {}, {}, {0.1, 0.1, 0.1}, {}});
  boxed.height_fields.push_back(field);
  boxed.terrain_meshes.push_back(tetrahedron);
  Diagnostics out;
  EXPECT_TRUE(Model::Compile(boxed, out)) << out.Format();
}

}  // namespace
}  // namespace taut::test
