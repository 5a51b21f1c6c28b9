#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vec.h"
#include "plant/body_channels.h"
#include "plant/cable_channels.h"
#include "plant/command_rows.h"
#include "plant/schedule.h"
#include "taut/plant.h"

namespace taut {
namespace {

using plant::kTimeToleranceS;

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// Number of channels that are readings. The rows of stiffness and commanded rest length follow the
/// rows of readings.
constexpr std::size_t kReadings = [] {
  std::size_t count = 0;
  for (const plant::CableChannel& channel : plant::kCableChannels) {
    count += channel.reading != nullptr ? 1 : 0;
  }
  return count;
}();

constexpr std::size_t kBodyNumbers = std::tuple_size_v<plant::BodyNumbers>;

/// Plant that replays a recorded trace. Commands have no effect.
class ReplayPlant final : public Plant, public Bodies {
 public:
  ReplayPlant(const Trace& trace, const RobotSpec& robot)
      : trace_(trace),
        robot_(robot),
        cables_(robot.def.cables.size()),
        rows_((kReadings + 2) * cables_),
        columns_(kReadings * cables_, kNone),
        faults_(cables_),
        command_rows_(cables_, 1),
        commands_(command_rows_.With(Row(kReadings + 1))) {
    seen_.time_s = &time_s_;
    seen_.faults = faults_.data();
    seen_.cables.stiffness_n_per_m = Row(kReadings);
    std::size_t i = 0;
    for (const plant::CableChannel& channel : plant::kCableChannels) {
      if (channel.reading == nullptr) continue;
      seen_.cables.*channel.reading = Row(i);
      for (std::size_t c = 0; c < cables_; ++c) {
        columns_[c * kReadings + i] =
            ColumnOf("cable/" + robot.def.cables[c].name + "/" + channel.name);
      }
      ++i;
    }
    for (std::size_t c = 0; c < cables_; ++c) {
      Row(kReadings)[c] = robot.def.cables[c].stiffness_n_per_m;
    }
    bool known = !robot.def.bodies.empty();
    for (const BodyDef& body : robot.def.bodies) {
      for (const ChannelInfo& channel : plant::BodyChannels()) {
        body_columns_.push_back(ColumnOf("body/" + body.name + "/" + channel.name));
        known = known && body_columns_.back() != kNone;
      }
    }
    if (known) seen_.bodies = this;
    Restart(0);
  }

  /// Returns whether the trace has at least one channel of the robot's cables.
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
    command_rows_.Restart(0);
    for (std::size_t c = 0; c < cables_; ++c) {
      Row(kReadings + 1)[c] = robot_.def.cables[c].rest_length_m;
    }
    Read();
  }

  bool IsRunning(int) const override {
    return time_s_ < TimeOf(trace_.time_s.size() - 1) - kTimeToleranceS;
  }

  BodyState Body(int, int body) const override {
    plant::BodyNumbers x;
    const std::size_t first = static_cast<std::size_t>(body) * kBodyNumbers;
    for (std::size_t i = 0; i < kBodyNumbers; ++i) {
      x[i] = trace_.values[body_columns_[first + i]][row_];
    }
    return plant::BodyFrom(x);
  }
  Vec3 NodePosition(int, int node) const override {
    const NodeDef& def = robot_.def.nodes[static_cast<std::size_t>(node)];
    if (def.body == kWorld) return def.position_m;
    const BodyState body = Body(0, def.body);
    return body.position_m + ArmOf(def, body);
  }
  Vec3 NodeVelocity(int, int node) const override {
    const NodeDef& def = robot_.def.nodes[static_cast<std::size_t>(node)];
    if (def.body == kWorld) return {};
    const BodyState body = Body(0, def.body);
    return body.velocity_m_per_s + Cross(body.angular_velocity_rad_per_s, ArmOf(def, body));
  }

 private:
  double* Row(std::size_t i) { return rows_.data() + cables_ * i; }
  double TimeOf(std::size_t row) const { return trace_.time_s[row] - trace_.time_s[0]; }
  std::size_t ColumnOf(const std::string& name) const { return trace_.Find(name).value_or(kNone); }

  Vec3 ArmOf(const NodeDef& node, const BodyState& body) const {
    const BodyDef& def = robot_.def.bodies[static_cast<std::size_t>(node.body)];
    return Rotate(body.orientation, node.position_m - def.com_m);
  }

  /// Reads the current row. For missing values, keeps the last reading and sets a fault.
  void Read() {
    std::fill(faults_.begin(), faults_.end(), kFaultNone);
    for (std::size_t c = 0; c < cables_; ++c) {
      for (std::size_t i = 0; i < kReadings; ++i) {
        const std::size_t column = columns_[c * kReadings + i];
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
  std::vector<double> rows_;  ///< Rows of readings, then stiffness, then commanded rest length.
  std::vector<std::size_t> columns_, body_columns_;
  std::vector<std::uint32_t> faults_;
  plant::CommandRows command_rows_;
  Commands commands_;
  double time_s_ = 0;
  std::size_t row_ = 0;
  Observation seen_;
};

}  // namespace

std::unique_ptr<Plant> ReplayOf(const Trace& trace, const RobotSpec& robot, Diagnostics& out) {
  if (trace.time_s.empty()) {
    out.Error("replay.no_rows", {}, "the recording has no rows");
    return nullptr;
  }
  auto plant = std::make_unique<ReplayPlant>(trace, robot);
  if (plant->HasCables()) return plant;
  out.Error("replay.no_cables", {}, "the recording has no channels of a cable of " + robot.def.name,
            "expected channels such as cable/NAME/tension_n");
  return nullptr;
}

}  // namespace taut
