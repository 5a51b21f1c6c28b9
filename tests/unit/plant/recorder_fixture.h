/// Runs of small models with rows in memory, for tests of recorders
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "math/vec.h"
#include "taut/run.h"
#include "taut/spec.h"
#include "taut/trace.h"
#include "tests/row_watch.h"

namespace taut::test {

/// An experiment that records every step
inline ExperimentSpec RecordedExperiment(const ModelDef& def, double duration_s,
                                         std::vector<std::string> channels, int contacts = 0) {
  ExperimentSpec experiment;
  experiment.name = "recorded";
  experiment.robot.def = def;
  experiment.duration_s = duration_s;
  experiment.record.rate_hz = 0;
  experiment.record.channels = std::move(channels);
  experiment.record.contacts = contacts;
  return experiment;
}

/// Runs an experiment and keeps its trace and summary
class Recording final : public test::RowWatch {
 public:
  /// `plant`: replaces the simulation.
  explicit Recording(const ExperimentSpec& experiment, Plant* plant = nullptr) {
    trace.channels = RunChannels(experiment, plant);
    trace.values.resize(trace.channels.size());
    Diagnostics out;
    RunOptions options;
    options.traces = {this};
    options.plant = plant;
    const auto run = RunExperiment(experiment, options, out);
    EXPECT_TRUE(run) << out.Format();
    if (run) summary = *run;
  }

  bool Append(double time_s, const double* values) override {
    trace.time_s.push_back(time_s);
    for (std::size_t i = 0; i < trace.values.size(); ++i) trace.values[i].push_back(values[i]);
    return true;
  }

  std::size_t rows() const { return trace.time_s.size(); }
  bool Has(const std::string& channel) const { return trace.Find(channel).has_value(); }
  double At(const std::string& channel, std::size_t row) const {
    const auto found = trace.Find(channel);
    EXPECT_TRUE(found) << channel;
    return found ? trace.values[*found].at(row) : std::numeric_limits<double>::quiet_NaN();
  }
  double Last(const std::string& channel) const { return At(channel, rows() - 1); }
  /// Returns the channels `prefix` + x, y, z + `suffix` as a vector.
  Vec3 VectorAt(const std::string& prefix, const std::string& suffix, std::size_t row) const {
    return {At(prefix + "x" + suffix, row), At(prefix + "y" + suffix, row),
            At(prefix + "z" + suffix, row)};
  }
  Quat OrientationAt(const std::string& body, std::size_t row) const {
    const std::string q = "body/" + body + "/orientation_";
    return {At(q + "w", row), At(q + "x", row), At(q + "y", row), At(q + "z", row)};
  }

  Trace trace;
  RunSummary summary;
};

inline void ExpectNear(const Vec3& a, const Vec3& b, double tolerance, const std::string& what) {
  EXPECT_NEAR(a.x, b.x, tolerance) << what;
  EXPECT_NEAR(a.y, b.y, tolerance) << what;
  EXPECT_NEAR(a.z, b.z, tolerance) << what;
}

inline CableDef SoftCable(const std::string& name, std::vector<AttachmentDef> attachments,
                          double stiffness_n_per_m, double rest_length_m) {
  CableDef cable;
  cable.name = name;
  cable.attachments = std::move(attachments);
  cable.stiffness_n_per_m = stiffness_n_per_m;
  cable.rest_length_m = rest_length_m;
  return cable;
}

/// A weight at rest on a cable with a motor, 1 m below the world's origin
inline ModelDef CraneOf(double mass_kg, double stiffness_n_per_m, double damping_n_s_per_m) {
  ModelDef def;
  BodyDef body;
  body.name = "load";
  body.mass_kg = mass_kg;
  body.com_m = {0, 0, -1};
  body.inertia_kg_m2 = {1e-3, 1e-3, 1e-3, 0, 0, 0};
  def.bodies.push_back(body);
  CableDef cable = SoftCable("rope", {{kWorld, {0, 0, 0}}, {0, {0, 0, -1}}}, stiffness_n_per_m,
                             1 - mass_kg * 9.81 / stiffness_n_per_m);
  cable.damping_n_s_per_m = damping_n_s_per_m;
  cable.actuator.kind = ActuatorDef::Kind::kDcMotor;
  cable.actuator.dc_motor.emplace();
  def.cables.push_back(cable);
  return def;
}

}  // namespace taut::test
