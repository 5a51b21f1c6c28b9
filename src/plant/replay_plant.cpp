#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vec.h"
#include "taut/plant.h"

namespace taut {
namespace {

constexpr double kTimeToleranceS = 1e-9;  // times are sums of steps
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

const char* const kBodyChannels[] = {"position_x_m",
                                     "position_y_m",
                                     "position_z_m",
                                     "orientation_w",
                                     "orientation_x",
                                     "orientation_y",
                                     "orientation_z",
                                     "velocity_x_m_per_s",
                                     "velocity_y_m_per_s",
                                     "velocity_z_m_per_s",
                                     "angular_velocity_x_rad_per_s",
                                     "angular_velocity_y_rad_per_s",
                                     "angular_velocity_z_rad_per_s"};
constexpr std::size_t kBodyChannelCount = std::size(kBodyChannels);

/// A log as a plant: what was read is read again; what is commanded goes nowhere.
class ReplayPlant final : public Plant, public Bodies {
 public:
  ReplayPlant(const Trace& trace, const RobotSpec& robot)
      : trace_(trace),
        robot_(robot),
        cables_(robot.def.cables.size()),
        rows_(10 * cables_),
        columns_(5 * cables_, kNone),
        faults_(cables_),
        mode_(cables_) {
    seen_.time_s = &time_s_;
    seen_.cables = {Row(0), Row(1), Row(2), Row(3), Row(4), Row(5)};
    seen_.faults = faults_.data();
    commands_ = {1, Row(6), Row(7), Row(8), Row(9), mode_.data(), &gait_};
    for (std::size_t c = 0; c < cables_; ++c) {
      const CableDef& cable = robot.def.cables[c];
      Row(5)[c] = cable.stiffness_n_per_m;
      Row(6)[c] = cable.rest_length_m;
      std::size_t i = 0;
      for (const char* name :
           {"rest_length_m", "length_m", "rate_m_per_s", "tension_n", "elastic_n"}) {
        columns_[c * 5 + i++] = ColumnOf("cable/" + cable.name + "/" + name);
      }
    }
    bool known = !robot.def.bodies.empty();
    for (const BodyDef& body : robot.def.bodies) {
      for (const char* name : kBodyChannels) {
        body_columns_.push_back(ColumnOf("body/" + body.name + "/" + name));
        known = known && body_columns_.back() != kNone;
      }
    }
    if (known) seen_.bodies = this;
    Restart(0);
  }

  /// False if the log has nothing of any cable of the robot.
  bool HasCables() const {
    return std::any_of(columns_.begin(), columns_.end(), [](std::size_t c) { return c != kNone; });
  }

  const Observation& Observe() override { return seen_; }
  Commands& commands() override { return commands_; }

  void Advance(const double*, const double* to_s) override {
    time_s_ = *to_s;
    while (row_ + 1 < trace_.time_s.size() && TimeOf(row_ + 1) <= time_s_ + kTimeToleranceS) ++row_;
    Read();
  }

  void Restart(int) override {
    time_s_ = 0;
    row_ = 0;
    Read();
  }

  bool Goes(int) const override {
    return time_s_ < TimeOf(trace_.time_s.size() - 1) - kTimeToleranceS;
  }

  BodyState Body(int, int body) const override {
    double x[kBodyChannelCount];
    for (std::size_t i = 0; i < kBodyChannelCount; ++i) {
      const std::size_t at = static_cast<std::size_t>(body) * kBodyChannelCount + i;
      x[i] = trace_.values[body_columns_[at]][row_];
    }
    return {
        {x[0], x[1], x[2]}, {x[3], x[4], x[5], x[6]}, {x[7], x[8], x[9]}, {x[10], x[11], x[12]}};
  }
  Vec3 NodePosition(int, int node) const override {
    const NodeDef& def = robot_.def.nodes[static_cast<std::size_t>(node)];
    if (def.body == kWorld) return def.position_m;
    return Body(0, def.body).position_m + ArmOf(def);
  }
  Vec3 NodeVelocity(int, int node) const override {
    const NodeDef& def = robot_.def.nodes[static_cast<std::size_t>(node)];
    if (def.body == kWorld) return {};
    const BodyState body = Body(0, def.body);
    return body.velocity_m_per_s + Cross(body.angular_velocity_rad_per_s, ArmOf(def));
  }

 private:
  double* Row(std::size_t i) { return rows_.data() + cables_ * i; }
  double TimeOf(std::size_t row) const { return trace_.time_s[row] - trace_.time_s[0]; }
  std::size_t ColumnOf(const std::string& name) const { return trace_.Find(name).value_or(kNone); }

  Vec3 ArmOf(const NodeDef& node) const {
    const BodyDef& body = robot_.def.bodies[static_cast<std::size_t>(node.body)];
    return Rotate(Body(0, node.body).orientation, node.position_m - body.com_m);
  }

  /// What a row lacks stays as it was, with a fault.
  void Read() {
    std::fill(faults_.begin(), faults_.end(), kFaultNone);
    for (std::size_t c = 0; c < cables_; ++c) {
      for (std::size_t i = 0; i < 5; ++i) {
        const std::size_t column = columns_[c * 5 + i];
        const double x = column == kNone ? std::numeric_limits<double>::quiet_NaN()
                                         : trace_.values[column][row_];
        if (std::isfinite(x)) {
          Row(i)[c] = x;
        } else {
          faults_[c] |= kFaultNoReading;
        }
      }
    }
  }

  const Trace& trace_;
  const RobotSpec& robot_;
  std::size_t cables_;
  std::vector<double> rows_;  ///< Six readings, four commands.
  std::vector<std::size_t> columns_, body_columns_;
  std::vector<std::uint32_t> faults_;
  std::vector<CommandMode> mode_;
  int gait_ = -1;
  double time_s_ = 0;
  std::size_t row_ = 0;
  Observation seen_;
  Commands commands_;
};

}  // namespace

std::unique_ptr<Plant> ReplayOf(const Trace& trace, const RobotSpec& robot, Diagnostics& out) {
  if (trace.time_s.empty()) {
    out.Error({}, "the log has no row");
    return nullptr;
  }
  auto plant = std::make_unique<ReplayPlant>(trace, robot);
  if (plant->HasCables()) return plant;
  out.Error({}, "the log knows no cable of " + robot.def.name,
            "its channels have to be called cable/NAME/tension_n and the like");
  return nullptr;
}

}  // namespace taut
