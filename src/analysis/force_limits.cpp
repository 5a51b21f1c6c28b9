// Bounds of cable tensions, friction cones as planes, and contacts of bodies with planes.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/force_balance.h"
#include "analysis/quadratic_program.h"
#include "base/fixed.h"
#include "math/shape_corners.h"
#include "math/vec.h"
#include "sim/contacts/combine.h"
#include "taut/shape_kinds.h"

namespace taut::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Kind = HoldingUnknown::Kind;

bool IsUnit(const Vec3& a) { return std::fabs(Dot(a, a) - 1) < 1e-6; }

/// Returns whether the bounds are valid; false for NaN.
bool IsBound(double least, double most) { return least >= 0 && std::isfinite(least) && most >= 0; }

}  // namespace

void ForceLimits::Add(const VectorXd& row, double bound) {
  rows.conservativeResize(rows.rows() + 1, row.size());
  rows.row(rows.rows() - 1) = row.transpose();
  at_least.conservativeResize(rows.rows());
  at_least[rows.rows() - 1] = bound;
}

void LimitCables(const ForceBalance& balance, const std::vector<CableBounds>& bounds,
                 ForceLimits& limits) {
  for (Index i = 0; i < balance.size(); ++i) {
    const HoldingUnknown& unknown = balance.unknowns[static_cast<std::size_t>(i)];
    if (unknown.kind != Kind::kCable) continue;
    const CableBounds bound = bounds.empty() ? CableBounds{} : bounds[unknown.index];
    const double length = balance.cable_length_m[unknown.index];
    const double least = std::max(bound.at_least_n, bound.at_least_n_per_m * length);
    const double most = std::min(bound.at_most_n, bound.at_most_n_per_m * length);
    const VectorXd row = VectorXd::Unit(balance.size(), i);
    limits.Add(row, least);
    if (std::isfinite(most)) limits.Add(-row, -most);
  }
}

std::vector<std::vector<double>> EvenAngles(std::size_t touches, int count) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back(2 * std::numbers::pi * i / count);
  return std::vector<std::vector<double>>(touches, angles);
}

void LimitTouches(const ForceBalance& balance, const std::vector<TouchDef>& touches,
                  const std::vector<std::vector<double>>& angles_rad, ConeSide side,
                  ForceLimits& limits) {
  for (std::size_t t = 0; t < touches.size(); ++t) {
    const Index first = balance.TouchColumn(t);
    VectorXd row = VectorXd::Unit(balance.size(), first);
    limits.Add(row, 0);
    if (!(touches[t].friction > 0)) continue;
    std::vector<double> angles = angles_rad[t];
    std::sort(angles.begin(), angles.end());
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double next = i + 1 < angles.size() ? angles[i + 1] : angles[0] + 2 * std::numbers::pi;
      const double half = 0.5 * (next - angles[i]);
      if (side == ConeSide::kInner && half < 1e-12) continue;
      const double angle = side == ConeSide::kInner ? angles[i] + half : angles[i];
      row[first] = touches[t].friction * (side == ConeSide::kInner ? std::cos(half) : 1.0);
      row[first + 1] = -std::cos(angle), row[first + 2] = -std::sin(angle);
      limits.Add(row, 0);
    }
  }
}

VectorXd Nearest(const ForceBalance& balance, const ForceLimits& limits) {
  QuadraticProgram program;
  const double scale = balance.LargestLoad();
  program.hessian = balance.columns.transpose() * balance.columns;
  program.gradient = -balance.columns.transpose() * balance.load / scale;
  program.inequalities = limits.rows;
  program.at_least = limits.at_least / scale;
  return scale * taut::analysis::Solve(program).x;
}

void CheckHolding(const ModelDef& def, const LoadCaseSpec& loads,
                  const std::vector<TouchDef>& touches, const std::vector<CableBounds>& bounds,
                  Diagnostics& out) {
  const int bodies = static_cast<int>(def.bodies.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const TouchDef& touch = touches[i];
    const std::string what = "contact " + std::to_string(i);
    const auto is_body = [&](int body) { return body >= kWorld && body < bodies; };
    if (!is_body(touch.body) || !is_body(touch.other) || touch.body == touch.other) {
      out.Error("contact.bad_bodies", {},
                what + " does not connect two bodies, or a body and the world");
    }
    if (!IsUnit(touch.normal))
      out.Error("contact.bad_normal", {}, "the normal of " + what + " is not a unit vector");
    if (!(touch.friction >= 0) || !std::isfinite(touch.friction)) {
      out.Error("contact.bad_friction", {},
                "the friction of " + what + " must be a finite number of at least 0");
    }
  }
  if (!bounds.empty() && bounds.size() != def.cables.size()) {
    out.Error("bounds.wrong_number", {},
              "there are " + std::to_string(bounds.size()) + " bounds for " +
                  std::to_string(def.cables.size()) + " cables");
  } else {
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const CableBounds& b = bounds[i];
      const std::string& name = def.cables[i].name;
      if (!IsBound(b.at_least_n, b.at_most_n) || !IsBound(b.at_least_n_per_m, b.at_most_n_per_m)) {
        out.Error("bounds.negative", {},
                  "the bounds of cable " + name + " must be numbers of at least 0");
        continue;
      }
      const double length = CableLength(def.cables[i]);
      const double least = std::max(b.at_least_n, b.at_least_n_per_m * length);
      const double most = std::min(b.at_most_n, b.at_most_n_per_m * length);
      if (least > most) {
        out.Error("bounds.empty", {},
                  "the lower bound of cable " + name + ", " + std::to_string(least) +
                      " N, is above its upper bound of " + std::to_string(most) + " N");
      }
    }
  }
  if (!loads.settlements.empty()) {
    out.Error("load_case.moves_supports", {},
              "load case " + loads.name +
                  " moves supports, but forces are computed in the described pose",
              "describe the pose with the moved supports");
  }
  for (const LoadCaseSpec::NodeForce& force : loads.forces) {
    if (force.node < 0 || force.node >= static_cast<int>(def.nodes.size())) {
      out.Error("load_case.force_on_no_node", {},
                "load case " + loads.name + " has a force on a node that does not exist");
    }
  }
}

}  // namespace taut::analysis

namespace taut {

std::vector<TouchDef> FindTouches(const ModelDef& def, double within_m) {
  std::vector<TouchDef> touches;
  const auto add = [&](int body, const Vec3& place, double radius, const Material& material) {
    if (base::IsFixed(def, body)) return;
    for (const PlaneDef& plane : def.planes) {
      const double gap = Dot(plane.normal, place - plane.point_m) - radius;
      if (gap > within_m) continue;
      const double friction = sim::Combined(def, material, plane.material).static_friction;
      const TouchDef touch{body, kWorld, place - (radius + gap) * plane.normal, plane.normal,
                           friction};
      // Rods of a body that end at the same point share one contact.
      constexpr double kSamePlaceM = 1e-9;
      const auto same = [&touch](const TouchDef& t) {
        const Vec3 away = t.point_m - touch.point_m, turned = t.normal - touch.normal;
        return t.body == touch.body && t.friction == touch.friction && Dot(turned, turned) == 0 &&
               Dot(away, away) < kSamePlaceM * kSamePlaceM;
      };
      if (std::none_of(touches.begin(), touches.end(), same)) touches.push_back(touch);
    }
  };
  EachShape(def, [&](const auto& shape) {
    if (!shape.collides) return;
    math::EachCorner(shape, [&](const Vec3& corner) {
      add(shape.body, corner, math::RadiusOf(shape), shape.material);
    });
  });
  return touches;
}

}  // namespace taut
