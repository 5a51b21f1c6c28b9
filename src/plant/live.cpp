#include "taut/live.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/vec.h"
#include "plant/find_start.h"
#include "plant/loop.h"
#include "plant/member_watch.h"
#include "plant/recorder.h"

namespace taut {
namespace {

using plant::kTheWorld;
using plant::NodeForce;

ExperimentSpec RecordingAll(ExperimentSpec experiment) {
  experiment.record.channels.clear();
  return experiment;
}

class Live final : public LiveRun {
 public:
  Live(const ExperimentSpec& experiment, Batch batch, const Extensions& extensions)
      : experiment_(RecordingAll(experiment)),
        batch_(std::move(batch)),
        plant_(PlantOf(batch_)),
        loop_(experiment_, *plant_, extensions),
        recorder_(experiment_),
        watch_(experiment_.robot.def),
        channels_(recorder_.channels()) {
    for (const char* hand : {"hand/drag/", "hand/push/"}) {
      channels_.push_back({std::string(hand) + "node", "1"});
      for (const char* axis : {"force_x_n", "force_y_n", "force_z_n"}) {
        channels_.push_back({std::string(hand) + axis, "N"});
      }
    }
    row_.resize(channels_.size());
    for (const BodyDef& body : experiment_.robot.def.bodies) {
      if (!body.fixed) mass_kg_ += body.mass_kg;
    }
    loop_.Prepare();
    Watch();
  }

  bool Step() override {
    if (!loop_.IsRunning()) return false;
    std::erase_if(pushes_, [&](const auto& p) { return p.until_s <= loop_.time_s() + 1e-12; });
    std::vector<NodeForce> forces;
    for (const TimedPush& push : pushes_) forces.push_back(push.force);
    if (hand_) {
      drag_n_ = HandForce();
      forces.push_back({hand_->node, drag_n_});
    }
    loop_.timeline().SetHandForces(std::move(forces));
    loop_.Step();
    Watch();
    return true;
  }

  double time_s() const override { return loop_.time_s(); }
  const ExperimentSpec& experiment() const override { return experiment_; }
  const Observation& Observe() const override { return loop_.exact(); }
  const Commands& commands() const override { return loop_.commands(); }
  const World* world() const override { return plant_->world(); }
  std::vector<Overload> Overloads() const override { return watch_.Overloads(); }

  std::vector<OutsideForce> OutsideForces() const override {
    std::vector<OutsideForce> forces;
    const auto add = [&](int node, const Vec3& force) {
      if (Dot(force, force) > 0) forces.push_back({node, force});
    };
    for (std::size_t i = 0; i < experiment_.pushes.size(); ++i) {
      const PushSpec& push = experiment_.pushes[i];
      add(push.node, loop_.timeline().push_n()[i] * push.direction);
    }
    for (std::size_t i = 0; i < experiment_.drags.size(); ++i) {
      const DragSpec& drag = experiment_.drags[i];
      const double speed = std::sqrt(Dot(drag.velocity_m_per_s, drag.velocity_m_per_s));
      if (speed > 0) {
        add(drag.node, (loop_.timeline().drag_n()[i] / speed) * drag.velocity_m_per_s);
      }
    }
    for (const TimedPush& push : pushes_) add(push.force.node, push.force.force_n);
    if (hand_) add(hand_->node, drag_n_);
    return forces;
  }

  void SetHand(const std::optional<HandSpec>& hand) override {
    hand_ = hand;
    drag_n_ = {};
  }

  double DragStiffness() const override { return 200.0 * mass_kg_; }

  void Push(const OutsideForce& push, double duration_s) override {
    pushes_.push_back({{push.node, push.force_n}, loop_.time_s() + duration_s});
  }

  void SetParameter(Parameter parameter, int index, double value) override {
    batch_.SetParameter(kTheWorld, parameter, index, value);
  }
  double GetParameter(Parameter parameter, int index) const override {
    return batch_.GetParameter(kTheWorld, parameter, index);
  }

  std::vector<LiveControl> Controls() const override {
    std::vector<LiveControl> controls;
    for (std::size_t c = 0; c < experiment_.robot.def.cables.size(); ++c) {
      if (experiment_.robot.def.cables[c].actuator.kind == ActuatorDef::Kind::kNone) continue;
      LiveControl control;
      control.cable = static_cast<int>(c);
      control.rest_length_m = loop_.commands().rest_length_m[c];
      control.impedance = loop_.Gains(control.cable);
      controls.push_back(control);
    }
    return controls;
  }

  bool SetControl(const LiveControl& control) override {
    const auto& cables = experiment_.robot.def.cables;
    if (control.cable < 0 || static_cast<std::size_t>(control.cable) >= cables.size() ||
        cables[static_cast<std::size_t>(control.cable)].actuator.kind == ActuatorDef::Kind::kNone) {
      return false;
    }
    if (control.impedance.has_value() != loop_.Gains(control.cable).has_value()) return false;
    if (control.impedance) return loop_.SetGains(*control.impedance);
    loop_.SetRestLength(control.cable, control.rest_length_m);
    return true;
  }

  const std::vector<ChannelInfo>& channels() const override { return channels_; }

  const std::vector<double>& Row() override {
    const std::vector<double>& recorded = recorder_.Row(
        {&loop_.exact(), &loop_.seen(), &loop_.commands(), plant_->world(), &loop_.timeline()});
    double* out = std::copy(recorded.begin(), recorded.end(), row_.data());
    NodeForce push{-1, {}};
    for (const TimedPush& one : pushes_) {
      push = {one.force.node, push.force_n + one.force.force_n};
    }
    const NodeForce drag{hand_ ? hand_->node : -1, drag_n_};
    for (const NodeForce& force : {drag, push}) {
      const Vec3& f = force.force_n;
      for (const double value : {static_cast<double>(force.node), f.x, f.y, f.z}) *out++ = value;
    }
    return row_;
  }

 private:
  void Watch() {
    if (watch_.empty()) return;  // building the observation costs more than the check
    watch_.Take(loop_.time_s(), loop_.exact(), plant_->world());
  }

  struct TimedPush {
    NodeForce force;
    double until_s = 0;
  };

  /// Returns the force of a spring and damper between node and hand. Both are explicit and limited,
  /// so that they are stable at the end of a rod, whose effective mass is a quarter of the rod's
  /// mass.
  Vec3 HandForce() const {
    const NodeDef& node = experiment_.robot.def.nodes[static_cast<std::size_t>(hand_->node)];
    if (node.body == kWorld) return {};
    const double mass_kg = batch_.GetParameter(kTheWorld, Parameter::kBodyMass, node.body);
    const double step_s = experiment_.step_s;
    const double stiffness = std::min(DragStiffness(), 0.05 * mass_kg / (step_s * step_s));
    const double damping = std::min(2.0 * std::sqrt(stiffness * mass_kg), 0.2 * mass_kg / step_s);
    const Vec3 stretch = hand_->target_m - batch_.NodePosition(kTheWorld, hand_->node);
    return stiffness * stretch - damping * batch_.NodeVelocity(kTheWorld, hand_->node);
  }

  ExperimentSpec experiment_;
  Batch batch_;
  std::unique_ptr<Plant> plant_;
  plant::Loop loop_;
  plant::Recorder recorder_;
  plant::MemberWatch watch_;
  std::vector<ChannelInfo> channels_;
  std::vector<double> row_;
  double mass_kg_ = 0;
  std::optional<HandSpec> hand_;
  Vec3 drag_n_;
  std::vector<TimedPush> pushes_;
};

}  // namespace

std::unique_ptr<LiveRun> LiveRun::Start(const ExperimentSpec& experiment, Diagnostics& out,
                                        const std::function<bool()>& go_on,
                                        const Extensions& extensions) {
  const auto model = Model::Compile(experiment.robot.def, out);
  if (!model) return nullptr;
  Batch batch(model, {});
  std::optional<SettledStart> settled;
  if (!plant::PrepareStart(experiment, batch, out, go_on, &settled)) return nullptr;
  if (settled) WarnOfStart(settled->change, out);
  return std::make_unique<Live>(experiment, std::move(batch), extensions);
}

}  // namespace taut
