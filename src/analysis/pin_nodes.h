/// The points of a robot in the words of the literature, and what is rigid between them.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/pin_jointed.h"

namespace taut::analysis {

/// Points of bodies, which joints may make one node of.
class PinPlaces {
 public:
  explicit PinPlaces(const ModelDef& def);

  /// The place of a body at this point: what is there already, or a new one.
  int At(int body, const Vec3& point_m);
  /// From here on both are one node.
  void Join(int a, int b);
  /// Where a support holds a place: along `axis`, or across it.
  void Hold(int place, const Vec3& axis, bool along);

  const Vec3& point_m(int place) const { return places_[Index(place)].point_m; }
  std::vector<int> OfBody(int body) const;
  int body(int place) const { return places_[Index(place)].body; }
  double size_m() const { return size_m_; }
  void Call(int place, std::string name) { places_[Index(place)].name = std::move(name); }

  /// To be called once all places are there and joined.
  struct Nodes {
    std::vector<PinNode> nodes;
    std::vector<int> of_place;
    std::vector<Eigen::Matrix3d> held;  ///< Per node: the directions that something holds.
  };
  Nodes Number() const;

 private:
  struct Place {
    int body;
    Vec3 point_m;
    std::string name;  ///< Of a place that no node of the model names.
  };
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }
  int Root(int place) const;
  bool Near(const Vec3& a, const Vec3& b) const;
  std::string NameOf(int place) const;

  const ModelDef& def_;
  double size_m_;
  std::vector<Place> places_;
  std::vector<int> joined_;
  std::vector<Eigen::Matrix3d> held_;
};

/// Whether it stands still or moves by a program: what hangs at it is pinned.
bool IsPinned(const ModelDef& def, int body);

/// What keeps the points of a body apart.
struct PinBody {
  struct Bar {
    PinMember::Kind kind;
    std::string name;
    int from, to;  ///< Places.
    MemberDef section;
  };
  std::vector<Bar> bars;
  std::vector<std::pair<int, double>> mass_kg;  ///< By place.
};

/// Adds places to `places` where a body has not enough of them to be rigid or to have its mass.
PinBody PinBodyOf(const ModelDef& def, int body, PinPlaces& places);

}  // namespace taut::analysis
