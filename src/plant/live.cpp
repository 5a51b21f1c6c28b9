#include "taut/live.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/vec.h"
#include "plant/recorder.h"
#include "plant/start.h"
#include "plant/stepper.h"

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
  Live(const ExperimentSpec& experiment, Batch batch)
      : experiment_(RecordingAll(experiment)),
        batch_(std::move(batch)),
        stepper_(experiment_, batch_),
        recorder_(experiment_),
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
    stepper_.Prepare();
  }

  bool Step() override {
    if (!stepper_.finite()) return false;
    std::erase_if(pushes_, [&](const auto& p) { return p.until_s <= stepper_.time_s() + 1e-12; });
    std::vector<NodeForce> forces;
    for (const TimedPush& push : pushes_) forces.push_back(push.force);
    if (hand_) {
      drag_n_ = HandForce();
      forces.push_back({hand_->node, drag_n_});
    }
    stepper_.timeline().SetHandForces(std::move(forces));
    stepper_.Step();
    return true;
  }

  double time_s() const override { return stepper_.time_s(); }
  const ExperimentSpec& experiment() const override { return experiment_; }
  const Batch& batch() const override { return batch_; }
  const std::vector<double>& set_point_n() const override { return stepper_.set_point_n(); }

  std::vector<OutsideForce> OutsideForces() const override {
    std::vector<OutsideForce> forces;
    const auto add = [&](int node, const Vec3& force) {
      if (Dot(force, force) > 0) forces.push_back({node, force});
    };
    for (std::size_t i = 0; i < experiment_.pushes.size(); ++i) {
      const PushSpec& push = experiment_.pushes[i];
      add(push.node, stepper_.timeline().push_n()[i] * push.direction);
    }
    for (std::size_t i = 0; i < experiment_.drags.size(); ++i) {
      const DragSpec& drag = experiment_.drags[i];
      const double speed = std::sqrt(Dot(drag.velocity_m_per_s, drag.velocity_m_per_s));
      if (speed > 0) {
        add(drag.node, (stepper_.timeline().drag_n()[i] / speed) * drag.velocity_m_per_s);
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
    pushes_.push_back({{push.node, push.force_n}, stepper_.time_s() + duration_s});
  }

  void SetParameter(Parameter parameter, int index, double value) override {
    batch_.SetParameter(kTheWorld, parameter, index, value);
  }

  std::vector<LiveControl> Controls() const override {
    std::vector<LiveControl> controls;
    for (std::size_t c = 0; c < experiment_.robot.def.cables.size(); ++c) {
      if (experiment_.robot.def.cables[c].actuator.kind == ActuatorDef::Kind::kNone) continue;
      LiveControl control;
      control.cable = static_cast<int>(c);
      control.rest_length_m = stepper_.commands().target_m[c];
      for (const plant::Controller& controller : stepper_.controllers()) {
        if (const ImpedanceGains* gains = controller.FindGains(control.cable)) {
          control.impedance = *gains;
        }
      }
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
    for (plant::Controller& controller : stepper_.controllers()) {
      if (ImpedanceGains* gains = controller.FindGains(control.cable)) {
        if (control.impedance) *gains = *control.impedance;
        return control.impedance.has_value();
      }
      if (controller.Hold(control.cable, control.rest_length_m)) return !control.impedance;
    }
    if (control.impedance) return false;
    stepper_.SetTarget(control.cable, control.rest_length_m);
    return true;
  }

  const std::vector<ChannelInfo>& channels() const override { return channels_; }

  const std::vector<double>& Row() override {
    const std::vector<double>& recorded =
        recorder_.Row({&batch_, kTheWorld, &stepper_.readings(), &stepper_.sensed(),
                       &stepper_.commands(), &stepper_.timeline()});
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
  struct TimedPush {
    NodeForce force;
    double until_s = 0;
  };

  /// Spring and damper towards the hand. Both act explicitly and are limited so that they stay
  /// stable on the end of a rod, which moves with a quarter of its mass.
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
  plant::Stepper stepper_;
  plant::Recorder recorder_;
  std::vector<ChannelInfo> channels_;
  std::vector<double> row_;
  double mass_kg_ = 0;
  std::optional<HandSpec> hand_;
  Vec3 drag_n_;
  std::vector<TimedPush> pushes_;
};

}  // namespace

std::unique_ptr<LiveRun> LiveRun::Start(const ExperimentSpec& experiment, Diagnostics& out,
                                        const std::function<bool()>& go_on) {
  const auto model = Model::Compile(experiment.robot.def, out);
  if (!model) return nullptr;
  Batch batch(model, {});
  if (!plant::PrepareStart(experiment, batch, out, go_on)) return nullptr;
  return std::make_unique<Live>(experiment, std::move(batch));
}

}  // namespace taut
