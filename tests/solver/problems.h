/// Stored contact problems from real runs, as test cases of the contact solver:
/// tests/solver/README.md describes their origin and the file format.
#pragma once

#include <zlib.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "math/vec.h"

namespace taut::test {

struct ProblemBody {
  double inverse_mass = 0;                                 ///< [1/kg]
  std::array<std::array<double, 3>, 3> inverse_inertia{};  ///< Inverse inertia in W [1/(kg m^2)].
  Vec3 free_v, free_w;  ///< Velocities at the step's end without contacts and stiff cables.
};

/// The impulse n l[0] + t1 l[1] + t2 l[2] acts on body a, its opposite on body b.
struct ProblemContact {
  int a = 0, b = -1;  ///< b = -1: the world.
  Vec3 n, t1, t2;
  std::array<Vec3, 3> lever_a, lever_b;  ///< Arm x n, t1, t2 [m]; of the world: zero.
  double bias = 0;                       ///< The normal velocity is at least -bias [m/s].
  double mu = 0;
  std::array<double, 3> impulse{};  ///< Warm start: impulse of the previous step [N s].
};

struct ProblemLink {
  int body = 0;
  Vec3 pull, lever;  ///< Force direction and its lever, arm x pull, for an impulse of 1.
};

/// An impulse max(0, min(base - gain u, upper)), u: the links' pull . v + lever . w, summed.
struct ProblemCable {
  double base = 0, gain = 0, upper = 0;  ///< [N s], [kg], [N s]
  double impulse = 0;                    ///< Warm start: impulse of the previous step [N s].
  std::vector<ProblemLink> links;
};

struct ContactProblem {
  std::string scene;
  double step_s = 0;
  int sweeps = 0;               ///< Sweeps of the original solver,
  double residual_m_per_s = 0;  ///< and its final residual: above 1e-10 it did not converge.
  std::vector<ProblemBody> bodies;
  std::vector<ProblemContact> contacts;
  std::vector<ProblemCable> cables;
};

namespace problem_file {

constexpr char kMagic[] = "tautcontacts";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kNameBytes = 16;

/// Returns the file's contents in order; never reads past its end.
class Content {
 public:
  explicit Content(const std::string& path) {
    gzFile const file = gzopen(path.c_str(), "rb");
    if (file == nullptr) throw std::runtime_error(path + " cannot be read");
    std::array<unsigned char, 1 << 16> part;
    int n = 0;
    while ((n = gzread(file, part.data(), static_cast<unsigned>(part.size()))) > 0) {
      bytes_.insert(bytes_.end(), part.begin(), part.begin() + n);
    }
    const bool whole = gzclose(file) == Z_OK && n == 0;
    if (!whole) throw std::runtime_error(path + " is damaged");
    left_ = bytes_;
  }
  std::span<const unsigned char> Take(std::size_t count) {
    if (count > left_.size()) throw std::runtime_error("a file of contact problems is too short");
    const auto taken = left_.first(count);
    left_ = left_.subspan(count);
    return taken;
  }
  std::uint32_t Unsigned() {
    const auto four = Take(4);
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | four[i];
    return value;
  }
  bool empty() const { return left_.empty(); }

 private:
  std::vector<unsigned char> bytes_;
  std::span<const unsigned char> left_;
};

/// The two streams that problems are stored in.
struct Streams {
  std::vector<int> ints;
  std::vector<double> numbers;
  std::size_t next_int = 0, next_number = 0;

  Streams(Content& file, std::size_t int_count, std::size_t number_count) {
    for (std::size_t i = 0; i < int_count; ++i) {
      ints.push_back(static_cast<std::int32_t>(file.Unsigned()));
    }
    // Bytes of the same place value are stored together: they are similar, which improves
    // compression.
    std::vector<std::uint64_t> bits(number_count);
    for (unsigned place = 0; place < 8; ++place) {
      const auto plane = file.Take(number_count);
      for (std::size_t i = 0; i < number_count; ++i) {
        bits[i] |= std::uint64_t{plane[i]} << 8 * place;
      }
    }
    for (const std::uint64_t b : bits) numbers.push_back(std::bit_cast<double>(b));
  }
  int Int() { return ints.at(next_int++); }
  std::size_t Count() { return static_cast<std::size_t>(Int()); }
  double Number() { return numbers.at(next_number++); }
  bool empty() const { return next_int == ints.size() && next_number == numbers.size(); }
};

/// Reads the first number of every item, then the next number of every item.
template <class Items, class... Fields>
void Columns(Streams& from, Items& items, Fields... fields) {
  const auto column = [&](auto field) {
    for (auto& item : items) {
      double* const place = field(item);
      if (place != nullptr) *place = from.Number();
    }
  };
  (column(fields), ...);
}

inline void ReadBodies(Streams& from, std::vector<ProblemBody>& bodies) {
  const auto inertia = [](std::size_t i, std::size_t j) {
    return [i, j](ProblemBody& b) { return &b.inverse_inertia[i][j]; };
  };
  Columns(
      from, bodies, [](ProblemBody& b) { return &b.inverse_mass; }, inertia(0, 0), inertia(1, 1),
      inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2));
  Columns(
      from, bodies, [](ProblemBody& b) { return &b.free_v.x; },
      [](ProblemBody& b) { return &b.free_v.y; }, [](ProblemBody& b) { return &b.free_v.z; },
      [](ProblemBody& b) { return &b.free_w.x; }, [](ProblemBody& b) { return &b.free_w.y; },
      [](ProblemBody& b) { return &b.free_w.z; });
  for (ProblemBody& b : bodies) {
    auto& m = b.inverse_inertia;
    m[1][0] = m[0][1], m[2][0] = m[0][2], m[2][1] = m[1][2];
  }
}

/// Computes the tangents from the normal: the first is the component, perpendicular to the normal,
/// of the axis x or y of W, whichever is certainly not parallel to it.
inline void MakeTangents(ProblemContact& c) {
  const Vec3 axis = std::abs(c.n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 across = axis - Dot(axis, c.n) * c.n;
  c.t1 = (1 / std::sqrt(Dot(across, across))) * across;
  c.t2 = Cross(c.n, c.t1);
}

inline void ReadContacts(Streams& from, std::vector<ProblemContact>& contacts) {
  struct Row {
    ProblemContact* contact;
    Vec3 arm_a, arm_b;
    double* OfB(double& x) const { return contact->b < 0 ? nullptr : &x; }
  };
  std::vector<Row> rows;
  for (ProblemContact& c : contacts) {
    c.a = from.Int(), c.b = from.Int();
    rows.push_back({&c, {}, {}});
  }
  Columns(
      from, rows, [](Row& r) { return &r.contact->n.x; }, [](Row& r) { return &r.contact->n.y; },
      [](Row& r) { return &r.contact->n.z; }, [](Row& r) { return &r.arm_a.x; },
      [](Row& r) { return &r.arm_a.y; }, [](Row& r) { return &r.arm_a.z; },
      [](Row& r) { return r.OfB(r.arm_b.x); }, [](Row& r) { return r.OfB(r.arm_b.y); },
      [](Row& r) { return r.OfB(r.arm_b.z); }, [](Row& r) { return &r.contact->bias; },
      [](Row& r) { return &r.contact->mu; }, [](Row& r) { return &r.contact->impulse[0]; },
      [](Row& r) { return &r.contact->impulse[1]; }, [](Row& r) { return &r.contact->impulse[2]; });
  for (const Row& r : rows) {
    ProblemContact& c = *r.contact;
    MakeTangents(c);
    c.lever_a = {Cross(r.arm_a, c.n), Cross(r.arm_a, c.t1), Cross(r.arm_a, c.t2)};
    c.lever_b = {Cross(r.arm_b, c.n), Cross(r.arm_b, c.t1), Cross(r.arm_b, c.t2)};
  }
}

inline void ReadCables(Streams& from, std::vector<ProblemCable>& cables) {
  for (ProblemCable& c : cables) c.links.resize(from.Count());
  Columns(
      from, cables, [](ProblemCable& c) { return &c.base; },
      [](ProblemCable& c) { return &c.gain; }, [](ProblemCable& c) { return &c.upper; },
      [](ProblemCable& c) { return &c.impulse; });
  for (ProblemCable& c : cables) {
    for (ProblemLink& link : c.links) {
      link.body = from.Int();
      for (double* const x : {&link.pull.x, &link.pull.y, &link.pull.z, &link.lever.x,
                              &link.lever.y, &link.lever.z}) {
        *x = from.Number();
      }
    }
  }
}

}  // namespace problem_file

/// Returns all problems of a file; throws if it is not such a file, or incomplete.
inline std::vector<ContactProblem> LoadProblems(const std::string& path = TAUT_SOURCE_DIR
                                                "/tests/solver/problems.bin.gz") {
  using problem_file::kMagic;
  using problem_file::kVersion;
  problem_file::Content file(path);
  const std::size_t magic = sizeof kMagic - 1;
  if (std::memcmp(file.Take(magic).data(), kMagic, magic) != 0) {
    throw std::runtime_error(path + " holds no contact problems");
  }
  if (const std::uint32_t version = file.Unsigned(); version != kVersion) {
    throw std::runtime_error(path + " is of version " + std::to_string(version) + ", not " +
                             std::to_string(kVersion));
  }
  const std::uint32_t scene_count = file.Unsigned(), problem_count = file.Unsigned();
  const std::uint32_t int_count = file.Unsigned(), number_count = file.Unsigned();
  std::vector<std::string> scenes;
  for (std::uint32_t i = 0; i < scene_count; ++i) {
    std::string name;
    for (const unsigned char c : file.Take(problem_file::kNameBytes)) {
      if (c != 0) name += static_cast<char>(c);
    }
    scenes.push_back(name);
  }
  problem_file::Streams from(file, int_count, number_count);
  std::vector<ContactProblem> problems;
  for (std::uint32_t i = 0; i < problem_count; ++i) {
    ContactProblem p;
    p.scene = scenes.at(from.Count());
    p.sweeps = from.Int();
    p.bodies.resize(from.Count());
    p.contacts.resize(from.Count());
    p.cables.resize(from.Count());
    p.step_s = from.Number();
    p.residual_m_per_s = from.Number();
    problem_file::ReadBodies(from, p.bodies);
    problem_file::ReadContacts(from, p.contacts);
    problem_file::ReadCables(from, p.cables);
    problems.push_back(std::move(p));
  }
  if (!from.empty() || !file.empty()) throw std::runtime_error(path + " holds more than it says");
  return problems;
}

}  // namespace taut::test
