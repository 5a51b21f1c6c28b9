// Modes (natural frequency and damping) and frequency response of a linearized system
// (docs/theory/linear.md, section 5).
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/angle.h"
#include "taut/state_space.h"

namespace taut {
namespace {

using Complex = std::complex<double>;

Eigen::MatrixXd MatrixOf(const Matrix& m) {
  Eigen::MatrixXd out(m.rows, m.columns);
  for (int i = 0; i < m.rows; ++i) {
    for (int j = 0; j < m.columns; ++j) out(i, j) = m(i, j);
  }
  return out;
}

}  // namespace

std::vector<LinearMode> ModesOf(const StateSpace& system) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(MatrixOf(system.A), false);
  constexpr double kNothing = 1e-9;  // |log z| or angle of a motion without oscillation and decay
  std::vector<LinearMode> modes;
  for (const Complex& z : solver.eigenvalues()) {
    if (z.imag() < 0) continue;
    LinearMode mode{z, 0, 0};
    const double angle = std::arg(z), log_size = std::log(std::abs(z));
    mode.frequency_hz = z.imag() == 0 ? 0 : angle / (2 * kPi * system.period_s);
    const double size = std::hypot(log_size, z.imag() == 0 ? 0 : angle);
    mode.damping = std::abs(z) == 0 ? 1 : size > kNothing ? -log_size / size : 0;
    modes.push_back(mode);
  }
  std::stable_sort(modes.begin(), modes.end(), [](const LinearMode& a, const LinearMode& b) {
    return a.frequency_hz != b.frequency_hz ? a.frequency_hz < b.frequency_hz
                                            : std::abs(a.z) > std::abs(b.z);
  });
  return modes;
}

FrequencyResponse ResponseOf(const StateSpace& system, int input, int output,
                             const std::vector<double>& frequencies_hz) {
  constexpr double kSingular = 1e-12, kBeside = 1e-6, kSame = 1e-3;
  const Eigen::MatrixXcd A = MatrixOf(system.A).cast<Complex>();
  const Eigen::MatrixXcd one = Eigen::MatrixXcd::Identity(A.rows(), A.cols());
  Eigen::VectorXcd b(system.A.rows);
  Eigen::RowVectorXcd c(system.A.rows);
  for (int i = 0; i < system.A.rows; ++i) b(i) = system.B(i, input), c(i) = system.C(output, i);
  const auto at = [&](Complex z, double& condition) {
    const Eigen::PartialPivLU<Eigen::MatrixXcd> factors(z * one - A);
    const Eigen::VectorXd pivots = factors.matrixLU().diagonal().cwiseAbs();
    condition = pivots.minCoeff() / pivots.maxCoeff();
    return (c * factors.solve(b))(0) + system.D(output, input);
  };
  FrequencyResponse response;
  for (const double f : frequencies_hz) {
    const Complex z = std::polar(1.0, 2 * kPi * f * system.period_s);
    double condition = 0, ignored = 0;
    Complex x = at(z, condition);
    bool finite = true;
    // Free positions or rotations (such as a weight that rotates about its rope) make the matrix
    // singular at 0 Hz. If the input does not excite them, or the output does not contain them, the
    // response is finite. Then the values at neighboring frequencies agree.
    if (!(condition > kSingular)) {
      const Complex more = at(z * (1 + kBeside), ignored), less = at(z * (1 - kBeside), ignored);
      x = 0.5 * (more + less);
      finite = std::abs(more - less) <= kSame * std::abs(x);
    }
    response.frequency_hz.push_back(f);
    response.magnitude.push_back(finite ? std::abs(x) : std::numeric_limits<double>::infinity());
    response.phase_rad.push_back(finite ? std::arg(x) : 0.0);
  }
  return response;
}

}  // namespace taut
