/// Pin-jointed structures of TsgFEM and CTSFEM (MPL-2.0), read from a folder next to the checkout
/// or from TAUT_REFERENCE; taut may not redistribute them.
#pragma once

#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "math/vec.h"
#include "tests/unit/analysis/analysis_scenes.h"

namespace taut::test {

inline std::filesystem::path ReferenceFolder() {
  const char* const given = std::getenv("TAUT_REFERENCE");
  return given != nullptr ? given : TAUT_SOURCE_DIR "/../shared/reference";
}

inline std::optional<nlohmann::json> StructuralFile(const std::string& name) {
  const std::filesystem::path path = ReferenceFolder() / "structural" / (name + ".json.gz");
  if (!std::filesystem::exists(path)) return std::nullopt;
  gzFile const file = gzopen(path.c_str(), "rb");
  std::string text;
  char part[1 << 16];
  for (int n = 0; (n = gzread(file, part, sizeof part)) > 0;) {
    text.append(part, static_cast<std::size_t>(n));
  }
  gzclose(file);
  return nlohmann::json::parse(text);
}

/// Reads a column or a row of numbers, or a plain list.
inline std::vector<double> Numbers(const nlohmann::json& list) {
  std::vector<double> out;
  for (const auto& item : list) {
    if (item.is_array()) {
      for (const auto& part : item) out.push_back(part);
    } else {
      out.push_back(item);
    }
  }
  return out;
}

/// Returns the structure with its nodes as points, its members as cables (under tension) and bars;
/// half of a member's mass is at each end. Guides in the world constrain directions of nodes that
/// are not free.
inline ModelDef TrussOf(const nlohmann::json& file, MemberMass mass) {
  ModelDef def;
  def.gravity_m_per_s2 = {};
  const auto& at = file["N"];
  const std::size_t count = at[0].size();
  std::vector<std::pair<std::size_t, std::size_t>> members;
  if (file.contains("members")) {
    for (const auto& m : file["members"]) members.emplace_back(m[0], m[1]);
  } else {
    for (const auto& row : file["C"]) {
      std::size_t from = 0, to = 0;
      for (std::size_t n = 0; n < count; ++n) {
        if (row[n] == -1.0) from = n;
        if (row[n] == 1.0) to = n;
      }
      members.emplace_back(from, to);
    }
  }
  const auto masses = Numbers(file["mass"]);
  std::vector<double> of_node(count);
  for (std::size_t m = 0; m < members.size(); ++m) {
    of_node[members[m].first] += 0.5 * masses[m];
    of_node[members[m].second] += 0.5 * masses[m];
  }
  std::set<std::size_t> free;
  if (file.contains("free_dof")) {
    for (const std::size_t dof : file["free_dof"]) free.insert(dof);
  } else {
    const auto& rows = file["Ia"];
    for (std::size_t dof = 0; dof < rows.size(); ++dof) {
      for (const double one : rows[dof]) {
        if (one != 0) free.insert(dof);
      }
    }
  }
  const auto place = [&](std::size_t n) { return Vec3{at[0][n], at[1][n], at[2][n]}; };
  for (std::size_t n = 0; n < count; ++n) {
    const int body = AddPoint(def, "node" + std::to_string(n), place(n), of_node[n]);
    std::vector<int> loose, stuck;
    for (int axis = 0; axis < 3; ++axis) {
      (free.count(3 * n + static_cast<std::size_t>(axis)) ? loose : stuck).push_back(axis);
    }
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (loose.empty()) def.bodies.back().fixed = true;
    if (loose.size() == 1) {
      AddJoint(def, JointKind::kLine, kWorld, place(n), body, place(n), axes[loose[0]]);
    }
    if (loose.size() == 2) {
      AddJoint(def, JointKind::kPlane, kWorld, place(n), body, place(n), axes[stuck[0]]);
    }
  }
  const auto young = Numbers(file["E"]), area = Numbers(file["A"]), rest = Numbers(file["l0"]),
             force = Numbers(file["t"]);
  for (std::size_t m = 0; m < members.size(); ++m) {
    const auto [a, b] = members[m];
    const double stiffness = young[m] * area[m] / rest[m];
    // In these files areas are rounded to five digits, forces are not.
    const Vec3 way = place(b) - place(a);
    const double slack_m = std::sqrt(Dot(way, way)) - force[m] / stiffness;
    MemberDef& member =
        force[m] > 0
            ? AddCable(def, {{static_cast<int>(a), place(a)}, {static_cast<int>(b), place(b)}},
                       stiffness, slack_m)
                  .member
            : AddBar(def, static_cast<int>(a), place(a), static_cast<int>(b), place(b), stiffness,
                     slack_m)
                  .member;
    member.mass_kg = masses[m];
    member.mass = mass;
  }
  return def;
}

}  // namespace taut::test
