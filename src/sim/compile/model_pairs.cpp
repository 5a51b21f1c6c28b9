// Pairs of shapes that may collide, and the storage of their contacts.
#include <algorithm>
#include <set>
#include <utility>

#include "sim/contacts/combine.h"
#include "sim/data/tables.h"

namespace taut::sim {
namespace {

std::set<int> JointedBodies(const Tables& t) {
  std::set<int> bodies;
  for (const JointTable& joint : t.joints) bodies.insert(joint.a), bodies.insert(joint.b);
  return bodies;
}

class PairCompiler {
 public:
  PairCompiler(Tables& t, const std::vector<std::vector<std::size_t>>& shapes_of,
               const std::vector<std::size_t>& ground)
      : t_(t), shapes_of_(shapes_of), ground_(ground) {}

  /// Pairs with a static body are first, sorted by the moving body, whose slots store their
  /// contacts.
  void Run() {
    std::uint32_t id = t_.first_pair_id;
    std::vector<int> solid;
    for (int a = 0; a <= t_.body_count; ++a) {
      if (!shapes_of_[static_cast<std::size_t>(a)].empty()) solid.push_back(a);
    }
    for (const int a : solid) {
      if (!t_.Moves(a)) continue;
      for (const int b : solid) {
        if (!t_.Moves(b) && !t_.HasMotion(b)) AddPair(a, b, id);
      }
      for (const std::size_t surface : ground_) {
        for (const std::size_t i : shapes_of_[static_cast<std::size_t>(a)]) {
          BeginPair(a, t_.body_count);
          Meet(i, surface, id);
          BodyPairTable& pair = t_.body_pairs.back();
          pair.on_ground = true;
          for (int end = 0; end < 2; ++end) {
            if (!t_.shapes[i].elsewhere[end]) continue;
            t_.shape_pairs.back().elsewhere |= FeaturesOfEnd(end);
          }
          if (t_.shapes[i].shape_P.kind == ShapeKind::kRound &&
              t_.shapes[surface].shape_P.surface.table->is_field) {
            pair.kept = t_.kept_count++;
          }
        }
      }
    }
    t_.world_pair_count = static_cast<int>(t_.body_pairs.size());
    Slots();
    const std::uint32_t first_of_two = id;
    for (std::size_t i = 0; i < solid.size(); ++i) {
      for (std::size_t j = i + 1; j < solid.size(); ++j) {
        const int a = solid[i], b = solid[j];
        if (t_.Moves(a) && (t_.Moves(b) || t_.HasMotion(b))) AddPair(a, b, id);
        if (t_.HasMotion(a) && t_.Moves(b)) AddPair(b, a, id);
      }
    }
    t_.pair_capacity = static_cast<int>(std::min<std::uint64_t>(
        id - first_of_two, static_cast<std::uint64_t>(16 + 12 * t_.body_count)));
  }

 private:
  /// Determines the number of slots for contacts of each body with static geometry: one for every
  /// point on every plane, and a reasonable number for other shapes.
  void Slots() {
    int first = 0;
    for (int body = 0; body < t_.body_count; ++body) {
      t_.first_slot.push_back(first);
      const auto b = static_cast<std::size_t>(body);
      first += (t_.first_point[b + 1] - t_.first_point[b]) * t_.plane_count;
      int possible = 0;
      for (const BodyPairTable& pair : t_.body_pairs) {
        if (pair.a == body) possible += kMaxPointsPerPair * pair.pair_count;
      }
      first += std::min(possible, 24 + 8 * static_cast<int>(shapes_of_[b].size()));
    }
    t_.first_slot.push_back(first);
    t_.slot_count = first;
  }

  bool IsLed(int body) const { return t_.HasMotion(body) || jointed_.count(body) > 0; }
  void BeginPair(int a, int b) {
    t_.body_pairs.push_back({a, b, static_cast<int>(t_.shape_pairs.size()), 0});
  }
  void EndPair() {
    if (t_.body_pairs.back().pair_count == 0) t_.body_pairs.pop_back();
  }
  void Meet(std::size_t i, std::size_t j, std::uint32_t& id) {
    const auto [at_rest, sliding, restitution] =
        Combined(t_.def(), t_.shapes[i].material, t_.shapes[j].material);
    const ShapeTable &a = t_.shapes[i], &b = t_.shapes[j];
    const bool round = a.shape_P.kind == ShapeKind::kRound || b.shape_P.kind == ShapeKind::kRound;
    t_.shape_pairs.push_back({static_cast<int>(i), static_cast<int>(j), id, at_rest, sliding,
                              restitution, 0, round && (IsLed(a.body) || IsLed(b.body))});
    id += kMaxPointsPerPair;
    ++t_.body_pairs.back().pair_count;
  }

  void AddPair(int a, int b, std::uint32_t& id) {
    if (apart_.count(std::minmax(a, b)) > 0) return;
    BeginPair(a, b);
    for (const std::size_t i : shapes_of_[static_cast<std::size_t>(a)]) {
      for (const std::size_t j : shapes_of_[static_cast<std::size_t>(b)]) Meet(i, j, id);
    }
    EndPair();
  }

  Tables& t_;
  const std::vector<std::vector<std::size_t>>& shapes_of_;
  const std::vector<std::size_t>& ground_;
  const std::set<std::pair<int, int>> apart_ = KeptApart(t_.def());
  const std::set<int> jointed_ = JointedBodies(t_);
};

}  // namespace

void LayOutPairs(Tables& tables, const std::vector<std::vector<std::size_t>>& shapes_of,
                 const std::vector<std::size_t>& ground) {
  PairCompiler(tables, shapes_of, ground).Run();
}

}  // namespace taut::sim
