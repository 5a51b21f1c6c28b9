// Change of a robot by settling, with warnings of changes that are probably unintended
// (docs/formats/checks.md).
#include <algorithm>
#include <cmath>
#include <string>

#include "base/brief.h"
#include "math/align.h"
#include "math/vec.h"
#include "plant/find_start.h"
#include "taut/start.h"

namespace taut {
namespace plant {
namespace {

/// A cable is slack if its tension is below this share of the largest described tension.
constexpr double kSlack = 1e-6;

std::pair<int, int> PairOf(const ContactState& contact) {
  return std::minmax(contact.body_a, contact.body_b);
}

}  // namespace

Unsettled NoteUnsettled(WorldBatch& batch, double step_s) {
  Unsettled before;
  for (std::size_t c = 0; c < batch.model().def().cables.size(); ++c) {
    before.elastic_n.push_back(batch.Cable(kTheWorld, static_cast<int>(c)).elastic_n);
  }
  const std::vector<std::uint8_t> as_described = batch.Save(kTheWorld);
  batch.Step(step_s);  // only a step detects contacts
  for (const ContactState& contact : batch.Contacts(kTheWorld)) {
    before.touching.insert(PairOf(contact));
  }
  batch.Restore(kTheWorld, as_described);
  return before;
}

StartChange ChangeOf(const Unsettled& before, const WorldBatch& batch) {
  const ModelDef& def = batch.model().def();
  StartChange change;
  for (const double n : before.elastic_n) {
    change.described_max_tension_n = std::max(change.described_max_tension_n, n);
  }
  const double slack_n = kSlack * change.described_max_tension_n;
  for (std::size_t c = 0; c < def.cables.size(); ++c) {
    const double elastic_n = batch.Cable(kTheWorld, static_cast<int>(c)).elastic_n;
    change.max_tension_n = std::max(change.max_tension_n, elastic_n);
    if (before.elastic_n[c] <= slack_n) continue;
    ++change.taut_cables;
    if (elastic_n <= slack_n) change.slack_cables.push_back(def.cables[c].name);
  }

  std::vector<Vec3> described, settled;
  for (std::size_t n = 0; n < def.nodes.size(); ++n) {
    described.push_back(def.nodes[n].position_m);
    settled.push_back(batch.NodePosition(kTheWorld, static_cast<int>(n)));
  }
  const RigidMotion motion = Align(described, settled);
  for (std::size_t n = 0; n < def.nodes.size(); ++n) {
    change.size_m = std::max(change.size_m, 2 * Length(described[n] - motion.from_center_m));
    const double moved_m = Length(settled[n] - motion.Of(described[n]));
    if (moved_m <= change.largest_displacement_m) continue;
    change.largest_displacement_m = moved_m;
    change.displaced_node = def.nodes[n].name;
  }

  std::set<std::pair<int, int>> pressing;
  for (const ContactState& contact : batch.Contacts(kTheWorld)) {
    if (contact.body_b == kWorld || !(Dot(contact.force_n, contact.force_n) > 0)) continue;
    if (before.touching.count(PairOf(contact)) == 0) pressing.insert(PairOf(contact));
  }
  for (const auto& [a, b] : pressing) {
    change.new_contacts.emplace_back(def.bodies[static_cast<std::size_t>(a)].name,
                                     def.bodies[static_cast<std::size_t>(b)].name);
  }
  return change;
}

}  // namespace plant

namespace {

using base::Brief;

/// If a node moves farther, relative to the robot's size, the robot has another shape.
constexpr double kFar = 0.25;
constexpr std::size_t kMostNames = 3;

/// Returns a text such as "a, b, c and 4 more".
template <class Items, class F>
std::string SomeOf(const Items& items, F name) {
  std::string text;
  for (std::size_t i = 0; i < items.size() && i < kMostNames; ++i) {
    text += (i == 0 ? "" : i + 1 == items.size() ? " and " : ", ") + name(items[i]);
  }
  if (items.size() > kMostNames) {
    text += " and " + std::to_string(items.size() - kMostNames) + " more";
  }
  return text;
}

}  // namespace

void WarnOfStart(const StartChange& change, Diagnostics& out) {
  const char* const hint = "see the settled robot with `taut check --settled` or `taut view`";
  if (!change.slack_cables.empty()) {
    const std::size_t slack = change.slack_cables.size();
    out.Warning("start.slack_cables", {},
                std::to_string(slack) + " of the " + std::to_string(change.taut_cables) +
                    " cables that are taut in the described pose " + (slack == 1 ? "is" : "are") +
                    " slack after settling: " +
                    SomeOf(change.slack_cables, [](const std::string& name) { return name; }) +
                    "; largest tension " + Brief(change.max_tension_n) +
                    " N, in the described pose " + Brief(change.described_max_tension_n) + " N",
                hint);
  }
  if (change.largest_displacement_m > kFar * change.size_m) {
    const double part = change.largest_displacement_m / change.size_m;
    out.Warning("start.other_shape", {},
                "the robot settles to another shape: the node \"" + change.displaced_node +
                    "\" moves " + Brief(change.largest_displacement_m) +
                    " m from its described position, " + Brief(100 * part) +
                    " % of the robot's size of " + Brief(change.size_m) + " m",
                hint);
  }
  if (!change.new_contacts.empty()) {
    out.Warning("start.new_contacts", {},
                "bodies that do not touch in the described pose touch after settling: " +
                    SomeOf(change.new_contacts,
                           [](const auto& pair) { return pair.first + " on " + pair.second; }),
                hint);
  }
}

}  // namespace taut
