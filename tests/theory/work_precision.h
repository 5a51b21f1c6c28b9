/// Work and precision of a scheme on two problems: a soft cable that oscillates, and a stiff cable
/// that carries a load.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "tests/physics/world.h"
#include "tests/scenes/solids.h"
#include "tests/theory/cable_schemes.h"

namespace taut::test {

/// A run: positions of the lowest mass after each step, tensions at the end, work.
struct SchemeRun {
  std::vector<double> x_m;
  HangingState end;
  double visits_per_s = 0;
  double energy_j = 0;  ///< At the end, relative to the pose at rest in which all cables are just
                        ///< taut.
};

inline double EnergyOf(const Hanging& robot, const HangingState& s) {
  double energy = 0, above = 0;
  for (std::size_t i = 0; i < s.x_m.size(); ++i) {
    const double stretch = std::max(s.x_m[i] - above, 0.0);
    energy += 0.5 * robot.mass_kg * s.v_m_per_s[i] * s.v_m_per_s[i] -
              robot.mass_kg * kGravity * s.x_m[i] +
              0.5 * robot.stiffness_n_per_m * stretch * stretch;
    above = s.x_m[i];
  }
  return energy;
}

inline SchemeRun RunScheme(CableScheme scheme, const Hanging& robot, HangingState s, double h,
                           int steps) {
  SchemeRun run;
  const long start = scheme.visits();
  for (int n = 0; n < steps; ++n) {
    scheme.Step(robot, s, h);
    run.x_m.push_back(s.x_m.back());
  }
  run.visits_per_s = static_cast<double>(scheme.visits() - start) / (steps * h);
  run.energy_j = EnergyOf(robot, s);
  run.end = s;
  return run;
}

/// Runs the same problem in taut's core, which selects its scheme by h^2 k / m. A sweep visits
/// every cable.
inline SchemeRun RunTaut(const Hanging& robot, const HangingState& start, double h, int steps) {
  ModelDef def;
  AttachmentDef above{kWorld, {}};
  for (int i = 0; i < robot.masses; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    BodyDef body;
    body.name = "mass_" + std::to_string(i);
    body.mass_kg = robot.mass_kg;
    body.com_m = {0, 0, -(i + 1.0) - start.x_m[k]};
    body.velocity_m_per_s = {0, 0, -start.v_m_per_s[k]};
    body.inertia_kg_m2 = scenes::SphereInertia(robot.mass_kg, 0.05);
    def.bodies.push_back(body);
    CableDef cable;
    cable.name = "cable_" + std::to_string(i);
    cable.attachments = {above, {i, body.com_m}};
    cable.stiffness_n_per_m = robot.stiffness_n_per_m;
    cable.damping_n_s_per_m = robot.damping_n_s_per_m;
    cable.rest_length_m = 1;
    def.cables.push_back(cable);
    above = cable.attachments[1];
  }
  def.gravity_m_per_s2 = {0, 0, -kGravity};
  WorldBatch world = MakeBatch(def);
  // A new world has no data about cables that were taut before: one step provides them.
  world.Step(h);
  for (int i = 0; i < robot.masses; ++i) {
    const BodyDef& body = def.bodies[static_cast<std::size_t>(i)];
    world.SetBodyState(0, i, {body.com_m, {}, body.velocity_m_per_s, {}});
  }
  SchemeRun run;
  long visits = 0;
  for (int n = 0; n < steps; ++n) {
    world.Step(h);
    visits += static_cast<long>(robot.masses) * (1 + world.Status(0).linear_solves);
    run.x_m.push_back(-world.Body(0, robot.masses - 1).position_m.z - robot.masses);
  }
  run.visits_per_s = static_cast<double>(visits) / (steps * h);
  for (int i = 0; i < robot.masses; ++i) {
    run.end.x_m.push_back(-world.Body(0, i).position_m.z - (i + 1));
    run.end.v_m_per_s.push_back(-world.Body(0, i).velocity_m_per_s.z);
    run.end.tension_n.push_back(world.Cable(0, i).tension_n);
  }
  run.energy_j = EnergyOf(robot, run.end);
  return run;
}

/// The free oscillation of a linear scheme is x_n = A r^n cos(n theta + phase) about its center, so
/// that x_n+1 = p x_n - q x_n-1 with q = r^2, p = 2 r cos(theta): fitted by least squares.
struct Swing {
  double angle_rad = 0;  ///< theta.
  double ratio = 0;      ///< r.
};

inline std::optional<Swing> SwingOf(const std::vector<double>& x, double middle) {
  double aa = 0, ab = 0, bb = 0, ac = 0, bc = 0;
  for (std::size_t n = 1; n + 1 < x.size(); ++n) {
    const double a = x[n] - middle, b = x[n - 1] - middle, c = x[n + 1] - middle;
    if (!std::isfinite(a * a + c * c)) return std::nullopt;
    aa += a * a, ab += a * b, bb += b * b, ac += a * c, bc += b * c;
  }
  const double det = aa * bb - ab * ab;
  const double p = (ac * bb - bc * ab) / det, q = -(aa * bc - ab * ac) / det;
  if (!(q > 0) || !(std::fabs(p) < 2 * std::sqrt(q))) return std::nullopt;
  return Swing{std::acos(p / (2 * std::sqrt(q))), std::sqrt(q)};
}

/// A point of the figure: one scheme at one step. An error of 1 or more, or NaN, is a failure.
struct WorkPoint {
  std::string problem, scheme;
  double step_s = 0, visits_per_s = 0, error = 0;
};

inline constexpr double kPiHere = 3.14159265358979323846;

/// Soft: 0.1 kg on 400 N/m without damping, 63 rad/s; errors of the period, and of the amplitude
/// after 100 periods.
inline void AddSoft(const std::string& name, const SchemeRun& run, const Hanging& robot, double h,
                    std::vector<WorkPoint>& out) {
  const double w = std::sqrt(robot.stiffness_n_per_m / robot.mass_kg);
  const auto swing = SwingOf(run.x_m, robot.weight_n(0) / robot.stiffness_n_per_m);
  const double none = std::nan("");
  out.push_back({"soft, period", name, h, run.visits_per_s,
                 swing ? std::fabs(w * h / swing->angle_rad - 1) : none});
  out.push_back(
      {"soft, amplitude", name, h, run.visits_per_s,
       swing ? std::fabs(std::pow(swing->ratio, 200 * kPiHere / swing->angle_rad) - 1) : none});
}

inline std::vector<WorkPoint> MeasureSoft() {
  const Hanging robot;
  const double w = std::sqrt(robot.stiffness_n_per_m / robot.mass_kg);
  const double sag = robot.weight_n(0) / robot.stiffness_n_per_m;
  const HangingState start{{1.5 * sag}, {0}, {1.5 * robot.weight_n(0)}};
  std::vector<WorkPoint> out;
  for (double angle = 1.28; angle > 0.003; angle /= 2) {
    const double h = angle / w;
    // The fit needs a few periods only, before a decayed amplitude is lost in rounding.
    const int steps = static_cast<int>(20 * kPiHere / angle);
    for (const CableScheme& scheme : CableSchemes()) {
      AddSoft(scheme.name(), RunScheme(scheme, robot, start, h, steps), robot, h, out);
    }
    AddSoft("taut", RunTaut(robot, start, h, steps), robot, h, out);
  }
  return out;
}

/// Stiff: two masses of 0.1 kg on cables of 1e6 N/m. With a tenth of critical damping, released
/// where the cables are just taut: error of the tensions after 0.5 s, when all motion has settled.
/// Without damping, released at one and a half times the sag, so that no cable goes slack: error of
/// the energy after 0.5 s, relative to the energy of the oscillation.
inline std::vector<WorkPoint> MeasureStiff() {
  std::vector<WorkPoint> out;
  for (const bool damped : {true, false}) {
    Hanging robot;
    robot.masses = 2;
    robot.stiffness_n_per_m = 1e6;
    robot.damping_n_s_per_m = damped ? 0.2 * std::sqrt(1e6 * 0.1) : 0;
    const double s0 = robot.weight_n(0) / 1e6, s1 = robot.weight_n(1) / 1e6;
    const double sag = damped ? 0 : 1.5;
    const HangingState start{
        {sag * s0, sag * (s0 + s1)}, {0, 0}, {sag * robot.weight_n(0), sag * robot.weight_n(1)}};
    const double energy = EnergyOf(robot, start);
    const double swing = energy - EnergyOf(robot, {{s0, s0 + s1}, {0, 0}, {}});
    const auto add = [&](const std::string& name, const SchemeRun& run, double h) {
      double error = 0;
      for (int c = 0; c < 2; ++c) {
        const double off = run.end.tension_n[static_cast<std::size_t>(c)] / robot.weight_n(c) - 1;
        error = std::isfinite(off) ? std::max(error, std::fabs(off)) : off;
      }
      if (!damped) error = std::fabs(run.energy_j - energy) / swing;
      out.push_back(
          {damped ? "stiff, tension" : "stiff, energy", name, h, run.visits_per_s, error});
    };
    for (double h = 8e-3; h > 3e-6; h /= 2) {
      const int steps = static_cast<int>(std::lround(0.5 / h));
      for (const CableScheme& scheme : CableSchemes()) {
        add(scheme.name(), RunScheme(scheme, robot, start, h, steps), h);
      }
      add("taut", RunTaut(robot, start, h, steps), h);
    }
  }
  return out;
}

}  // namespace taut::test
