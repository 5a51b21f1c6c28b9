#include "taut/live.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/vec.h"
#include "plant/member_watch.h"
#include "taut/simulation.h"

namespace taut {
namespace {

ExperimentSpec RecordingAll(ExperimentSpec experiment) {
  experiment.record.channels.clear();
  return experiment;
}

class Live final : public LiveRun {
 public:
  explicit Live(std::unique_ptr<Simulation> simulation)
      : simulation_(std::move(simulation)),
        watch_(simulation_->def()),
        channels_(simulation_->channels()) {
    for (const char* hand : {"hand/drag/", "hand/push/"}) {
      channels_.push_back({std::string(hand) + "node", "1"});
      for (const char* axis : {"force_x_n", "force_y_n", "force_z_n"}) {
        channels_.push_back({std::string(hand) + axis, "N"});
      }
    }
    row_.resize(channels_.size());
    for (const BodyDef& body : simulation_->def().bodies) {
      if (!body.fixed) mass_kg_ += body.mass_kg;
    }
    Watch();
  }

  bool Step() override {
    if (!simulation_->IsRunning()) return false;
    std::erase_if(pushes_, [&](const auto& p) { return p.until_s <= time_s() + 1e-12; });
    std::vector<ExternalForce> forces;
    for (const TimedPush& push : pushes_) forces.push_back(push.force);
    if (hand_) {
      drag_n_ = HandForce();
      forces.push_back({hand_->node, drag_n_});
    }
    simulation_->SetExternalForces(forces);
    simulation_->Step();
    Watch();
    return true;
  }

  double time_s() const override { return simulation_->Time(); }
  const ExperimentSpec& experiment() const override { return simulation_->experiment(); }
  const Observation& Observe() const override { return simulation_->Observe(); }
  const Commands& commands() const override { return simulation_->commands(); }
  const World* world() const override { return &simulation_->world(); }
  std::vector<Overload> Overloads() const override { return watch_.Overloads(); }
  std::vector<ExternalForce> ExternalForces() const override {
    return simulation_->ExternalForces();
  }

  void SetHand(const std::optional<HandSpec>& hand) override {
    hand_ = hand;
    drag_n_ = {};
  }
  double DragStiffness() const override { return 200.0 * mass_kg_; }
  void Push(const ExternalForce& push, double duration_s) override {
    pushes_.push_back({push, time_s() + duration_s});
  }

  void SetParameter(Parameter parameter, int index, double value) override {
    simulation_->SetParameter(parameter, index, value);
  }
  double GetParameter(Parameter parameter, int index) const override {
    return simulation_->GetParameter(parameter, index);
  }

  std::vector<LiveControl> Controls() const override {
    std::vector<LiveControl> controls;
    for (std::size_t c = 0; c < simulation_->def().cables.size(); ++c) {
      if (!IsDriven(c)) continue;
      const int cable = static_cast<int>(c);
      controls.push_back({cable, simulation_->Gains(cable), simulation_->RestLengthCommand(cable)});
    }
    return controls;
  }

  bool SetControl(const LiveControl& control) override {
    const int cable = control.cable;
    if (cable < 0 || static_cast<std::size_t>(cable) >= simulation_->def().cables.size() ||
        !IsDriven(static_cast<std::size_t>(cable)) ||
        control.impedance.has_value() != simulation_->Gains(cable).has_value()) {
      return false;
    }
    if (control.impedance) return simulation_->SetGains(*control.impedance);
    simulation_->SetRestLength(cable, control.rest_length_m);
    return true;
  }

  const std::vector<ChannelInfo>& channels() const override { return channels_; }

  const std::vector<double>& Row() override {
    const std::vector<double>& recorded = simulation_->Row();
    double* out = std::copy(recorded.begin(), recorded.end(), row_.data());
    ExternalForce push{-1, {}};
    for (const TimedPush& one : pushes_) {
      push = {one.force.node, push.force_n + one.force.force_n};
    }
    const ExternalForce drag{hand_ ? hand_->node : -1, drag_n_};
    for (const ExternalForce& force : {drag, push}) {
      const Vec3& f = force.force_n;
      for (const double value : {static_cast<double>(force.node), f.x, f.y, f.z}) *out++ = value;
    }
    return row_;
  }

 private:
  struct TimedPush {
    ExternalForce force;
    double until_s = 0;
  };

  bool IsDriven(std::size_t cable) const {
    return simulation_->def().cables[cable].actuator.kind != ActuatorDef::Kind::kNone;
  }

  void Watch() {
    if (watch_.empty()) return;  // saves the observation, which is expensive
    watch_.Take(time_s(), simulation_->Observe(), world());
  }

  /// Returns the force of a spring and damper between node and hand. Stiffness and damping are
  /// limited so that explicit integration is stable, even at the end of a rod, where the effective
  /// mass is a quarter of the rod's mass.
  Vec3 HandForce() const {
    const NodeDef& node = simulation_->def().nodes[static_cast<std::size_t>(hand_->node)];
    if (node.body == kWorld) return {};
    const double mass_kg = GetParameter(Parameter::kBodyMass, node.body);
    const double step_s = experiment().step_s;
    const double stiffness = std::min(DragStiffness(), 0.05 * mass_kg / (step_s * step_s));
    const double damping = std::min(2.0 * std::sqrt(stiffness * mass_kg), 0.2 * mass_kg / step_s);
    const Vec3 stretch = hand_->target_m - simulation_->NodePosition(hand_->node);
    return stiffness * stretch - damping * simulation_->NodeVelocity(hand_->node);
  }

  std::unique_ptr<Simulation> simulation_;
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
  auto simulation = Simulation::Create(RecordingAll(experiment),
                                       {.extensions = extensions, .keep_going = go_on}, out);
  return simulation ? std::make_unique<Live>(std::move(simulation)) : nullptr;
}

}  // namespace taut
