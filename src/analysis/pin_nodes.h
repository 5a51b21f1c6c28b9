/// Nodes of the pin-jointed model of a robot, and the bars that make its bodies rigid.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "taut/pin_jointed.h"

namespace taut::analysis {

/// Points of bodies (places); joints merge places into one node.
class PinPlaces {
 public:
  explicit PinPlaces(const ModelDef& def);

  /// Returns the place of a body at this point; adds the place if it is missing.
  int At(int body, const Vec3& point_m);
  /// Merges two places into one node.
  void Join(int a, int b);
  /// Adds a support at a place: along `axis`, or in the two directions perpendicular to it.
  void Hold(int place, const Vec3& axis, bool along);

  const Vec3& point_m(int place) const { return places_[Index(place)].point_m; }
  std::vector<int> OfBody(int body) const;
  int body(int place) const { return places_[Index(place)].body; }
  double size_m() const { return size_m_; }
  void Call(int place, std::string name) { places_[Index(place)].name = std::move(name); }

  /// Result of `Number`. Call `Number` after all places were added and joined.
  struct Nodes {
    std::vector<PinNode> nodes;
    std::vector<int> of_place;
    std::vector<Eigen::Matrix3d> held;  ///< Per node: projector onto the supported directions.
  };
  Nodes Number() const;

 private:
  struct Place {
    int body;
    Vec3 point_m;
    std::string name;  ///< Name of a place; empty if it is a node of the model.
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

/// Returns whether a body is static or kinematic, so that its points are pinned.
bool IsPinned(const ModelDef& def, int body);

/// Bars and masses that represent a body.
struct PinBody {
  struct Bar {
    PinMember::Kind kind;
    std::string name;
    int from, to;  ///< Places at the bar's ends.
    MemberDef section;
  };
  std::vector<Bar> bars;
  std::vector<std::pair<int, double>> mass_kg;  ///< Pairs of place and mass.
};

/// Represents a body by bars and masses. Adds places if the existing ones are too few to make the
/// body rigid or to reproduce its mass and center of mass.
PinBody PinBodyOf(const ModelDef& def, int body, PinPlaces& places);

}  // namespace taut::analysis
