// Benchmark of contact-rich scenes: convergence and time of each step, and the time of the peers
// for the same scene in the same run. Prints JSON; script/bench makes tables of it.
//
//   taut_contact_bench [--scene REGEX] [--seeds N] [--steps N] [--seconds S] [--mjcf]
//
// --scene: only scenes whose name matches. --seeds: number of starts of each scene (3). --steps:
// largest number of steps per run. --seconds: processor time after which a run ends (20). --mjcf:
// measures nothing and prints the inputs for another MuJoCo (benchmarks/wasm).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <utility>

#include "benchmarks/contact_catalogue.h"
#include "benchmarks/mujoco_files.h"
#include "benchmarks/peers/settings.h"
#include "benchmarks/robots.h"
#include "tests/scenes/chance.h"

namespace taut::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Wanted {
  std::string scene = ".";
  int seeds = 3;
  int most_steps = 1 << 30;
  double most_s = 20;
  bool print = false;
};

/// Returns the processor time of this thread, independent of other processes [s].
double Now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Returns the time that a reading of the clock adds to an interval [s].
double ReadingCost() {
  double least = 1;
  for (int i = 0; i < 1000; ++i) {
    const double before = Now();
    least = std::min(least, Now() - before);
  }
  return least;
}

/// Returns the quantile of a sorted series.
double Quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size());
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(at))];
}

double Mean(const std::vector<double>& series) {
  double sum = 0;
  for (const double x : series) sum += x;
  return sum / static_cast<double>(series.size());
}

Json Summary(std::vector<double> series) {
  std::sort(series.begin(), series.end());
  return {{"mean", Mean(series)},
          {"median", Quantile(series, 0.5)},
          {"p99", Quantile(series, 0.99)},
          {"p999", Quantile(series, 0.999)},
          {"worst", series.back()}};
}

std::shared_ptr<const Model> Compiled(const ModelDef& def) {
  Diagnostics complaints;
  auto model = Model::Compile(def, complaints);
  if (model == nullptr) throw std::runtime_error(complaints.Format());
  return model;
}

/// Results of a run. A step of several worlds counts as as many steps of one world, each with its
/// share of the time.
struct Record {
  std::vector<double> step_us, iterations;
  double contacts = 0;
  long solved = 0, world_steps = 0;
  double worst_residual = 0;
  std::uint32_t bits = 0;  ///< All bits except `kStatusNotConverged`.

  void Look(WorldBatch& batch) {
    for (int w = 0; w < batch.worlds(); ++w) {
      const WorldStatus status = batch.Status(w);
      ++world_steps;
      if ((status.bits & kStatusNotConverged) == 0) ++solved;
      bits |= status.bits & ~kStatusNotConverged;
      worst_residual = std::max(worst_residual, status.residual_m_per_s);
      iterations.push_back(status.linear_solves);
      batch.ClearStatus(w);
    }
  }
  Json Taut() const {
    return {{"steps", world_steps},
            {"solved", solved},
            {"worst_residual_m_per_s", worst_residual},
            {"other_status_bits", bits},
            {"contacts", contacts},
            {"time_us", Summary(step_us)},
            {"iterations", Summary(iterations)}};
  }
};

/// Runs and times steps until a limit is reached: `step(i)` performs a step, `look(i)` is not
/// timed.
template <class Step, class Look>
std::vector<double> Timed(const Wanted& wanted, int steps, int worlds, Step step, Look look) {
  static const double cost = ReadingCost();
  std::vector<double> times_us;
  double spent = 0;
  for (int i = 0; i < std::min(steps, wanted.most_steps) && spent < wanted.most_s; ++i) {
    const double before = Now();
    step(i);
    const double took = std::max(0.0, Now() - before - cost);
    spent += took;
    times_us.push_back(1e6 * took / worlds);
    look(i);
  }
  return times_us;
}

/// Gives the worlds of a batch small different velocities, so that their contacts soon differ.
void Disturb(WorldBatch& batch, std::uint64_t seed) {
  for (int w = 1; w < batch.worlds(); ++w) {
    scenes::Chance chance(1000 * seed + static_cast<std::uint64_t>(w));
    for (int b = 0; b < static_cast<int>(batch.model().def().bodies.size()); ++b) {
      BodyState state = batch.Body(w, b);
      state.velocity_m_per_s = scenes::Sum(state.velocity_m_per_s, chance.Jolt(0.01));
      batch.SetBodyState(w, b, state);
    }
  }
}

Record RunTaut(const Wanted& wanted, const ContactScene& scene, const ModelDef& def, int worlds,
               std::uint64_t seed) {
  WorldBatchOptions options;
  options.worlds = worlds;
  options.simd = static_cast<Simd>(worlds);
  WorldBatch batch(Compiled(def), options);
  Disturb(batch, seed);
  const Motion motion(def);
  Record record;
  double looks = 0;
  record.step_us = Timed(
      wanted, scene.steps, worlds, [&](int) { batch.Step(kStepS); },
      [&](int i) {
        record.Look(batch);
        if (i % kControlSteps != 0) return;
        record.contacts += static_cast<double>(batch.Contacts(0).size());
        ++looks;
        for (int c = 0; scene.moves && c < motion.cables(); ++c) {
          for (int w = 0; w < worlds; ++w) {
            batch.SetRestLengthTarget(w, c, motion.RestLength(w, c, i / kControlSteps));
          }
        }
      });
  record.contacts /= looks;
  return record;
}

std::vector<double> RunPeer(const Wanted& wanted, const ContactScene& scene, const ModelDef& def,
                            const peers::Setting& setting) {
  const auto world = peers::MakeWorld(setting.engine, def, setting.options);
  const Motion motion(def);
  return Timed(
      wanted, scene.steps, 1, [&](int) { world->Step(kStepS); },
      [&](int i) {
        if (!scene.moves || i % kControlSteps != 0) return;
        for (int c = 0; c < motion.cables(); ++c) {
          world->SetRestLength(c, motion.RestLength(0, c, i / kControlSteps));
        }
      });
}

Json About(const Wanted& wanted, const ContactScene& scene, std::uint64_t seed, const ModelDef& def,
           const char* engine, const char* setting, int lanes) {
  return {{"scene", scene.name},
          {"seed", seed},
          {"engine", engine},
          {"setting", setting},
          {"lanes", lanes},
          {"held_out", scene.held_out},
          {"planned_steps", std::min(scene.steps, wanted.most_steps) * lanes},
          {"bodies", def.bodies.size()},
          {"cables", def.cables.size()}};
}

/// Adds one start of a scene as input for another MuJoCo.
void Print(const Wanted& wanted, const ContactScene& scene, std::uint64_t seed, Json& runs) {
  const ModelDef def = scene.def(seed);
  if (!scene.for_peers || !peers::Unsupported(def).empty()) return;
  for (const peers::Setting& setting : peers::kSettings) {
    if (setting.engine != peers::Engine::kMujoco || !setting.main) continue;
    Json run = About(wanted, scene, seed, def, kMujocoElsewhere, setting.name, 1);
    run["file"] = MujocoFile(def, setting.options, scene.moves);
    runs.push_back(run);
  }
}

/// Measures one start of a scene: the peers, then taut in one world and in the widest batch.
void Measure(const Wanted& wanted, const ContactScene& scene, std::uint64_t seed, Json& runs) {
  const ModelDef def = scene.def(seed);
  const auto add = [&](const char* engine, const char* setting, int lanes, const Json& found) {
    Json run = About(wanted, scene, seed, def, engine, setting, lanes);
    run.update(found);
    runs.push_back(run);
  };
  double ode_us = 0;
  for (const peers::Setting& setting : peers::kSettings) {
    if (!scene.for_peers || !setting.main || !peers::Available(setting.engine)) continue;
    if (!peers::Unsupported(def).empty()) continue;
    Json found;
    try {
      const std::vector<double> times_us = RunPeer(wanted, scene, def, setting);
      found = {{"steps", times_us.size()}, {"time_us", Summary(times_us)}};
      if (setting.options.full_step) ode_us = Mean(times_us);
    } catch (const std::exception& error) {
      found = {{"error", error.what()}};
    }
    add(peers::Name(setting.engine), setting.name, 1, found);
  }
  const Record one = RunTaut(wanted, scene, def, 1, seed);
  Json found = one.Taut();
  if (ode_us > 0) {
    const auto within = std::count_if(one.step_us.begin(), one.step_us.end(),
                                      [&](double us) { return us <= 16 * ode_us; });
    found["share_within_16_of_ode"] =
        static_cast<double>(within) / static_cast<double>(one.step_us.size());
  }
  add("taut", "default", 1, found);
  const int widest = static_cast<int>(BestSimd());
  if (widest > 1) {
    add("taut", "default", widest, RunTaut(wanted, scene, def, widest, seed).Taut());
  }
}

/// Measures one step of every rod of the grid.
void MeasurePainleve(Json& runs) {
  Record record;
  const Wanted all;
  for (const ModelDef& def : PainleveGrid()) {
    WorldBatch batch(Compiled(def), {});
    const auto times_us = Timed(
        all, 1, 1, [&](int) { batch.Step(kStepS); }, [&](int) { record.Look(batch); });
    record.step_us.push_back(times_us[0]);
    record.contacts += static_cast<double>(batch.Contacts(0).size());
  }
  record.contacts /= static_cast<double>(record.step_us.size());
  Json run = {{"scene", "painleve"},
              {"seed", 1},
              {"engine", "taut"},
              {"setting", "default"},
              {"lanes", 1},
              {"held_out", false},
              {"planned_steps", record.world_steps},
              {"bodies", 1},
              {"cables", 0}};
  run.update(record.Taut());
  runs.push_back(run);
}

Json Context() {
  Json context;
  for (const peers::Engine engine : peers::kEngines) {
    context[peers::Name(engine)] = peers::Version(engine);
  }
  char tolerance[32];
  std::snprintf(tolerance, sizeof tolerance, "%g", WorldBatchOptions().tolerance_m_per_s);
  context["step_s"] = std::to_string(kStepS);
  context["max_linear_solves"] = std::to_string(WorldBatchOptions().max_linear_solves);
  context["tolerance_m_per_s"] = tolerance;
  return context;
}

/// Parses the command line. Returns false for an unknown option.
bool Read(int argc, char** argv, Wanted& wanted) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--mjcf") {
      wanted.print = true;
      continue;
    }
    if (++i == argc) return false;
    const char* const value = argv[i];
    if (word == "--scene") {
      wanted.scene = value;
    } else if (word == "--seeds") {
      wanted.seeds = std::atoi(value);
    } else if (word == "--steps") {
      wanted.most_steps = std::atoi(value);
    } else if (word == "--seconds") {
      wanted.most_s = std::atof(value);
    } else {
      return false;
    }
  }
  return wanted.seeds > 0 && wanted.most_steps > 0 && wanted.most_s > 0;
}

int Main(int argc, char** argv) {
  Wanted wanted;
  if (!Read(argc, argv, wanted)) {
    std::fprintf(stderr,
                 "usage: taut_contact_bench [--scene REGEX] [--seeds N] [--steps N] "
                 "[--seconds S] [--mjcf]\n");
    return 2;
  }
  Json runs = Json::array();
  try {
    const std::regex names(wanted.scene);
    for (const ContactScene& scene : ContactScenes()) {
      if (!std::regex_search(scene.name, names)) continue;
      for (int seed = 1; seed <= wanted.seeds; ++seed) {
        const auto start = static_cast<std::uint64_t>(seed);
        wanted.print ? Print(wanted, scene, start, runs) : Measure(wanted, scene, start, runs);
      }
    }
    if (!wanted.print && std::regex_search("painleve", names)) MeasurePainleve(runs);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "taut_contact_bench: %s\n", error.what());
    return 1;
  }
  std::printf("%s\n", Json{{"context", Context()}, {"runs", runs}}.dump(1).c_str());
  return 0;
}

}  // namespace
}  // namespace taut::bench

int main(int argc, char** argv) { return taut::bench::Main(argc, argv); }
