#include "description/assets/mesh_file.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>
#include <tuple>

#include "base/brief.h"
#include "base/input_file.h"
#include "base/number_text.h"
#include "math/triangles.h"

namespace taut::description {
namespace {

constexpr std::size_t kMostMeshBytes = std::size_t{1} << 30, kMostErrors = 10;

/// Corners without duplicates. STL files repeat corners for every triangle, so a mesh is closed
/// only after the merge.
class Corners {
 public:
  explicit Corners(MeshFile& mesh) : mesh_(mesh) {}
  int Add(const Vec3& p) {
    const auto [at, fresh] =
        known_.try_emplace({p.x, p.y, p.z}, static_cast<int>(mesh_.corners.size()));
    if (fresh) mesh_.corners.push_back(p);
    return at->second;
  }

 private:
  MeshFile& mesh_;
  std::map<std::tuple<double, double, double>, int> known_;
};

/// Removes and returns the next word of a line. Returns an empty text at the end of the line.
std::string_view NextWord(std::string_view& line) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!line.empty() && blank(line.front())) line.remove_prefix(1);
  std::size_t size = 0;
  while (size < line.size() && !blank(line[size])) ++size;
  const std::string_view word = line.substr(0, size);
  line.remove_prefix(size);
  return word;
}

template <class Number>
bool ReadWhole(std::string_view word, Number& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto read = base::FromChars(word.data(), word.data() + word.size(), value);
  return read.ec == std::errc() && read.ptr == word.data() + word.size();
}

std::optional<Vec3> ReadPoint(std::string_view& line) {
  double x[3];
  for (double& one : x) {
    if (!ReadWhole(NextWord(line), one) || !std::isfinite(one)) return std::nullopt;
  }
  return Vec3{x[0], x[1], x[2]};
}

/// Calls `use(line, number)` for every line, until `use` returns false.
template <class Use>
void EachLine(std::string_view text, const Use& use) {
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (!use(text.substr(at, end - at), ++number)) return;
    at = end + 1;
  }
}

class ObjReader {
 public:
  ObjReader(std::string path, MeshFile& mesh, Diagnostics& out)
      : path_(std::move(path)), mesh_(mesh), corners_(mesh), out_(out) {}

  void Read(std::string_view text) {
    const std::size_t errors_before = out_.items().size();
    EachLine(text, [&](std::string_view line, int number) {
      at_ = {path_, number, 0};
      const std::string_view kind = NextWord(line);
      if (kind == "v") {
        const auto point = ReadPoint(line);
        if (!point)
          out_.Error("mesh.bad_corner", at_, "a corner needs three finite numbers",
                     "expected x, y and z, separated by spaces");
        points_.push_back(corners_.Add(point.value_or(Vec3{})));
      } else if (kind == "f") {
        Face(line);
      } else if (kind == "o" || kind == "g") {
        mesh_.BeginPart(NextWord(line));
      }
      return out_.items().size() - errors_before < kMostErrors;
    });
  }

 private:
  void Face(std::string_view line) {
    std::vector<int> face;
    for (std::string_view word = NextWord(line); !word.empty(); word = NextWord(line)) {
      long index = 0;
      const std::string_view corner = word.substr(0, std::min(word.find('/'), word.size()));
      const long count = static_cast<long>(points_.size());
      const bool read = ReadWhole(corner, index);
      const long from_start = index < 0 ? count + index : index - 1;
      if (!read || from_start < 0 || from_start >= count) {
        out_.Error("mesh.unknown_corner", at_, "there is no corner \"" + std::string(corner) + "\"",
                   "corners are numbered from 1, or backward from -1, and come before their faces");
        return;
      }
      face.push_back(points_[static_cast<std::size_t>(from_start)]);
    }
    if (face.size() < 3) out_.Error("mesh.few_corners", at_, "a face needs at least three corners");
    for (std::size_t k = 2; k < face.size(); ++k) {
      mesh_.triangles.push_back({face[0], face[k - 1], face[k]});
      mesh_.lines.push_back(at_.line);
    }
  }

  std::string path_;
  MeshFile& mesh_;
  Corners corners_;
  Diagnostics& out_;
  SourceRef at_;
  std::vector<int> points_;  ///< Indices into the mesh's corners, per corner of the file.
};

void ReadStlText(const std::string& path, std::string_view text, MeshFile& mesh, Diagnostics& out) {
  Corners corners(mesh);
  std::array<int, 3> triangle{};
  std::size_t count = 0;
  const std::size_t errors_before = out.items().size();
  EachLine(text, [&](std::string_view line, int number) {
    const SourceRef at{path, number, 0};
    const std::string_view kind = NextWord(line);
    if (kind == "vertex") {
      const auto point = ReadPoint(line);
      if (!point)
        out.Error("mesh.bad_corner", at, "a corner needs three finite numbers",
                  "expected x, y and z, separated by spaces");
      if (count < 3) triangle[count] = corners.Add(point.value_or(Vec3{}));
      ++count;
    } else if (kind == "endfacet") {
      if (count != 3)
        out.Error("mesh.facet_corners", at,
                  "a facet must have three corners, got " + std::to_string(count));
      mesh.triangles.push_back(triangle);
      mesh.lines.push_back(number);
      count = 0;
    } else if (kind == "solid") {
      mesh.BeginPart(NextWord(line));
    }
    return out.items().size() - errors_before < kMostErrors;
  });
}

/// Binary STL: 80 arbitrary bytes, a count, then 50 bytes per triangle (normal, three corners, two
/// unused bytes).
constexpr std::size_t kStlHead = 84, kStlTriangle = 50;

std::uint32_t Word(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t k = 4; k-- > 0;) {
    word = word << 8 | static_cast<unsigned char>(bytes[at + k]);
  }
  return word;
}

void ReadStlBinary(const std::string& path, std::string_view bytes, MeshFile& mesh,
                   Diagnostics& out) {
  Corners corners(mesh);
  for (std::size_t at = kStlHead; at < bytes.size(); at += kStlTriangle) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      double x[3];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        x[axis] = __builtin_bit_cast(float, Word(bytes, at + 12 * (k + 1) + 4 * axis));
      }
      if (!std::isfinite(x[0] + x[1] + x[2])) {
        out.Error("mesh.not_finite", {path, 0, 0},
                  "triangle " + std::to_string(mesh.triangles.size()) +
                      " has a corner that is not finite");
        return;
      }
      triangle[k] = corners.Add({x[0], x[1], x[2]});
    }
    mesh.triangles.push_back(triangle);
  }
}

}  // namespace

MeshFile PartOf(const MeshFile& mesh, std::size_t part) {
  const std::size_t first = mesh.parts[part].first_triangle;
  const std::size_t end =
      part + 1 < mesh.parts.size() ? mesh.parts[part + 1].first_triangle : mesh.triangles.size();
  MeshFile out;
  std::vector<int> number(mesh.corners.size(), -1);
  for (std::size_t t = first; t < end; ++t) {
    std::array<int, 3> triangle = mesh.triangles[t];
    for (int& corner : triangle) {
      int& known = number[static_cast<std::size_t>(corner)];
      if (known < 0) {
        known = static_cast<int>(out.corners.size());
        out.corners.push_back(mesh.corners[static_cast<std::size_t>(corner)]);
      }
      corner = known;
    }
    out.triangles.push_back(triangle);
    if (t < mesh.lines.size()) out.lines.push_back(mesh.lines[t]);
  }
  return out;
}

bool ReportFaults(const MeshFile& mesh, bool closed, const std::string& path,
                  const MeshWords& words, Diagnostics& out) {
  using Kind = math::MeshFault::Kind;
  constexpr std::size_t kMostFaults = 10;
  const auto corner = [&](int i) {
    const Vec3& p = mesh.corners[static_cast<std::size_t>(i)];
    return "(" + base::Brief(p.x) + ", " + base::Brief(p.y) + ", " + base::Brief(p.z) + ")";
  };
  const auto faults = math::FindFaults(mesh.corners, mesh.triangles, closed, kMostFaults);
  for (const math::MeshFault& fault : faults) {
    const auto triangle = static_cast<std::size_t>(fault.triangle);
    const bool has_line = fault.triangle >= 0 && triangle < mesh.lines.size();
    const SourceRef at{path, has_line ? mesh.lines[triangle] : 0, 0};
    const std::string edge =
        fault.from < 0 ? "" : "the edge from " + corner(fault.from) + " to " + corner(fault.to);
    if (fault.kind == Kind::kOpen) {
      out.Error("mesh.not_closed", at,
                words.what + " is not closed: " + edge + " has one triangle only",
                "close the mesh" + words.or_else);
    } else if (fault.kind == Kind::kCrowded) {
      out.Error("mesh.edge_shared", at,
                edge + " has two triangles on one side, or more than two in all",
                "list the corners of all triangles counter-clockwise as seen from outside" +
                    words.or_else);
    } else if (fault.kind == Kind::kInsideOut) {
      out.Error("mesh.inside_out", at, words.what + " is inside out",
                "list the corners of all triangles counter-clockwise as seen from outside");
    } else {
      const std::string which =
          has_line ? "this triangle" : "triangle " + std::to_string(fault.triangle);
      out.Error("mesh.no_area", at, which + " has no area",
                "leave it out: its corners are on one line");
    }
  }
  return faults.empty();
}

bool EndsIn(const std::string& path, std::string_view end) {
  if (path.size() < end.size()) return false;
  for (std::size_t i = 0; i < end.size(); ++i) {
    const char c = path[path.size() - end.size() + i];
    if ((c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) != end[i]) return false;
  }
  return true;
}

std::optional<MeshFile> ReadMeshFile(const std::string& path, Diagnostics& out) {
  const bool obj = EndsIn(path, ".obj");
  if (!obj && !EndsIn(path, ".stl")) {
    out.Error("mesh.unknown_format", {path, 0, 0}, "unknown mesh format",
              "expected a Wavefront OBJ file (.obj) or an STL file (.stl)");
    return std::nullopt;
  }
  const auto text = base::ReadInputFile(path, kMostMeshBytes, "use fewer triangles", out);
  if (!text) return std::nullopt;
  const std::size_t errors_before = out.items().size();
  MeshFile mesh;
  mesh.BeginPart({});
  // Some programs write "solid" at the start of binary files, too; the file size distinguishes the
  // two formats.
  const bool binary = !obj && text->size() >= kStlHead &&
                      text->size() == kStlHead + kStlTriangle * std::size_t{Word(*text, 80)};
  if (obj) {
    ObjReader(path, mesh, out).Read(*text);
  } else if (binary) {
    ReadStlBinary(path, *text, mesh, out);
  } else {
    ReadStlText(path, *text, mesh, out);
  }
  if (out.items().size() == errors_before && mesh.triangles.empty()) {
    out.Error("mesh.no_triangles", {path, 0, 0}, "the mesh has no triangles",
              obj ? "faces are lines that begin with f" : "expected text or binary STL");
  }
  if (out.items().size() != errors_before) return std::nullopt;
  if (mesh.parts.back().first_triangle == mesh.triangles.size()) mesh.parts.pop_back();
  return mesh;
}

}  // namespace taut::description
