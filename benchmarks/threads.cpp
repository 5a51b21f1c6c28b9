// Speedup by threads: thread_gain [ROBOT] [THREADS] [WORLDS] [STEPS A CALL]. Prints JSON.
//
// One thread and several threads take turns of a few calls, so that other load on the machine
// affects both. Each round yields a ratio; the result is their median. A round is undisturbed if
// none of the threads lost its core to another process, and all of them had a core most of the
// time. On a shared machine only these rounds show the cost of threads.
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
// Of one thread: short compared with disturbances on this machine.
constexpr double kRoundS = 0.002;

/// Returns the number of times that threads of this process lost their cores.
long Disturbances() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_nivcsw;
}

/// Returns the processor time of all threads of this process [s].
double WorkedS() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Worlds that all receive new rest lengths before every call.
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

/// Returns quartile 0 to 4; 0 for an empty list.
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
    several.Seconds(1);  // wakes the threads up after idle time
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
