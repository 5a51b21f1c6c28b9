/// Area loads of load cases: pressure on the surfaces between members.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "description/experiment/experiment_text.h"
#include "description/experiment/load_members.h"

namespace taut::description {

/// Forces from pressure on the triangles and flat quadrilaterals that members form. Reused for all
/// area loads of a robot.
class AreaLoads {
 public:
  AreaLoads(const RobotSpec& robot, const Scope& scope);
  /// Adds all area loads to the forces of `out`. A third of a triangle's load acts on each corner;
  /// a quadrilateral is split along both diagonals, each with half of the load. The forces have the
  /// resultant and the moment of the load on each flat face.
  void AddTo(LoadCaseSpec& out, const std::vector<AreaLoadText>& loads);

 private:
  using Face = std::vector<int>;  ///< Three or four corners, in order around the face.

  std::vector<LoadMember> Members(const AreaLoadText& load) const;
  /// Builds the graph of corners and members.
  bool Connect(const AreaLoadText& load, const std::vector<LoadMember>& members);
  bool ConnectPair(const AreaLoadText& load, const LoadPoint& a, const LoadPoint& b,
                   const std::string& member);
  std::optional<int> CornerAt(const LoadPoint& point, const AreaLoadText& load,
                              const std::string& member);
  std::vector<Face> Faces() const;
  bool IsFlatConvex(const Face& face) const;
  bool Contains(const Face& face, int corner) const;
  bool IsDivided(const Face& face) const;
  bool IsHidden(const Face& face, const std::vector<Face>& faces, const Vec3& direction) const;
  void Press(const AreaLoadText& load, const Face& face);
  void PressTriangle(const AreaLoadText& load, std::array<int, 3> corners, double share);

  const RobotSpec& robot_;
  const Scope& scope_;
  NodePlaces places_;
  std::vector<int> node_of_;  ///< Node per corner; -1: point of the world without a node.
  std::vector<Vec3> at_m_;    ///< Place per corner.
  std::multimap<double, int> corner_at_x_;  ///< Corners by x [m].
  std::vector<std::set<int>> joined_;  ///< Corners at the other ends of the members at a corner.
  std::map<int, Vec3> force_n_;        ///< By node.
};

}  // namespace taut::description
