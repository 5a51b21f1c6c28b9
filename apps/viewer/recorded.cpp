#include "recorded.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "command.h"
#include "run_names.h"
#include "shape_info.h"
#include "taut/run_folder.h"

namespace taut::viewer {
namespace {

namespace fs = std::filesystem;

/// Returns whether a trace can belong to this experiment: all its bodies and cables are in the
/// experiment.
bool Belongs(const Trace& trace, const ExperimentSpec& experiment) {
  std::vector<std::string> known;
  for (const BodyDef& body : experiment.robot.def.bodies) known.push_back("body/" + body.name);
  for (const CableDef& cable : experiment.robot.def.cables) known.push_back("cable/" + cable.name);
  std::sort(known.begin(), known.end());
  return std::all_of(trace.channels.begin(), trace.channels.end(), [&](const ChannelInfo& channel) {
    if (!channel.name.starts_with("body/") && !channel.name.starts_with("cable/")) return true;
    return std::binary_search(known.begin(), known.end(),
                              channel.name.substr(0, channel.name.rfind('/')));
  });
}

double ValueAt(const std::vector<double>* column, std::size_t row) {
  return column == nullptr ? Frame::kUnknown : (*column)[row];
}

}  // namespace

std::unique_ptr<Recorded> Recorded::LoadAlone(const std::string& path, Diagnostics& out) {
  auto trace = ReadTraceOfRun(path, out);
  if (!trace) return nullptr;
  if (trace->time_s.empty()) {
    out.Error("trace.no_rows", {path}, "the trace has no rows");
    return nullptr;
  }
  auto recorded = std::make_unique<Recorded>();
  recorded->path_ = path;
  recorded->trace_ = std::move(*trace);
  recorded->FindInputs();
  if (recorded->trace_.unfinished) {
    std::string& notice = recorded->notice_;
    notice += fmt::format("{}the trace is unfinished: its run continues, or was killed",
                          notice.empty() ? "" : "; ");
  }
  recorded->FindColumns();
  recorded->FindForces();
  return recorded;
}

std::unique_ptr<Recorded> Recorded::Load(const std::string& path,
                                         const std::vector<std::string>& compare,
                                         Diagnostics& out) {
  auto recorded = LoadAlone(path, out);
  std::vector<std::string> others = compare;
  if (others.empty() && recorded && recorded->experiment_ && recorded->experiment_->compare_with &&
      fs::exists(*recorded->experiment_->compare_with)) {
    others = {*recorded->experiment_->compare_with};
  }
  bool good = recorded != nullptr;
  if (others.size() > kMaxComparedRuns) {
    out.Error("report.too_many_runs", {path},
              fmt::format("the trace is compared with {} runs, expected at most {}", others.size(),
                          kMaxComparedRuns));
    good = false;
  }
  std::vector<std::unique_ptr<Recorded>> compared;
  for (const std::string& other : others) {
    compared.push_back(LoadAlone(other, out));
    good = good && compared.back() != nullptr;
  }
  if (!good) return nullptr;
  recorded->compared_ = std::move(compared);
  if (recorded->compared_.empty()) return recorded;
  std::vector<NamedTrace> traces = {{&recorded->trace_, path}};
  for (const auto& run : recorded->compared_) traces.push_back({&run->trace_, run->path_});
  const std::vector<std::string> names = RunNames(traces);
  recorded->run_name_ = names[0];
  for (std::size_t k = 0; k < recorded->compared_.size(); ++k) {
    recorded->compared_[k]->run_name_ = names[k + 1];
  }
  return recorded;
}

void Recorded::FindInputs() {
  const fs::path inputs = BesideTrace(path_, "inputs", ".yaml");
  std::error_code failed;
  if (!fs::is_regular_file(inputs, failed)) {  // reading a pipe could block
    notice_ = fmt::format("there is no {} in the trace's folder: bodies are shown as spheres",
                          inputs.filename().string());
    return;
  }
  Diagnostics found;
  experiment_ = LoadExperiment(inputs.string(), {}, found);
  if (experiment_ && !Belongs(trace_, *experiment_)) experiment_.reset();
  if (!experiment_) {
    notice_ = fmt::format("{} belongs to another trace: bodies are shown as spheres",
                          inputs.filename().string());
    return;
  }
  inputs_ = ReadRunText(inputs.string()).value_or("");
  nodes_ = NodeChannels(experiment_->robot.def);
  const double end_s = trace_.time_s.back();
  // The planned duration is unknown for parts of a live run after a reset (inputs_2.yaml).
  const bool planned = inputs.filename() == "inputs.yaml";
  if (planned && end_s < experiment_->duration_s * (1 - 1e-9) - 1e-9) {
    notice_ = fmt::format("the trace ends at {:g} s of {:g} s", end_s, experiment_->duration_s);
  }
  summary_ =
      Json::parse(ReadRunText(BesideTrace(path_, "summary", ".json")).value_or(""), nullptr, false);
  if (summary_.is_discarded()) summary_ = nullptr;
}

const std::vector<double>* Recorded::Column(const std::string& name) const {
  const auto at = trace_.Find(name);
  return at ? &trace_.values[*at] : nullptr;
}

void Recorded::FindColumns() {
  static const char* const kPose[] = {"position_x_m",  "position_y_m",  "position_z_m",
                                      "orientation_w", "orientation_x", "orientation_y",
                                      "orientation_z"};
  static const char* const kCable[] = {"tension_n", "length_m", "rest_length_m", "setpoint_n"};
  const Json scene = experiment_ ? SceneOf(*experiment_) : SceneOf(trace_);
  for (const Json& body : scene["bodies"]) {
    BodyColumns columns;
    const Json& at = body["position_m"];
    columns.start.position_m = {at[0].get<double>(), at[1].get<double>(), at[2].get<double>()};
    for (int i = 0; i < 7; ++i) {
      columns.values[i] = Column("body/" + body["name"].get<std::string>() + "/" + kPose[i]);
    }
    bodies_.push_back(columns);
  }
  for (const Json& cable : scene["cables"]) {
    CableColumns columns;
    for (int i = 0; i < 4; ++i) {
      columns.values[i] = Column("cable/" + cable["name"].get<std::string>() + "/" + kCable[i]);
    }
    for (int i = 1; i <= cable.value("most_bends", 0); ++i) {
      static const char* const kPlace[] = {"x_m", "y_m", "z_m"};
      const std::vector<double>* place[3];
      const std::string name = cable["name"].get<std::string>();
      if (!FindAll(fmt::format("cable/{}/bend_{}_", name, i), kPlace, place)) break;
      columns.bends.insert(columns.bends.end(), std::begin(place), std::end(place));
    }
    for (int i = 1;; ++i) {
      const auto* const tension =
          Column(fmt::format("cable/{}/span_{}_tension_n", cable["name"].get<std::string>(), i));
      if (tension == nullptr) break;
      columns.spans.push_back(tension);
    }
    cables_.push_back(std::move(columns));
  }
  energy_[0] = Column("system/kinetic_j");
  energy_[1] = Column("system/gravity_j");
  energy_[2] = Column("system/elastic_j");
  contact_count_ = Column("system/contact_count");
}

void Recorded::FindForces() {
  static const char* const kContact[] = {"point_x_m", "point_y_m", "point_z_m",
                                         "force_x_n", "force_y_n", "force_z_n"};
  static const char* const kHand[] = {"node", "force_x_n", "force_y_n", "force_z_n"};
  if (experiment_) {
    for (const PushSpec& push : experiment_->pushes) {
      const auto* value = Column("push/" + push.name + "/force_n");
      if (value != nullptr) forces_.push_back({push.node, push.direction, value});
    }
    for (const DragSpec& drag : experiment_->drags) {
      const auto* value = Column("drag/" + drag.name + "/force_n");
      const Vec3& v = drag.velocity_m_per_s;
      const double speed = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
      if (value == nullptr || speed == 0) continue;
      forces_.push_back({drag.node, {v.x / speed, v.y / speed, v.z / speed}, value});
    }
    for (const char* hand : {"hand/drag/", "hand/push/"}) {
      HandColumns columns;
      if (FindAll(hand, kHand, columns.values)) hands_.push_back(columns);
    }
  }
  ContactColumns contact;
  for (int slot = 0; FindAll(fmt::format("contact/{}/", slot), kContact, contact.values); ++slot) {
    contacts_.push_back(contact);
  }
}

template <std::size_t count>
bool Recorded::FindAll(const std::string& prefix, const char* const (&names)[count],
                       const std::vector<double>* (&columns)[count]) const {
  for (std::size_t i = 0; i < count; ++i) {
    columns[i] = Column(prefix + names[i]);
    if (columns[i] == nullptr) return false;
  }
  return true;
}

bool Recorded::has_poses() const {
  return std::any_of(bodies_.begin(), bodies_.end(),
                     [](const BodyColumns& body) { return body.values[0] != nullptr; });
}

std::string Recorded::title() const {
  return experiment_ ? experiment_->name : fs::path(path_).filename().string();
}

Json Recorded::scene() const {
  Json scene = experiment_ ? SceneOf(*experiment_) : SceneOf(trace_);
  std::vector<ChannelInfo> channels = trace_.channels;
  for (const ChannelInfo& node : nodes_.channels()) {
    if (!trace_.Find(node.name) && PosesOf(*nodes_.Find(node.name))) channels.push_back(node);
  }
  scene["channels"] = ToJson(channels);
  scene["first_s"] = trace_.time_s.front();
  scene["duration_s"] = trace_.time_s.back();
  scene["contact_forces"] = !contacts_.empty();
  if (!compared_.empty()) scene["run_name"] = run_name_;
  for (const auto& run : compared_) scene["compared"].push_back(run->ComparedRun());
  if (!notice_.empty()) scene["notice"] = notice_;
  if (const Json shape = ShapeOf(trace_.metadata); !shape.is_null()) scene["shape"] = shape;
  return scene;
}

Json Recorded::ComparedRun() const {
  Json run = {{"name", run_name_},
              {"measured", !Said(trace_, "measured").empty()},
              {"channels", ToJson(trace_.channels)},
              {"first_s", trace_.time_s.front()},
              {"last_s", trace_.time_s.back()},
              {"bodies", Json::array()},
              {"cables", Json::array()}};
  if (!has_poses()) {
    run["notice"] = "no ghost: the trace contains no poses of bodies";
    return run;
  }
  const Json scene = experiment_ ? SceneOf(*experiment_) : SceneOf(trace_);
  run["bodies"] = scene["bodies"];
  run["cables"] = scene["cables"];
  if (!notice_.empty()) run["notice"] = notice_;
  return run;
}

void Recorded::AddBends(std::size_t row, int first, std::vector<Frame::Bend>& bends) const {
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    const auto& columns = cables_[c].bends;
    for (std::size_t i = 0; i < columns.size(); i += 3) {
      const Vec3 place{(*columns[i])[row], (*columns[i + 1])[row], (*columns[i + 2])[row]};
      if (std::isnan(place.x)) break;
      bends.push_back({first + static_cast<int>(c), place});
    }
  }
}

void Recorded::AddGhost(double time_s, int first_cable, Frame& frame) const {
  const std::vector<double>& times = trace_.time_s;
  // A row is valid until the next is due; times of the same row in two runs may differ by
  // round-off.
  constexpr double kRoundingS = 1e-9;
  const double row_s =
      times.size() < 2 ? 0 : (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  const std::size_t row = RowAt(time_s + kRoundingS);
  std::vector<Frame::Body> poses = PosesOf(row);
  if (time_s < times.front() - kRoundingS || time_s > times.back() + row_s + kRoundingS) {
    constexpr double kNo = Frame::kUnknown;
    std::fill(poses.begin(), poses.end(), Frame::Body{{kNo, kNo, kNo}, {kNo, kNo, kNo, kNo}});
  } else {
    AddBends(row, first_cable, frame.bends);
  }
  frame.ghosts.insert(frame.ghosts.end(), poses.begin(), poses.end());
}

std::vector<Frame::Body> Recorded::PosesOf(std::size_t row) const {
  std::vector<Frame::Body> poses;
  for (const BodyColumns& body : bodies_) {
    Frame::Body pose = body.start;
    double* const to[] = {&pose.position_m.x,  &pose.position_m.y,  &pose.position_m.z,
                          &pose.orientation.w, &pose.orientation.x, &pose.orientation.y,
                          &pose.orientation.z};
    for (int i = 0; i < 7; ++i) {
      if (body.values[i] != nullptr) *to[i] = (*body.values[i])[row];
    }
    poses.push_back(pose);
  }
  return poses;
}

Frame Recorded::FrameOf(std::size_t row) const {
  Frame frame;
  frame.time_s = trace_.time_s[row];
  frame.energy = {ValueAt(energy_[0], row), ValueAt(energy_[1], row), ValueAt(energy_[2], row)};
  frame.contact_count = ValueAt(contact_count_, row);
  frame.bodies = PosesOf(row);
  AddBends(row, 0, frame.bends);
  for (std::size_t c = 0; c < cables_.size(); ++c) {
    for (const auto* const tension : cables_[c].spans) {
      if (std::isnan((*tension)[row])) break;  // fewer spans in this row
      frame.spans.push_back({static_cast<int>(c), (*tension)[row]});
    }
  }
  auto cables = static_cast<int>(cables_.size());
  for (const auto& run : compared_) {
    if (!run->has_poses()) continue;  // no ghost without poses
    run->AddGhost(frame.time_s, cables, frame);
    cables += static_cast<int>(run->cables_.size());
  }
  for (const CableColumns& cable : cables_) {
    frame.cables.push_back({ValueAt(cable.values[0], row), ValueAt(cable.values[1], row),
                            ValueAt(cable.values[2], row), ValueAt(cable.values[3], row)});
  }
  for (const ForceColumn& force : forces_) {
    const double n = (*force.value)[row];
    const Vec3& d = force.direction;
    if (n != 0) frame.pushes.push_back({force.node, {n * d.x, n * d.y, n * d.z}});
  }
  const double nodes = experiment_ ? static_cast<double>(experiment_->robot.def.nodes.size()) : 0;
  for (const HandColumns& hand : hands_) {
    const double node = (*hand.values[0])[row];
    if (!(node >= 0 && node < nodes)) continue;
    frame.pushes.push_back(
        {static_cast<int>(node),
         {(*hand.values[1])[row], (*hand.values[2])[row], (*hand.values[3])[row]}});
  }
  for (const ContactColumns& contact : contacts_) {
    double v[6];
    for (int i = 0; i < 6; ++i) v[i] = (*contact.values[i])[row];
    // NaN: a slot without a contact
    if (std::any_of(std::begin(v), std::end(v), [](double x) { return std::isnan(x); })) continue;
    frame.contacts.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
  }
  return frame;
}

std::size_t Recorded::RowAt(double time_s) const {
  const auto after = std::upper_bound(trace_.time_s.begin(), trace_.time_s.end(), time_s);
  return after == trace_.time_s.begin()
             ? 0
             : static_cast<std::size_t>(after - trace_.time_s.begin()) - 1;
}

std::optional<NodeChannels::Poses> Recorded::PosesOf(const NodeChannels::Place& node) const {
  NodeChannels::Poses poses;
  const BodyColumns& body = bodies_[static_cast<std::size_t>(node.body)];
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i] = body.values[i];
    if (poses[i] == nullptr) return std::nullopt;
  }
  return poses;
}

const Recorded::NodeColumn* Recorded::Node(const std::string& name) const {
  const auto known = node_columns_.find(name);
  if (known != node_columns_.end()) return &known->second;
  const auto place = nodes_.Find(name);
  const auto poses = place ? PosesOf(*place) : std::nullopt;
  if (!poses) return nullptr;
  std::vector<double> values = NodeChannels::Column(*place, *poses);
  Pyramid pyramid(values);
  return &node_columns_.try_emplace(name, NodeColumn{std::move(values), std::move(pyramid)})
              .first->second;
}

std::optional<Series> Recorded::SeriesOf(const std::string& channel, int source, double t0,
                                         double t1, std::size_t points) const {
  if (source > 0) {
    const auto k = static_cast<std::size_t>(source) - 1;
    return k < compared_.size() ? compared_[k]->SeriesOf(channel, 0, t0, t1, points) : std::nullopt;
  }
  const auto at = trace_.Find(channel);
  if (!at) {
    const NodeColumn* const node = Node(channel);
    if (node == nullptr) return std::nullopt;
    return node->pyramid.Get(trace_.time_s, node->values, t0, t1, points);
  }
  const std::vector<double>& column = trace_.values[*at];
  const auto pyramid = pyramids_.try_emplace(*at, column).first;
  return pyramid->second.Get(trace_.time_s, column, t0, t1, points);
}

}  // namespace taut::viewer
