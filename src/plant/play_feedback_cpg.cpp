#include "plant/oscillators.h"
#include "taut/control/network.h"
#include "taut/control/turns.h"

namespace taut::plant {
namespace {

/// Number of feedback values per oscillator: frequency, amplitude, phase.
constexpr std::size_t kSaid = 3;
static_assert(NetworkSpec::kMostHidden == kMostHidden);
constexpr const char* kSaidNames[kSaid] = {"frequency", "amplitude", "phase"};

/// Neural network, evaluated in all lanes. Without a network, all outputs are 0.
class LaneNetwork {
 public:
  /// Sets the size from the first lane's network. `outputs`: names of all possible outputs.
  void Shape(const std::optional<NetworkSpec>& spec, std::vector<std::string> outputs,
             std::size_t lanes) {
    lanes_ = lanes;
    outputs_ = std::move(outputs);
    said_.assign(outputs_.size() * lanes, 0.0);
    if (!spec) return;
    shape_ = {static_cast<int>(spec->hidden[0].weights.size()),
              static_cast<int>(spec->hidden.size()), static_cast<int>(outputs_.size())};
    weights_.assign(static_cast<std::size_t>(control::WeightCount(shape_)) * lanes, 0.0);
    inputs_.assign(static_cast<std::size_t>(shape_.inputs) * lanes, 0.0);
  }
  bool there() const noexcept { return shape_.inputs > 0; }
  int inputs() const noexcept { return shape_.inputs; }

  void SetNumbers(std::size_t lane, const std::optional<NetworkSpec>& spec) {
    if (!there() || !spec) return;
    std::size_t n = 0;
    const auto put = [&](double weight) { weights_[n++ * lanes_ + lane] = weight; };
    for (const Neuron& neuron : spec->hidden) {
      for (const double weight : neuron.weights) put(weight);
      put(neuron.bias);
    }
    for (const std::string& name : outputs_) {
      const auto found = std::find_if(spec->outputs.begin(), spec->outputs.end(),
                                      [&](const Neuron& neuron) { return neuron.name == name; });
      for (std::size_t j = 0; j < spec->hidden.size(); ++j) {
        put(found == spec->outputs.end() ? 0.0 : found->weights[j]);
      }
      put(found == spec->outputs.end() ? 0.0 : found->bias);
    }
  }

  double& Input(std::size_t i, std::size_t lane) { return inputs_[i * lanes_ + lane]; }
  void Say(const LaneKernel& kernel) {
    kernel.network({shape_.inputs, shape_.hidden, shape_.outputs, weights_.data()}, inputs_.data(),
                   said_.data());
  }
  double Said(std::size_t k, std::size_t lane) const { return said_[k * lanes_ + lane]; }

 private:
  control::NetworkShape shape_{0, 0, 0};
  std::size_t lanes_ = 1;
  std::vector<std::string> outputs_;
  std::vector<double> weights_, inputs_, said_;
};

/// Central pattern generator with feedback from cables and from the goal's direction
/// (docs/theory/gaits.md).
class FeedbackCpgPlayer final : public OscillatorPlayer {
 public:
  explicit FeedbackCpgPlayer(const GaitSetup& setup)
      : OscillatorPlayer(setup, setup.gaits[0]->feedback_cpg->integrator_step_s),
        found_(setup.resolved) {
    const FeedbackCpgGait& cpg = *setup.gaits[0]->feedback_cpg;
    for (std::vector<double>* row :
         {&frequency_hz_, &start_turns_, &amplitude_, &convergence_per_s_, &frequency_gain_,
          &amplitude_gain_, &phase_gain_, &offset_, &first_length_m_}) {
      row->resize(signal_.size());
    }
    feedback_.resize(kSaid * signal_.size());
    for (std::vector<double>* row : {&weight_, &coupling_turns_}) {
      row->resize(found_.graph.couplings.size() * setup.gaits.size());
    }
    of_cable_.Shape(cpg.cable_network, {std::begin(kSaidNames), std::end(kSaidNames)},
                    setup.gaits.size());
    std::vector<std::string> names;
    for (const FeedbackOscillator& oscillator : cpg.oscillators) {
      for (const char* said : kSaidNames) names.push_back(oscillator.name + "_" + said);
    }
    of_goal_.Shape(cpg.goal_network, std::move(names), setup.gaits.size());
    Prepare(setup, kernel().feedback_cpg_bytes(count(), couplings()));
  }

  void Serialize(LaneState& state) override {
    OscillatorPlayer::Serialize(state);
    state.Row(first_length_m_);
    state.Row(feedback_);
  }

 private:
  double* States() const override {
    return kernel().feedback_cpg_states(count(), couplings(), memory());
  }
  FeedbackCpgRows Rows() const {
    return {count(),
            couplings(),
            frequency_hz_.data(),
            start_turns_.data(),
            amplitude_.data(),
            convergence_per_s_.data(),
            frequency_gain_.data(),
            amplitude_gain_.data(),
            phase_gain_.data(),
            to(),
            from(),
            weight_.data(),
            coupling_turns_.data()};
  }

  void SetNumbers(int lane, const GaitSpec& gait) override {
    const FeedbackCpgGait& cpg = *gait.feedback_cpg;
    for (std::size_t i = 0; i < cables().size(); ++i) {
      const std::size_t at = At(i, lane);
      const FeedbackOscillator& own = cpg.oscillators[static_cast<std::size_t>(found_.role[i])];
      frequency_hz_[at] = cpg.frequency_hz;
      start_turns_[at] = control::WrapTurns(own.phase_rad * control::kTurnsPerRad);
      amplitude_[at] = own.amplitude;
      offset_[at] = own.offset;
      convergence_per_s_[at] = cpg.convergence_per_s;
      frequency_gain_[at] = cpg.frequency_gain_hz_per_s;
      amplitude_gain_[at] = cpg.amplitude_gain;
      phase_gain_[at] = cpg.phase_gain_rad_per_s * control::kTurnsPerRad;
    }
    for (std::size_t k = 0; k < found_.graph.couplings.size(); ++k) {
      const CouplingGroup& group =
          cpg.groups[static_cast<std::size_t>(found_.graph.couplings[k].group)];
      weight_[At(k, lane)] = group.weight;
      coupling_turns_[At(k, lane)] = control::WrapTurns(group.phase_rad * control::kTurnsPerRad);
    }
    of_cable_.SetNumbers(static_cast<std::size_t>(lane), cpg.cable_network);
    of_goal_.SetNumbers(static_cast<std::size_t>(lane), cpg.goal_network);
  }

  double& Feedback(std::size_t i, std::size_t said, int lane) {
    return feedback_[At(kSaid * i + said, lane)];
  }
  std::size_t CableAt(std::size_t i, int lane) const {
    return At(static_cast<std::size_t>(cables()[i]), lane);
  }

  void StartKernel() override { kernel().feedback_cpg_start(Rows(), memory()); }

  void TickKernel(int steps) override {
    kernel().feedback_cpg_tick(count(), couplings(), memory(), feedback_.data(),
                               integrator_step_s(), steps, offset_.data(), signal_.data());
  }

  void Forget(int lane) override {
    for (std::size_t k = 0; k < kSaid * cables().size(); ++k) feedback_[At(k, lane)] = 0.0;
  }

  void Begin(Lanes first, const Observation& seen) override {
    if (!of_cable_.there()) return;
    for (std::size_t i = 0; i < cables().size(); ++i) {
      for (int j = 0; j < lanes(); ++j) {
        if (Has(first, j)) first_length_m_[At(i, j)] = seen.cables.length_m[CableAt(i, j)];
      }
    }
  }

  /// Computes the feedback of all oscillators from the network outputs.
  void Hear(Lanes due, const Observation& seen) override {
    if (!of_cable_.there() && !of_goal_.there()) return;
    for (int j = 0; j < lanes(); ++j) {
      for (std::size_t i = 0; Has(due, j) && i < kSaid * cables().size(); ++i) {
        feedback_[At(i, j)] = 0.0;
      }
    }
    if (of_cable_.there()) HearCables(due, seen);
    if (of_goal_.there()) HearGoal(due, seen);
  }

  void HearCables(Lanes due, const Observation& seen) {
    for (std::size_t i = 0; i < cables().size(); ++i) {
      const double most_n = found_.most_tension_n[i];
      for (int j = 0; j < lanes(); ++j) {
        const auto lane = static_cast<std::size_t>(j);
        const std::size_t cable = CableAt(i, j);
        const double first_m = first_length_m_[At(i, j)];
        of_cable_.Input(0, lane) = (seen.cables.length_m[cable] - first_m) / first_m;
        of_cable_.Input(1, lane) = (seen.cables.tension_n[cable] - 0.5 * most_n) / most_n;
      }
      of_cable_.Say(kernel());
      AddSaid(of_cable_, 0, i, due);
    }
  }

  /// Evaluates the goal network for one joint after the other. Without a goal sensor, the goal
  /// inputs are (0, 0).
  void HearGoal(Lanes due, const Observation& seen) {
    for (std::size_t joint = 0; joint < found_.place.size(); ++joint) {
      for (int j = 0; j < lanes(); ++j) {
        const auto lane = static_cast<std::size_t>(j);
        of_goal_.Input(0, lane) = seen.goal ? seen.goal[At(0, j)] : 0.0;
        of_goal_.Input(1, lane) = seen.goal ? seen.goal[At(1, j)] : 0.0;
        if (of_goal_.inputs() > 2) of_goal_.Input(2, lane) = found_.place[joint];
      }
      of_goal_.Say(kernel());
      for (std::size_t i = 0; i < cables().size(); ++i) {
        if (static_cast<std::size_t>(found_.joint[i]) != joint) continue;
        AddSaid(of_goal_, kSaid * static_cast<std::size_t>(found_.role[i]), i, due);
      }
    }
  }

  void AddSaid(const LaneNetwork& network, std::size_t from, std::size_t i, Lanes due) {
    for (int j = 0; j < lanes(); ++j) {
      for (std::size_t said = 0; Has(due, j) && said < kSaid; ++said) {
        Feedback(i, said, j) += network.Said(from + said, static_cast<std::size_t>(j));
      }
    }
  }

  ResolvedGait found_;  ///< The same in all lanes.
  std::vector<double> frequency_hz_, start_turns_, amplitude_, convergence_per_s_, frequency_gain_,
      amplitude_gain_, phase_gain_, offset_, weight_, coupling_turns_;
  LaneNetwork of_cable_, of_goal_;
  std::vector<double> first_length_m_;
  std::vector<double> feedback_;  ///< Row kSaid * oscillator + input.
};

}  // namespace

std::unique_ptr<GaitPlayer> MakeFeedbackCpg(const GaitSetup& setup) {
  if (!setup.gaits[0]->feedback_cpg) return nullptr;
  return std::make_unique<FeedbackCpgPlayer>(setup);
}

}  // namespace taut::plant
