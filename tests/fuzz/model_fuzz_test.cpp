// Model files with random damage: whatever stands in a file, reading it ends, throws nothing and
// gives either a robot or at least one error.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>

#include "taut/spec.h"

namespace taut {
namespace {

std::string Text(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class Damage {
 public:
  explicit Damage(unsigned seed) : random_(seed) {}

  std::string To(std::string text) {
    for (int i = Below(4); i >= 0; --i) Once(text);
    return text;
  }

 private:
  int Below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  void Once(std::string& text) {
    static const char* const kPieces[] = {
        "0",     "-1",   ".nan",       ".inf",    "1e308",    "1e-320",     "[",
        "]",     "{",    "}",          ": ",      "- ",       "\n",         "  ",
        "&a ",   "*a ",  "<<: *cable", "null",    "~",        "'",          "\"",
        "#",     "? ",   "| ",         "!!int ",  "segments", "edge_m / 0", "copies: 9999",
        "nodes", "\t",   "\xff",       "%",       "@",        "---\n",      "right",
        "tip",   "[[]]", "{}",         "radius_m"};
    const int at = Below(static_cast<int>(text.size()) + 1);
    switch (Below(5)) {
      case 0:
        text.erase(at, 1 + Below(3));
        break;
      case 1:
        text.erase(at, 1 + Below(60));
        break;
      case 2:
        text.insert(at, kPieces[Below(std::size(kPieces))]);
        break;
      case 3: {  // a line somewhere else
        const std::size_t begin = text.rfind('\n', at), end = text.find('\n', at);
        if (begin == std::string::npos || end == std::string::npos) break;
        const std::string line = text.substr(begin, end - begin);
        const std::size_t to = text.find('\n', Below(static_cast<int>(text.size())));
        if (to != std::string::npos) text.insert(to, line);
        break;
      }
      default:
        text[at % static_cast<int>(text.size())] = static_cast<char>(32 + Below(95));
        break;
    }
    if (text.empty()) text = " ";
  }

  std::mt19937 random_;
};

void ReadDamaged(const std::string& model, unsigned count) {
  const std::string good = Text(TAUT_SOURCE_DIR "/models/" + model + ".yaml");
  const std::string path = ::testing::TempDir() + "taut_damaged_" + model + ".yaml";
  unsigned robots = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    std::ofstream(path, std::ios::binary) << Damage(seed).To(good);
    Diagnostics out;
    const auto robot = LoadRobot(path, {}, out);
    ASSERT_EQ(robot.has_value(), out.ok()) << model << " seed " << seed;
    robots += robot.has_value();
    if (!robot) continue;
    for (const BodyDef& body : robot->def.bodies) {
      ASSERT_TRUE(body.fixed || (body.mass_kg > 0 && std::isfinite(body.mass_kg)))
          << model << " seed " << seed;
      ASSERT_TRUE(std::isfinite(body.com_m.x + body.com_m.y + body.com_m.z))
          << model << " seed " << seed;
    }
    for (const CableDef& cable : robot->def.cables) {
      ASSERT_TRUE(cable.rest_length_m > 0 && std::isfinite(cable.rest_length_m))
          << model << " seed " << seed;
    }
  }
  std::remove(path.c_str());
  EXPECT_GT(robots, 0u);         // some damage is harmless: a comment, a number
  EXPECT_LT(robots, count / 2);  // most is not
}

TEST(ModelFuzz, ADamagedSpineIsReadOrRefused) { ReadDamaged("tetraspine3", 800); }
TEST(ModelFuzz, ADamagedPrismIsReadOrRefused) { ReadDamaged("prism3", 800); }
TEST(ModelFuzz, ADamagedPendulumIsReadOrRefused) { ReadDamaged("hanging_mass", 800); }

}  // namespace
}  // namespace taut
