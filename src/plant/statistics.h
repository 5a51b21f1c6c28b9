/// Statistics for the summary of a run, updated at every step.
#pragma once

#include <optional>
#include <vector>

#include "plant/body_forces.h"
#include "plant/member_watch.h"
#include "taut/plant.h"
#include "taut/run.h"

namespace taut::plant {

class Statistics {
 public:
  explicit Statistics(const ExperimentSpec& experiment);

  /// Adds the state after a step of length `step_s` (0 at the start). `world`: null if the plant is
  /// not a simulation; contains the motors.
  void Take(double time_s, double step_s, const Observation& now, const std::vector<double>& drag_n,
            const World* world);

  /// Adds the loads of struts and anchors. Call it for recorded rows only: at every step, it would
  /// take half of the time of a run.
  void TakeLoads(const Observation& now, const World& world);

  /// Sets phases, cables, struts, anchors, drags, overloads and maxima. The runner sets all other
  /// fields.
  void Fill(RunSummary& summary) const;

 private:
  /// Time-weighted mean. The weight of a value is the step that ends with it.
  struct Sum {
    double integral = 0, time_s = 0, min = 0, max = 0;
    bool any = false;
    void Take(double x, double step_s);
    Range range() const;
  };
  struct Quantity {
    double max = 0, max_after_start = 0;
    std::vector<Sum> phases;
  };
  struct Cable {
    Quantity tension, elastic;
    double rest_length_m = 0, max_force_n = 0, max_speed = 0, max_power_w = 0, energy_j = 0,
           net_energy_j = 0;
    double since_s = 0;  ///< Time since the last change of the rest length.
    std::optional<MotorSummary> motor;
  };
  void Take(Quantity& quantity, double time_s, double step_s, double force_n) const;
  static void Take(std::optional<MotorSummary>& sum, const MotorState& motor);

  struct StrutSum {
    mechanics::Strut strut;
    double least_n = 0, greatest_n = 0;
  };
  struct AnchorSum {
    int body = 0;
    Vec3 weight_n;
    double max_force_n = 0, max_torque_n_m = 0;
  };
  const ExperimentSpec& experiment_;
  MemberWatch watch_;
  BodyForces forces_;
  std::vector<StrutSum> struts_;
  std::vector<AnchorSum> anchors_;
  bool has_loads_ = false;  ///< Whether `TakeLoads` was called.
  std::vector<Cable> cables_;
  std::vector<Sum> drags_;
};

}  // namespace taut::plant
