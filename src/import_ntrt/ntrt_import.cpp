// Importer of NTRT's structure files: reads them, builds the structure like NTRT, and writes a taut
// model file.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/union_find.h"
#include "description/yaml/reader.h"
#include "import_ntrt/draft.h"
#include "taut/import_ntrt.h"
#include "taut/spec.h"

namespace taut {
namespace import_ntrt {
namespace {

/// Returns whether some moving bodies are not connected to the others by cables.
bool IsDisconnected(const Built& built) {
  const auto world = built.mass_kg.size();
  base::UnionFind sets(world + 1);
  const auto index = [&](int body) {
    return built.mass_kg[static_cast<std::size_t>(body)] > 0.0 ? body : static_cast<int>(world);
  };
  for (const Cable& cable : built.cables) sets.Join(index(cable.from.body), index(cable.to.body));
  int robot = -1;
  for (std::size_t body = 0; body < world; ++body) {
    if (!(built.mass_kg[body] > 0.0)) continue;
    const int root = sets.Root(static_cast<int>(body));
    if (robot >= 0 && root != robot) return true;
    robot = root;
  }
  return false;
}

bool HasCompounds(const Built& built) {
  return std::any_of(built.bodies_solids.begin(), built.bodies_solids.end(),
                     [](int solids) { return solids > 1; });
}

double SizeOf(const Model& model) {
  double size = 0.0;
  for (const auto x : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    double low = INFINITY, high = -INFINITY;
    for (const Node& node : model.nodes) {
      low = std::min(low, node.place.*x);
      high = std::max(high, node.place.*x);
    }
    size = std::max(size, high - low);
  }
  return size;
}

void SayLaws(const Model& model, const Built& built, const NtrtOptions& options,
             NtrtImport& import) {
  const NtrtCounts& counts = model.counts;
  if (counts.cables > 0) {
    import.as_ntrt.emplace_back(
        "cables end on the surface of rods and spheres (ends: surface), and their damper force is "
        "at most the spring force (damping_law: clamped)");
  }
  if (counts.cables > 0) {
    import.as_ntrt.emplace_back(
        "motors: target_velocity and max_tension are the limits of the actuator, which stops at "
        "the minimum lengths");
  }
  if (HasCompounds(built)) {
    import.as_ntrt.emplace_back(
        "a body of several solids has the inertia of its bounding box (inertia: bounding_box)");
  }
  import.as_ntrt.emplace_back(
      "the friction coefficients of two touching shapes are multiplied, and so are their "
      "restitutions; NTRT's ground has friction 0.5 and restitution 0, whatever its configuration");
  if (options.like_ntrt) {
    import.as_ntrt.emplace_back("friction acts along the slip only (friction_law: along_slip)");
  }
  if (counts.rods > 0) {
    import.different.emplace_back(
        "rods collide as capsules, whose round ends extend NTRT's cylinders by the radius");
  }
  import.different.emplace_back(
      "gravity is 9.81 m/s^2, and the experiment defines the ground; NTRT's programs set both");
  if (counts.ignored_pairs > 0) {
    import.dropped.push_back(std::to_string(counts.ignored_pairs) +
                             " pairs that no builder of NTRT matches");
  }
}

std::string Comment(const std::string& text) {
  constexpr std::size_t kWidth = 100;
  std::string lines, line = "#";
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (line.size() + 1 + word.size() > kWidth) {
      lines += line + "\n";
      line = "#  ";
    }
    line += " " + word;
    begin = end + 1;
  }
  return lines + line + "\n";
}

std::string HeadText(const std::string& path, const NtrtOptions& options, const std::string& name,
                     const NtrtImport& import) {
  const std::string file = std::filesystem::path(path).filename().string();
  std::string text = Comment("Imported from NTRT's " + file +
                             " (unit of length: " + NumberText(options.length_unit_m) +
                             " m). NTRT's y axis points up: its (z, x, y) become (x, y, z).");
  for (const std::string& law : import.as_ntrt) text += Comment("Same as NTRT: " + law + ".");
  for (const std::string& law : import.different)
    text += Comment("Different from NTRT: " + law + ".");
  for (const std::string& what : import.dropped) text += Comment("Left out: " + what + ".");
  return text + "taut: 1\nkind: model\nname: " + name + "\n";
}

}  // namespace
}  // namespace import_ntrt

std::optional<NtrtImport> ImportNtrt(const std::string& path, const NtrtOptions& options,
                                     Diagnostics& out) {
  using namespace import_ntrt;  // NOLINT(google-build-using-namespace): this is its last step
  const std::size_t errors_before = out.items().size();
  std::optional<Model> model = ReadStructure(path, options, out);
  if (!model) return std::nullopt;
  const Built built = BuildStructure(*model, out);
  if (model->ComparedTooMuch()) {
    out.Error(
        "ntrt.too_large", {path, 0, 0},
        "the structure is too large: resolving its names, bonds and builders takes more than " +
            std::to_string(kMostComparisons) + " comparisons",
        "use fewer or shorter names, bonds and builders");
  }
  if (built.solids.empty() && out.items().size() == errors_before) {
    out.Error("ntrt.no_solid", {path, 0, 0}, "the builders of this structure build no solid",
              "builders for its tags, such as tgRodInfo, may be in a file that includes this one, "
              "or, with --like_ntrt, after a line that begins with %, which ends the file");
  }
  if (out.items().size() != errors_before) return std::nullopt;

  NtrtImport import;
  Draft draft = MakeDraft(*model, built, options.length_unit_m);
  AddGroups(*model, built, options, draft, import, out);
  if (out.items().size() != errors_before) return std::nullopt;
  import.counts = model->counts;
  import.counts.size_m = options.length_unit_m * SizeOf(*model);
  SayLaws(*model, built, options, import);
  if (model->counts.cables_without_rest_length > 0) {
    out.Warning("ntrt.no_rest_length", {path, 0, 0},
                std::to_string(model->counts.cables_without_rest_length) +
                    " cables would start with a rest length of zero or less: the model has errors "
                    "until their "
                    "prestress is lower",
                "reduce it with `--set NAME=VALUE`");
  }
  std::string name = options.name;
  if (name.empty()) name = NameText(std::filesystem::path(path).stem().string());
  const std::vector<Parameter> parameters = TakeOutParameters(draft.groups);

  std::string& text = import.model_yaml;
  text = HeadText(path, options, name, import);
  if (!parameters.empty()) text += "\nparameters:\n";
  for (const Parameter& parameter : parameters) {
    text += "  " + parameter.name + ": " + NumberText(parameter.value) + "\n";
  }
  text += PartsText(*model, draft, options.length_unit_m) + BuildersText(draft) + "\n";
  text += "contact: {friction_combine: product, restitution_combine: product";
  text += options.like_ntrt ? ", friction_law: along_slip}\n" : "}\n";
  if (HasCompounds(built)) text += "inertia: bounding_box\n";
  if (model->counts.cables > 0) text += "damping_law: clamped\n";
  if (IsDisconnected(built))
    text += "allow_disconnected: true  # not all bodies are connected by cables\n";
  return import;
}

}  // namespace taut
