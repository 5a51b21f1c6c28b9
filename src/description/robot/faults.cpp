// Loader of fault scripts.
#include "taut/faults.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "base/assert.h"
#include "description/robot/fault_keys.h"
#include "description/robot/robot_file.h"
#include "description/yaml/read_keys.h"

namespace taut {
namespace description {
namespace {

/// Keys of a kind of fault, in addition to `at_s` and `for_s`.
struct KindKeys {
  FaultKind kind;
  std::initializer_list<const char*> needed, allowed;
  bool lasts = true;  ///< Whether `for_s` is permitted.
};
const KindKeys kKindKeys[] = {
    {FaultKind::kClockDrift, {"board", "drift_ppm"}, {}},
    {FaultKind::kBoardLoss, {"board"}, {}},
    {FaultKind::kBrownOut, {"board"}, {}},
    {FaultKind::kFirmwareHang, {"board"}, {}, false},
    {FaultKind::kBusNoise, {"flips_per_bit"}, {}},
    {FaultKind::kBusError, {}, {}, false},
    {FaultKind::kBusStuck, {"line"}, {}},
    {FaultKind::kCutCable, {"cable"}, {}, false},
    {FaultKind::kStuckLoadCell, {"cable"}, {"force_n"}},
    {FaultKind::kStuckEncoder, {"cable"}, {}},
    {FaultKind::kDriverFault, {"board"}, {}},
    {FaultKind::kMotorSupplyLoss, {}, {}},
    {FaultKind::kUsbLoss, {}, {}},
    {FaultKind::kHostKilled, {}, {}},
};

bool Contains(std::initializer_list<const char*> keys, std::string_view key) {
  return std::any_of(keys.begin(), keys.end(), [&](const char* one) { return key == one; });
}

std::string KindsWith(const char* key) {
  std::string out;
  for (const KindKeys& one : kKindKeys) {
    const bool has = std::string_view(key) == "for_s"
                         ? one.lasts
                         : Contains(one.needed, key) || Contains(one.allowed, key);
    if (has) out += (out.empty() ? "" : ", ") + std::string(FaultName(one.kind));
  }
  return out;
}

FaultScript ReadScript(const Value& root, const std::vector<std::string>& cables,
                       const Scope& scope) {
  FaultFileText text;
  ReadMapping(root, "", scope, text);
  FaultScript script{text.name, text.description, {}, {}};
  for (FaultText& fault : text.faults) {
    if (!fault.cable.text.empty()) fault.spec.cable = FindActuatedCable(fault.cable, cables, scope);
    const int boards = static_cast<int>(cables.size() + 1) / 2;
    if (fault.board && *fault.board >= boards) {
      scope.out.Error("fault.unknown_board", fault.board_at,
                      "there is no board " + std::to_string(*fault.board),
                      "the robot has " + std::to_string(cables.size()) +
                          " motors, two per board; the first board is 0");
    }
    fault.spec.board = fault.board.value_or(-1);
    script.faults.push_back(fault.spec);
  }
  return script;
}

}  // namespace

void Check(const MapReader& map, FaultText& fault) {
  if (map.Has("board")) fault.board_at = map.Find("board")->at;
  const Value* kind = map.Find("kind");
  // If the kind is invalid, the permitted keys are unknown.
  if (!kind || kind->text != FaultName(fault.spec.kind)) return;
  const auto* keys = std::find_if(std::begin(kKindKeys), std::end(kKindKeys),
                                  [&](const KindKeys& one) { return one.kind == fault.spec.kind; });
  TAUT_ASSERT(keys != std::end(kKindKeys));
  for (const char* key : keys->needed) {
    if (!map.Has(key)) {
      map.scope().out.Error("fault.key_missing", map.at(),
                            map.what() + " needs the key \"" + key + "\"",
                            std::string("required by `kind: ") + FaultName(keys->kind) + "`");
    }
  }
  for (const char* key : {"board", "cable", "drift_ppm", "flips_per_bit", "line", "force_n"}) {
    if (map.Has(key) && !Contains(keys->needed, key) && !Contains(keys->allowed, key)) {
      map.Error("fault.key_without_effect", key, map.Path(key) + " has no effect here",
                "it is for kind: " + KindsWith(key));
    }
  }
  if (map.Has("for_s") && !keys->lasts) {
    map.Error("fault.duration_without_effect", "for_s", map.Path("for_s") + " has no effect here",
              std::string(FaultName(keys->kind)) + " has no duration");
  }
}

}  // namespace description

const char* FaultName(FaultKind kind) {
  for (const auto& [name, one] : description::kFaultKinds) {
    if (one == kind) return name.c_str();
  }
  return "";
}

std::optional<FaultScript> LoadFaults(const std::string& path,
                                      const std::vector<std::string>& cables, Diagnostics& out) {
  return description::LoadRobotFile(
      path, "faults", out, [&](const description::Value& root, const description::Scope& scope) {
        return description::ReadScript(root, cables, scope);
      });
}

}  // namespace taut
