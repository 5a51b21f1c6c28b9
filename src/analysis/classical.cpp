// Counts of mechanisms and self-stresses of a pin-jointed structure: rods are members between
// points (Pellegrino and Calladine, 1986).
#include <cmath>

#include "analysis/structure_members.h"
#include "analysis/whole_motions.h"
#include "math/vec.h"

namespace taut::analysis {
namespace {

class Counter {
 public:
  Counter(const ModelDef& def, const Structure& s, const std::vector<MemberTerm>& members)
      : def_(def), s_(s), members_(members), places_(PlacesOf(def, s)) {}

  std::optional<Classical> Run() {
    if (places_.empty() || !FindRods()) return std::nullopt;
    const Eigen::Index rows = 3 * Index(places_.size());
    matrix_ = Eigen::MatrixXd::Zero(rows, Index(members_.size() + rods_.size()));
    for (std::size_t m = 0; m < members_.size(); ++m) {
      if (!Fill(members_[m], Index(m))) return std::nullopt;
    }
    for (std::size_t r = 0; r < rods_.size(); ++r) {
      FillPair(Index(members_.size() + r), rods_[r].first, rods_[r].second);
    }
    return Counted();
  }

 private:
  static Eigen::Index Index(std::size_t i) { return static_cast<Eigen::Index>(i); }

  /// Returns whether every body is a point or a rod; collects the rods.
  bool FindRods() {
    for (std::size_t b = 0; b < s_.bodies.size(); ++b) {
      std::vector<std::size_t> own;
      for (std::size_t p = 0; p < places_.size(); ++p) {
        if (places_[p].body == static_cast<int>(b)) own.push_back(p);
      }
      const Eigen::Index free = s_.FreeTurns(b, s_.start).cols();
      if (own.size() == 1 && free == 3) continue;
      if (own.size() != 2 || free != 1) return false;
      rods_.emplace_back(own[0], own[1]);
      out_.count.rods.push_back(s_.bodies[b]);
      const Vec3 along = places_[own[1]].at_m - places_[own[0]].at_m;
      out_.rod_length_m.push_back(std::sqrt(Dot(along, along)));
    }
    return true;
  }

  /// Returns the index of an anchor's point; nothing if the anchor is static.
  std::optional<std::size_t> PlaceAt(const Anchor& at) const {
    for (std::size_t p = 0; p < places_.size(); ++p) {
      const Vec3 apart = places_[p].at_m - at.at_m;
      if (places_[p].body == at.body && Dot(apart, apart) < 1e-18 * s_.size_m * s_.size_m) return p;
    }
    return std::nullopt;
  }
  void Push(Eigen::Index column, const Anchor& at, const Vec3& by) {
    if (const auto place = PlaceAt(at)) matrix_.block<3, 1>(3 * Index(*place), column) += Of(by);
  }
  void FillSpan(Eigen::Index column, const Anchor& a, const Anchor& b) {
    const Vec3 way = PlaceOf(b, s_.start) - PlaceOf(a, s_.start);
    const Vec3 u = (1 / std::fmax(std::sqrt(Dot(way, way)), 1e-300)) * way;
    Push(column, a, -1.0 * u);
    Push(column, b, u);
  }
  void FillPair(Eigen::Index column, std::size_t a, std::size_t b) {
    FillSpan(column, places_[a], places_[b]);
  }

  bool Fill(const MemberTerm& term, Eigen::Index column) {
    const StaticMember& member = term.member;
    if (member.kind == StaticMember::Kind::kContact) return false;
    if (member.kind == StaticMember::Kind::kCable) return FillCable(member, column);
    const PlacedJoint& joint = s_.joints[static_cast<std::size_t>(member.index)];
    if (joint.def.kind == JointKind::kDistance) {
      FillSpan(column, joint.a, joint.b);
      return true;
    }
    const HeldMotions held = ConstrainedMotions(joint.def.kind);
    if (held.swing || held.twist || (joint.def.stiffness > 0)) return false;
    const Vec3 along =
        UnitOf(joint.def, HeldRowsOf(joint.def)[static_cast<std::size_t>(member.part)]).force;
    Push(column, joint.a, -1.0 * along);
    Push(column, joint.b, along);
    return true;
  }
  bool FillCable(const StaticMember& member, Eigen::Index column) {
    const CableDef& cable = def_.cables[static_cast<std::size_t>(member.index)];
    int part = 0;
    for (std::size_t i = 1; i < cable.attachments.size(); ++i) {
      const AttachmentDef &a = cable.attachments[i - 1], &b = cable.attachments[i];
      if (a.wheel || b.wheel) return false;
      part += i > 1 && a.friction > 0;
      if (part != member.part) continue;
      FillSpan(column, s_.AnchorAt(a.body, a.position_m), s_.AnchorAt(b.body, b.position_m));
    }
    return true;
  }

  Classical Counted() {
    const Split split = SplitOf(matrix_);
    ClassicalCount& count = out_.count;
    count.nodes = static_cast<int>(places_.size());
    count.members = static_cast<int>(matrix_.cols());
    count.rank = split.rank;
    count.self_stresses = count.members - split.rank.rank;
    const Eigen::MatrixXd whole = WholeMotions(def_, s_);
    Eigen::MatrixXd rigid(matrix_.rows(), whole.cols());
    for (std::size_t p = 0; p < places_.size(); ++p) {
      rigid.middleRows<3>(3 * Index(p)) = MovesOf(s_, places_[p]) * whole;
    }
    count.rigid = static_cast<int>(PartsOf(split.left, rigid).in.cols());
    count.mechanisms = static_cast<int>(split.left.cols()) - count.rigid;
    out_.null = split.null;
    return out_;
  }

  const ModelDef& def_;
  const Structure& s_;
  const std::vector<MemberTerm>& members_;
  std::vector<Anchor> places_;
  std::vector<std::pair<std::size_t, std::size_t>> rods_;
  Eigen::MatrixXd matrix_;
  Classical out_;
};

}  // namespace

std::optional<Classical> ClassicalOf(const ModelDef& def, const Structure& s,
                                     const std::vector<MemberTerm>& members) {
  return Counter(def, s, members).Run();
}

}  // namespace taut::analysis
