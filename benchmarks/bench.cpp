// Benchmarks of taut, MuJoCo, Bullet and ODE on the same robots (Google Benchmark). script/bench
// runs it, computes medians and writes the page docs/performance.md.
//
// With --mjcf REGEX it measures nothing. It prints, as JSON, the inputs for another MuJoCo
// (benchmarks/wasm): all benchmarks of MuJoCo, renamed to that engine, whose names match.
//
// The name of a benchmark is KIND/engine/setting/robot/worlds/lanes/threads; counters contain the
// other results. Every robot stands on the ground, has had time to settle, and moves.
#include <benchmark/benchmark.h>

#include <algorithm>

#include <cstdio>
#include <ctime>
#include <functional>
#include <regex>
#include <thread>

#include "benchmarks/mujoco_files.h"
#include "benchmarks/peers/settings.h"
#include "benchmarks/robots.h"
#include "benchmarks/stage_watch.h"

namespace taut::bench {
namespace {

constexpr int kWorldsPerThread = 64;

using Make = std::function<std::unique_ptr<Runner>()>;
/// Adds counters about the quality of the steps.
using Judge = std::function<void(benchmark::State&, const Runner&)>;

struct Case {
  std::string kind, robot;
  int worlds = 1, lanes = 1, threads = 1;
  std::string engine{}, setting{};
  std::string Name() const {
    return kind + "/" + engine + "/" + setting + "/" + robot + "/" + std::to_string(worlds) + "/" +
           std::to_string(lanes) + "/" + std::to_string(threads);
  }
};

/// Benchmark of the MuJoCo peer for another program.
struct Elsewhere {
  Case what;
  ModelDef def;
  peers::Options options;
  int settle_periods;
};

/// Worlds that persist between calls of a benchmark.
class Standing {
 public:
  Standing(Make make, int settle_periods) : make_(std::move(make)), settle_(settle_periods) {}
  Runner& operator()() {
    if (runner_ == nullptr) {
      runner_ = make_();
      runner_->Run(settle_);
    }
    return *runner_;
  }

 private:
  Make make_;
  int settle_;
  std::unique_ptr<Runner> runner_;
};

double StepsOf(const benchmark::State& state, const Runner& runner) {
  return static_cast<double>(state.iterations()) * kControlSteps * runner.worlds();
}

void Measure(benchmark::State& state, Runner& runner) {
  for (auto _ : state) runner.Run(1);
  state.counters["steps_per_s"] =
      benchmark::Counter(StepsOf(state, runner), benchmark::Counter::kIsRate);
  state.counters["contacts"] = runner.contacts();
  state.counters["converged"] = runner.converged() ? 1 : 0;
  if (auto* const ours = dynamic_cast<TautRunner*>(&runner)) {
    state.counters["bytes_per_world"] = static_cast<double>(ours->batch().BytesPerWorld());
    state.counters["linear_solves"] = ours->batch().Status(0).linear_solves;
  }
}

/// Returns the clock ticks of one reading of the clock, the least of many: each stage includes one
/// reading.
std::uint64_t TicksOfAReading() {
  std::uint64_t least = ~std::uint64_t{0};
  for (int i = 0; i < 10000; ++i) {
    const std::uint64_t before = __builtin_ia32_rdtsc();
    least = std::min<std::uint64_t>(least, __builtin_ia32_rdtsc() - before);
  }
  return least;
}

void MeasureStages(benchmark::State& state, TautRunner& runner) {
  std::uint64_t before[sim::kStages];
  std::copy_n(sim::g_stage_ticks, sim::kStages, before);
  const std::clock_t start = std::clock();  // processor time, like Google Benchmark's rates
  const std::uint64_t start_ticks = __builtin_ia32_rdtsc();
  for (auto _ : state) runner.Run(1);
  const double ticks = static_cast<double>(__builtin_ia32_rdtsc() - start_ticks);
  const double ns = 1e9 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double steps = StepsOf(state, runner);
  const double group_steps = steps / runner.batch().lanes();
  const double readings = group_steps * static_cast<double>(TicksOfAReading());
  for (int i = 0; i < sim::kStages; ++i) {
    const double spent = static_cast<double>(sim::g_stage_ticks[i] - before[i]) - readings;
    state.counters[std::string("ns_") + sim::kStageNames[i]] = spent * ns / ticks / steps;
  }
  state.counters["steps_per_s"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
}

void Register(const Case& what, const Make& make, int settle_periods, bool stages = false,
              const Judge& judge = {}) {
  const auto standing = std::make_shared<Standing>(make, settle_periods);
  auto* const registered = benchmark::RegisterBenchmark(
      what.Name().c_str(), [standing, stages, judge](benchmark::State& state) {
        try {
          Runner& runner = (*standing)();
          stages ? MeasureStages(state, dynamic_cast<TautRunner&>(runner)) : Measure(state, runner);
          if (judge) judge(state, runner);
        } catch (const std::exception& error) {
          state.SkipWithError(error.what());
        }
      });
  // Processor time is steadier on a busy machine; with several threads only wall-clock time is
  // meaningful.
  if (what.threads > 1) registered->UseRealTime();
}

/// Adds counters of the solver and the number of joints.
void JudgeJoints(benchmark::State& state, const Runner& runner) {
  const auto& ours = dynamic_cast<const TautRunner&>(runner);
  state.counters["joints"] = ours.joints();
  state.counters["linear_solves"] = ours.linear_solves();
}

void RegisterTaut(Case what, const ModelDef& def, int settle_periods) {
  const bool joints = what.kind == "joints", stages = joints || what.kind == "stages";
  if (stages && !sim::HasWatch(what.lanes)) return;
  what.engine = "taut";
  what.setting = "default";
  WorldBatchOptions options;
  options.worlds = what.worlds;
  options.threads = what.threads;
  options.simd = static_cast<Simd>(what.lanes);
  const Make make = [def, options, stages] {
    auto runner = std::make_unique<TautRunner>(def, options);
    if (stages) BatchInside::Watch(runner->batch());
    return runner;
  };
  Register(what, make, settle_periods, stages, joints ? JudgeJoints : Judge());
}

constexpr int kHillsSettle = 300, kHillsCorners = 120;

Judge HowDeep(const std::string& robot) {
  return [robot](benchmark::State& state, const Runner& runner) {
    state.counters["deepest_m"] = Deepest(OnHills(robot, kHillsCorners), runner);
  };
}

/// Registers height fields; fields of ten million cells are created only when measured.
void RegisterHills(const std::string& robot, const std::string& ground, int corners, int lanes) {
  WorldBatchOptions options;
  options.worlds = lanes;
  options.simd = static_cast<Simd>(lanes);
  const Make make = [robot, corners, options] {
    auto runner = std::make_unique<TautRunner>(OnHills(robot, corners), options);
    SpreadOut(runner->batch());
    return runner;
  };
  Register({.kind = "hills",
            .robot = robot + "@" + ground,
            .worlds = lanes,
            .lanes = lanes,
            .engine = "taut",
            .setting = "default"},
           make, kHillsSettle, false, corners == kHillsCorners ? HowDeep(robot) : Judge());
}

void RegisterPeers(Case what, const ModelDef& def, int settle_periods, bool all,
                   std::vector<Elsewhere>& elsewhere, const Judge& judge = {}) {
  for (const peers::Setting& setting : peers::kSettings) {
    if (!(setting.main || all)) continue;
    if (setting.engine == peers::Engine::kMujoco) {
      what.engine = kMujocoElsewhere;
      what.setting = setting.name;
      elsewhere.push_back({what, def, setting.options, settle_periods});
    }
    if (!peers::Available(setting.engine)) continue;
    what.engine = peers::Name(setting.engine);
    what.setting = setting.name;
    Register(
        what,
        [def, setting] {
          return std::make_unique<PeerRunner>(setting.engine, def, setting.options);
        },
        settle_periods, false, judge);
  }
}

/// Measures a ball that repeatedly rolls for 3 s over level triangles: the remaining share of its 1
/// m/s.
void RegisterBall(const std::string& engine, const std::string& setting, const Make& make) {
  constexpr int kRolling = 300;
  const Case what{.kind = "hills", .robot = "ball@level", .engine = engine, .setting = setting};
  benchmark::RegisterBenchmark(what.Name().c_str(), [make](benchmark::State& state) {
    double speed = 0;
    for (auto _ : state) {
      state.PauseTiming();
      auto runner = make();
      state.ResumeTiming();
      runner->Run(kRolling);
      speed = runner->Body(0).velocity_m_per_s.x;
      state.PauseTiming();
      runner.reset();
      state.ResumeTiming();
    }
    const double steps = static_cast<double>(state.iterations()) * kRolling * kControlSteps;
    state.counters["steps_per_s"] = benchmark::Counter(steps, benchmark::Counter::kIsRate);
    state.counters["speed_kept"] = speed;
  });
}

/// Registers the peers on the same hills, except robots whose cables are too stiff for explicit
/// forces.
void RegisterPeersOnHills(std::vector<Elsewhere>& elsewhere) {
  for (const char* robot : {"six_strut", "tetraspine12"}) {
    const std::string name = robot;
    RegisterPeers({.kind = "hills", .robot = name + "@plane"}, OnHills(robot, 0), kHillsSettle,
                  false, elsewhere);
    RegisterPeers({.kind = "hills", .robot = name + "@hills"}, OnHills(robot, kHillsCorners),
                  kHillsSettle, false, elsewhere, HowDeep(robot));
  }
  const ModelDef ball = BallOnTriangles();
  RegisterBall("taut", "default",
               [ball] { return std::make_unique<TautRunner>(ball, WorldBatchOptions{}); });
  for (const peers::Setting& setting : peers::kSettings) {
    if (!setting.main || !peers::Available(setting.engine)) continue;
    RegisterBall(peers::Name(setting.engine), setting.name, [ball, setting] {
      return std::make_unique<PeerRunner>(setting.engine, ball, setting.options);
    });
  }
}

std::vector<Elsewhere> RegisterAll() {
  std::vector<Elsewhere> elsewhere;
  const int widest = static_cast<int>(BestSimd());
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  for (const char* robot : {"tetraspine3", "tetraspine12", "six_strut"}) {
    const ModelDef def = OnGround(robot);
    constexpr int kSettle = 300;
    RegisterTaut({.kind = "one", .robot = robot}, def, kSettle);
    for (int lanes = 1; lanes <= widest; lanes *= 2) {
      RegisterTaut({.kind = "batch", .robot = robot, .worlds = kWorldsPerThread, .lanes = lanes},
                   def, kSettle);
    }
    if (cores > 1) {
      RegisterTaut({.kind = "batch",
                    .robot = robot,
                    .worlds = kWorldsPerThread * cores,
                    .lanes = widest,
                    .threads = cores},
                   def, kSettle);
    }
    RegisterPeers({.kind = "one", .robot = robot}, def, kSettle, true, elsewhere);
    for (int lanes : {1, widest}) {
      RegisterTaut({.kind = "stages", .robot = robot, .worlds = lanes, .lanes = lanes}, def,
                   kSettle);
    }
  }
  for (const char* robot : {"six_strut", "six_strut_stiff", "tetraspine12"}) {
    for (int lanes : {1, widest}) {
      RegisterHills(robot, "plane", 0, lanes);
      RegisterHills(robot, "hills", kHillsCorners, lanes);
      RegisterHills(robot, "many", 3163, lanes);
    }
  }
  RegisterPeersOnHills(elsewhere);
  const std::pair<const char*, ModelDef> jointed[] = {
      {"chain_16", SwingingChain(16, 0)},
      {"chain_64", SwingingChain(64, 0)},
      {"chain_64_friction", SwingingChain(64, 0.05)},
      {"puppy", OnGround("puppy")}};
  for (const auto& [robot, def] : jointed) {
    for (int lanes : {1, widest}) {
      RegisterTaut({.kind = "joints", .robot = robot, .worlds = lanes, .lanes = lanes}, def, 50);
    }
  }
  const auto growth = [&](const char* kind, const std::string& robot, const ModelDef& def) {
    constexpr int kSettle = 50;
    RegisterTaut({.kind = kind, .robot = robot}, def, kSettle);
    RegisterTaut({.kind = kind, .robot = robot, .worlds = widest, .lanes = widest}, def, kSettle);
    RegisterPeers({.kind = kind, .robot = robot}, def, kSettle, false, elsewhere);
  };
  for (int segments = 1; segments <= 64; segments *= 2) {
    growth("segments", "spine_" + std::to_string(segments), Spine(segments));
  }
  for (int contacts : {0, 4, 8, 16, 32, 64}) {
    growth("contacts", "footed_" + std::to_string(contacts), Footed(contacts));
  }
  return elsewhere;
}

int Print(const std::vector<Elsewhere>& cases, const char* wanted) {
  auto list = nlohmann::ordered_json::array();
  try {
    const std::regex names(wanted);
    for (const Elsewhere& one : cases) {
      if (!std::regex_search(one.what.Name(), names)) continue;
      list.push_back({{"name", one.what.Name()},
                      {"settle_periods", one.settle_periods},
                      {"file", MujocoFile(one.def, one.options, true)}});
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "taut_bench: %s\n", error.what());
    return 2;
  }
  std::printf("%s\n", list.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace taut::bench

int main(int argc, char** argv) {
  for (const taut::peers::Engine engine : taut::peers::kEngines) {
    benchmark::AddCustomContext(taut::peers::Name(engine), taut::peers::Version(engine));
  }
  benchmark::AddCustomContext("step_s", std::to_string(taut::bench::kStepS));
  benchmark::AddCustomContext("max_linear_solves",
                              std::to_string(taut::WorldBatchOptions().max_linear_solves));
  char tolerance[32];
  std::snprintf(tolerance, sizeof tolerance, "%g", taut::WorldBatchOptions().tolerance_m_per_s);
  benchmark::AddCustomContext("tolerance_m_per_s", tolerance);
  const auto elsewhere = taut::bench::RegisterAll();
  if (argc == 3 && std::string(argv[1]) == "--mjcf") {
    return taut::bench::Print(elsewhere, argv[2]);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
