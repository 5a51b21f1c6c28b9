// Reader of a robot's pose in a row of a trace.
#include <array>
#include <cmath>

#include "base/brief.h"
#include "taut/statics.h"
#include "taut/trace_pose.h"

namespace taut {
namespace {

constexpr double kUnit = 1e-3;        // tolerance for the length of a quaternion
constexpr double kSameLength = 1e-3;  // relative tolerance for a cable's recorded length

class RowOfTrace {
 public:
  RowOfTrace(const Trace& trace, std::size_t row, const SourceRef& at, Diagnostics& out)
      : trace_(trace), row_(row), at_(at), out_(out) {}

  bool Has(const std::string& name) const { return trace_.Find(name).has_value(); }
  /// Reads channels that must all be present and finite. Reports an error for each other channel.
  template <std::size_t kCount>
  bool Read(const std::string& before, const std::array<const char*, kCount>& names,
            std::array<double, kCount>& values) const {
    bool good = true;
    for (std::size_t i = 0; i < kCount; ++i) {
      const std::string name = before + names[i];
      const auto channel = trace_.Find(name);
      if (!channel) {
        out_.Error("pose.no_channel", at_, "the trace has no channel " + name,
                   "a pose needs the position and orientation of every body");
        good = false;
        continue;
      }
      values[i] = trace_.values[*channel][row_];
      if (std::isfinite(values[i])) continue;
      out_.Error(
          "pose.not_finite", at_,
          name + " is " + base::Brief(values[i]) + " at " + base::Brief(trace_.time_s[row_]) + " s",
          "choose another row");
      good = false;
    }
    return good;
  }

  void ReadBody(const std::string& name, BodyState& state) const {
    static constexpr std::array<const char*, 3> kPlace{"position_x_m", "position_y_m",
                                                       "position_z_m"};
    static constexpr std::array<const char*, 4> kTurn{"orientation_w", "orientation_x",
                                                      "orientation_y", "orientation_z"};
    const std::string before = "body/" + name + "/";
    std::array<double, 3> x{};
    std::array<double, 4> q{};
    const bool placed = Read(before, kPlace, x), turned = Read(before, kTurn, q);
    if (placed) state.position_m = {x[0], x[1], x[2]};
    if (!turned) return;
    const double size = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (std::fabs(size - 1) > kUnit) {
      out_.Error("pose.bad_quaternion", at_,
                 "the orientation of body " + name + " has the length " + base::Brief(size),
                 "expected a unit quaternion: w, x, y, z");
      return;
    }
    state.orientation = {q[0] / size, q[1] / size, q[2] / size, q[3] / size};
  }

  void ReadRestLength(const std::string& name, double& rest_m) const {
    const std::string channel = "cable/" + name + "/rest_length_m";
    std::array<double, 1> value{};
    if (!Has(channel) || !Read<1>("", {channel.c_str()}, value)) return;
    if (value[0] > 0) {
      rest_m = value[0];
    } else {
      out_.Error("pose.bad_value", at_, channel + " is " + base::Brief(value[0]),
                 "expected a value above 0");
    }
  }

  /// Warns if recorded cable lengths differ from those in this pose. In this case, the trace
  /// belongs to another robot, or to a robot with another described pose.
  void CompareLengths(const ModelDef& there) const {
    for (const CableDef& cable : there.cables) {
      if (cable.touches != CableTouches::kNone) continue;  // wrapping cables bend at contacts
      const auto channel = trace_.Find("cable/" + cable.name + "/length_m");
      if (!channel) continue;
      const double recorded_m = trace_.values[*channel][row_], length_m = CableLength(cable);
      if (!(std::fabs(recorded_m - length_m) > kSameLength * length_m)) continue;
      out_.Warning(
          "pose.cable_length_differs", at_,
          "cable " + cable.name + " is " + base::Brief(length_m) + " m long in this pose, but " +
              base::Brief(recorded_m) + " m in the recording",
          "use the experiment of the recording: orientations are relative to its described pose");
    }
  }

 private:
  const Trace& trace_;
  std::size_t row_;
  const SourceRef& at_;
  Diagnostics& out_;
};

}  // namespace

std::optional<Pose> PoseOfTrace(const RobotSpec& robot, const Trace& trace, std::size_t row,
                                const SourceRef& at, Diagnostics& out) {
  const ModelDef& def = robot.def;
  if (row >= trace.time_s.size()) {
    out.Error("pose.no_rows", at, "the trace has no rows, so it contains no pose");
    return std::nullopt;
  }
  const std::size_t before = out.items().size();
  const RowOfTrace from(trace, row, at, out);
  Pose pose;
  for (const BodyDef& body : def.bodies) {
    BodyState& state = pose.bodies.emplace_back();
    state.position_m = body.com_m;
    // A trace may omit the state of a fixed body.
    if (body.fixed && !from.Has("body/" + body.name + "/position_x_m")) continue;
    from.ReadBody(body.name, state);
  }
  for (const CableDef& cable : def.cables) {
    pose.rest_lengths_m.push_back(cable.rest_length_m);
    from.ReadRestLength(cable.name, pose.rest_lengths_m.back());
  }
  if (out.items().size() > before) return std::nullopt;
  from.CompareLengths(RobotAt(robot, pose).def);
  return pose;
}

}  // namespace taut
