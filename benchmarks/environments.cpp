// Overhead of environments: env_speed EXPERIMENT [WORLDS] [STEPS A PERIOD] [ROUNDS]. Prints JSON.
//
// "bare" is a batch that receives the same rest lengths and only runs WorldBatch::Step; the program
// checks that its worlds have the same bits. "singles": as many environments of one world each, one
// after the other. All variants take turns of a few milliseconds, so that other load on the machine
// affects all of them. Each round yields ratios of processor time; results are their medians. Two
// threads are compared by wall-clock time, in rounds in which no thread lost its core.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "taut/env.h"

namespace taut {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kRoundS = 0.01;
constexpr int kActionSets = 8;

double WallS() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }
/// Returns the processor time of all threads of the process [s].
double WorkedS() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}
long Disturbances() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_nivcsw;
}

/// Actions of some steps, all different, and the equivalent rest lengths.
struct Deeds {
  std::vector<std::vector<float>> actions;
  std::vector<std::vector<double>> targets_m;
};

Deeds DeedsOf(const ExperimentSpec& experiment, int worlds) {
  const auto& actions = experiment.environment->actions;
  const std::vector<CableDef>& cables = experiment.robot.def.cables;
  Deeds deeds;
  std::uint32_t random = 1;
  for (int set = 0; set < kActionSets; ++set) {
    std::vector<float>& row = deeds.actions.emplace_back();
    std::vector<double>& targets = deeds.targets_m.emplace_back();
    for (int w = 0; w < worlds; ++w) {
      for (const CableDef& cable : cables) targets.push_back(cable.rest_length_m);
      for (const EnvironmentAction& action : actions) {
        random = random * 1664525u + 1013904223u;
        row.push_back(static_cast<float>(static_cast<int>(random >> 25) - 64) / 128.0f);
        double& target =
            targets[targets.size() - cables.size() + static_cast<std::size_t>(action.cable)];
        target = std::max(target + *action.rest_length_m * static_cast<double>(row.back()), 0.0);
      }
    }
  }
  return deeds;
}

/// Environments that are stepped one after the other.
class Envs {
 public:
  Envs(const ExperimentSpec& experiment, int count, int worlds, int threads) {
    for (int i = 0; i < count; ++i) {
      Diagnostics out;
      envs_.push_back(
          Env::Create(experiment, {.worlds = worlds, .threads = threads, .randomise = false}, out));
      if (!envs_.back()) throw std::string(out.Format());
    }
    const Env& env = *envs_[0];
    const auto rows = static_cast<std::size_t>(worlds);
    width_ = rows * env.action_channels().size();
    observations_.resize(rows * env.observation_channels().size());
    rewards_.resize(rows);
    flags_.resize(2 * rows);
  }
  void Step(const std::vector<float>& actions) {
    const std::size_t worlds = rewards_.size();
    const EnvStep<float> out{observations_, rewards_, std::span(flags_).first(worlds),
                             std::span(flags_).last(worlds)};
    for (std::size_t i = 0; i < envs_.size(); ++i) {
      envs_[i]->Step(std::span(actions).subspan(i * width_, width_), out);
    }
  }
  const Env& env() const { return *envs_[0]; }

 private:
  std::vector<std::unique_ptr<Env>> envs_;
  std::size_t width_ = 0;
  std::vector<float> observations_;
  std::vector<double> rewards_;
  std::vector<std::uint8_t> flags_;
};

/// Performs periods one after the other and measures the cost of several.
class Runner {
 public:
  template <class Step>
  Runner(Step step, int periods) : step_(std::move(step)), periods_(periods) {}
  struct Cost {
    double worked_s = 0, wall_s = 0;
    bool disturbed = false;
  };
  Cost Run() {
    step_(next_++ % kActionSets);  // warm-up
    const long before = Disturbances();
    const double worked_s = WorkedS(), wall_s = WallS();
    for (int i = 0; i < periods_; ++i) step_(next_++ % kActionSets);
    return {WorkedS() - worked_s, WallS() - wall_s, Disturbances() != before};
  }
  std::int64_t periods() const { return next_; }

 private:
  std::function<void(std::size_t)> step_;
  int periods_;
  std::size_t next_ = 0;
};

double Quartile(std::vector<double> list, int quartile) {
  if (list.empty()) return 0;
  std::sort(list.begin(), list.end());
  return list[(list.size() - 1) * static_cast<std::size_t>(quartile) / 4];
}

void Print(const char* name, const std::vector<double>& ratios) {
  std::printf("\"%s\": {\"rounds\": %zu, \"median\": %.3f, \"quartiles\": [%.3f, %.3f]}", name,
              ratios.size(), Quartile(ratios, 2), Quartile(ratios, 1), Quartile(ratios, 3));
}

int Main(int argc, char** argv) {
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::max(1, std::atoi(argv[i])) : otherwise;
  };
  Diagnostics out;
  auto experiment = argc > 1 ? LoadExperiment(argv[1], {}, out) : std::nullopt;
  const int worlds = number(2, 256), steps = number(3, 10), rounds = number(4, 101);
  const auto model = experiment ? Model::Compile(experiment->robot.def, out) : nullptr;
  if (!model) {
    std::fprintf(stderr, "usage: env_speed EXPERIMENT [WORLDS] [STEPS A PERIOD] [ROUNDS]\n%s",
                 out.Format().c_str());
    return 2;
  }
  const double step_s = experiment->step_s;
  experiment->environment->period_s = steps * step_s;
  experiment->duration_s = 1e5 * steps * step_s;
  // Work and tensions are measured after every step, not once per period; this is a separate
  // variant.
  ExperimentSpec measured = *experiment;
  measured.environment->max_tension_n = 1e9;
  experiment->environment->max_tension_n.reset();
  experiment->environment->reward.work_penalty_per_j = 0;
  experiment->environment->reward.tension_limit.reset();
  const Deeds deeds = DeedsOf(*experiment, worlds);

  Envs many(*experiment, 1, worlds, 1), two(*experiment, 1, worlds, 2);
  Envs costly(measured, 1, worlds, 1);
  const int single_count = std::min(worlds, 64);
  Envs few(*experiment, 1, single_count, 1), singles(*experiment, single_count, 1, 1);
  WorldBatch bare(model, {.worlds = worlds, .threads = 1, .simd = BestSimd()});
  const auto calls = [&](int of) {
    const double guess_s = 2e-6 * of * steps;
    return std::max(1, static_cast<int>(kRoundS / guess_s));
  };
  Runner of_many([&](std::size_t k) { many.Step(deeds.actions[k]); }, calls(worlds));
  Runner of_costly([&](std::size_t k) { costly.Step(deeds.actions[k]); }, calls(worlds));
  Runner of_two([&](std::size_t k) { two.Step(deeds.actions[k]); }, calls(worlds));
  Runner of_few([&](std::size_t k) { few.Step(deeds.actions[k]); }, calls(single_count));
  Runner of_singles([&](std::size_t k) { singles.Step(deeds.actions[k]); }, 1);
  Runner of_bare([&](std::size_t k) { bare.Step(step_s, steps, deeds.targets_m[k]); },
                 calls(worlds));
  std::vector<double> share, share_measured, gain, of_single, rate;
  for (int round = 0; round < rounds; ++round) {
    const auto bare_cost = of_bare.Run(), many_cost = of_many.Run();
    share.push_back(bare_cost.worked_s / many_cost.worked_s);
    share_measured.push_back(bare_cost.worked_s / of_costly.Run().worked_s);
    rate.push_back(calls(worlds) * worlds / many_cost.worked_s);
    const auto two_cost = of_two.Run();
    if (!many_cost.disturbed && !two_cost.disturbed && two_cost.worked_s > 1.4 * two_cost.wall_s) {
      gain.push_back(many_cost.wall_s / two_cost.wall_s);
    }
    if (round % 4 != 0) continue;
    const auto few_cost = of_few.Run(), singles_cost = of_singles.Run();
    of_single.push_back(singles_cost.worked_s / few_cost.worked_s * calls(single_count));
  }
  const bool same = many.env().Hash(worlds - 1) == bare.Hash(worlds - 1);
  std::printf(
      "{\"worlds\": %d, \"lanes\": %d, \"steps_a_period\": %d, \"actions\": %zu, "
      "\"observations\": %zu, \"same_bits\": %s, \"env_steps_per_s\": %.4g,\n ",
      worlds, many.env().lanes(), steps, many.env().action_channels().size(),
      many.env().observation_channels().size(), same ? "true" : "false", Quartile(rate, 2));
  Print("share_of_bare", share);
  std::printf(",\n ");
  Print("share_with_work_measured", share_measured);
  std::printf(",\n ");
  Print("over_singles", of_single);
  std::printf(",\n ");
  Print("two_threads", gain);
  std::printf("}\n");
  return same ? 0 : 1;
}

}  // namespace
}  // namespace taut

int main(int argc, char** argv) {
  try {
    return taut::Main(argc, argv);
  } catch (const std::string& what) {
    std::fprintf(stderr, "%s", what.c_str());
    return 2;
  }
}
