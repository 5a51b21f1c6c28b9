/// Readings of a world, and serialization of its state (snapshots).

#include <algorithm>
#include <cstring>

#include "math/cable_law.h"
#include "sim/batch/batch_impl.h"
#include "sim/batch/motion.h"
#include "sim/contacts/moving_pairs.h"

namespace taut {

void WorldBatch::Sense(int group) const noexcept {
  sim::CheckIndex(__func__, "group", group, groups());
  impl_->Sense(group * impl_->lanes());
}

BodyState WorldBatch::Body(int world, int body) const noexcept {
  const Impl& d = *impl_;
  d.CheckBody(__func__, world, body);
  const Quat q = d.quat(world, body);
  const double* q0 = d.model->q_WP0.data() + static_cast<std::size_t>(4 * body);
  const Vec3 l = Rotate(Conjugate(q), d.vec(world, d.layout.mom + 3 * body));
  const Vec3 inv = d.vec(world, d.layout.inv_inertia + 3 * body);
  if (d.view.HasMotion(body)) {
    const sim::MotionSample now =
        sim::SampleMotion(d.view, d.view.motion_of_body[body], Time(world));
    return {now.position_m, now.orientation, now.velocity_m_per_s, now.spin_rad_per_s};
  }
  return {d.vec(world, d.layout.pos + 3 * body), q * Conjugate({q0[0], q0[1], q0[2], q0[3]}),
          d.vec(world, d.layout.vel + 3 * body),
          Rotate(q, {inv.x * l.x, inv.y * l.y, inv.z * l.z})};
}

Vec3 WorldBatch::NodePosition(int world, int node) const noexcept {
  const Impl& d = *impl_;
  d.CheckNode(__func__, world, node);
  const sim::AttachmentTable& n = d.view.nodes[node];
  const Vec3 p{n.p_P[0], n.p_P[1], n.p_P[2]};
  if (n.body == d.view.body_count) return p;
  return d.vec(world, d.layout.pos + 3 * n.body) + Rotate(d.quat(world, n.body), p);
}

Vec3 WorldBatch::NodeVelocity(int world, int node) const noexcept {
  const Impl& d = *impl_;
  d.CheckNode(__func__, world, node);
  const sim::AttachmentTable& n = d.view.nodes[node];
  if (n.body == d.view.body_count) return {};
  const BodyState b = Body(world, n.body);
  const Vec3 arm = Rotate(d.quat(world, n.body), {n.p_P[0], n.p_P[1], n.p_P[2]});
  return b.velocity_m_per_s + Cross(b.angular_velocity_rad_per_s, arm);
}

Energy WorldBatch::TotalEnergy(int world) const noexcept {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  Energy e;
  const Vec3 gravity = d.vec(world, d.layout.gravity);
  for (int b = 0; b < d.view.body_count; ++b) {
    const double mass = d.at(world, d.layout.mass + b);
    const Vec3 v = d.vec(world, d.layout.vel + 3 * b);
    const Vec3 l = Rotate(Conjugate(d.quat(world, b)), d.vec(world, d.layout.mom + 3 * b));
    const Vec3 inv = d.vec(world, d.layout.inv_inertia + 3 * b);
    e.kinetic_j +=
        0.5 * mass * Dot(v, v) + 0.5 * (inv.x * l.x * l.x + inv.y * l.y * l.y + inv.z * l.z * l.z);
    e.gravity_j -= mass * Dot(gravity, d.vec(world, d.layout.pos + 3 * b));
  }
  for (int c = 0; c < d.view.cable_count; ++c) {
    const CableState cable = Cable(world, c);
    if (d.view.cables[c].span_count > 0) {
      const double area_n = cable.stiffness_n_per_m * cable.rest_length_m;
      for (int i = 0; i < d.view.cables[c].span_count; ++i) {
        const CableSpanState span = CableSpan(world, c, i);
        if (span.rest_length_m == 0) continue;  // this bend does not exist at present
        const double longer = std::max(span.length_m - span.rest_length_m, 0.0);
        e.elastic_j += math::CableLaw{area_n / span.rest_length_m}.Energy(longer);
      }
      continue;
    }
    const double stretch = std::max(cable.length_m - cable.rest_length_m, 0.0);
    e.elastic_j += math::CableLaw{d.at(world, d.layout.stiffness + c)}.Energy(stretch);
  }
  for (int i = 0; i < d.view.joint_count; ++i) {
    const JointDef& joint = d.model->def().joints[static_cast<std::size_t>(i)];
    if (joint.stiffness == 0) continue;
    const JointState now = Joint(world, i);
    const bool turns = joint.kind == JointKind::kBall;
    const double stretch = turns ? now.turned_rad : now.coordinate - joint.rest;
    e.elastic_j += 0.5 * joint.stiffness * stretch * stretch;
  }
  return e;
}

Vec3 WorldBatch::Momentum(int world) const noexcept {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  Vec3 sum;
  for (int b = 0; b < d.view.body_count; ++b) {
    sum = sum + d.at(world, d.layout.mass + b) * d.vec(world, d.layout.vel + 3 * b);
  }
  return sum;
}

Vec3 WorldBatch::AngularMomentum(int world) const noexcept {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  Vec3 sum;
  for (int b = 0; b < d.view.body_count; ++b) {
    const Vec3 p = d.at(world, d.layout.mass + b) * d.vec(world, d.layout.vel + 3 * b);
    sum = sum + d.vec(world, d.layout.mom + 3 * b) + Cross(d.vec(world, d.layout.pos + 3 * b), p);
  }
  return sum;
}

namespace {

struct Touching {
  int a, b;
};

/// Returns the bodies of a contact from its key.
Touching BodiesOf(const sim::View& m, double key) {
  const auto id = static_cast<std::uint32_t>(key);
  if (id < m.first_pair_id) {
    const int point = static_cast<int>(id) / m.plane_count;
    const int* const end = m.first_point + m.body_count + 1;
    return {static_cast<int>(std::upper_bound(m.first_point, end, point) - m.first_point) - 1,
            m.body_count};
  }
  const sim::ShapePairTable pair = sim::PairOfKey(m, id);
  return {m.shapes[pair.a].body, m.shapes[pair.b].body};
}

}  // namespace

std::vector<ContactState> WorldBatch::Contacts(int world) const {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  const sim::View& m = d.view;
  std::vector<ContactState> out;
  d.ForEachContact(world, [&](int i) {
    ContactState c;
    const Touching bodies = BodiesOf(m, d.at(world, d.layout.contact_key + i));
    c.body_a = bodies.a;
    c.body_b = bodies.b == m.body_count ? kWorld : bodies.b;
    c.point_m =
        d.vec(world, d.layout.pos + 3 * c.body_a) + d.vec(world, d.layout.contact_arm + 3 * i);
    c.normal = d.vec(world, d.layout.contact_normal + 3 * i);
    c.force_n = d.vec(world, d.layout.contact_force + 3 * i);
    c.gap_m = d.at(world, d.layout.contact_gap + i);
    out.push_back(c);
  });
  return out;
}

namespace {

/// Header of a snapshot. The rows of the state follow, then the contact memory.
struct SnapshotHeader {
  std::uint32_t magic = 0x74736e32;  // "tsn2"
  std::uint32_t rows = 0, contacts = 0, bits = 0;
  double first_time_s = 0;
};

/// Returns the number of values per contact; the key is first.
constexpr std::size_t MemoryWidth() {
  std::size_t width = 0;
  for (const sim::RowInfo& row : sim::kStateRows) {
    if (row.role == sim::Role::kMemory) width += static_cast<std::size_t>(row.width);
  }
  return width;
}

std::size_t SnapshotSize(const SnapshotHeader& header) {
  return sizeof(SnapshotHeader) + sizeof(double) * header.rows +
         sizeof(double) * MemoryWidth() * header.contacts;
}

template <class T>
void Write(std::uint8_t*& at, const T& x) {
  std::memcpy(at, &x, sizeof(T));
  at += sizeof(T);
}
template <class T>
T Read(const std::uint8_t*& at) {
  T x;
  std::memcpy(&x, at, sizeof(T));
  at += sizeof(T);
  return x;
}

}  // namespace

std::vector<std::uint8_t> WorldBatch::Save(int world) const {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  const sim::Group& g = d.group(world);
  const sim::LaneStatus& status = g.status[world % d.lanes()];
  SnapshotHeader header;
  header.rows = static_cast<std::uint32_t>(d.layout.snapshot_rows);
  header.bits = status.bits;
  header.first_time_s = status.first_time_s;
  std::vector<int> live;
  d.ForEachContact(world, [&](int i) { live.push_back(i); });
  header.contacts = static_cast<std::uint32_t>(live.size());
  std::vector<std::uint8_t> out(SnapshotSize(header));
  std::uint8_t* at = out.data();
  Write(at, header);
  for (int row = 0; row < d.layout.snapshot_rows; ++row) Write(at, d.at(world, row));
  for (const int i : live) {
    d.EachMemory(world, i, [&](double x) { Write(at, x); });
  }
  return out;
}

bool WorldBatch::Restore(int world, const std::vector<std::uint8_t>& snapshot) noexcept {
  Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  if (snapshot.size() < sizeof(SnapshotHeader)) return false;
  const std::uint8_t* at = snapshot.data();
  const auto header = Read<SnapshotHeader>(at);
  if (header.magic != SnapshotHeader().magic || snapshot.size() != SnapshotSize(header) ||
      header.rows != static_cast<std::uint32_t>(d.layout.snapshot_rows) ||
      header.contacts > static_cast<std::uint32_t>(d.view.ContactCapacity())) {
    return false;
  }
  const std::uint8_t* key_at = at + sizeof(double) * header.rows;
  for (std::uint32_t k = 0; k < header.contacts; ++k) {
    const double key = Read<double>(key_at);
    key_at += sizeof(double) * (MemoryWidth() - 1);
    if (!(key >= 0 && key < KeyEnd(d.view))) return false;
  }
  d.Moved(world);
  for (int row = 0; row < d.layout.snapshot_rows; ++row) d.at(world, row) = Read<double>(at);
  for (int node = 0; node < d.view.node_count; ++node) {
    const Vec3 f = d.vec(world, d.layout.node_force + 3 * node);
    if (f.x != 0 || f.y != 0 || f.z != 0) d.ForceNode(world, node);
  }
  sim::Group& g = d.group(world);
  sim::LaneStatus& status = g.status[world % d.lanes()];
  status = {};
  status.bits = header.bits;
  status.first_time_s = header.first_time_s;

  // The contacts of the snapshot replace those of this lane; other lanes keep their contacts.
  d.ForEachContact(world, [&](int i) { d.at(world, d.layout.contact_key + i) = sim::kNoKey; });
  const sim::View& m = d.view;
  int list = -1, next = 0;
  for (std::uint32_t k = 0; k < header.contacts; ++k) {
    const Touching bodies = BodiesOf(m, Read<double>(at));
    at -= sizeof(double);
    // Contacts with the world are in the slots of their body; contacts between moving bodies follow
    // after all slots.
    const bool moves = bodies.b < m.body_count &&
                       (d.at(world, d.layout.mass + bodies.b) > 0 || d.view.HasMotion(bodies.b));
    const int first = moves ? m.slot_count : m.first_slot[bodies.a];
    if (list != first) next = first;
    list = first;
    const int room = moves ? m.pair_capacity : m.first_slot[bodies.a + 1] - first;
    int& used = moves ? g.touches_used : g.slots_used[bodies.a];
    const int i = next++;
    if (i - first >= room) {  // impossible for a snapshot from Save
      at += sizeof(double) * MemoryWidth();
      continue;
    }
    if (i - first == used) {
      ++used;
      std::fill_n(g.rows + (d.layout.contact_key + i) * g.lanes, g.lanes, sim::kNoKey);
    }
    d.EachMemory(world, i, [&](double& x) { x = Read<double>(at); });
  }
  // Derived rows belong to the replaced state.
#define TAUT_ROW(name, type, per, role, halted, start)                    \
  if constexpr (sim::Role::role == sim::Role::kDerived) {                 \
    const int count = sim::kWidth##type * d.view.Count(sim::Per::per);    \
    for (int i = 0; i < count; ++i) d.at(world, d.layout.name + i) = 0.0; \
  }
  TAUT_STATE_ROWS(TAUT_ROW)
#undef TAUT_ROW
  return true;
}

std::uint64_t WorldBatch::Hash(int world) const noexcept {
  // FNV-1a hash over the contents of a snapshot except readings; no snapshot is created.
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&](double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof(bits));
    for (int i = 0; i < 8; ++i) hash = (hash ^ ((bits >> (8 * i)) & 0xff)) * 0x100000001b3u;
  };
  for (int row = 0; row < d.layout.hash_rows; ++row) add(d.at(world, row));
  d.ForEachContact(world, [&](int i) { d.EachMemory(world, i, add); });
  return hash;
}

WorldStatus WorldBatch::Status(int world) const noexcept {
  const Impl& d = *impl_;
  d.CheckWorld(__func__, world);
  const sim::LaneStatus& s = d.group(world).status[world % d.lanes()];
  return {s.bits,
          s.first_time_s,
          s.body,
          s.cable,
          s.ground,
          d.at(world, d.layout.residual),
          static_cast<int>(d.at(world, d.layout.linear_solves)),
          d.at(world, d.layout.relaxation)};
}

void WorldBatch::ClearStatus(int world) noexcept {
  impl_->CheckWorld(__func__, world);
  impl_->group(world).status[world % impl_->lanes()] = {};
  impl_->at(world, impl_->layout.halted) = 0.0;
}

}  // namespace taut
