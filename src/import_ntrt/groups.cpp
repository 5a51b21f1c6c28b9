// Conversion of NTRT's builders to builders of a model, in SI units. Equal builders are merged,
// unused ones are omitted.
#include <algorithm>
#include <cmath>
#include <map>

#include "description/model/beam_axes.h"
#include "import_ntrt/draft.h"
#include "import_ntrt/turn.h"

namespace taut::import_ntrt {
namespace {

/// Returns the largest number with three digits that is not above `number`.
double RoundedDown(double number) {
  if (!(number > 0.0)) return 0.0;
  const double step = std::pow(10.0, std::floor(std::log10(number)) - 2);
  return Rounded15(std::floor(number / step) * step);
}

class Grouper {
 public:
  Grouper(const Model& model, const Built& built, const NtrtOptions& options, Draft& draft,
          Diagnostics& out)
      : model_(model), built_(built), u_(options.length_unit_m), draft_(draft), out_(out) {}

  void Run() {
    for (const Solid& solid : built_.solids) AddSolid(solid);
    FindShortestRest();
    for (const Cable& cable : built_.cables) AddCable(cable);
    AddAnchors();
  }

 private:
  const Builder& BuilderOf(int i) const { return model_.builders[static_cast<std::size_t>(i)]; }
  const Vec3& PlaceOf(int node) const { return model_.nodes[static_cast<std::size_t>(node)].place; }

  void Add(Group group, int item, const Words& key) {
    const auto [same, fresh] = group_by_text_.try_emplace(group.Text(), draft_.groups.size());
    if (fresh) draft_.groups.push_back(std::move(group));
    draft_.groups[same->second].items.push_back(item);
    draft_.groups[same->second].keys.push_back(key);
  }

  /// Returns the tags in the builder's search that are not tags of the structure.
  Words KeyOf(const Builder& builder, int structure) const {
    Words key;
    const Words& own = model_.structures[static_cast<std::size_t>(structure)].tags;
    for (const std::string& word : Without(builder.search, own)) key.push_back(NameText(word));
    return key;
  }

  void AddSurface(const Parameters& is, std::vector<Field>& fields) const {
    fields.push_back({"density_kg_per_m3", is.density / (u_ * u_ * u_)});
    fields.push_back({"friction", is.friction});
    fields.push_back({"restitution", is.restitution});
  }

  void AddSolid(const Solid& solid) {
    const Builder& builder = BuilderOf(solid.builder);
    Group group;
    group.comment = NameOf(builder.kind);
    if (builder.kind == Class::kSphere) {
      group.kind = "sphere";
      group.on_nodes = true;
      group.fields = {{"radius_m", builder.is.radius * u_}};
      AddSurface(builder.is, group.fields);
      const Node& node = model_.nodes[static_cast<std::size_t>(solid.node)];
      Add(std::move(group), solid.from, KeyOf(builder, node.structure));
      return;
    }
    const int structure = model_.pairs[static_cast<std::size_t>(solid.pair)].structure;
    if (builder.kind == Class::kBox) {
      AddBox(solid, builder, std::move(group), structure);
      return;
    }
    group.kind = "rod";
    group.fields = {{"radius_m", builder.is.radius * u_}};
    AddSurface(builder.is, group.fields);
    Add(std::move(group), solid.pair, KeyOf(builder, structure));
  }

  /// NTRT rotates a box from y to its pair's direction by the shortest rotation. taut's boxes have
  /// a horizontal y axis. If the orientations differ by more than a swap of width and height,
  /// writes a convex solid with the box's corners.
  void AddBox(const Solid& solid, const Builder& builder, Group group, int structure) {
    const Vec3 from = PlaceOf(solid.from), along = PlaceOf(solid.to) - from;
    const Quat q = Between({0, 1, 0}, along, {});
    const Vec3 width = ZUp(Rotate(q, {1, 0, 0})), height = ZUp(Rotate(q, {0, 0, 1}));
    const DraftNode& node = draft_.nodes[static_cast<std::size_t>(solid.from)];
    const Structure& part = model_.structures[static_cast<std::size_t>(node.structure)];
    const bool in_part = node.structure == structure &&
                         draft_.nodes[static_cast<std::size_t>(solid.to)].structure == structure;
    const Quat turn = in_part ? ZUp(part.turn) : Quat{};
    const Quat beam =
        turn * description::BeamOrientation(Unit(Rotate(Conjugate(turn), ZUp(along))));
    const auto same = [](const Vec3& a, const Vec3& b) { return std::fabs(Dot(a, b)) > 1 - 1e-12; };
    const double w = 2 * builder.is.width * u_, h = 2 * builder.is.height * u_;
    group.kind = "box";
    group.comment += ", whose width and height are half of these";
    if (same(width, Rotate(beam, {0, 1, 0}))) {
      group.fields = {{"width_m", w}, {"height_m", h}};
    } else if (same(width, Rotate(beam, {0, 0, 1}))) {
      group.fields = {{"width_m", h}, {"height_m", w}};
    } else {
      AddTurnedBox(solid, builder, std::move(group), width, height);
      return;
    }
    AddSurface(builder.is, group.fields);
    Add(std::move(group), solid.pair, KeyOf(builder, structure));
  }

  void AddTurnedBox(const Solid& solid, const Builder& builder, Group group, const Vec3& width,
                    const Vec3& height) {
    DraftNode& from = draft_.nodes[static_cast<std::size_t>(solid.from)];
    DraftNode& to = draft_.nodes[static_cast<std::size_t>(solid.to)];
    const SourceRef& at = model_.pairs[static_cast<std::size_t>(solid.pair)].at;
    if (from.structure != to.structure) {
      out_.Error("ntrt.tilted_box", at, "a tilted box between two substructures cannot be imported",
                 "use tgRodInfo to build a rod instead");
      return;
    }
    const Quat back =
        Conjugate(ZUp(model_.structures[static_cast<std::size_t>(from.structure)].turn));
    const Vec3 along = u_ * ZUp(PlaceOf(solid.to) - PlaceOf(solid.from));
    const Grid grid(Length(along));
    std::string corners;
    for (const double l : {0.0, 1.0}) {
      for (const double w : {-1.0, 1.0}) {
        for (const double h : {-1.0, 1.0}) {
          const Vec3 corner = l * along + (w * builder.is.width * u_) * width +
                              (h * builder.is.height * u_) * height;
          corners += (corners.empty() ? "[" : ", ") + grid.Text(Rotate(back, corner));
        }
      }
    }
    group.kind = "convex";
    group.on_nodes = true;
    group.comment = std::string(NameOf(Class::kBox)) + ", oriented as in NTRT";
    group.fields = {{"corners_m", 0.0, corners + "]"}};
    AddSurface(builder.is, group.fields);
    if (to.fixed_to.empty()) to.fixed_to = from.name;
    Add(std::move(group), solid.from, {from.full_name});
  }

  /// taut's motors respect the minimum rest length from the start. NTRT's cables jump to the
  /// minimum at the first command.
  void FindShortestRest() {
    shortest_.assign(model_.builders.size(), INFINITY);
    for (const Cable& cable : built_.cables) {
      double& shortest = shortest_[static_cast<std::size_t>(cable.builder)];
      if (cable.rest_length > 0.0) shortest = std::min(shortest, cable.rest_length);
    }
    for (std::size_t b = 0; b < shortest_.size(); ++b) {
      const Builder& builder = model_.builders[b];
      if (!(shortest_[b] < builder.is.min_rest_length)) continue;
      const auto written = builder.written.find("min_rest_length");
      out_.Warning("ntrt.below_min_rest_length",
                   written == builder.written.end() ? PlaceOfBuilder(builder) : written->second,
                   "cables of \"" + builder.search[0] + "\" start with a rest length of " +
                       NumberText(shortest_[b]) + ", below min_rest_length, which is " +
                       NumberText(builder.is.min_rest_length) +
                       ": in NTRT the cables jump to min_rest_length at the first command; the "
                       "import uses the initial rest length as their minimum");
    }
  }
  SourceRef PlaceOfBuilder(const Builder& builder) const {
    return builder.at.file.empty() ? SourceRef{model_.structures[0].file, 0, 0} : builder.at;
  }

  void AddCable(const Cable& cable) {
    const Builder& builder = BuilderOf(cable.builder);
    DraftPair& pair = draft_.pairs[static_cast<std::size_t>(cable.pair)];
    Group group;
    group.kind = "cable";
    group.comment = NameOf(builder.kind);
    group.fields = {{"stiffness_n_per_m", builder.is.stiffness}};
    if (builder.is.damping > 0) group.fields.push_back({"damping_n_s_per_m", builder.is.damping});
    group.fields.push_back({"prestress_n", builder.is.pretension * u_});
    pair.from = cable.from.node;
    pair.to = cable.to.node;
    const bool on_surface = cable.from.kind == End::kSurface && cable.to.kind == End::kSurface;
    if (on_surface) {
      group.fields.push_back({"ends", 0.0, "surface"});
    } else {
      pair.from = NodeFor(cable.from, cable.to);
      pair.to = NodeFor(cable.to, cable.from);
    }
    if (builder.is.target_velocity > 0.0) {
      const double shortest = shortest_[static_cast<std::size_t>(cable.builder)];
      const double least = builder.is.min_rest_length;
      group.actuator = {
          {"max_speed_m_per_s", builder.is.target_velocity * u_},
          {"max_force_n", builder.is.max_tension * u_},
          {"min_rest_length_m", shortest < least ? RoundedDown(shortest * u_) : least * u_}};
      if (builder.is.min_actual_length > 0.0) {
        group.actuator.push_back({"min_length_m", builder.is.min_actual_length * u_});
      }
    }
    const int structure = model_.pairs[static_cast<std::size_t>(cable.pair)].structure;
    Add(std::move(group), cable.pair, KeyOf(builder, structure));
  }

  /// Returns the node of a cable end. Adds a node if the end is at a point that models cannot
  /// express otherwise.
  int NodeFor(const CableEnd& end, const CableEnd& other) {
    if (end.kind == End::kNode) return end.node;
    const DraftNode& at = draft_.nodes[static_cast<std::size_t>(end.node)];
    const Structure& part = model_.structures[static_cast<std::size_t>(at.structure)];
    DraftNode node;
    node.structure = at.structure;
    node.fixed_to = at.name;
    node.name = at.name + "_to_" + draft_.nodes[static_cast<std::size_t>(other.node)].name;
    const auto taken = [&] {
      return std::any_of(draft_.nodes.begin(), draft_.nodes.end(), [&](const DraftNode& n) {
        return n.structure == node.structure && n.name == node.name;
      });
    };
    while (taken()) node.name += "_";
    const std::string& placement = draft_.placements[static_cast<std::size_t>(at.structure)];
    node.full_name = placement.empty() ? node.name : placement + "." + node.name;
    node.at_m = u_ * ZUp(Rotate(Conjugate(part.turn), end.point - part.shift));
    draft_.nodes.push_back(node);
    return static_cast<int>(draft_.nodes.size()) - 1;
  }

  /// Adds an anchor to each body without mass, because Bullet does not move such bodies.
  void AddAnchors() {
    std::vector<bool> done(built_.mass_kg.size(), false);
    for (const Solid& solid : built_.solids) {
      const auto body = static_cast<std::size_t>(solid.body);
      if (built_.mass_kg[body] > 0.0 || done[body]) continue;
      done[body] = true;
      Group group;
      group.kind = "anchor";
      group.comment = "no mass, so it is fixed";
      group.on_nodes = true;
      Add(std::move(group), solid.from,
          {draft_.nodes[static_cast<std::size_t>(solid.from)].full_name});
    }
  }

  const Model& model_;
  const Built& built_;
  const double u_;
  Draft& draft_;
  std::map<std::string, std::size_t> group_by_text_;
  Diagnostics& out_;
  std::vector<double> shortest_;
};

/// Ensures that each group's selector matches only its items. If existing tags cannot do this, adds
/// a new tag.
class ReportWriter {
 public:
  explicit ReportWriter(Draft& draft) : draft_(draft) {}

  void Run() {
    for (Group& group : draft_.groups) {
      std::vector<Words> keys;
      for (const Words& key : group.keys) {
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
      }
      if (!Tells(group, keys)) {
        std::string tag = group.keys[0].empty() ? group.kind : group.keys[0].back();
        std::replace(tag.begin(), tag.end(), '.', '_');
        for (tag += "_"; IsTag(tag + std::to_string(number_)); ++number_) continue;
        tag += std::to_string(number_);
        for (const int item : group.items) TagsOf(group, item).push_back(tag);
        keys = {{tag}};
      }
      group.keys = keys;
    }
  }

 private:
  Words& TagsOf(const Group& group, int item) {
    const auto i = static_cast<std::size_t>(item);
    return group.on_nodes ? draft_.nodes[i].tags : draft_.pairs[i].tags;
  }
  Words AllTagsOf(const Group& group, int item) {
    Words tags = TagsOf(group, item);
    if (group.on_nodes) {
      const DraftNode& node = draft_.nodes[static_cast<std::size_t>(item)];
      tags.insert(tags.end(), {node.name, node.full_name});
    } else {
      tags.push_back(draft_.pairs[static_cast<std::size_t>(item)].name);
    }
    return tags;
  }

  bool Tells(const Group& group, const std::vector<Words>& keys) {
    const auto matches = [&](const Group& of, int item) {
      const Words tags = AllTagsOf(of, item);
      return std::any_of(keys.begin(), keys.end(),
                         [&](const Words& key) { return !key.empty() && HasAll(tags, key); });
    };
    for (const int item : group.items) {
      if (!matches(group, item)) return false;
    }
    if (group.on_nodes) {  // compare with all nodes, since most have no builder
      for (std::size_t i = 0; i < draft_.nodes.size(); ++i) {
        const int item = static_cast<int>(i);
        if (draft_.nodes[i].structure < 0) continue;
        const bool own =
            std::find(group.items.begin(), group.items.end(), item) != group.items.end();
        if (!own && matches(group, item)) return false;
      }
      return true;
    }
    for (const Group& other : draft_.groups) {
      if (other.on_nodes || &other == &group) continue;
      for (const int item : other.items) {
        if (matches(other, item)) return false;
      }
    }
    return true;
  }

  bool IsTag(const std::string& tag) const {
    const auto has = [&](const auto& item) { return item.name == tag || Has(item.tags, tag); };
    return std::any_of(draft_.nodes.begin(), draft_.nodes.end(), has) ||
           std::any_of(draft_.pairs.begin(), draft_.pairs.end(), has);
  }

  Draft& draft_;
  int number_ = 1;
};

/// Lists parameters of used builders that models lack, one sentence per parameter.
void ReportDropped(const Model& model, const Built& built, NtrtImport& import) {
  std::vector<bool> used(model.builders.size(), false);
  for (const Solid& solid : built.solids) used[static_cast<std::size_t>(solid.builder)] = true;
  for (const Cable& cable : built.cables) used[static_cast<std::size_t>(cable.builder)] = true;
  const auto say = [&](const std::string& what, const std::string& why, const auto& is_so) {
    Words tags;
    for (std::size_t b = 0; b < used.size(); ++b) {
      const Builder& builder = model.builders[b];
      if (!used[b] || !is_so(builder)) continue;
      std::string tag;
      for (const std::string& word : builder.search) tag += (tag.empty() ? "" : " ") + word;
      if (!Has(tags, tag)) tags.push_back(tag);
    }
    if (tags.empty()) return;
    std::string list;
    for (const std::string& tag : tags) list += (list.empty() ? "" : ", ") + tag;
    import.dropped.push_back(what + " of " + list + ": " + why);
  };
  const auto writes = [](const char* name) {
    return [name](const Builder& builder) { return builder.written.count(name) > 0; };
  };
  say("history", "a run records every cable", writes("history"));
  say("roll_friction", "rolling friction is not modeled", [](const Builder& builder) {
    return IsSolid(builder.kind) && builder.is.roll_friction != 0.0;
  });
  say("radius, motor_friction, motor_inertia and back_drivable",
      "the actuator has limits only, as with tgBasicActuatorInfo; `dc_motor` adds a motor",
      [](const Builder& builder) {
        return builder.kind == Class::kKinematic || builder.kind == Class::kKinematicContact;
      });
  say("contact", "the cables pass through obstacles; `touches: rods` lets them wrap around rods",
      [](const Builder& builder) {
        return builder.kind == Class::kBasicContact || builder.kind == Class::kKinematicContact;
      });
}

}  // namespace

void AddGroups(const Model& model, const Built& built, const NtrtOptions& options, Draft& draft,
               NtrtImport& import, Diagnostics& out) {
  Grouper(model, built, options, draft, out).Run();
  ReportWriter(draft).Run();
  ReportDropped(model, built, import);
}

}  // namespace taut::import_ntrt
