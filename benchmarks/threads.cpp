// What more threads gain: thread_gain [ROBOT] [THREADS] [WORLDS] [STEPS A CALL]. Prints JSON.
//
// One thread and several take turns, a few calls each, so that what else the machine does meets
// both. Each round gives a ratio; what counts is their median. A round is undisturbed if none of
// our threads had to give its core to somebody else and all of them had one at all, most of the
// time: on a machine that others use, too, only those say what the threads cost each other.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "benchmarks/robots.h"

namespace taut::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kSettlePeriods = 300, kRounds = 501;
constexpr double kRoundS = 0.002;  // of one thread: short beside what others do here

/// How often threads of ours were taken off their cores.
long Disturbances() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_nivcsw;
}

/// Processor's time of all our threads.
double WorkedS() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Worlds that all get new rest lengths before every call.
class Worlds {
 public:
  Worlds(const ModelDef& def, int threads, int worlds, int steps)
      : runner_(def, {.worlds = worlds, .threads = threads, .simd = BestSimd()}, steps) {
    runner_.Run(kSettlePeriods * kControlSteps / steps);
  }
  double Seconds(int calls) {
    const auto start = Clock::now();
    runner_.Run(calls);
    return std::chrono::duration<double>(Clock::now() - start).count();
  }

 private:
  TautRunner runner_;
};

/// Quartile 0 to 4; 0 of nothing.
double Quartile(std::vector<double> list, int quartile) {
  if (list.empty()) return 0;
  std::sort(list.begin(), list.end());
  return list[(list.size() - 1) * static_cast<std::size_t>(quartile) / 4];
}

int Main(int argc, char** argv) {
  const auto number = [&](int i, int otherwise) {
    return argc > i ? std::max(1, std::atoi(argv[i])) : otherwise;
  };
  const std::string robot = argc > 1 ? argv[1] : "tetraspine3";
  const int threads = number(2, 2), worlds = number(3, 128), steps = number(4, kControlSteps);
  const ModelDef def = OnGround(robot);
  Worlds one(def, 1, worlds, steps), several(def, threads, worlds, steps);
  const double call_s = one.Seconds(20) / 20;
  const int calls = std::max(1, static_cast<int>(kRoundS / call_s));
  std::vector<double> all, undisturbed, one_s, several_s;
  for (int round = 0; round < kRounds; ++round) {
    one.Seconds(1);
    long before = Disturbances();
    const double one_took_s = one.Seconds(calls);
    const bool one_disturbed = Disturbances() != before;
    several.Seconds(1);  // they have been idle, and may sleep
    before = Disturbances();
    const double worked_before_s = WorkedS();
    const double several_took_s = several.Seconds(calls);
    all.push_back(one_took_s / several_took_s);
    const double cores = (WorkedS() - worked_before_s) / several_took_s;
    if (one_disturbed || Disturbances() != before || cores < 1 + 0.4 * (threads - 1)) continue;
    undisturbed.push_back(all.back());
    one_s.push_back(one_took_s / calls);
    several_s.push_back(several_took_s / calls);
  }
  std::printf(
      "{\"robot\": \"%s\", \"threads\": %d, \"worlds\": %d, \"steps_a_call\": %d, "
      "\"gain\": %.3f, \"undisturbed\": {\"rounds\": %zu, \"gain\": %.3f, "
      "\"quartiles\": [%.3f, %.3f], \"call_us\": [%.1f, %.1f]}}\n",
      robot.c_str(), threads, worlds, steps, Quartile(all, 2), undisturbed.size(),
      Quartile(undisturbed, 2), Quartile(undisturbed, 1), Quartile(undisturbed, 3),
      1e6 * Quartile(one_s, 2), 1e6 * Quartile(several_s, 2));
  return 0;
}

}  // namespace
}  // namespace taut::bench

int main(int argc, char** argv) { return taut::bench::Main(argc, argv); }
