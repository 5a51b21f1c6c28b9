// Contact pairs and friction. MuJoCo selects contacts by masks of geoms, pairs of bodies and pairs
// of geoms. taut excludes whole shapes or pairs of bodies.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "math/vec.h"
#include "mechanics/contact_roles.h"
#include "mjcf/mjcf_build.h"

namespace taut::mjcf {
namespace {

class ContactBuilder {
 public:
  explicit ContactBuilder(Building& b) : b_(b), scene_(b.scene) {
    for (const ContactPair& pair : scene_.pairs) {
      said_[std::minmax(pair.shape1, pair.shape2)] = &pair;
    }
    for (const auto& [one, two] : scene_.excludes) {
      excluded_.insert(std::minmax(Root(one), Root(two)));
    }
  }

  void FindWhatCollides() {
    for (Shape& s : scene_.shapes) s.collides = false;
    const int count = static_cast<int>(scene_.shapes.size());
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < i; ++j) {
        if (MayMeet(i, j) && Meet(i, j)) At(i).collides = At(j).collides = true;
      }
    }
  }

  void Apart() {
    // Pairs of bodies with at least one pair of shapes that do not collide in MuJoCo. True: other
    // shapes of the same bodies collide. Most pairs of bodies have no entry, since all their shapes
    // collide.
    std::map<std::pair<int, int>, bool> pass;
    const int count = static_cast<int>(scene_.shapes.size());
    const std::vector<int> body = Bodies();
    const auto pair_of = [&](int i, int j) {
      return std::minmax(body[Scene::Index(i)], body[Scene::Index(j)]);
    };
    std::string example;
    SourceRef example_at;
    int finer = 0;
    const auto add_finer = [&](int i, int j) {
      ++finer;
      if (example.empty()) example_at = At(i).at, example = Named(i) + " and " + Named(j);
    };
    const auto for_each_pair = [&](const auto& use) {
      for (int i = 0; i < count; ++i) {
        if (!At(i).collides) continue;
        for (int j = 0; j < i; ++j) {
          if (At(j).collides && MayMeet(i, j)) use(i, j, pair_of(i, j));
        }
      }
    };
    for_each_pair([&](int i, int j, const std::pair<int, int>& bodies) {
      if (Meet(i, j)) return;
      if (bodies.first != kWorld && bodies.second != kWorld) {
        pass.try_emplace(bodies, false);
      } else if (!Covered(i, j)) {
        add_finer(i, j);
      }
    });
    if (!pass.empty()) {
      for_each_pair([&](int i, int j, const std::pair<int, int>& bodies) {
        if (!Meet(i, j)) return;
        if (const auto found = pass.find(bodies); found != pass.end()) found->second = true;
      });
      for (const auto& [pair, meets] : pass) {
        if (!meets) b_.def().apart.push_back({pair.first, pair.second});
      }
      for_each_pair([&](int i, int j, const std::pair<int, int>& bodies) {
        if (Meet(i, j)) return;
        const auto found = pass.find(bodies);
        if (found != pass.end() && found->second && !Covered(i, j)) add_finer(i, j);
      });
    }
    if (finer == 0) return;
    b_.out.Warning(
        "mjcf.more_contacts", example_at,
        "the model has contacts that the MJCF file excludes: " +
            Count(static_cast<std::size_t>(finer), "pair") + " of geoms, such as " + example,
        "a shape of taut collides with everything or nothing, and `apart` excludes whole bodies");
  }

  /// Sets friction. MuJoCo uses the larger friction of two geoms, or the friction of the geom with
  /// higher priority.
  void Friction() {
    std::set<double> of_shapes;
    bool priorities = false;
    const int count = static_cast<int>(scene_.shapes.size());
    for (int i = 0; i < count; ++i) {
      if (Body(i) != kWorld && At(i).collides) of_shapes.insert(At(i).friction);
      for (int j = 0; j < i; ++j) {
        if (At(i).priority != At(j).priority && MayMeet(i, j)) priorities = true;
      }
    }
    ModelDef& def = b_.def();
    def.friction_combine = CombineRule::kMaximum;
    const bool one_kind = of_shapes.size() == 1 && *of_shapes.begin() > 0;
    if (priorities && one_kind) {  // a geometric mean can then reproduce the friction of the ground
      const double shape = *of_shapes.begin();
      def.friction_combine = CombineRule::kGeometricMean;
      for (int i = 0; i < count; ++i) {
        if (Body(i) != kWorld || !At(i).collides) continue;
        const bool rules = At(i).priority > LeastPriority();
        const double theirs = rules ? At(i).friction : std::max(At(i).friction, shape);
        const Building::Made& made = b_.made_of_shape[Scene::Index(i)];
        Material& m = std::string(made.list) == "plane" ? def.planes[made.index].material
                                                        : def.terrain_boxes[made.index].material;
        m.static_friction = m.kinetic_friction = theirs * theirs / shape;
      }
    }
    CheckFriction();
  }

 private:
  Shape& At(int i) { return scene_.shapes[Scene::Index(i)]; }
  int Root(int body) const { return scene_.bodies[Scene::Index(body)].root; }
  /// Returns the robot's body of a shape; the world for terrain.
  int Body(int i) {
    const Building::Made& made = b_.made_of_shape[Scene::Index(i)];
    const std::string list = made.list;
    return list == "plane" || list == "terrain box" ? kWorld : b_.RigidOf(At(i).body).body;
  }
  std::vector<int> Bodies() {
    std::vector<int> bodies;
    for (int i = 0; i < static_cast<int>(scene_.shapes.size()); ++i) bodies.push_back(Body(i));
    return bodies;
  }
  std::string Named(int i) {
    const Shape& s = At(i);
    return s.name.empty() ? "the geom in line " + std::to_string(s.at.line) : "\"" + s.name + "\"";
  }
  int LeastPriority() const {
    int least = 0;
    for (const Shape& s : scene_.shapes) least = std::min(least, s.priority);
    return least;
  }

  /// Returns whether two shapes belong to different bodies, at least one of which moves.
  bool MayMeet(int i, int j) {
    const Shape &one = At(i), &two = At(j);
    return Root(one.body) != Root(two.body) && (scene_.Moves(one.body) || scene_.Moves(two.body));
  }
  bool Meet(int i, int j) {
    if (said_.contains(std::minmax(i, j))) return true;
    const Shape &one = At(i), &two = At(j);
    return !scene_.only_pairs && scene_.has_contacts &&
           ((one.contype & two.conaffinity) != 0 || (two.contype & one.conaffinity) != 0) &&
           !excluded_.contains(std::minmax(Root(one.body), Root(two.body)));
  }

  /// Returns whether taut also excludes this pair.
  bool Covered(int i, int j) {
    if (!roles_) roles_ = mechanics::ContactRolesOf(b_.def());
    const auto role = [&](int k) {
      const Building::Made& made = b_.made_of_shape[Scene::Index(k)];
      const std::string list = made.list;
      if (list == "rod") return roles_->capsules[made.index];
      if (list == "sphere") return roles_->spheres[made.index];
      return mechanics::ContactRole{};
    };
    const bool plane = At(i).kind == Shape::Kind::kPlane || At(j).kind == Shape::Kind::kPlane;
    return plane ? !role(i).meets_planes || !role(j).meets_planes
                 : !role(i).meets_bodies || !role(j).meets_bodies;
  }

  void CheckFriction() {
    const ModelDef& def = b_.def();
    int other = 0;
    std::string example;
    SourceRef at;
    const auto material = [&](int i) {
      const Building::Made& made = b_.made_of_shape[Scene::Index(i)];
      const std::string list = made.list;
      const Material* m = list == "rod"      ? &def.capsules[made.index].material
                          : list == "sphere" ? &def.spheres[made.index].material
                          : list == "box"    ? &def.boxes[made.index].material
                          : list == "plane"  ? &def.planes[made.index].material
                                             : &def.terrain_boxes[made.index].material;
      return m->kinetic_friction;
    };
    const int count = static_cast<int>(scene_.shapes.size());
    std::vector<double> friction(scene_.shapes.size(), -1);  // -1: not computed yet
    const auto friction_of = [&](int i) {
      double& its = friction[Scene::Index(i)];
      if (its < 0) its = material(i);
      return its;
    };
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < i; ++j) {
        if (!MayMeet(i, j) || !Meet(i, j)) continue;
        const Shape &one = At(i), &two = At(j);
        const auto said = said_.find(std::minmax(i, j));
        const double theirs = said != said_.end()           ? said->second->friction
                              : one.priority > two.priority ? one.friction
                              : two.priority > one.priority ? two.friction
                                                            : std::max(one.friction, two.friction);
        const double m = friction_of(i), n = friction_of(j);
        const double ours =
            def.friction_combine == CombineRule::kMaximum ? std::max(m, n) : std::sqrt(m * n);
        if (std::fabs(ours - theirs) <= 1e-12 * (1 + theirs)) continue;
        ++other;
        if (example.empty()) {
          example = Named(i) + " on " + Named(j), at = one.at;
        }
      }
    }
    if (other == 0) return;
    b_.out.Warning(
        "mjcf.friction_differs", at,
        "the friction of " + Count(static_cast<std::size_t>(other), "pair") +
            " of geoms differs from that in MuJoCo, such as " + example,
        "a model has neither priorities nor contact pairs; change `friction` in the model");
  }

  Building& b_;
  Scene& scene_;
  std::map<std::pair<int, int>, const ContactPair*> said_;
  std::set<std::pair<int, int>> excluded_;
  std::optional<mechanics::ContactRoles> roles_;
};

}  // namespace

void FindWhatCollides(Building& b) { ContactBuilder(b).FindWhatCollides(); }

void BuildContacts(Building& b) {
  ContactBuilder contacts(b);
  contacts.Apart();
  contacts.Friction();
}

}  // namespace taut::mjcf
