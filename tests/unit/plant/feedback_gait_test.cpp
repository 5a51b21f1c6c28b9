// Gaits whose oscillators have feedback from cables and a goal: files, errors, and signals
#include <cmath>

#include "plant/player_kinds.h"
#include "tests/constants.h"
#include "unit/description/experiment_fixture.h"

namespace taut::test {
namespace {

constexpr const char* kGait = R"(taut: 1
kind: gait
name: hearing
drives: rest_length
feedback_cpg:
  frequency_hz: 0.5
  amplitude_gain: 0.5
  phase_gain_rad_per_s: 2
  oscillators:
    - {name: one, cables: left, amplitude_m: 0.02, phase_rad: 0.5, offset_m: 0.01}
    - {name: two, cables: right, amplitude_m: 0.03}
  symmetry: none
  groups:
    - {name: left.right, weight_per_m_s: 20, phase_rad: 0.1}
  goal_network:
    hidden:
      - {name: h1, weights: [2, 0, 0.5]}
      - {name: h2, weights: [0, 3, 0], bias: 0.25}
    outputs:
      - {name: one_phase, weights: [1, -2], bias: 0.5}
)";

class FeedbackGait : public ExperimentFolder {
 protected:
  void Expect(const std::string& old_text, const std::string& new_text,
              const std::string& expected) {
    ChangeFile("g.yaml", kGait, old_text, new_text);
    Diagnostics out;
    EXPECT_FALSE(LoadGait(Path("g.yaml"), out));
    EXPECT_EQ(Without("g.yaml:", Without(Path(""), out.Format())), expected + "\n");
  }
  GaitSpec LoadText(const std::string& text) {
    Write("g.yaml", text);
    Diagnostics out;
    const auto gait = LoadGait(Path("g.yaml"), out);
    EXPECT_TRUE(gait) << out.Format();
    return gait.value_or(GaitSpec{});
  }
  /// Returns the errors of the experiment with a controller that plays the gait, and more keys.
  std::string PlayedComplaints(const std::string& gait, const std::string& keys) {
    Write("g.yaml", gait);
    std::string text = kExperiment;
    const std::size_t from = text.find("controllers:"), to = text.find("timeline:");
    text.replace(from, to - from,
                 keys + "controllers:\n  - {name: hold, rest_length_input: {gait: g.yaml}}\n");
    Write("trial.yaml", text);
    return Complaints();
  }
};

constexpr const char* kGoal = "goal: {at_m: [3, 0, 0], body: a}\n";

TEST_F(FeedbackGait, WhatIsWrittenIsReadBack) {
  GaitSpec gait = LoadText(kGait);
  const std::string text = GaitYaml(gait);
  GaitSpec again = LoadText(text);
  EXPECT_EQ(GaitYaml(again), text);
  const auto numbers = GaitValues(gait), numbers_again = GaitValues(again);
  ASSERT_EQ(numbers.size(), numbers_again.size());
  std::string names;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(*numbers[i].value, *numbers_again[i].value) << numbers[i].name;
    names += numbers[i].name + " ";
  }
  for (const char* name :
       {"feedback_cpg.one.amplitude_m ", "feedback_cpg.left.right.weight_per_m_s ",
        "feedback_cpg.goal_network.h1.weights_3 ", "feedback_cpg.goal_network.h2.bias ",
        "feedback_cpg.goal_network.one_phase.weights_2 "}) {
    EXPECT_NE(names.find(name), names.npos) << name;
  }
}

TEST_F(FeedbackGait, AResolvedExperimentHasItAndItsGoal) {
  EXPECT_EQ(PlayedComplaints(kGait, kGoal), "");
  ExperimentSpec experiment = Load();
  Write("resolved.yaml", ResolvedYaml(experiment));
  ExperimentSpec again = Load("resolved.yaml");
  ASSERT_TRUE(again.goal);
  EXPECT_EQ(again.goal->at_m.x, 3.0);
  EXPECT_EQ(again.goal->body, 0);
  EXPECT_EQ(GaitYaml(again.controllers[0].rest_length_input->gait),
            GaitYaml(experiment.controllers[0].rest_length_input->gait));
}

TEST_F(FeedbackGait, WrongNetworksAreAnswered) {
  Expect("[2, 0, 0.5]", "[2, 0, 0.5, 1]",
         "17:9: error: neuron h1 has 4 weights, but there are 2 or 3 inputs: goal_x, goal_y, and "
         "optionally place");
  Expect("[0, 3, 0]", "[0, 3]",
         "18:9: error: goal_network: neuron h2 has 2 weights, but h1 has 3 (all hidden neurons "
         "must have the same inputs)");
  Expect("[1, -2]", "[1]",
         "20:9: error: neuron one_phase has 1 weights, but there are 2 hidden neurons");
  Expect("name: one_phase", "name: one_phas",
         "20:9: error: goal_network.outputs: there is no output called one_phas (did you mean "
         "\"one_phase\"?)");
  Expect("name: h2", "name: h1",
         "18:9: error: two hidden neurons are called h1 (the first is in line 17)");
  Expect("name: h1", "name: one_phase",
         "20:9: error: a hidden neuron and an output are both called one_phase (give each neuron a "
         "different name: parameters are named after neurons)");
  Expect("weights: [1, -2]", "weights: [1, x]",
         "20:40: error: neuron.weights: unknown name \"x\" (no parameters are defined)");
  Expect("name: two", "name: one",
         "11:7: error: two oscillators are called one (the first is in line 10)");
}

TEST_F(FeedbackGait, HiddenNeuronsAre32AtMost) {
  std::string more;
  for (int i = 2; i <= 33; ++i) {
    more += "      - {name: h" + std::to_string(i) + ", weights: [0, 3, 0]}\n";
  }
  ChangeFile("g.yaml", kGait, "      - {name: h2, weights: [0, 3, 0], bias: 0.25}\n", more);
  Diagnostics out;
  EXPECT_FALSE(LoadGait(Path("g.yaml"), out));
  EXPECT_NE(out.Format().find("error: goal_network.hidden must have 1 to 32 neurons, got 33\n"),
            std::string::npos)
      << out.Format();
}

TEST_F(FeedbackGait, WhatDoesNotFitTheRobotIsAnswered) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = kGait;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(PlayedComplaints(changed("cables: right", "cables: driven"), kGoal),
            "g.yaml:11:7: error: oscillators two: left already has an oscillator, of one (a cable "
            "can have only one oscillator)\n");
  EXPECT_EQ(PlayedComplaints(changed("left.right", "left.top"), kGoal),
            "g.yaml:14:7: error: feedback_cpg.groups: pair has no group left.top (one of: "
            "left.right, right.left)\n");
  EXPECT_EQ(PlayedComplaints(kGait, ""),
            "g.yaml:16:5: error: gait hearing has a goal_network, but the experiment has no `goal` "
            "(add its position and the tracked body: `goal: {at_m: [3.5, 0, 0], body: ...}`)\n");
}

/// A gait alone in some lanes, with its feedback set by the test
struct Playing {
  Playing(const std::vector<const GaitSpec*>& gaits, const RobotSpec& robot) {
    plant::GaitSetup setup;
    setup.gaits = gaits;
    setup.period_s = 0.01;
    Diagnostics out;
    setup.resolved = ResolveGait(*gaits[0], robot, out).value_or(ResolvedGait{});
    EXPECT_TRUE(out.ok()) << out.Format();
    player = plant::PlayerOf(setup);
    lanes = static_cast<int>(gaits.size());
    number.resize(gaits.size());
    time_s.resize(gaits.size());
    goal.resize(2 * gaits.size());
    cables.resize(3 * gaits.size(), 0.2);
  }
  void Tick(int ticks) {
    Observation seen;
    seen.lanes = lanes;
    seen.goal = goal.data();
    seen.cables.length_m = seen.cables.tension_n = cables.data();
    for (int i = 0; i < ticks; ++i) {
      player->Tick({AllLanes(lanes), number.data(), time_s.data(), time_s.data()}, seen);
      for (std::int64_t& n : number) ++n;
    }
  }
  std::unique_ptr<plant::GaitPlayer> player;
  int lanes = 1;
  std::vector<std::int64_t> number;
  std::vector<double> time_s, goal, cables;
};

// Without couplings the phase is 2 pi v t + k_p f_p t from the second tick on, because feedback at
// a tick acts from that tick on; f_p is the network's output, computed here with library functions.
TEST_F(FeedbackGait, TheGoalHastensItsOscillator) {
  Write("g.yaml", kGait);
  PlayedComplaints(kGait, kGoal);
  const ExperimentSpec experiment = Load();
  GaitSpec gait = experiment.controllers[0].rest_length_input->gait;
  gait.feedback_cpg->groups.clear();
  Playing playing({&gait}, experiment.robot);
  playing.goal = {0.6, -0.8};
  playing.Tick(1);
  const auto sigma = [](double x) { return 1.0 / (1.0 + std::exp(-x)); };
  EXPECT_NEAR(playing.player->signal()[0], 0.01 + 0.02 * std::cos(0.5), 1e-15);
  EXPECT_NEAR(playing.player->signal()[1], 0.03, 1e-15);
  playing.Tick(40);
  // one joint: its place is 0
  const double says = 2.0 * sigma(sigma(2.0 * 0.6) - 2.0 * sigma(3.0 * -0.8 + 0.25) + 0.5) - 1.0;
  const double t = 0.4;
  EXPECT_NEAR(playing.player->signal()[0],
              0.01 + 0.02 * std::cos(0.5 + kTwoPi * 0.5 * t + 2.0 * says * t), 1e-12);
  EXPECT_NEAR(playing.player->signal()[1], 0.03 * std::cos(kTwoPi * 0.5 * t), 1e-12);
}

TEST_F(FeedbackGait, ALaneHearsItsOwnGoalAndHasItsOwnWeights) {
  PlayedComplaints(kGait, kGoal);
  const ExperimentSpec experiment = Load();
  std::vector<GaitSpec> gaits(4, experiment.controllers[0].rest_length_input->gait);
  std::vector<const GaitSpec*> pointers;
  for (std::size_t j = 0; j < gaits.size(); ++j) {
    gaits[j].feedback_cpg->goal_network->hidden[1].weights[0] = 0.3 * static_cast<double>(j);
    pointers.push_back(&gaits[j]);
  }
  Playing together(pointers, experiment.robot);
  for (std::size_t j = 0; j < 4; ++j) {
    together.goal[j] = 0.2 * static_cast<double>(j);
    together.goal[4 + j] = -0.5;
  }
  together.Tick(30);
  for (std::size_t j = 0; j < 4; ++j) {
    Playing alone({pointers[j]}, experiment.robot);
    alone.goal = {0.2 * static_cast<double>(j), -0.5};
    alone.Tick(30);
    EXPECT_EQ(together.player->signal()[j], alone.player->signal()[0]) << j;
    EXPECT_EQ(together.player->signal()[4 + j], alone.player->signal()[1]) << j;
    EXPECT_NE(together.player->signal()[j], together.player->signal()[(j + 1) % 4]) << j;
  }
  // A restarted lane repeats its signal; the other lanes are not affected.
  const std::vector<double> before = together.player->signal();
  together.player->Restart(2, gaits[2]);
  together.number[2] = 0;
  together.Tick(30);
  EXPECT_EQ(together.player->signal()[2], before[2]);
}

// The feedback of the amplitude is the output of a cable's network for its stretch and its tension.
TEST_F(FeedbackGait, CablesAreHeard) {
  std::string text = kGait;
  const std::size_t from = text.find("  goal_network");
  text.replace(from, text.size() - from, R"(  cable_network:
    hidden:
      - {name: h1, weights: [10, 4]}
    outputs:
      - {name: amplitude, weights: [3], bias: -1}
)");
  ChangeFile("model.yaml", kModel, "max_speed_m_per_s: 0.1",
             "max_speed_m_per_s: 0.1, max_force_n: 2");
  EXPECT_EQ(PlayedComplaints(text, ""), "");
  const ExperimentSpec experiment = Load();
  const GaitSpec& gait = experiment.controllers[0].rest_length_input->gait;
  Playing playing({&gait}, experiment.robot);
  playing.Tick(1);
  playing.cables = {0.25, 0.25, 0.25};  // lengths, and in this test also tensions
  playing.Tick(3000);
  const auto sigma = [](double x) { return 1.0 / (1.0 + std::exp(-x)); };
  const double says = 2.0 * sigma(3.0 * sigma(10.0 * 0.25 + 4.0 * (0.25 - 1.0) / 2.0) - 1.0) - 1.0;
  double most = 0;
  for (int i = 0; i < 400; ++i) {
    playing.Tick(1);
    most = std::max(most, playing.player->signal()[1]);
  }
  EXPECT_NEAR(most, 0.03 * std::sqrt(1.0 + 0.5 * says), 1e-5);
}

TEST_F(FeedbackGait, ACableWithoutALimitOfForceHasNothingToSetItsTensionBeside) {
  std::string text = kGait;
  const std::size_t from = text.find("  goal_network");
  text.replace(from, text.size() - from,
               "  cable_network: {hidden: [{name: h, weights: [1, 1]}], outputs: []}\n");
  EXPECT_EQ(PlayedComplaints(text, ""),
            "g.yaml:15:18: error: cable_network: the actuator of left has no max_force_n, to which "
            "the network's input is relative (add max_force_n, or leave out `cable_network`)\n");
}

}  // namespace
}  // namespace taut::test
