/// What a run has to say at its end, gathered at every step.
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

  /// Takes a moment in. `step_s` is the length of the step that led here; 0 at the start. `world`:
  /// whose motors to look at; null where there is no simulation.
  void Take(double time_s, double step_s, const Observation& now, const std::vector<double>& drag_n,
            const World* world);

  /// Takes in what struts and anchors bear at the moment of a row: at every step it would be half
  /// of a run's time.
  void TakeLoads(const Observation& now, const World& world);

  /// Cables, drags and maxima; the rest of the summary is the runner's.
  void Fill(RunSummary& summary) const;

 private:
  /// Mean over time: a value counts for the step that ends with it.
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
    double since_s = 0;  ///< The last time that the rest length was another.
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
  bool has_loads_ = false;  ///< Whether struts and anchors were looked at.
  std::vector<Cable> cables_;
  std::vector<Sum> drags_;
};

}  // namespace taut::plant
