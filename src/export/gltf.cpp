// Writer of glTF 2.0 in one binary file (GLB): a header, a JSON chunk and a binary chunk.
// Specification of the Khronos Group: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "export/appearance.h"
#include "export/little_endian.h"
#include "math/vec.h"
#include "taut/shape_mesh.h"
#include "taut/version.h"

namespace taut {
namespace {

using nlohmann::ordered_json;

// Constants in the specification.
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr int kFloat = 5126, kShort = 5123, kWord = 5125;
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;
constexpr std::size_t kMostShorts = 65535;  // the specification reserves 65535

class Glb {
 public:
  Glb(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale)
      : def_(def), shapes_(shapes), scale_(scale) {}

  std::string Run() {
    gltf_["asset"] = {{"version", "2.0"}, {"generator", std::string("taut ") + kVersion}};
    gltf_["scene"] = 0;
    gltf_["scenes"] = List({{"name", def_.name}, {"nodes", ordered_json::array({0})}});
    // glTF has y up: rotate a quarter turn about x, so that z becomes y.
    const double half = std::sqrt(0.5);
    ordered_json root{{"name", def_.name}, {"rotation", {-half, 0.0, 0.0, half}}};
    if (scale_ != 1) root["scale"] = {scale_, scale_, scale_};
    gltf_["nodes"] = List(root);
    std::vector<int> children;
    for (std::size_t b = 0; b < def_.bodies.size(); ++b) {
      const BodyDef& body = def_.bodies[b];
      if (const auto node = Group(static_cast<int>(b), body.name, body.com_m)) {
        children.push_back(*node);
      }
    }
    if (const auto node = Group(kWorld, "cables", {})) children.push_back(*node);
    gltf_["nodes"][0]["children"] = children;
    return File();
  }

 private:
  /// Adds a node with the shapes of a body, relative to `origin_m`. Returns nothing if the body has
  /// no shapes.
  std::optional<int> Group(int body, const std::string& name, const Vec3& origin_m) {
    std::vector<int> children;
    for (const ShapeMesh& mesh : shapes_) {
      if (mesh.body != body || mesh.triangles.empty()) continue;
      const int index = Mesh(mesh, origin_m);
      children.push_back(Node({{"name", mesh.name}, {"mesh", index}}));
    }
    if (children.empty()) return std::nullopt;
    ordered_json node{{"name", name}};
    if (body != kWorld) node["translation"] = {origin_m.x, origin_m.y, origin_m.z};
    node["children"] = children;
    return Node(node);
  }
  static ordered_json List(const ordered_json& one) {
    ordered_json list = ordered_json::array();
    list.push_back(one);
    return list;
  }
  int Node(const ordered_json& node) { return Push("nodes", node); }
  int Push(const char* list, const ordered_json& item) {
    gltf_[list].push_back(item);
    return static_cast<int>(gltf_[list].size()) - 1;
  }

  int Mesh(const ShapeMesh& mesh, const Vec3& origin_m) {
    ordered_json attributes{{"POSITION", Vectors(mesh.corners_m, origin_m, true)}};
    if (!mesh.normals.empty()) attributes["NORMAL"] = Vectors(mesh.normals, {}, false);
    const ordered_json primitive{
        {"attributes", attributes}, {"indices", Indices(mesh)}, {"material", Material(mesh.kind)}};
    return Push("meshes", {{"name", mesh.name}, {"primitives", List(primitive)}});
  }

  int Vectors(const std::vector<Vec3>& list, const Vec3& origin, bool bounds) {
    const std::size_t start = binary_.size();
    std::array<float, 3> low, high;
    low.fill(INFINITY), high.fill(-INFINITY);
    for (const Vec3& p : list) {
      const Vec3 at = p - origin;
      const std::array<float, 3> x{static_cast<float>(at.x), static_cast<float>(at.y),
                                   static_cast<float>(at.z)};
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
        exporting::PutFloat(binary_, x[k]);
      }
    }
    ordered_json accessor{{"bufferView", View(start, kArrayBuffer)},
                          {"componentType", kFloat},
                          {"count", list.size()},
                          {"type", "VEC3"}};
    if (bounds) accessor["min"] = low, accessor["max"] = high;
    return Push("accessors", accessor);
  }

  int Indices(const ShapeMesh& mesh) {
    const std::size_t start = binary_.size();
    const bool small = mesh.corners_m.size() < kMostShorts;
    for (const auto& triangle : mesh.triangles) {
      for (const int corner : triangle) {
        if (small) {
          exporting::PutShort(binary_, static_cast<std::uint16_t>(corner));
        } else {
          exporting::PutWord(binary_, static_cast<std::uint32_t>(corner));
        }
      }
    }
    return Push("accessors", {{"bufferView", View(start, kElementBuffer)},
                              {"componentType", small ? kShort : kWord},
                              {"count", 3 * mesh.triangles.size()},
                              {"type", "SCALAR"}});
  }

  /// Adds a buffer view of the bytes from `start` to the end. Pads the buffer to multiples of 4
  /// bytes.
  int View(std::size_t start, int target) {
    const std::size_t size = binary_.size() - start;
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    return Push("bufferViews",
                {{"buffer", 0}, {"byteOffset", start}, {"byteLength", size}, {"target", target}});
  }

  int Material(ShapeMesh::Kind kind) {
    const auto known = materials_.find(kind);
    if (known != materials_.end()) return known->second;
    const exporting::Appearance& look = exporting::AppearanceOf(kind);
    const int index = Push(
        "materials", {{"name", look.name},
                      {"pbrMetallicRoughness",
                       {{"baseColorFactor", {look.Light(0), look.Light(1), look.Light(2), 1.0}},
                        {"metallicFactor", 0.1},
                        {"roughnessFactor", 0.55}}}});
    materials_[kind] = index;
    return index;
  }

  std::string File() {
    gltf_["buffers"] = List({{"byteLength", binary_.size()}});
    std::string text = gltf_.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file;
    const auto word = [&](std::size_t x) {
      exporting::PutWord(file, static_cast<std::uint32_t>(x));
    };
    word(kMagic), word(2), word(12 + 8 + text.size() + 8 + binary_.size());
    word(text.size()), word(kJsonChunk);
    file += text;
    word(binary_.size()), word(kBinaryChunk);
    return file + binary_;
  }

  const ModelDef& def_;
  const std::vector<ShapeMesh>& shapes_;
  double scale_;
  ordered_json gltf_;
  std::string binary_;
  std::map<ShapeMesh::Kind, int> materials_;
};

}  // namespace

std::string GlbOf(const ModelDef& def, const std::vector<ShapeMesh>& shapes, double scale) {
  return Glb(def, shapes, scale).Run();
}

}  // namespace taut
