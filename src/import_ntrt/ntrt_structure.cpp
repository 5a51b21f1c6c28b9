#include "import_ntrt/ntrt_structure.h"

#include <deque>

namespace taut::import_ntrt {

const char* NameOf(Class kind) {
  switch (kind) {
    case Class::kRod:
      return "tgRodInfo";
    case Class::kBox:
      return "tgBoxInfo";
    case Class::kSphere:
      return "tgSphereInfo";
    case Class::kBasic:
      return "tgBasicActuatorInfo";
    case Class::kBasicContact:
      return "tgBasicContactCableInfo";
    case Class::kKinematic:
      return "tgKinematicActuatorInfo";
    case Class::kKinematicContact:
      return "tgKinematicContactCableInfo";
  }
  return "";
}

/// Calls `visit` for a structure and all its descendants, level by level, until it returns true.
template <class F>
void Model::ForEachBelow(int structure, const F& visit) const {
  std::deque<int> open{structure};
  while (!open.empty()) {
    const int now = open.front();
    open.pop_front();
    if (visit(now)) return;
    const std::vector<int>& children = structures[static_cast<std::size_t>(now)].children;
    open.insert(open.end(), children.begin(), children.end());
  }
}

int Model::FindChild(int structure, const std::string& name) const {
  const Words wanted = Split(name);
  int found = -1;
  ForEachBelow(structure, [&](int s) {
    const Words& tags = structures[static_cast<std::size_t>(s)].tags;
    if (!MayCompare(tags, wanted)) return true;
    if (s == structure || !HasAll(tags, wanted)) return false;
    found = s;
    return true;
  });
  return found;
}

int Model::FindNode(int structure, const std::string& name) const {
  const Words wanted = Split(name);
  int found = -1;
  ForEachBelow(structure, [&](int s) {
    for (const int node : structures[static_cast<std::size_t>(s)].nodes) {
      const Words& tags = nodes[static_cast<std::size_t>(node)].tags;
      if (!MayCompare(tags, wanted)) return true;
      if (!HasAll(tags, wanted)) continue;
      found = node;
      return true;
    }
    return false;
  });
  return found;
}

int Model::FindPair(int structure, const Vec3& a, const Vec3& b) const {
  int found = -1;
  ForEachBelow(structure, [&](int s) {
    for (const int i : structures[static_cast<std::size_t>(s)].pairs) {
      const Pair& pair = pairs[static_cast<std::size_t>(i)];
      if (!MayCompare(pair.tags, {})) return true;
      if (pair.removed) continue;
      const Vec3& from = nodes[static_cast<std::size_t>(pair.from)].place;
      const Vec3& to = nodes[static_cast<std::size_t>(pair.to)].place;
      if (!(SamePlace(from, a) && SamePlace(to, b)) && !(SamePlace(from, b) && SamePlace(to, a))) {
        continue;
      }
      found = i;
      return true;
    }
    return false;
  });
  return found;
}

void Model::Turn(int structure, const Vec3& about, const Quat& q) {
  ForEachBelow(structure, [&](int s) {
    Structure& moved = structures[static_cast<std::size_t>(s)];
    comparisons += moved.nodes.size();
    if (ComparedTooMuch()) return true;
    for (const int i : moved.nodes) {
      Vec3& place = nodes[static_cast<std::size_t>(i)].place;
      place = about + Rotate(q, place - about);
    }
    moved.shift = about + Rotate(q, moved.shift - about);
    moved.turn = q * moved.turn;
    return false;
  });
}

void Model::Shift(int structure, const Vec3& by) {
  ForEachBelow(structure, [&](int s) {
    Structure& moved = structures[static_cast<std::size_t>(s)];
    comparisons += moved.nodes.size();
    if (ComparedTooMuch()) return true;
    for (const int i : moved.nodes) {
      Vec3& place = nodes[static_cast<std::size_t>(i)].place;
      place = place + by;
    }
    moved.shift = moved.shift + by;
    return false;
  });
}

void Model::Scale(int structure, double factor) {
  const Vec3 about = Centroid(structure);
  ForEachBelow(structure, [&](int s) {
    Structure& moved = structures[static_cast<std::size_t>(s)];
    comparisons += moved.nodes.size();
    if (ComparedTooMuch()) return true;
    for (const int i : moved.nodes) {
      Node& node = nodes[static_cast<std::size_t>(i)];
      node.place = about + factor * (node.place - about);
      node.in_file = factor * node.in_file;
    }
    moved.shift = about + factor * (moved.shift - about);
    return false;
  });
}

Vec3 Model::Centroid(int structure) const {
  Vec3 sum;
  int count = 0;
  ForEachBelow(structure, [&](int s) {
    for (const int i : structures[static_cast<std::size_t>(s)].nodes) {
      sum = sum + nodes[static_cast<std::size_t>(i)].place;
      ++count;
    }
    return false;
  });
  return count == 0 ? sum : (1.0 / count) * sum;
}

}  // namespace taut::import_ntrt
