// Natural frequencies and mode shapes: K v = omega^2 M v in the subspace of free motions
// (docs/theory/statics.md, section 5).
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "analysis/structure_members.h"
#include "analysis/tangent.h"
#include "analysis/whole_motions.h"
#include "math/angle.h"
#include "math/vec.h"

namespace taut {
namespace analysis {

Mode ShapeOf(const ModelDef& def, const Structure& s, Eigen::VectorXd shape) {
  Mode mode;
  double most = 0;
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(b);
    most = std::max(
        {most, shape.segment<3>(at).norm(), s.reach_m[b] * shape.segment<3>(at + 3).norm()});
  }
  if (most > 0) shape /= most;
  mode.translation_m.resize(def.bodies.size());
  mode.turn_rad.resize(def.bodies.size());
  for (std::size_t b = 0; b < s.bodies.size(); ++b) {
    const Eigen::Index at = 6 * static_cast<Eigen::Index>(b);
    const std::size_t body = static_cast<std::size_t>(s.bodies[b]);
    mode.translation_m[body] = To(shape.segment<3>(at));
    mode.turn_rad[body] = To(shape.segment<3>(at + 3));
  }
  return mode;
}

namespace {

/// Adds all modes except rigid motions. Eigenvalues up to kZero of the largest count as zero: these
/// modes are mechanisms.
void AddVibrations(const ModelDef& def, const Structure& s, const Eigen::MatrixXd& basis,
                   const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass, Modes& out) {
  constexpr double kZero = 1e-12;  ///< Share of the largest eigenvalue.
  if (basis.cols() == 0) return;
  const Eigen::LLT<Eigen::MatrixXd> root(basis.transpose() * mass * basis);
  if (root.info() != Eigen::Success) {
    out.why = "the mass matrix is not positive definite: members are heavier than their bodies";
    return;
  }
  const Eigen::MatrixXd lower = root.matrixL();
  const auto solve = [&](const Eigen::MatrixXd& m) {
    return Eigen::MatrixXd(lower.triangularView<Eigen::Lower>().solve(m));
  };
  const Eigen::MatrixXd half = solve(basis.transpose() * stiffness * basis);
  Eigen::MatrixXd all = solve(half.transpose());
  all = 0.5 * (all + all.transpose()).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(all);
  const double most = solver.eigenvalues().cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < solver.eigenvalues().size(); ++i) {
    const double value = solver.eigenvalues()[i], size = std::fabs(value);
    const Eigen::VectorXd shape = basis * lower.transpose().triangularView<Eigen::Upper>().solve(
                                              solver.eigenvectors().col(i));
    Mode mode = ShapeOf(def, s, shape);
    mode.eigenvalue_per_s2 = value;
    if (size <= kZero * most) {
      mode.kind = Mode::Kind::kMechanism;
      mode.eigenvalue_per_s2 = 0;
      out.largest_dropped = std::max(out.largest_dropped, size);
      ++out.mechanisms;
    } else {
      if (value < 0) mode.kind = Mode::Kind::kUnstable, ++out.unstable;
      mode.frequency_hz = std::copysign(std::sqrt(size) / (2 * kPi), value);
      if (out.smallest_kept == 0 || size < out.smallest_kept) out.smallest_kept = size;
    }
    out.modes.push_back(mode);
  }
}

}  // namespace
}  // namespace analysis

const char* NameOf(Mode::Kind kind) noexcept {
  switch (kind) {
    case Mode::Kind::kRigid:
      return "rigid";
    case Mode::Kind::kMechanism:
      return "mechanism";
    case Mode::Kind::kElastic:
      return "elastic";
    case Mode::Kind::kUnstable:
      return "unstable";
  }
  return "";
}

Modes FindModes(const ModelDef& def, const LoadCaseSpec& loads) {
  using namespace analysis;  // NOLINT(google-build-using-namespace): this function alone
  const Structure s(def, loads, true);
  Modes out;
  if (s.bodies.empty()) {
    out.why = "all bodies are fixed";
    return out;
  }
  const auto [holding, stiffness] = StiffnessAsDescribed(s);
  const Eigen::MatrixXd mass = MassMatrix(def, s);
  const FreeMotions free = FreeMotionsOf(def, s, stiffness, mass, HeldDirections(s, holding));
  for (Eigen::Index i = 0; i < free.rigid; ++i) {
    out.modes.push_back(ShapeOf(def, s, free.basis.col(i)));
    out.modes.back().kind = Mode::Kind::kRigid;
  }
  out.rigid = static_cast<int>(free.rigid);
  AddVibrations(def, s, free.basis.rightCols(free.basis.cols() - free.rigid), stiffness, mass, out);
  return out;
}

}  // namespace taut
