#include "import_ntrt/si.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "description/yaml/reader.h"
#include "math/angle.h"

namespace taut::import_ntrt {
namespace {

constexpr std::size_t kLineWidth = 110;

double Reread(const char* format, int precision, double number) {
  char text[400];
  std::snprintf(text, sizeof text, format, precision, number);
  const double read = std::strtod(text, nullptr);
  return read == 0.0 ? 0.0 : read;  // -0 becomes 0
}

/// Returns a text such as "2 * pi / 3". Returns an empty text if the angle is not a simple fraction
/// of pi.
std::string ShareOfPi(double angle_rad) {
  for (const int part : {1, 2, 3, 4, 5, 6, 8, 9, 10, 12, 18, 36}) {
    const double times = angle_rad / kPi * part;
    const double whole = std::round(times);
    if (whole == 0.0 || std::fabs(times - whole) > 1e-12) continue;
    std::string text = whole < 0 ? "-" : "";
    if (std::fabs(whole) != 1.0) text += std::to_string(static_cast<int>(std::fabs(whole))) + " * ";
    text += "pi";
    return part == 1 ? text : text + " / " + std::to_string(part);
  }
  return {};
}

}  // namespace

double Rounded15(double number) { return Reread("%.*g", 15, number); }
std::string NumberText(double number) { return description::Shown(Rounded15(number)); }

Grid::Grid(double size_m) {
  if (size_m > 0.0) decimals_ = 13 - static_cast<int>(std::ceil(std::log10(size_m)));
  decimals_ = std::clamp(decimals_, 0, 30);
}
std::string Grid::Text(double x) const { return description::Shown(Reread("%.*f", decimals_, x)); }
std::string Grid::Text(const Vec3& v) const {
  return "[" + Text(v.x) + ", " + Text(v.y) + ", " + Text(v.z) + "]";
}

std::string RotationText(const Quat& q) {
  constexpr double kNone = 1e-13;
  const double parts[] = {q.x, q.y, q.z};
  if (std::fabs(q.x) < kNone && std::fabs(q.y) < kNone && std::fabs(q.z) < kNone) return {};
  for (int i = 0; i < 3; ++i) {
    if (std::fabs(parts[(i + 1) % 3]) > kNone || std::fabs(parts[(i + 2) % 3]) > kNone) continue;
    double angle_rad = 2 * std::atan2(parts[i], q.w);
    if (angle_rad > kPi + kNone) angle_rad -= 2 * kPi;
    if (angle_rad < -kPi + kNone) angle_rad += 2 * kPi;
    const std::string share = ShareOfPi(angle_rad);
    return std::string("{axis: ") + "xyz"[i] +
           ", angle_rad: " + (share.empty() ? description::Shown(angle_rad) : share) + "}";
  }
  const Grid unit(1.0);
  return "{quaternion: [" + unit.Text(q.w) + ", " + unit.Text(q.x) + ", " + unit.Text(q.y) + ", " +
         unit.Text(q.z) + "]}";
}

std::string NameText(const std::string& ntrt) {
  std::string name = ntrt.substr(0, description::kMaxNameLength / 4);
  for (char& c : name) {
    if (c == '/') c = '-';
    if (!IsName(std::string_view(&c, 1))) c = '_';
  }
  return name.empty() ? "_" : name;
}

std::string WrappedList(const std::vector<std::string>& items, const std::string& indent) {
  std::string text, line = "[";
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::string item = items[i] + (i + 1 < items.size() ? "," : "]");
    if (line.size() > 1 && indent.size() + line.size() + 1 + item.size() > kLineWidth) {
      text += "\n" + indent + line;
      line = " ";
    }
    line += (line.size() > 1 ? " " : "") + item;
  }
  return text.empty() ? " " + line : text + "\n" + indent + line;
}

}  // namespace taut::import_ntrt
