// Stored contact problems: bits as stored, and validity of their data, so that a failure of a
// solver is not a fault of the problem.
#include "tests/solver/problems.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

namespace taut::test {
namespace {

const std::vector<ContactProblem>& AllProblems() {
  static const std::vector<ContactProblem> problems = LoadProblems();
  return problems;
}

double LengthOf(const Vec3& v) { return std::sqrt(Dot(v, v)); }

/// FNV-1a hash of the bits of all given values of a problem.
class Checksum {
 public:
  void Add(double x) {
    auto bits = std::bit_cast<std::uint64_t>(x);
    for (int i = 0; i < 8; ++i, bits >>= 8) sum_ = (sum_ ^ (bits & 0xff)) * 0x100000001b3;
  }
  void Add(const Vec3& v) { Add(v.x), Add(v.y), Add(v.z); }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325;
};

/// Adds one problem's contents, without values that the reader computes (tangents and levers).
void Add(const ContactProblem& p, Checksum& sum) {
  sum.Add(p.step_s);
  for (const ProblemBody& b : p.bodies) {
    sum.Add(b.inverse_mass);
    for (const auto& row : b.inverse_inertia) {
      for (const double x : row) sum.Add(x);
    }
    sum.Add(b.free_v), sum.Add(b.free_w);
  }
  for (const ProblemContact& c : p.contacts) {
    sum.Add(c.a), sum.Add(c.b), sum.Add(c.n), sum.Add(c.bias), sum.Add(c.mu);
    for (const double l : c.impulse) sum.Add(l);
  }
  for (const ProblemCable& c : p.cables) {
    sum.Add(c.base), sum.Add(c.gain), sum.Add(c.upper), sum.Add(c.impulse);
    for (const ProblemLink& l : c.links) sum.Add(l.body), sum.Add(l.pull), sum.Add(l.lever);
  }
}

/// Returns the name of a problem for failure messages.
std::string ProblemName(const ContactProblem& p) {
  return p.scene + ", problem " + std::to_string(&p - AllProblems().data());
}

TEST(ContactProblems, AreAsManyOfEachSceneAsWereStored) {
  std::map<std::string, int> count, gave_up;
  for (const ContactProblem& p : AllProblems()) {
    ++count[p.scene];
    if (p.residual_m_per_s > 1e-10) ++gave_up[p.scene];
  }
  const std::map<std::string, int> stored = {
      {"boxes_10", 24}, {"boxes_3", 39},      {"boxes_6", 30},   {"feet_16", 30},
      {"feet_32", 22},  {"feet_64", 16},      {"feet_8", 30},    {"logs_20", 14},
      {"net_1e6", 22},  {"net_1e7b1e4", 22},  {"painleve", 468}, {"pile_10", 44},
      {"pile_20", 21},  {"pile_20_mu.8", 42}, {"pile_40", 10},   {"six_strut", 20},
      {"slab_1e4", 34}, {"spine3", 50},       {"wall12", 36}};
  EXPECT_EQ(count, stored);
  const std::map<std::string, int> hard = {{"boxes_10", 6}, {"boxes_3", 1},      {"boxes_6", 4},
                                           {"feet_64", 2},  {"painleve", 53},    {"pile_20", 7},
                                           {"pile_40", 6},  {"pile_20_mu.8", 33}};
  EXPECT_EQ(gave_up, hard);
}

TEST(ContactProblems, AreBitForBitWhatWasStored) {
  Checksum sum;
  for (const ContactProblem& p : AllProblems()) Add(p, sum);
  // Computed by a separate program (in Python) from the output of the runs.
  EXPECT_EQ(sum.sum(), std::uint64_t{0x92d529e3b6d56d4e});
}

TEST(ContactProblems, HaveBodiesWithMassAndInertia) {
  for (const ContactProblem& p : AllProblems()) {
    ASSERT_FALSE(p.bodies.empty()) << ProblemName(p);
    for (const ProblemBody& b : p.bodies) {
      EXPECT_GT(b.inverse_mass, 0) << ProblemName(p);
      const auto& m = b.inverse_inertia;
      const double minor = m[0][0] * m[1][1] - m[0][1] * m[1][0];
      const double det = minor * m[2][2] - m[0][2] * (m[2][0] * m[1][1] - m[2][1] * m[1][0]) +
                         m[1][2] * (m[2][0] * m[0][1] - m[2][1] * m[0][0]);
      EXPECT_TRUE(m[0][0] > 0 && minor > 0 && det > 0) << ProblemName(p);
      EXPECT_TRUE(m[0][1] == m[1][0] && m[0][2] == m[2][0] && m[1][2] == m[2][1]) << ProblemName(p);
    }
  }
}

TEST(ContactProblems, HaveNormalsAndTangentsAcrossEachOther) {
  for (const ContactProblem& p : AllProblems()) {
    for (const ProblemContact& c : p.contacts) {
      for (const Vec3& d : {c.n, c.t1, c.t2}) EXPECT_NEAR(LengthOf(d), 1, 1e-15) << ProblemName(p);
      for (const double cosine : {Dot(c.n, c.t1), Dot(c.n, c.t2), Dot(c.t1, c.t2)}) {
        EXPECT_NEAR(cosine, 0, 4e-16) << ProblemName(p);
      }
      EXPECT_NEAR(Dot(Cross(c.n, c.t1), c.t2), 1, 2e-15) << ProblemName(p) << ": not right-handed";
    }
  }
}

TEST(ContactProblems, HaveLeversOfOneArm) {
  // arm x n, arm x t1, arm x t2: each perpendicular to its direction, and any two give the same
  // third component of the arm: n . (arm x t1) = -t1 . (arm x n).
  for (const ContactProblem& p : AllProblems()) {
    for (const ProblemContact& c : p.contacts) {
      for (const std::array<Vec3, 3>& l : {c.lever_a, c.lever_b}) {
        const double size = 1e-15 * (LengthOf(l[0]) + LengthOf(l[1]) + LengthOf(l[2]));
        const std::array<Vec3, 3> d = {c.n, c.t1, c.t2};
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t j = 0; j < 3; ++j) {
            EXPECT_NEAR(Dot(d[i], l[j]) + Dot(d[j], l[i]), 0, size) << ProblemName(p);
          }
        }
      }
    }
  }
}

TEST(ContactProblems, HaveContactsOnTheSideThatTheirNormalSays) {
  // In these scenes all bodies are convex, their centers inside: seen from the center of A, a
  // contact lies against its normal, and from the center of B along it. The check uses arm . n,
  // which is t2 . (arm x t1): n = t1 x t2. Rods that cross at a small angle share one normal
  // between two contacts, for which this need not hold; hence no piles.
  for (const ContactProblem& p : AllProblems()) {
    const std::string kind = p.scene.substr(0, p.scene.find('_'));
    if (kind == "pile" || kind == "spine3" || kind == "wall12" || kind == "six") continue;
    for (const ProblemContact& c : p.contacts) {
      EXPECT_LT(Dot(c.t2, c.lever_a[1]), 0) << ProblemName(p);
      if (c.b == kWorld) continue;
      EXPECT_GT(Dot(c.t2, c.lever_b[1]), 0) << ProblemName(p);
    }
  }
}

TEST(ContactProblems, NameBodiesThatAreThere) {
  for (const ContactProblem& p : AllProblems()) {
    const int bodies = static_cast<int>(p.bodies.size());
    EXPECT_GT(p.contacts.size() + p.cables.size(), 0U) << ProblemName(p) << ": nothing to solve";
    for (const ProblemContact& c : p.contacts) {
      EXPECT_TRUE(c.a >= 0 && c.a < bodies && c.b >= -1 && c.b < bodies && c.a != c.b)
          << ProblemName(p);
      EXPECT_TRUE(c.mu >= 0 && c.impulse[0] >= 0) << ProblemName(p);
    }
    for (const ProblemCable& c : p.cables) {
      EXPECT_TRUE(c.gain > 0 && c.upper >= 0 && !c.links.empty()) << ProblemName(p);
      for (const ProblemLink& l : c.links) {
        EXPECT_TRUE(l.body >= 0 && l.body < bodies) << ProblemName(p);
        EXPECT_NEAR(LengthOf(l.pull), 1, 1e-15)
            << ProblemName(p) << ": these cables are not routed";
        EXPECT_NEAR(Dot(l.pull, l.lever), 0, 4e-16) << ProblemName(p);
      }
    }
  }
}

/// Returns the reader's error for a file that begins with this content.
std::string Complaint(const std::string& content) {
  const auto path = std::filesystem::path(testing::TempDir()) / "problems_test.bin";
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  std::fwrite(content.data(), 1, content.size(), file);
  std::fclose(file);
  std::string said;
  try {
    LoadProblems(path.string());
  } catch (const std::exception& error) {
    said = error.what();
  }
  std::filesystem::remove(path);
  return said;
}

TEST(ContactProblems, AreNotReadFromAnotherKindOfFile) {
  const std::string magic = "tautcontacts";
  EXPECT_NE(Complaint("something else altogether").find("holds no contact problems"),
            std::string::npos);
  EXPECT_NE(Complaint(magic + std::string("\2\0\0\0", 4)).find("is of version 2, not 1"),
            std::string::npos);
  EXPECT_NE(Complaint(magic + std::string("\1\0\0\0", 4)).find("too short"), std::string::npos);
  const std::string none = magic + std::string("\1\0\0\0", 4) + std::string(16, '\0');
  EXPECT_EQ(Complaint(none), "") << "no problems are none";
  EXPECT_NE(Complaint(none + "x").find("holds more than it says"), std::string::npos);
}

}  // namespace
}  // namespace taut::test
