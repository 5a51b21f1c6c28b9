/// Mutations of lists of triangles for libFuzzer's custom mutator: long, degenerate, coincident,
/// nearly coincident and subdivided triangles, closed solids.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

namespace taut::fuzz {

using Corner = std::array<float, 3>;
using Triangle = std::array<Corner, 3>;

/// Returns the triangles encoded in bytes, nine floats each.
inline std::vector<Triangle> TrianglesIn(const std::uint8_t* data, std::size_t size) {
  std::vector<Triangle> triangles(size / sizeof(Triangle));
  if (!triangles.empty()) std::memcpy(triangles.data(), data, triangles.size() * sizeof(Triangle));
  return triangles;
}

class TriangleMutator {
 public:
  explicit TriangleMutator(unsigned seed) : random_(seed) {}

  void Mutate(std::vector<Triangle>& t) {
    if (t.empty()) return AddSolid(t);
    switch (Below(10)) {
      case 0:
        t.push_back({Random(), Random(), Random()});
        break;
      case 1:
        AddSolid(t);
        break;
      case 2: {  // coincident or nearly so, on either side
        Triangle copy = Any(t);
        if (Below(2) == 0) std::swap(copy[0], copy[1]);
        const float shift = Below(2) == 0 ? 0 : Size(1e-9F, 1e-3F);
        for (Corner& corner : copy) corner[2] += shift;
        t.push_back(copy);
        break;
      }
      case 3:  // long
        Any(t)[Below(3)][Below(3)] += Size(1, 1e7F);
        break;
      case 4:
        Flatten(Any(t));
        break;
      case 5:
        Any(t)[Below(3)] = Any(t)[Below(3)];
        break;
      case 6:
        Subdivide(t);
        break;
      case 7:
        t.erase(t.begin() + static_cast<std::ptrdiff_t>(Below(t.size())));
        break;
      case 8:
        AddFan(t);
        break;
      default:
        Move(t);
        break;
    }
  }

 private:
  std::size_t Below(std::size_t n) { return random_() % n; }
  Triangle& Any(std::vector<Triangle>& t) { return t[Below(t.size())]; }
  float Between(float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random_);
  }
  /// Log-uniform, of either sign.
  float Size(float low, float high) {
    const float size = std::exp(Between(std::log(low), std::log(high)));
    return Below(2) == 0 ? size : -size;
  }
  Corner Random() { return {Between(-1, 1), Between(-1, 1), Between(-1, 1)}; }

  /// Moves the last corner onto, or nearly onto, the line through the others.
  void Flatten(Triangle& triangle) {
    const float share = Below(3) == 0 ? 0 : Between(-1, 2);
    const float off = Below(2) == 0 ? 0 : Size(1e-12F, 1e-4F);
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[2][k] = triangle[0][k] + share * (triangle[1][k] - triangle[0][k]) + off;
    }
  }

  /// Divides a triangle at a point of an edge; its neighbor stays undivided.
  void Subdivide(std::vector<Triangle>& t) {
    const std::size_t index = Below(t.size());
    const Triangle whole = t[index];
    const float share = Below(4) == 0 ? 1e-6F : Between(0, 1);
    Corner middle;
    for (std::size_t k = 0; k < 3; ++k) {
      middle[k] = whole[0][k] + share * (whole[1][k] - whole[0][k]);
    }
    t[index] = {whole[0], middle, whole[2]};
    t.push_back({middle, whole[1], whole[2]});
  }

  /// Adds a tetrahedron, a box or a strip of squares, counterclockwise seen from outside or above.
  void AddSolid(std::vector<Triangle>& t) {
    const Corner at = Random();
    const Corner size{Between(0.01F, 1), Between(0.01F, 1), Size(1e-4F, 1)};
    const auto add = [&](const std::vector<std::array<int, 3>>& corners, const int(*triangles)[3],
                         std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        Triangle one;
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t k = 0; k < 3; ++k) {
            const auto number = static_cast<std::size_t>(triangles[i][c]);
            one[c][k] = at[k] + size[k] * static_cast<float>(corners[number][k]);
          }
        }
        t.push_back(one);
      }
    };
    static constexpr int kTetrahedron[][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    static constexpr int kBox[][3] = {{0, 3, 2}, {0, 2, 1}, {4, 5, 6}, {4, 6, 7},
                                      {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                      {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    static constexpr int kSquare[][3] = {{0, 1, 2}, {0, 2, 3}};
    const std::size_t kind = Below(3);
    if (kind == 0) {
      add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, kTetrahedron, 4);
    } else if (kind == 1) {
      add({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
          kBox, 12);
    } else {
      for (int i = 0; i < 4; ++i) {
        add({{i, 0, 0}, {i + 1, 0, 0}, {i + 1, 1, 0}, {i, 1, 0}}, kSquare, 2);
      }
    }
  }

  /// Adds thin triangles around one corner.
  void AddFan(std::vector<Triangle>& t) {
    const Corner top = Random();
    const float width = Size(1e-7F, 1), reach = Size(0.1F, 1e3F);
    for (int i = 0; i < 8; ++i) {
      const auto k = static_cast<float>(i);
      t.push_back({top, Corner{top[0] + reach, top[1] + k * width, top[2]},
                   Corner{top[0] + reach, top[1] + (k + 1) * width, top[2]}});
    }
  }

  /// Moves, scales or rounds all triangles.
  void Move(std::vector<Triangle>& t) {
    const std::size_t how = Below(3), axis = Below(3);
    const float by = how == 1 ? Size(1e-3F, 1e3F) : Between(-1, 1);
    for (Triangle& triangle : t) {
      for (Corner& corner : triangle) {
        if (how == 0) corner[axis] += by;
        if (how == 1) corner[axis] *= by;
        if (how == 2) corner[axis] = std::round(8 * corner[axis]) / 8;
      }
    }
  }

  std::mt19937 random_;
};

}  // namespace taut::fuzz
