// Pairs of shapes that may collide, and the storage of their contacts.
#include <algorithm>
#include <set>
#include <utility>

#include "sim/contacts/combine.h"
#include "sim/contacts/moving_pairs.h"
#include "sim/data/tables.h"

namespace taut::sim {
namespace {

/// Motion of a body after which the list of near bodies is made again, as a fraction of the mean
/// radius of the bodies.
constexpr double kNearShare = 0.1;

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
    for (const int body : jointed_) Lead(body);
    for (int body = 0; body < t_.body_count; ++body) {
      if (t_.HasMotion(body)) Lead(body);
    }
    std::uint32_t id = t_.first_pair_id;
    std::vector<int> solid;
    for (int a = 0; a <= t_.body_count; ++a) {
      if (!shapes_of_[static_cast<std::size_t>(a)].empty()) solid.push_back(a);
    }
    std::vector<int> fixed;
    for (const int b : solid) {
      if (!Collides(b)) fixed.push_back(b);
    }
    for (const int a : solid) {
      if (!t_.Moves(a)) continue;
      for (const int b : fixed) AddPair(a, b, id);
      for (const std::size_t surface : ground_) {
        for (const std::size_t i : shapes_of_[static_cast<std::size_t>(a)]) {
          BeginPair(a, t_.body_count);
          Meet(i, surface, id);
          WorldPairTable& pair = t_.world_pairs.back();
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
    Slots();
    Rows();
    Moving();
  }

 private:
  /// Returns whether other bodies may touch a body that moves or is kinematic.
  bool Collides(int body) const { return t_.Moves(body) || t_.HasMotion(body); }
  std::size_t ShapesOf(int body) const { return shapes_of_[static_cast<std::size_t>(body)].size(); }
  void Lead(int body) {
    for (const std::size_t i : shapes_of_[static_cast<std::size_t>(body)]) t_.shapes[i].led = true;
  }

  /// Determines the number of slots for contacts of each body with static geometry: one for every
  /// point on every plane, and a reasonable number for other shapes.
  void Slots() {
    std::vector<int> possible(static_cast<std::size_t>(t_.body_count));
    for (const WorldPairTable& pair : t_.world_pairs) {
      possible[static_cast<std::size_t>(pair.a)] += kMaxPointsPerPair * pair.pair_count;
    }
    int first = 0;
    for (int body = 0; body < t_.body_count; ++body) {
      t_.first_slot.push_back(first);
      const auto b = static_cast<std::size_t>(body);
      first += (t_.first_point[b + 1] - t_.first_point[b]) * t_.plane_count;
      first += std::min(possible[b], 24 + 8 * static_cast<int>(ShapesOf(body)));
    }
    t_.first_slot.push_back(first);
    t_.slot_count = first;
  }

  /// Lists the shapes of bodies that may touch each other, and the bodies that cannot collide with
  /// each of them.
  void Rows() {
    std::vector<int> led;  // kinematic bodies, which do not touch each other
    for (int body = 0; body < t_.body_count; ++body) {
      t_.first_shape.push_back(static_cast<int>(t_.body_shapes.size()));
      if (!Collides(body) || ShapesOf(body) == 0) continue;
      t_.colliders.push_back(body);
      if (t_.HasMotion(body)) led.push_back(body);
      for (const std::size_t i : shapes_of_[static_cast<std::size_t>(body)]) {
        t_.body_shapes.push_back(static_cast<int>(i));
      }
    }
    t_.first_shape.push_back(static_cast<int>(t_.body_shapes.size()));
    std::set<std::pair<int, int>> apart;
    for (const auto& [a, b] : apart_) {
      const auto touches = [&](int body) { return Collides(body) && ShapesOf(body) > 0; };
      if (a >= 0 && a != b && touches(a) && touches(b)) apart.emplace(a, b);
    }
    for (const int a : led) {
      for (const int b : led) {
        if (a < b) apart.emplace(a, b);
      }
    }
    std::uint64_t before = 0;
    auto next = apart.begin();
    for (int body = 0; body < t_.body_count; ++body) {
      const auto b = static_cast<std::size_t>(body);
      t_.shape_pairs_before.push_back(static_cast<std::uint32_t>(before));
      t_.first_apart.push_back(static_cast<int>(t_.apart.size()));
      int kept_apart = 0;
      for (; next != apart.end() && next->first == body; ++next) {
        t_.apart.push_back({next->second, kept_apart});
        kept_apart += static_cast<int>(ShapesOf(next->second));
      }
      const int own = t_.first_shape[b + 1] - t_.first_shape[b];
      const int later = static_cast<int>(t_.body_shapes.size()) - t_.first_shape[b + 1];
      before += static_cast<std::uint64_t>(own) * static_cast<std::uint64_t>(later - kept_apart);
    }
    t_.shape_pairs_before.push_back(static_cast<std::uint32_t>(before));
    t_.first_apart.push_back(static_cast<int>(t_.apart.size()));
    t_.pair_capacity = static_cast<int>(
        std::min(kMaxPointsPerPair * before, static_cast<std::uint64_t>(16 + 12 * t_.body_count)));
  }

  /// Lists all pairs of moving bodies, or reserves a list of near bodies if there are many.
  void Moving() {
    const auto n = static_cast<std::int64_t>(t_.colliders.size());
    const std::int64_t pairs = n * (n - 1) / 2 - static_cast<std::int64_t>(t_.apart.size());
    if (pairs > kFewMovingPairs) {
      t_.near_capacity = static_cast<int>(std::min(pairs, kNearPerBody * n));
      double bounds_m = 0;
      for (const int body : t_.colliders) bounds_m += t_.bound_m[static_cast<std::size_t>(body)];
      t_.near_m = kNearShare * bounds_m / static_cast<double>(n);
      return;
    }
    const struct View m = t_.View();
    for (const int a : t_.colliders) {
      for (const int b : t_.colliders) {
        if (a < b && !AreApart(m, a, b)) t_.moving_pairs.push_back(Ordered(m, a, b));
      }
    }
  }

  void BeginPair(int a, int b) {
    t_.world_pairs.push_back({a, b, static_cast<int>(t_.shape_pairs.size()), 0});
  }
  void EndPair() {
    if (t_.world_pairs.back().pair_count == 0) t_.world_pairs.pop_back();
  }
  void Meet(std::size_t i, std::size_t j, std::uint32_t& id) {
    const auto [at_rest, sliding, restitution] =
        Combined(t_.def(), t_.shapes[i].material, t_.shapes[j].material);
    t_.shape_pairs.push_back(
        {static_cast<int>(i), static_cast<int>(j), id, at_rest, sliding, restitution, 0});
    id += kMaxPointsPerPair;
    ++t_.world_pairs.back().pair_count;
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
