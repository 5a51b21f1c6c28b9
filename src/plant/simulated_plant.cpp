#include <algorithm>
#include <vector>

#include "base/assert.h"
#include "plant/command_rows.h"
#include "plant/many_steps.h"
#include "taut/plant.h"

namespace taut {
namespace {

class SimulatedPlant final : public Plant, public World, public plant::ManySteps {
 public:
  explicit SimulatedPlant(WorldBatch& batch)
      : batch_(batch),
        lanes_(static_cast<std::size_t>(batch.lanes())),
        time_s_(lanes_),
        goes_(static_cast<std::size_t>(batch.worlds())),
        rows_(batch.model().def().cables.size(), lanes_, HasMotors(batch.model().def())),
        commands_(rows_.With(batch.Cables(0).rest_length_target_m)) {
    TAUT_ASSERT(batch.groups() == 1);
    const std::vector<CableDef>& cables = batch.model().def().cables;
    bool has_backlash = false;
    for (std::size_t c = 0; c < cables.size(); ++c) {
      if (cables[c].actuator.kind == ActuatorDef::Kind::kDcMotor) {
        motors_.push_back(static_cast<int>(c));
        has_backlash = has_backlash || cables[c].actuator.dc_motor->backlash_rad > 0;
      }
    }
    if (has_backlash) shaft_m_.resize(cables.size() * lanes_);
    powers_.resize(cables.size() * lanes_);
    seen_.lanes = batch.lanes();
    seen_.time_s = time_s_.data();
    seen_.bodies = this;
    seen_.cables = batch.Cables(0);
  }

  const Observation& Observe() override {
    batch_.Sense(0);  // sets the rows once; their addresses do not change
    if (!shaft_m_.empty()) ReadShafts();
    return seen_;
  }
  Commands& commands() override { return commands_; }

  void Advance(const double* step_s, const double* to_s) override {
    Switch();
    Hold();
    bool alike = true;
    for (std::size_t j = 0; j < lanes_; ++j) {
      alike = alike && step_s[j] == step_s[0];
      time_s_[j] = to_s[j];
    }
    if (!alike) return StepByLength(step_s);
    if (step_s[0] > 0) batch_.Step(step_s[0]);
  }

  void AdvanceMany(double step_s, int count, const double* to_s) override {
    Switch();
    Hold();
    std::copy_n(to_s, lanes_, time_s_.begin());
    batch_.Step(step_s, count);
  }

  void Restart(int lane) override {
    time_s_[static_cast<std::size_t>(lane)] = 0;
    rows_.Restart(lane);
  }

  /// Rest lengths and motor states are in the batch's snapshots.
  void Serialize(plant::LaneState& state) override {
    state.Row(time_s_);
    rows_.Serialize(state);
    state.Row(powers_);
  }

  bool IsRunning(int lane) const override {
    return (batch_.Status(lane).bits & kStatusNonFinite) == 0;
  }
  World* world() noexcept override { return this; }

  BodyState Body(int lane, int body) const override { return batch_.Body(lane, body); }
  Vec3 NodePosition(int lane, int node) const override { return batch_.NodePosition(lane, node); }
  Vec3 NodeVelocity(int lane, int node) const override { return batch_.NodeVelocity(lane, node); }
  void SetNodeForce(int lane, int node, const Vec3& force_n) override {
    batch_.SetNodeForce(lane, node, force_n);
  }
  Vec3 NodeForce(int lane, int node) const override { return batch_.NodeForce(lane, node); }
  double BodyMass(int lane, int body) const override {
    return batch_.GetParameter(lane, Parameter::kBodyMass, body);
  }
  Energy TotalEnergy(int lane) const override { return batch_.TotalEnergy(lane); }
  MotorState Motor(int lane, int cable) const override { return batch_.Motor(lane, cable); }
  std::vector<ContactState> Contacts(int lane) const override { return batch_.Contacts(lane); }
  std::vector<double> CableSpanTensions(int lane, int cable) const override {
    return batch_.CableSpanTensions(lane, cable);
  }
  double CableFrictionLoss(int lane, int cable) const override {
    return batch_.CableFrictionLoss(lane, cable);
  }
  double WheelAngle(int lane, int cable, int wheel) const override {
    return batch_.WheelAngle(lane, cable, wheel);
  }
  std::vector<CablePoint> CablePath(int lane, int cable) const override {
    return batch_.CablePath(lane, cable);
  }
  std::vector<Vec3> CableBendPlaces(int lane, int cable) const override {
    return batch_.CableBendPlaces(lane, cable);
  }
  double CableWrap(int lane, int cable) const override { return batch_.CableWrap(lane, cable); }
  JointState Joint(int lane, int joint) const override { return batch_.Joint(lane, joint); }
  MotionState Motion(int lane, int motion) const override { return batch_.Motion(lane, motion); }
  WorldStatus Status(int lane) const override { return batch_.Status(lane); }
  std::uint64_t Hash(int lane) const override { return batch_.Hash(lane); }

 private:
  void ReadShafts() {
    std::copy_n(seen_.cables.rest_length_m, shaft_m_.size(), shaft_m_.begin());
    for (const int c : motors_) {
      for (std::size_t j = 0; j < goes_.size(); ++j) {
        shaft_m_[static_cast<std::size_t>(c) * lanes_ + j] +=
            batch_.Motor(static_cast<int>(j), c).backlash_m;
      }
    }
    seen_.shaft_m = shaft_m_.data();
  }

  /// Drives of a motor by commands.
  enum Power : std::uint8_t { kByServo, kWithoutPower, kByDuty };

  static bool HasMotors(const ModelDef& def) {
    return std::any_of(def.cables.begin(), def.cables.end(), [](const CableDef& cable) {
      return cable.actuator.kind == ActuatorDef::Kind::kDcMotor;
    });
  }

  /// Switches motors if commands have changed, and applies duties. Motors that other callers have
  /// switched stay switched.
  void Switch() {
    for (const int c : motors_) {
      for (std::size_t j = 0; j < goes_.size(); ++j) {
        const std::size_t i = static_cast<std::size_t>(c) * lanes_ + j;
        const int lane = static_cast<int>(j);
        const CommandMode mode = rows_.mode()[i];
        const Power power = mode == CommandMode::kOff    ? kWithoutPower
                            : mode == CommandMode::kDuty ? kByDuty
                                                         : kByServo;
        if (power == kByDuty) batch_.SetDuty(lane, c, rows_.duty()[i]);
        if (power == powers_[i]) continue;
        if (powers_[i] == kByDuty && power == kByServo) {
          batch_.SetRestLengthTarget(lane, c, commands_.rest_length_m[i]);
        }
        if ((power == kWithoutPower) != (powers_[i] == kWithoutPower)) {
          batch_.SetMotorEnabled(lane, c, power != kWithoutPower);
        }
        powers_[i] = power;
      }
    }
  }

  /// Sets the targets of actuators in hold mode to their current rest lengths.
  void Hold() {
    const std::vector<CommandMode>& modes = rows_.mode();
    CommandMode most = CommandMode::kRestLength;
    for (const CommandMode mode : modes) most = mode > most ? mode : most;
    if (most < CommandMode::kHold) return;
    for (std::size_t i = 0; i < modes.size(); ++i) {
      if (modes[i] != CommandMode::kHold && modes[i] != CommandMode::kOff) continue;
      commands_.rest_length_m[i] = seen_.cables.rest_length_m[i];
    }
  }

  /// Steps lanes with different step lengths: all lanes with one length, then those with the next.
  void StepByLength(const double* step_s) {
    std::vector<double> lengths(step_s, step_s + goes_.size());
    std::sort(lengths.begin(), lengths.end());
    lengths.erase(std::unique(lengths.begin(), lengths.end()), lengths.end());
    for (const double length : lengths) {
      if (!(length > 0)) continue;
      for (std::size_t j = 0; j < goes_.size(); ++j) goes_[j] = step_s[j] == length;
      batch_.StepMasked(length, goes_);
    }
  }

  WorldBatch& batch_;
  std::size_t lanes_;
  std::vector<double> time_s_;
  std::vector<std::uint8_t> goes_;
  plant::CommandRows rows_;
  Commands commands_;
  Observation seen_;
  std::vector<int> motors_;      ///< Cables with DC motors.
  std::vector<Power> powers_;    ///< Row of motor drives.
  std::vector<double> shaft_m_;  ///< See `Observation::shaft_m`; empty if no gear has backlash.
};

}  // namespace

std::unique_ptr<Plant> PlantOf(WorldBatch& batch) {
  return std::make_unique<SimulatedPlant>(batch);
}

}  // namespace taut
