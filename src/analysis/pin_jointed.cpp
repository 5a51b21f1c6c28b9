// Pin-jointed model of a robot: points, bars and strings (docs/export.md, section 1).
#include "taut/pin_jointed.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "analysis/coordinate.h"
#include "analysis/pin_nodes.h"
#include "base/brief.h"
#include "base/fixed.h"
#include "math/described_path.h"
#include "math/vec.h"
#include "taut/inverse_statics.h"
#include "taut/statics.h"

namespace taut {
namespace {

using analysis::Of;
using analysis::To;

constexpr double kTouch_m = 1e-3;    // largest gap of a ground contact [m]
constexpr double kBalanced = 1e-6;   // tolerance of the balance, as a share of the largest force
constexpr double kNoLength = 1e-12;  // strings up to this length count as having length zero [m]

/// Member between two places; its length is their distance.
struct Draft {
  PinMember member;
  bool known = true;  ///< Whether its force is known.
  double tension_n = 0;
};

class Maker {
 public:
  Maker(const ModelDef& def, bool weight) : def_(def), weight_(weight), places_(def) {}

  PinJointed Run() {
    for (const CableDef& cable : def_.cables) AddCable(cable);
    for (std::size_t j = 0; j < def_.joints.size(); ++j) AddJoint(def_.joints[j]);
    for (const CapsuleDef& rod : def_.capsules) {
      places_.At(rod.body, rod.from_m), places_.At(rod.body, rod.to_m);
    }
    AddGround();
    AddBodies();
    Number();
    Solve();
    return std::move(out_);
  }

 private:
  static std::size_t Index(int i) { return static_cast<std::size_t>(i); }

  void AddCable(const CableDef& cable) {
    math::DescribedPath path(cable);
    const double tension_n = CableTension(cable);
    double on_wheels_m = 0;
    for (const auto& wheel : path.wheels()) on_wheels_m += wheel.arc;
    std::vector<int> ends;    // places at the ends of the strings, two per string
    std::vector<int> starts;  // first string of each cluster
    for (int i = 1, before = 0; i < path.count(); ++i) {
      const std::size_t at = path.attachment(i);
      const bool on_wheel = cable.attachments[at].wheel.has_value();
      const bool arc = on_wheel && path.attachment(i - 1) == at;
      if (on_wheel && ArcAt(path, arc ? i - 1 : i) <= 0)
        continue;  // the cable passes this wheel without contact
      if (!arc) {
        if (starts.empty() || cable.attachments[path.attachment(before)].friction > 0) {
          starts.push_back(static_cast<int>(ends.size() / 2));
        }
        ends.push_back(PlaceOn(cable, path, before));
        ends.push_back(PlaceOn(cable, path, i));
      }
      before = i;
    }
    const double share = 1 - on_wheels_m / path.length_m();
    AddStrings(cable, ends, starts, cable.rest_length_m - on_wheels_m, share, tension_n);
    if (on_wheels_m > 0) {
      Note("cable " + cable.name + ": its strings and rest length exclude the " +
           base::Brief(on_wheels_m) + " m on wheels");
    }
    if (cable.touches != CableTouches::kNone) {
      Note("cable " + cable.name + " is straight: its wrapping around obstacles is ignored");
    }
  }
  static double ArcAt(const math::DescribedPath& path, int point) {
    for (const auto& wheel : path.wheels()) {
      if (wheel.at == point) return wheel.arc;
    }
    return 0;
  }
  int PlaceOn(const CableDef& cable, math::DescribedPath& path, int point) {
    return places_.At(cable.attachments[path.attachment(point)].body, path.points()[point].p);
  }

  /// Divides `rest_m` and the compliance of the cable among its strings, in proportion to their
  /// lengths.
  void AddStrings(const CableDef& cable, const std::vector<int>& ends,
                  const std::vector<int>& starts, double rest_m, double share, double tension_n) {
    double all_m = 0;
    std::vector<double> length_m;
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
      const Vec3 way = places_.point_m(ends[i + 1]) - places_.point_m(ends[i]);
      length_m.push_back(std::sqrt(Dot(way, way)));
      all_m += length_m.back();
    }
    const int strings = static_cast<int>(length_m.size());
    for (int s = 0; s < strings; ++s) {
      const bool begins = std::find(starts.begin(), starts.end(), s) != starts.end();
      if (begins) {
        PinCluster cluster;
        cluster.name = cable.name;
        if (starts.size() > 1) {
          cluster.name += "_span_" + std::to_string(++spans_);
        }
        strings_clusters_.push_back(cluster);
      }
      if (length_m[Index(s)] < kNoLength) continue;
      Draft draft;
      PinMember& member = draft.member;
      member.kind = PinMember::Kind::kString;
      member.name = strings == 1 ? cable.name : cable.name + "_" + std::to_string(s + 1);
      member.from = ends[Index(2 * s)], member.to = ends[Index(2 * s + 1)];
      member.cluster = static_cast<int>(strings_clusters_.size()) - 1;
      const double part = length_m[Index(s)] / all_m;
      member.rest_length_m = part * rest_m;
      member.stiffness_n_per_m = cable.stiffness_n_per_m / part;
      member.section = cable.member;
      member.section.mass_kg *= part * share;
      draft.tension_n = tension_n;
      strings_.push_back(draft);
    }
    spans_ = 0;
  }

  void AddJoint(const JointDef& joint) {
    const HeldMotions held = ConstrainedMotions(joint.kind);
    const bool a_stands = analysis::IsPinned(def_, joint.body_a),
               b_stands = analysis::IsPinned(def_, joint.body_b);
    if (joint.kind == JointKind::kDistance) {
      AddDistance(joint);
      return;
    }
    if (held.along && held.across) {
      places_.Join(FromOf(joint), ToOf(joint));
    } else if ((a_stands || b_stands) && (held.along || held.across)) {
      places_.Hold(b_stands ? FromOf(joint) : ToOf(joint), joint.axis, held.along);
    } else {
      Note("joint " + joint.name + " is left out: its points slide on each other");
      return;
    }
    if (held.swing || held.twist) {
      Note("joint " + joint.name + " holds its point, but no rotation");
    }
    if (joint.stiffness > 0) Note("the spring of joint " + joint.name + " is left out");
  }
  int FromOf(const JointDef& joint) { return places_.At(joint.body_a, joint.from_m); }
  int ToOf(const JointDef& joint) { return places_.At(joint.body_b, joint.to_m); }

  void AddDistance(const JointDef& joint) {
    if (!IsBar(joint) && !HoldsLength(joint)) {
      Note("joint " + joint.name + " is left out: it has only limits");
      return;
    }
    Draft draft;
    draft.known = IsBar(joint);
    draft.member.kind = PinMember::Kind::kBar;
    draft.member.name = joint.name;
    draft.member.from = FromOf(joint), draft.member.to = ToOf(joint);
    draft.member.section = joint.member;
    if (draft.known) {
      const Vec3 way = joint.to_m - joint.from_m;
      draft.member.stiffness_n_per_m = joint.stiffness;
      draft.member.rest_length_m = joint.rest;
      draft.tension_n = joint.stiffness * (std::sqrt(Dot(way, way)) - joint.rest);
    }
    bars_.push_back(draft);
  }

  /// Adds contacts with planes. Uses the place on the line of the contact force if there is one;
  /// otherwise adds a place.
  void AddGround() {
    for (const TouchDef& touch : FindTouches(def_, kTouch_m)) {
      int at = -1;
      for (const int place : places_.OfBody(touch.body)) {
        const Vec3 beside = Cross(places_.point_m(place) - touch.point_m, touch.normal);
        if (Dot(beside, beside) < 1e-12 * places_.size_m() * places_.size_m()) at = place;
      }
      if (at < 0) at = places_.At(touch.body, touch.point_m);
      ground_.push_back(at);
    }
  }

  void AddBodies() {
    std::vector<Draft> rods, braces;
    for (std::size_t b = 0; b < def_.bodies.size(); ++b) {
      if (places_.OfBody(static_cast<int>(b)).empty()) {
        Note("body " + def_.bodies[b].name + " is left out: no member is attached to it");
        continue;
      }
      const analysis::PinBody body = analysis::PinBodyOf(def_, static_cast<int>(b), places_);
      for (const auto& bar : body.bars) {
        Draft draft;
        draft.known = false;
        draft.member.kind = bar.kind, draft.member.name = bar.name;
        draft.member.from = bar.from, draft.member.to = bar.to;
        draft.member.section = bar.section;
        (bar.kind == PinMember::Kind::kRod ? rods : braces).push_back(draft);
      }
      mass_kg_.insert(mass_kg_.end(), body.mass_kg.begin(), body.mass_kg.end());
    }
    rods.insert(rods.end(), bars_.begin(), bars_.end());
    rods.insert(rods.end(), braces.begin(), braces.end());
    bars_ = std::move(rods);
  }

  void Number() {
    numbers_ = places_.Number();
    out_.nodes = numbers_.nodes;
    for (const auto& [place, mass_kg] : mass_kg_) {
      PinNode& node = out_.nodes[Index(numbers_.of_place[Index(place)])];
      node.mass_kg += mass_kg;
    }
    for (const int place : ground_) {
      out_.nodes[Index(numbers_.of_place[Index(place)])].on_ground = true;
    }
    AddWeight();
    out_.bars = static_cast<int>(bars_.size());
    for (Draft& bar : bars_) {
      bar.member.cluster = static_cast<int>(out_.clusters.size());
      out_.clusters.emplace_back().name = bar.member.name;
    }
    for (Draft& string : strings_) string.member.cluster += out_.bars;
    out_.clusters.insert(out_.clusters.end(), strings_clusters_.begin(), strings_clusters_.end());
    drafts_ = std::move(bars_);
    drafts_.insert(drafts_.end(), strings_.begin(), strings_.end());
    for (Draft& draft : drafts_) {
      PinMember& member = draft.member;
      member.from = numbers_.of_place[Index(member.from)];
      member.to = numbers_.of_place[Index(member.to)];
      const Vec3 way = Way(member);
      member.length_m = std::sqrt(Dot(way, way));
      if (!draft.known) member.rest_length_m = member.length_m;
    }
  }
  void AddWeight() {
    bool held = false;
    for (std::size_t n = 0; n < out_.nodes.size(); ++n) {
      held = held || out_.nodes[n].on_ground || numbers_.held[n].trace() > 0.5;
    }
    if (!weight_ || !held) return;
    for (PinNode& node : out_.nodes) node.load_n = node.mass_kg * def_.gravity_m_per_s2;
  }
  Vec3 Way(const PinMember& m) const {
    return out_.nodes[Index(m.to)].position_m - out_.nodes[Index(m.from)].position_m;
  }
  Eigen::Vector3d Direction(const PinMember& m) const {
    return m.length_m > kNoLength ? Of((1 / m.length_m) * Way(m)) : Eigen::Vector3d::Zero().eval();
  }

  /// Computes the unknown member forces [N] by least squares of the imbalance at the nodes.
  void Solve() {
    const Eigen::Index rows = 3 * static_cast<Eigen::Index>(out_.nodes.size());
    Eigen::VectorXd left = Eigen::VectorXd::Zero(rows);
    for (std::size_t n = 0; n < out_.nodes.size(); ++n) {
      left.segment<3>(3 * static_cast<Eigen::Index>(n)) = Of(out_.nodes[n].load_n);
    }
    std::vector<std::size_t> unknown;
    for (std::size_t m = 0; m < drafts_.size(); ++m) {
      if (drafts_[m].known) {
        Pull(drafts_[m].member, drafts_[m].tension_n, left);
      } else {
        unknown.push_back(m);
      }
    }
    Eigen::MatrixXd pulls = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(unknown.size()));
    for (std::size_t u = 0; u < unknown.size(); ++u) {
      Eigen::VectorXd column = Eigen::VectorXd::Zero(rows);
      Pull(drafts_[unknown[u]].member, 1, column);
      pulls.col(static_cast<Eigen::Index>(u)) = column;
    }
    if (!unknown.empty()) {
      const Eigen::VectorXd force_n =
          Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(Unheld(pulls))
              .solve(-Unheld(left));
      left += pulls * force_n;
      for (std::size_t u = 0; u < unknown.size(); ++u) {
        drafts_[unknown[u]].tension_n = force_n[static_cast<Eigen::Index>(u)];
      }
    }
    Finish(left);
  }
  void Pull(const PinMember& member, double tension_n, Eigen::VectorXd& at_nodes) const {
    const Eigen::Vector3d pull = tension_n * Direction(member);
    at_nodes.segment<3>(3 * member.from) += pull;
    at_nodes.segment<3>(3 * member.to) -= pull;
  }
  /// Removes the force components that supports and the ground carry.
  Eigen::MatrixXd Unheld(Eigen::MatrixXd at_nodes) const {
    for (std::size_t n = 0; n < out_.nodes.size(); ++n) {
      auto rows = at_nodes.middleRows<3>(3 * static_cast<Eigen::Index>(n));
      if (out_.nodes[n].on_ground) {
        rows.setZero();
      } else {
        rows -= (numbers_.held[n] * rows).eval();
      }
    }
    return at_nodes;
  }

  void Finish(const Eigen::VectorXd& left) {
    double largest_n = 0;
    for (Draft& draft : drafts_) {
      PinMember& member = draft.member;
      member.force_n = draft.tension_n;
      member.force_density_n_per_m = draft.tension_n / std::max(member.length_m, kNoLength);
      largest_n = std::max(largest_n, std::fabs(member.force_n));
      PinCluster& cluster = out_.clusters[Index(member.cluster)];
      cluster.length_m += member.length_m;
      cluster.rest_length_m += member.rest_length_m;
      cluster.force_n = member.force_n;
      // The strings of a cluster are springs in series.
      const double k = member.stiffness_n_per_m, sum = cluster.stiffness_n_per_m;
      if (k > 0) cluster.stiffness_n_per_m = sum > 0 ? sum * k / (sum + k) : k;
      out_.members.push_back(member);
    }
    const Eigen::VectorXd unheld = Unheld(left);
    double most_n = 0;
    std::size_t worst = 0;
    for (std::size_t n = 0; n < out_.nodes.size(); ++n) {
      const auto row = 3 * static_cast<Eigen::Index>(n);
      out_.nodes[n].left_n = To(-left.segment<3>(row));
      if (unheld.segment<3>(row).norm() > most_n) most_n = unheld.segment<3>(row).norm(), worst = n;
    }
    for (const PinNode& node : out_.nodes) {
      largest_n = std::max(largest_n, Of(node.load_n).norm());
    }
    if (most_n > kBalanced * largest_n) {
      Note("forces do not balance: the residual at node " + out_.nodes[worst].name + " is " +
           base::Brief(most_n) + " N; the robot is not at rest in this pose");
    }
  }

  void Note(std::string text) { out_.notes.push_back(std::move(text)); }

  const ModelDef& def_;
  bool weight_;
  analysis::PinPlaces places_;
  std::vector<Draft> bars_, strings_, drafts_;
  std::vector<PinCluster> strings_clusters_;
  int spans_ = 0;
  std::vector<int> ground_;
  std::vector<std::pair<int, double>> mass_kg_;
  analysis::PinPlaces::Nodes numbers_;
  PinJointed out_;
};

}  // namespace

PinJointed PinJointedOf(const ModelDef& def, bool weight) { return Maker(def, weight).Run(); }

Matrix NodeMatrix(const PinJointed& structure) {
  Matrix n(3, static_cast<int>(structure.nodes.size()));
  for (int i = 0; i < n.columns; ++i) {
    const Vec3& at = structure.nodes[static_cast<std::size_t>(i)].position_m;
    n(0, i) = at.x, n(1, i) = at.y, n(2, i) = at.z;
  }
  return n;
}

Matrix Connectivity(const PinJointed& structure, std::size_t from, std::size_t to) {
  Matrix c(static_cast<int>(to - from), static_cast<int>(structure.nodes.size()));
  for (int m = 0; m < c.rows; ++m) {
    const PinMember& member = structure.members[from + static_cast<std::size_t>(m)];
    c(m, member.from) = -1, c(m, member.to) = 1;
  }
  return c;
}

Matrix Clustering(const PinJointed& structure) {
  Matrix s(static_cast<int>(structure.clusters.size()), static_cast<int>(structure.members.size()));
  for (int m = 0; m < s.columns; ++m) {
    s(structure.members[static_cast<std::size_t>(m)].cluster, m) = 1;
  }
  return s;
}

}  // namespace taut
