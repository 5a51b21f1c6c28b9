// Gait inputs of controllers: loading of gait files, and checks against the robot.
#include <algorithm>
#include <filesystem>
#include <iterator>

#include "description/experiment/control_keys.h"
#include "description/experiment/experiment_parts.h"

namespace taut::description {
namespace {

std::string NamesOf(const std::vector<int>& cables, const RobotSpec& robot) {
  std::string names;
  for (const int cable : cables) {
    names += (names.empty() ? "" : ", ") + robot.def.cables[static_cast<std::size_t>(cable)].name;
  }
  return names;
}

/// Returns the elements of `a` that are not in `b`; both are in ascending order.
std::vector<int> Without(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> rest;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
  return rest;
}

/// Gait files of an input. A file with several paths is read once.
class GaitFiles {
 public:
  GaitFiles(std::string what, const Scope& scope) : what_(std::move(what)), scope_(scope) {}

  /// Loads a gait file and returns its index; -1 after an error.
  int Add(const Value* file, const char* key) {
    const auto path = FindFile(file, what_ + "." + key, scope_);
    if (!path) return -1;
    std::error_code failed;
    for (const Known& known : known_) {
      if (std::filesystem::equivalent(known.path, *path, failed)) return known.number;
    }
    auto gait = LoadGait(*path, scope_.out);
    known_.push_back({*path, gait ? static_cast<int>(gaits.size()) : -1});
    if (gait) {
      gaits.push_back(std::move(*gait));
      places.push_back(file->at);
    }
    return known_.back().number;
  }

  std::vector<GaitSpec> gaits;
  std::vector<SourceRef> places;

 private:
  struct Known {
    std::string path;
    int number = 0;
  };
  std::string what_;
  const Scope& scope_;
  std::vector<Known> known_;
};

void CheckQuantity(const GaitSpec& gait, const GaitInputKind& kind, const SourceRef& at,
                   Diagnostics& out) {
  if (gait.drives == kind.drives) return;
  const bool lengths = gait.drives == GaitDrives::kRestLength;
  const GaitInputKind& right = lengths ? kRestLengthInput : kVelocityInput;
  out.Error("gait.wrong_output", at,
            std::string(kind.key) + ": gait " + gait.name + " drives " +
                (lengths ? "rest lengths" : "velocities"),
            std::string("use it as `") + right.key + "`");
}

}  // namespace

void Check(const MapReader& map, GaitInputText& input) {
  for (std::size_t i = 1; i < input.change_texts.size(); ++i) {
    const GaitChangeText& change = input.change_texts[i];
    const double before_s = input.change_texts[i - 1].at_s;
    if (!(change.at_s <= before_s)) continue;
    map.scope().out.Error("gait.times_not_increasing", change.at,
                          "changes: times must increase, but " + Shown(change.at_s) +
                              " s follows " + Shown(before_s) + " s");
  }
}

std::optional<GaitInputSpec> ToGaitInput(const GaitInputText& text, const GaitInputKind& kind,
                                         const RobotSpec* robot, const Scope& scope,
                                         std::vector<int>& cables) {
  const std::size_t errors_before = scope.out.items().size();
  GaitFiles files(kind.key, scope);
  GaitInputSpec input = text;
  files.Add(text.gait_file.value, "gait");
  for (const GaitChangeText& change : text.change_texts) {
    input.changes.push_back({change.at_s, files.Add(change.gait_file.value, "changes.gait")});
  }
  const std::string more = std::string(kind.key) + ".more_gaits";
  for (const ValuePtr& file : Items(text.more_gaits.value, more, scope)) {
    files.Add(file.get(), "more_gaits");
  }
  if (scope.out.items().size() != errors_before || files.gaits.empty()) return std::nullopt;
  input.gait = std::move(files.gaits.front());
  input.others.assign(std::make_move_iterator(files.gaits.begin() + 1),
                      std::make_move_iterator(files.gaits.end()));
  cables = CheckGaits(input, kind, files.places, robot, scope.out);
  if (scope.out.items().size() != errors_before) return std::nullopt;
  return input;
}

std::vector<int> CheckGaits(const GaitInputSpec& input, const GaitInputKind& kind,
                            const std::vector<SourceRef>& places, const RobotSpec* robot,
                            Diagnostics& out) {
  std::vector<int> first;
  bool known = false;
  for (std::size_t i = 0; i <= input.others.size(); ++i) {
    const GaitSpec& gait = GaitOf(input, i);
    CheckQuantity(gait, kind, places[i], out);
    for (std::size_t j = 0; j < i; ++j) {
      if (GaitOf(input, j).name != gait.name) continue;
      out.Error("gait.duplicate_name", places[i],
                std::string(kind.key) + ": two gaits are called " + gait.name,
                "give one of them another name: the names of its parameters begin with it");
      break;
    }
    const auto resolved = robot ? ResolveGait(gait, *robot, out) : std::nullopt;
    if (!resolved) continue;
    std::vector<int> cables = resolved->cables;
    std::sort(cables.begin(), cables.end());
    if (i == 0) {
      first = std::move(cables);
      known = true;
    } else if (known && cables != first) {
      const std::vector<int> lacks = Without(first, cables), more = Without(cables, first);
      const bool is_less = !lacks.empty();
      const std::string &who = is_less ? gait.name : input.gait.name,
                        &than = is_less ? input.gait.name : gait.name;
      out.Error("gait.different_cables", places[i],
                std::string(kind.key) + ": gait " + who + " does not drive " +
                    NamesOf(is_less ? lacks : more, *robot) + ", which gait " + than + " drives",
                "all gaits of an input must drive the same cables");
    }
  }
  return first;
}

void CheckGaitDrives(const ControllerSpec& controller, const std::vector<int>& cables,
                     const RobotSpec& robot, const SourceRef& at, Diagnostics& out) {
  std::vector<int> driven;
  for (const ImpedanceGains& gains : controller.impedance->cables) driven.push_back(gains.cable);
  std::sort(driven.begin(), driven.end());
  const std::vector<int> idle = Without(cables, driven);
  if (idle.empty()) return;
  out.Error("gait.cable_not_driven", at,
            "gait " + controller.velocity_input->gait.name + " drives " + NamesOf(idle, robot) +
                ", which controller " + controller.name + " does not drive",
            "add `gains` and `set_points` for them");
}

}  // namespace taut::description
