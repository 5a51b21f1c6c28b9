// Points of bodies and their nodes in the pin-jointed model.
#include "analysis/pin_nodes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/coordinate.h"
#include "math/vec.h"

namespace taut::analysis {
namespace {

constexpr double kSamePlace = 1e-9;  // largest distance of equal places, as a share of the
                                     // structure's size
constexpr double kAligned = 1e-9;

double SizeOf(const ModelDef& def) {
  double size_m = 0;
  const auto reach = [&](const Vec3& p) { size_m = std::max(size_m, Dot(p, p)); };
  Vec3 middle;
  for (const BodyDef& body : def.bodies) {
    middle = middle + (1.0 / static_cast<double>(def.bodies.size())) * body.com_m;
  }
  for (const CapsuleDef& rod : def.capsules) reach(rod.from_m - middle), reach(rod.to_m - middle);
  for (const CableDef& cable : def.cables) {
    for (const AttachmentDef& at : cable.attachments) reach(at.position_m - middle);
  }
  return std::max(std::sqrt(size_m), 1e-6);
}

}  // namespace

bool IsPinned(const ModelDef& def, int body) {
  if (body == kWorld || def.bodies[static_cast<std::size_t>(body)].fixed) return true;
  return std::any_of(def.motions.begin(), def.motions.end(),
                     [&](const MotionDef& motion) { return motion.body == body; });
}

PinPlaces::PinPlaces(const ModelDef& def) : def_(def), size_m_(SizeOf(def)) {}

bool PinPlaces::Near(const Vec3& a, const Vec3& b) const {
  const Vec3 apart = a - b;
  return Dot(apart, apart) <= kSamePlace * kSamePlace * size_m_ * size_m_;
}

int PinPlaces::At(int body, const Vec3& point_m) {
  for (std::size_t p = 0; p < places_.size(); ++p) {
    if (places_[p].body == body && Near(places_[p].point_m, point_m)) return static_cast<int>(p);
  }
  places_.push_back({body, point_m, {}});
  joined_.push_back(static_cast<int>(places_.size()) - 1);
  held_.push_back(IsPinned(def_, body) ? Eigen::Matrix3d::Identity().eval()
                                       : Eigen::Matrix3d::Zero().eval());
  return joined_.back();
}

int PinPlaces::Root(int place) const {
  while (joined_[Index(place)] != place) place = joined_[Index(place)];
  return place;
}

void PinPlaces::Join(int a, int b) {
  const int first = std::min(Root(a), Root(b)), second = std::max(Root(a), Root(b));
  joined_[Index(second)] = first;
}

void PinPlaces::Hold(int place, const Vec3& axis, bool along) {
  const Eigen::Vector3d n = Of(axis).normalized();
  const Eigen::Matrix3d onto = n * n.transpose();
  held_[Index(place)] += along ? onto : (Eigen::Matrix3d::Identity() - onto).eval();
}

std::vector<int> PinPlaces::OfBody(int body) const {
  std::vector<int> found;
  for (std::size_t p = 0; p < places_.size(); ++p) {
    if (places_[p].body == body) found.push_back(static_cast<int>(p));
  }
  return found;
}

std::string PinPlaces::NameOf(int place) const {
  const Place& at = places_[Index(place)];
  if (!at.name.empty()) return at.name;
  for (const NodeDef& node : def_.nodes) {
    if (node.body == at.body && Near(node.position_m, at.point_m)) return node.name;
  }
  const std::string owner = at.body == kWorld ? "world" : def_.bodies[Index(at.body)].name;
  const std::vector<int> all = OfBody(at.body);
  return owner + "_point_" +
         std::to_string(std::find(all.begin(), all.end(), place) - all.begin() + 1);
}

PinPlaces::Nodes PinPlaces::Number() const {
  // First the nodes of the model, in their order, then all other places.
  std::vector<int> order;
  for (const NodeDef& node : def_.nodes) {
    for (std::size_t p = 0; p < places_.size(); ++p) {
      if (places_[p].body == node.body && Near(places_[p].point_m, node.position_m)) {
        order.push_back(static_cast<int>(p));
      }
    }
  }
  for (std::size_t p = 0; p < places_.size(); ++p) order.push_back(static_cast<int>(p));

  Nodes out;
  std::vector<int> of_root(places_.size(), -1);
  std::set<std::string> taken;
  for (const int place : order) {
    int& node = of_root[Index(Root(place))];
    if (node >= 0) continue;
    node = static_cast<int>(out.nodes.size());
    std::string name = NameOf(place);
    for (int more = 2; !taken.insert(name).second; ++more) {
      name = NameOf(place) + "_" + std::to_string(more);
    }
    PinNode& made = out.nodes.emplace_back();
    made.name = name, made.position_m = places_[Index(place)].point_m;
    out.held.emplace_back(Eigen::Matrix3d::Zero());
  }
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const int node = of_root[Index(Root(static_cast<int>(p)))];
    out.of_place.push_back(node);
    out.held[Index(node)] += held_[p];
  }
  for (std::size_t n = 0; n < out.nodes.size(); ++n) {
    // Projector onto the supported directions, whatever the number of supports per direction.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> parts(out.held[n]);
    Eigen::Matrix3d onto = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d v = parts.eigenvectors().col(i);
      if (parts.eigenvalues()[i] > kAligned) onto += v * v.transpose();
    }
    out.held[n] = onto;
    for (int axis = 0; axis < 3; ++axis) {
      out.nodes[n].pinned[Index(axis)] = onto(axis, axis) > 1 - kAligned;
    }
  }
  return out;
}

}  // namespace taut::analysis
