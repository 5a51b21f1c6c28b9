// Rigid body as a truss: bars along its rods, and braces that make its points rigid.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/coordinate.h"
#include "analysis/pin_nodes.h"
#include "math/vec.h"

namespace taut::analysis {
namespace {

// Tolerance for points on a line or plane, as a share of the body's size.
constexpr double kFlat = 1e-7;

class Builder {
 public:
  Builder(const ModelDef& def, int body, PinPlaces& places)
      : def_(def), body_(body), places_(places) {}

  PinBody Run() {
    for (const CapsuleDef& rod : def_.capsules) {
      if (rod.body == body_) AddRod(rod);
    }
    if (IsPinned(def_, body_)) return out_;  // a static body needs no masses and no braces
    SpreadMass();
    Brace();
    return out_;
  }

 private:
  const BodyDef& def() const { return def_.bodies[static_cast<std::size_t>(body_)]; }
  Vec3 At(int place) const { return places_.point_m(place); }

  double Reach(const std::vector<int>& all) const {
    double reach = 0;
    for (const int a : all) {
      const Vec3 way = At(a) - At(all.front());
      reach = std::max(reach, std::sqrt(Dot(way, way)));
    }
    return reach;
  }

  /// Returns the position of a point along a line segment, from 0 to 1. Returns nothing if the
  /// point is not on the segment.
  std::optional<double> Along(int place, const Vec3& from, const Vec3& to) const {
    const Vec3 way = to - from, there = At(place) - from;
    const double length2 = Dot(way, way), share = Dot(there, way) / length2;
    const Vec3 beside = there - share * way;
    if (share < 0 || share > 1 || Dot(beside, beside) > kFlat * kFlat * length2) return {};
    return share;
  }

  /// Adds bars between successive places.
  void Chain(PinMember::Kind kind, const std::string& name, const std::vector<int>& all,
             const MemberDef& section) {
    for (std::size_t i = 1; i < all.size(); ++i) {
      if (!Tie(all[i - 1], all[i])) continue;
      out_.bars.push_back({kind, all.size() == 2 ? name : name + "_" + std::to_string(i),
                           all[i - 1], all[i], section});
    }
  }
  /// Records a connection of two places. Returns false if they are already connected.
  bool Tie(int a, int b) { return tied_.insert({std::min(a, b), std::max(a, b)}).second; }

  void AddRod(const CapsuleDef& rod) {
    const Vec3 way = rod.to_m - rod.from_m;
    if (!(Dot(way, way) > 0)) return;
    std::vector<std::pair<double, int>> on;
    for (const int place : places_.OfBody(body_)) {
      if (const auto share = Along(place, rod.from_m, rod.to_m)) on.emplace_back(*share, place);
    }
    std::sort(on.begin(), on.end());
    std::vector<int> chain;
    for (const auto& [share, place] : on) chain.push_back(place);
    Chain(PinMember::Kind::kRod, rod.name, chain, rod.member);
  }

  /// Distributes the body's mass over its places, with the same center of mass and least sum of
  /// squared masses. If this is impossible, adds the center of mass as a place.
  void SpreadMass() {
    if (places_.OfBody(body_).empty()) return;
    for (int round = 0; round < 2; ++round) {
      const std::vector<int> all = places_.OfBody(body_);
      const double reach = std::max(Reach(all), 1e-2 * places_.size_m());
      Eigen::MatrixXd sums(4, static_cast<Eigen::Index>(all.size()));
      for (std::size_t i = 0; i < all.size(); ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        sums(0, column) = 1;
        sums.block<3, 1>(1, column) = Of((1 / reach) * (At(all[i]) - def().com_m));
      }
      const Eigen::Vector4d wanted(def().mass_kg, 0, 0, 0);
      const Eigen::VectorXd mass =
          Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(sums).solve(wanted);
      if ((sums * mass - wanted).norm() < kFlat * def().mass_kg) {
        for (std::size_t i = 0; i < all.size(); ++i) {
          out_.mass_kg.emplace_back(all[i], mass[static_cast<Eigen::Index>(i)]);
        }
        return;
      }
      places_.Call(places_.At(body_, def().com_m), def().name + "_centre");
    }
  }

  /// Returns the place farthest from the line or plane through `spanned`. Returns nothing if all
  /// places are on this line or plane.
  std::optional<int> Farthest(const std::vector<int>& all, const std::vector<int>& spanned,
                              double reach) const {
    const Eigen::Vector3d origin = Of(At(spanned.front()));
    Eigen::Matrix3d onto = Eigen::Matrix3d::Zero();
    for (const int place : spanned) {
      Eigen::Vector3d way = Of(At(place)) - origin;
      way -= onto * way;
      if (way.norm() > kFlat * reach) onto += way.normalized() * way.normalized().transpose();
    }
    std::optional<int> farthest;
    double most = kFlat * reach;
    for (const int place : all) {
      const Eigen::Vector3d way = Of(At(place)) - origin;
      const double off = (way - onto * way).norm();
      if (off > most * (1 + 1e-9)) farthest = place, most = off;
    }
    return farthest;
  }

  /// Adds places off the line or plane of `corners`, so that four places form a tetrahedron.
  void AddBeside(std::vector<int>& corners, double reach) {
    const Eigen::Vector3d origin = Of(At(corners.front()));
    while (corners.size() < 4) {
      Eigen::Vector3d out;
      if (corners.size() == 2) {
        out = (Of(At(corners[1])) - origin).unitOrthogonal();
      } else {
        const Eigen::Vector3d u = Of(At(corners[1])) - origin, v = Of(At(corners[2])) - origin;
        out = u.cross(v).normalized();
      }
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const int place : corners) middle += Of(At(place)) / static_cast<double>(corners.size());
      const int place = places_.At(body_, To(middle + 0.5 * reach * out));
      places_.Call(place, def().name + "_beside_" + std::to_string(corners.size() - 1));
      corners.push_back(place);
    }
  }

  void Brace() {
    const std::vector<int> all = places_.OfBody(body_);
    if (all.size() < 2) return;
    const double reach = Reach(all);
    std::vector<int> corners{all.front()};
    while (corners.size() < 4) {
      const auto next = Farthest(all, corners, reach);
      if (!next) break;
      corners.push_back(*next);
    }
    // All other places are braced to the corners, so the corners must form a tetrahedron.
    if (all.size() > corners.size()) AddBeside(corners, reach);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) AddBrace(corners[j], corners[i]);
    }
    for (const int place : all) {
      if (std::find(corners.begin(), corners.end(), place) != corners.end()) continue;
      for (const int corner : corners) AddBrace(corner, place);
    }
  }
  void AddBrace(int from, int to) {
    if (!Tie(from, to)) return;
    out_.bars.push_back({PinMember::Kind::kBrace,
                         def().name + "_brace_" + std::to_string(++braces_),
                         from,
                         to,
                         {}});
  }

  const ModelDef& def_;
  int body_, braces_ = 0;
  PinPlaces& places_;
  PinBody out_;
  std::set<std::pair<int, int>> tied_;
};

}  // namespace

PinBody PinBodyOf(const ModelDef& def, int body, PinPlaces& places) {
  return Builder(def, body, places).Run();
}

}  // namespace taut::analysis
