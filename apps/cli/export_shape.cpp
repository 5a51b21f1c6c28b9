// `taut export shape`: geometry of a robot, for slides and 3D printers.
#include <fmt/format.h>

#include <map>
#include <memory>
#include <string>

#include "any_robot.h"
#include "export.h"
#include "output.h"
#include "overrides.h"
#include "standard_streams.h"
#include "taut/shape_mesh.h"

namespace taut::cli {
namespace {

enum class Format { kStl, kGltf };
const std::map<std::string, Format> kFormats{{"stl", Format::kStl}, {"gltf", Format::kGltf}};

struct ShapeArguments {
  PlacedRobotArguments robot;
  std::string out;
  std::optional<Format> format;
  double scale = 1.0;
  ShapeOptions options;
};

/// Returns the requested format, or the format of the file's extension.
std::optional<Format> FormatOf(const ShapeArguments& args) {
  if (args.format) return args.format;
  if (args.out.ends_with(".stl")) return Format::kStl;
  if (args.out.ends_with(".glb")) return Format::kGltf;
  return std::nullopt;
}

int ExportShape(const ShapeArguments& args) {
  const auto format = FormatOf(args);
  if (!format) {
    fmt::print(stderr, "error: unknown format of {} (expected .stl, .glb or --format)\n", args.out);
    return kUsage;
  }
  int exit = kOk;
  const auto robot = LoadPlacedRobot(args.robot, exit);
  if (!robot) return exit;
  const std::vector<ShapeMesh> shapes = ShapesOf(robot->def, args.options);
  if (shapes.empty()) {
    fmt::print(stderr, "{}: error: the robot has no shapes and no cables to export\n",
               args.robot.path);
    return kBadInput;
  }
  OutputIsNews();
  exit = WriteNamed(args.out, *format == Format::kStl ? StlOf(robot->def, shapes, args.scale)
                                                      : GlbOf(robot->def, shapes, args.scale));
  if (exit != kOk) return exit;
  std::size_t triangles = 0, cables = 0;
  for (const ShapeMesh& mesh : shapes) {
    triangles += mesh.triangles.size();
    cables += mesh.kind == ShapeMesh::Kind::kCable || mesh.kind == ShapeMesh::Kind::kSlackCable;
  }
  fmt::print("{}: shapes: {}, cables: {}, triangles: {}\n", args.out, shapes.size() - cables,
             cables, triangles);
  SayNextProgram({"xdg-open", args.out});
  return kOk;
}

}  // namespace

void AddExportShape(CLI::App& group, int& exit_code) {
  auto args = std::make_shared<ShapeArguments>();
  CLI::App* command = group.add_subcommand(
      "shape",
      "Write the geometry of a robot: closed meshes as STL for 3D printers, glTF for slides.");
  AddPlacedRobot(*command, args->robot);
  command->add_option("--out", args->out, "Output file (.stl or .glb)")
      ->option_text("FILE")
      ->required();
  command
      ->add_option_function<std::string>(
          "--format", [args](const std::string& word) { args->format = kFormats.at(word); },
          "Format (default: from the extension)")
      ->option_text("stl|gltf")
      ->check(OneOf({"stl", "gltf"}));
  command
      ->add_option("--cable_radius_m", args->options.cable_radius_m,
                   "Radius of cables [m] (default: 0.002); 0: no cables")
      ->option_text("NUMBER")
      ->check(NumberWithin(0, 1e3));
  command
      ->add_option(
          "--scale", args->scale,
          "Factor on all lengths (default: 1); 3D printers read STL in mm: 1000 is true size")
      ->option_text("NUMBER")
      ->check(NumberWithin(1e-6, 1e9));
  command->footer(
      "Examples:\n"
      "  taut export shape models/six_strut.yaml --out six_strut.glb\n"
      "  taut export shape models/prism3.yaml --out prism3.stl --scale 1000 --cable_radius_m "
      "0.001\n"
      "  taut export shape experiments/drop_six_strut.yaml --pose runs/drop_six_strut/trace.h5 \\\n"
      "    --at_s 0.5 --out falling.glb\n"
      "STL contains one mesh; glTF names bodies, shapes and cables.\n"
      "Exit status: 0 success, 1 the file cannot be written or the robot does not settle,\n"
      "2 bad usage, 3 bad input.");
  command->callback([args, &exit_code] { exit_code = ExportShape(*args); });
}

}  // namespace taut::cli
