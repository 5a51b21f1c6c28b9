// Animated run of a mode shape or self-stress for the viewer.
#include "taut/shape_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "math/angle.h"
#include "math/vec.h"
#include "taut/run.h"
#include "taut/run_folder.h"
#include "taut/summary.h"

namespace taut {
namespace {

Quat TurnBy(const Vec3& turn) {
  const double angle = Length(turn);
  if (angle == 0) return {};
  const Vec3 v = std::sin(angle / 2) / angle * turn;
  return {std::cos(angle / 2), v.x, v.y, v.z};
}

/// Returns the largest displacement of any node or center of mass per unit of amplitude [m].
double GreatestWay(const ModelDef& def, const Shape& shape) {
  double most = 0;
  for (const Vec3& t : shape.translation_m) most = std::max(most, Length(t));
  for (const NodeDef& node : def.nodes) {
    if (node.body == kWorld || shape.translation_m.empty()) continue;
    const auto b = static_cast<std::size_t>(node.body);
    const Vec3 arm = node.position_m - def.bodies[b].com_m;
    most = std::max(most, Length(shape.translation_m[b] + Cross(shape.turn_rad[b], arm)));
  }
  return most;
}

/// Converts to percent of the largest tension, since the magnitude of a self-stress is arbitrary.
/// Rounding removes differences between equal cables.
void ToPerCent(std::vector<double>& tension_n) {
  double largest = 0;
  for (const double t : tension_n) largest = std::max(largest, std::fabs(t));
  if (largest == 0) return;
  for (double& t : tension_n) t = std::round(t / largest * 1e11) * 1e-9;
}

std::vector<ChannelInfo> Channels(const ModelDef& def) {
  static constexpr std::pair<const char*, const char*> kBody[] = {
      {"position_x_m", "m"},  {"position_y_m", "m"},  {"position_z_m", "m"}, {"orientation_w", "1"},
      {"orientation_x", "1"}, {"orientation_y", "1"}, {"orientation_z", "1"}};
  static constexpr std::pair<const char*, const char*> kCable[] = {
      {"tension_n", "N"}, {"length_m", "m"}, {"rest_length_m", "m"}};
  std::vector<ChannelInfo> channels;
  for (const BodyDef& body : def.bodies) {
    for (const auto& [name, unit] : kBody) {
      channels.push_back({"body/" + body.name + "/" + name, unit});
    }
  }
  for (const CableDef& cable : def.cables) {
    for (const auto& [name, unit] : kCable) {
      channels.push_back({"cable/" + cable.name + "/" + name, unit});
    }
  }
  return channels;
}

std::vector<double> RowAt(WorldBatch& batch, const Pose& pose, const Shape& shape) {
  std::vector<double> row;
  for (std::size_t b = 0; b < pose.bodies.size(); ++b) {
    const BodyState& s = pose.bodies[b];
    batch.SetBodyState(0, static_cast<int>(b), s);
    const Quat& q = s.orientation;
    row.insert(row.end(), {s.position_m.x, s.position_m.y, s.position_m.z, q.w, q.x, q.y, q.z});
  }
  for (std::size_t c = 0; c < pose.rest_lengths_m.size(); ++c) {
    const CableState cable = batch.Cable(0, static_cast<int>(c));
    row.insert(row.end(), {shape.tension_n.empty() ? cable.elastic_n : shape.tension_n[c],
                           cable.length_m, cable.rest_length_m});
  }
  return row;
}

/// Updates the summary of the cables with a row.
void Note(const std::vector<double>& row, std::size_t cables, RunSummary& summary) {
  for (std::size_t c = 0; c < cables; ++c) {
    CableSummary& cable = summary.cables[c];
    const double tension_n = row[row.size() - 3 * (cables - c)];
    cable.tension.max_n = cable.elastic.max_n = std::max(cable.tension.max_n, tension_n);
    if (tension_n <= summary.system_max_tension_n) continue;
    summary.system_max_tension_n = summary.system_max_elastic_n = tension_n;
    summary.system_max_tension_cable = cable.name;
  }
}

bool Fill(RunFolder& folder, const ExperimentSpec& e, const Shape& shape, const ShapeLook& look,
          RunSummary& summary, Diagnostics& out) {
  const ModelDef& def = e.robot.def;
  const auto model = Model::CompileForExperiment(def, out);
  if (!model) return false;
  WorldBatch batch(model, {});
  TraceMetadata metadata = RunMetadata(e);
  metadata.emplace_back(kRunIdKey, folder.id());
  metadata.emplace_back("shape", shape.name);
  if (shape.count > 0) {
    metadata.emplace_back("shape_number", std::to_string(shape.number));
    metadata.emplace_back("shape_count", std::to_string(shape.count));
  }
  if (shape.frequency_hz > 0) {
    metadata.emplace_back("shape_frequency_hz", fmt::format("{}", shape.frequency_hz));
    metadata.emplace_back("shape_slowdown", fmt::format("{}", shape.frequency_hz * look.period_s));
  }
  if (!shape.translation_m.empty()) {
    metadata.emplace_back("shape_amplitude", fmt::format("{}", look.size));
  }
  auto trace = CreateHdf5Trace(folder.Path("trace.h5"), Channels(def), metadata, out);
  if (!trace) return false;
  trace = folder.BeginWith(std::move(trace), {"trace.h5"});
  const double way = GreatestWay(def, shape);
  const double amplitude = way > 0 ? look.size * SizeOf(def) / way : 0;
  const int rows = static_cast<int>(std::lround(e.duration_s * look.rate_hz));
  bool good = true;
  for (int i = 0; good && i <= rows; ++i) {
    const double time_s = i / look.rate_hz;
    const double share = std::sin(2 * kPi * time_s / look.period_s);
    const std::vector<double> row = RowAt(batch, SwungBy(def, shape, amplitude, share), shape);
    Note(row, def.cables.size(), summary);
    good = trace->Append(time_s, row.data());
  }
  if (good && trace->Finish()) return true;
  out.Error("trace.not_written", {}, trace->error());
  return false;
}

}  // namespace

double SizeOf(const ModelDef& def) {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  const auto add = [&](const Vec3& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  };
  for (const BodyDef& body : def.bodies) add(body.com_m);
  for (const NodeDef& node : def.nodes) add(node.position_m);
  for (const CableDef& cable : def.cables) {
    for (const AttachmentDef& at : cable.attachments) add(at.position_m);
  }
  return low.x > high.x ? 0 : Length(high - low);
}

Pose SwungBy(const ModelDef& def, const Shape& shape, double amplitude, double share) {
  Pose pose;
  for (std::size_t b = 0; b < def.bodies.size(); ++b) {
    BodyState& s = pose.bodies.emplace_back();
    s.position_m = def.bodies[b].com_m;
    if (shape.translation_m.empty()) continue;
    s.position_m = s.position_m + amplitude * share * shape.translation_m[b];
    s.orientation = TurnBy(amplitude * share * shape.turn_rad[b]);
  }
  for (const CableDef& cable : def.cables) pose.rest_lengths_m.push_back(cable.rest_length_m);
  return pose;
}

bool WriteShapeRun(const std::string& path, const ExperimentSpec& experiment, const Shape& shape,
                   const ShapeLook& look, Diagnostics& out) {
  ExperimentSpec e = experiment;
  e.name = shape.name;
  e.description = shape.description;
  e.controllers.clear(), e.pushes.clear(), e.drags.clear(), e.phases.clear();
  e.references.clear(), e.load_cases.clear(), e.sensors.reset(), e.goal.reset();
  e.compare_with.reset();
  e.record = {}, e.start_noise = {};
  e.start = StartKind::kAsDescribed;
  e.duration_s = shape.translation_m.empty() ? look.period_s : look.period_s * look.periods;
  const auto folder = RunFolder::Open(path, {}, out);
  RunSummary summary;
  for (const CableDef& cable : e.robot.def.cables) summary.cables.emplace_back().name = cable.name;
  if (!folder || !folder->Prepare(ResolvedYaml(e), out) ||
      !Fill(*folder, e, shape, look, summary, out)) {
    return false;
  }
  summary.experiment = e.name;
  summary.run = folder->id();
  summary.simulated_s = e.duration_s;
  return folder->Finish(SummaryJson(summary), out);
}

std::vector<std::string> WriteShapeRuns(const std::string& folder, const ExperimentSpec& experiment,
                                        const Modes& modes, const ForceAnalysis& forces,
                                        int most_modes, const ShapeLook& look, Diagnostics& out) {
  std::vector<std::string> written;
  const auto write = [&](const Shape& shape) {
    const std::string path = (std::filesystem::path(folder) / shape.name).string();
    if (WriteShapeRun(path, experiment, shape, look, out)) written.push_back(path);
  };
  std::vector<const Mode*> shown;
  for (const Mode& mode : modes.modes) {
    if (mode.kind == Mode::Kind::kRigid || static_cast<int>(shown.size()) == most_modes) continue;
    shown.push_back(&mode);
  }
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Mode& mode = *shown[i];
    const char* const kind = mode.kind == Mode::Kind::kUnstable ? ", unstable" : "";
    write({fmt::format("mode_{}", i + 1),
           fmt::format("Mode of {:.6g} Hz{}, slowed down and enlarged.", mode.frequency_hz, kind),
           mode.translation_m,
           mode.turn_rad,
           {},
           static_cast<int>(i + 1),
           static_cast<int>(shown.size()),
           mode.frequency_hz});
  }
  int number = 0;
  for (const Mode& mechanism : forces.mechanisms) {
    ++number;
    write({fmt::format("mechanism_{}", number),
           "Infinitesimal mechanism: a motion that changes no member's length to first order.",
           mechanism.translation_m,
           mechanism.turn_rad,
           {},
           number,
           static_cast<int>(forces.mechanisms.size()),
           0});
  }
  number = 0;
  const std::size_t cables = experiment.robot.def.cables.size();
  for (const SelfStress& state : forces.self_stress) {
    Shape shape;
    shape.name = fmt::format("self_stress_{}", ++number);
    shape.number = number;
    shape.count = static_cast<int>(forces.self_stress.size());
    shape.description =
        state.feasible
            ? "Self-stress, scaled to a largest force of 100 N; all cables are in tension."
            : "Self-stress, scaled to a largest force of 100 N; some cables are in compression.";
    shape.tension_n.assign(cables, 0.0);
    for (std::size_t i = 0; i < forces.members.size(); ++i) {
      const StaticMember& member = forces.members[i];
      if (member.kind != StaticMember::Kind::kCable) continue;
      shape.tension_n[static_cast<std::size_t>(member.index)] = state.force_n[i];
    }
    ToPerCent(shape.tension_n);
    write(shape);
  }
  return written;
}

}  // namespace taut
