#include "mjcf/values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "math/rotation.h"
#include "math/vec.h"
#include "mjcf/mjcf_schema.h"

namespace taut::mjcf {
namespace {

std::string KindOf(const std::string& name) {
  if (IsActuator(name)) return "actuator";
  if (name == "spatial") return "tendon";
  if (name == "weld" || name == "connect") return "equality";
  return name;
}

}  // namespace

Pose operator*(const Pose& a, const Pose& b) { return {a.p + Rotate(a.q, b.p), a.q * b.q}; }

std::optional<std::vector<double>> ToNumbers(const std::string& text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && is_blank(*at)) ++at;
    if (at == end) return numbers;
    if (*at == '+') ++at;
    double number = 0;
    const auto [next, status] = std::from_chars(at, end, number);
    if (status != std::errc() || !std::isfinite(number)) return std::nullopt;
    if (next != end && !is_blank(*next)) return std::nullopt;
    numbers.push_back(number);
    at = next;
  }
}

Quat AboutAxis(const Vec3& axis, double angle_rad) {
  const double s = std::sin(0.5 * angle_rad) / Length(axis);
  return {std::cos(0.5 * angle_rad), s * axis.x, s * axis.y, s * axis.z};
}

Quat FromZ(const Vec3& v) {
  const Vec3 axis = Cross({0, 0, 1}, v);
  const double across = Length(axis);
  const double angle = std::atan2(across, v.z);
  return AboutAxis(across < 1e-10 ? Vec3{1, 0, 0} : axis, angle);
}

const Attribute* Layers::Find(std::string_view name) const {
  for (auto layer = layers_.rbegin(); layer != layers_.rend(); ++layer) {
    if (const Attribute* const found = (*layer)->Find(name)) return found;
  }
  return nullptr;
}

std::string Layers::Text(std::string_view name, const std::string& if_absent) const {
  const Attribute* const found = Find(name);
  return found ? found->value : if_absent;
}

void Layers::Error(MessageId id, std::string_view attribute, const std::string& what,
                   const std::string& hint) const {
  const Attribute* const found = Find(attribute);
  out_->Error(id, found ? found->at : element().at, element().Called() + ": " + what, hint);
}

std::vector<double> Layers::Numbers(std::string_view name, std::vector<double> if_absent,
                                    std::size_t least, std::size_t most) const {
  for (const Element* const layer : layers_) {
    const Attribute* const a = layer->Find(name);
    if (!a) continue;
    const auto numbers = ToNumbers(a->value);
    if (!numbers || numbers->size() < least || numbers->size() > most) {
      const std::string count = least == most
                                    ? std::to_string(most)
                                    : std::to_string(least) + " to " + std::to_string(most);
      out_->Error("mjcf.wrong_numbers", a->at,
                  element().Called() + ": " + std::string(name) + " must be " + count +
                      (most == 1 ? " number" : " numbers") + ", not \"" + a->value + "\"");
      continue;
    }
    if (if_absent.size() < numbers->size()) if_absent.resize(numbers->size());
    std::copy(numbers->begin(), numbers->end(), if_absent.begin());
  }
  return if_absent;
}

double Layers::Number(std::string_view name, double if_absent) const {
  return Numbers(name, {if_absent}, 1, 1)[0];
}

int Layers::Whole(std::string_view name, int if_absent) const {
  const double number = Number(name, if_absent);
  if (number == std::floor(number) && std::fabs(number) < 2e9) return static_cast<int>(number);
  Error("mjcf.not_whole", name, std::string(name) + " must be a whole number");
  return if_absent;
}

bool Layers::Flag(std::string_view name, bool if_absent) const {
  const std::string text = Text(name);
  if (text == "true" || text == "false") return text == "true";
  if (!text.empty())
    Error("mjcf.not_boolean", name,
          std::string(name) + " must be true or false, not \"" + text + '"');
  return if_absent;
}

std::optional<std::pair<double, double>> Layers::Range(std::string_view flag,
                                                       std::string_view range,
                                                       const CompilerSettings& settings) const {
  const auto n = Numbers(range, {0, 0}, 2, 2);
  const bool limited =
      Text(flag, "auto") == "auto" ? settings.autolimits && n[0] != n[1] : Flag(flag, false);
  if (!limited) return std::nullopt;
  if (!(n[0] < n[1]))
    Error("mjcf.empty_range", range, std::string(range) + " must be two increasing numbers");
  return std::pair(n[0], n[1]);
}

std::optional<std::pair<Vec3, Vec3>> Layers::FromTo() const {
  if (!Has("fromto")) return std::nullopt;
  const std::vector<double> n = Numbers("fromto", {0, 0, 0, 0, 0, 1}, 6, 6);
  const Vec3 from{n[0], n[1], n[2]}, to{n[3], n[4], n[5]};
  if (Length(to - from) < 1e-14) {
    Error("mjcf.no_length", "fromto", "the two points of fromto coincide");
    return std::pair(from, from + Vec3{0, 0, 1});
  }
  return std::pair(from, to);
}

Quat Layers::ReadTurn(const CompilerSettings& settings) const {
  const auto unit = [&](const char* name, const Vec3& v) {
    const double length = Length(v);
    if (length > 1e-14) return (1 / length) * v;
    Error("mjcf.zero_vector", name, std::string(name) + " must not be a zero vector");
    return Vec3{0, 0, 1};
  };
  const double angle = settings.degrees ? std::numbers::pi / 180 : 1;
  int ways = 0;
  for (const char* name : {"quat", "axisangle", "xyaxes", "zaxis", "euler"}) {
    ways += element().Find(name) != nullptr;
  }
  if (ways > 1)
    Error("mjcf.orientation_given_twice", "pos", "the orientation is given in several ways",
          "keep one of quat, axisangle, xyaxes, zaxis and euler");
  if (Has("axisangle")) {
    const auto n = Numbers("axisangle", {0, 0, 1, 0}, 4, 4);
    return AboutAxis(unit("axisangle", {n[0], n[1], n[2]}), angle * n[3]);
  }
  if (Has("xyaxes")) {
    const auto n = Numbers("xyaxes", {1, 0, 0, 0, 1, 0}, 6, 6);
    const Vec3 x = unit("xyaxes", {n[0], n[1], n[2]}), given{n[3], n[4], n[5]};
    const Vec3 y = unit("xyaxes", given - Dot(x, given) * x), z = Cross(x, y);
    const double r[9] = {x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z};
    return QuatOf(r);
  }
  if (Has("zaxis")) {
    const auto n = Numbers("zaxis", {0, 0, 1}, 3, 3);
    return FromZ(unit("zaxis", {n[0], n[1], n[2]}));
  }
  if (Has("euler")) {
    const auto n = Numbers("euler", {0, 0, 0}, 3, 3);
    Quat q;
    for (std::size_t i = 0; i < 3; ++i) {
      const char letter = settings.eulerseq[i];
      const bool fixed_axes = letter < 'a';  // capital letters: rotation about the axes of the
                                             // parent
      const char axis = static_cast<char>(fixed_axes ? letter - 'A' + 'a' : letter);
      const Quat turn = AboutAxis(
          {axis == 'x' ? 1.0 : 0, axis == 'y' ? 1.0 : 0, axis == 'z' ? 1.0 : 0}, angle * n[i]);
      q = fixed_axes ? turn * q : q * turn;
    }
    return q;
  }
  const auto n = Numbers("quat", {1, 0, 0, 0}, 4, 4);
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] + n[3] * n[3]);
  if (length < 1e-14) {
    Error("mjcf.zero_orientation", "quat", "quat must not be zero");
    return {};
  }
  return {n[0] / length, n[1] / length, n[2] / length, n[3] / length};
}

Pose Layers::ReadPose(const CompilerSettings& settings) const {
  const auto n = Numbers("pos", {0, 0, 0}, 3, 3);
  return {{n[0], n[1], n[2]}, ReadTurn(settings)};
}

void Defaults::Add(const Element& element, const Class* in, Diagnostics& out) {
  const Attribute* const name = element.Find("class");
  std::string called = name ? name->value : "";
  if (in == nullptr) {
    if (!called.empty() && classes_.empty()) main_ = called;
    if (called.empty()) called = main_;
  } else if (called.empty()) {
    out.Error("mjcf.unnamed_default", element.at, "a default inside another default has no class");
    return;
  }
  const auto [entry, fresh] = classes_.try_emplace(called);
  Class* const its = &entry->second;
  if (fresh && in != nullptr) its->in = in, its->inherited = in->settings.size();
  if (!fresh && (in != nullptr || called != main_)) {
    out.Error("mjcf.duplicate_default", name->at,
              "the default class \"" + called + "\" is defined twice");
    return;
  }
  for (const Element& child : element.children) {
    if (child.name == "default") continue;
    its->settings.push_back(&child);
    class_of_[&child] = its;
  }
  for (const Element& child : element.children) {
    if (child.name == "default") Add(child, its, out);
  }
}

void Defaults::CheckClass(const Element& element, std::string_view attribute,
                          Diagnostics& out) const {
  const Attribute* const name = element.Find(attribute);
  if (!name || classes_.contains(name->value) || name->value == main_) return;
  std::vector<std::string> known;
  for (const auto& [key, value] : classes_) {
    if (out.items().size() < kMostHints) known.push_back(key);
  }
  out.Error("mjcf.unknown_default", name->at, "there is no default class \"" + name->value + "\"",
            known.empty() ? "" : DidYouMean(name->value, known));
}

void Defaults::Collect(const Class& of, std::size_t count, const std::string& kind,
                       std::vector<const Element*>& found) {
  if (of.in != nullptr) Collect(*of.in, of.inherited, kind, found);
  for (std::size_t i = 0; i < count; ++i) {
    if (KindOf(of.settings[i]->name) == kind) found.push_back(of.settings[i]);
  }
}

Layers Defaults::Over(const Element& element, const std::string& child_class,
                      Diagnostics& out) const {
  CheckClass(element, "class", out);
  const Attribute* const own = element.Find("class");
  const std::string& called = own ? own->value : child_class.empty() ? main_ : child_class;
  std::vector<const Element*> layers;
  const auto found = classes_.find(called);
  // A freejoint does not use defaults.
  if (found != classes_.end() && element.name != "freejoint") {
    Collect(found->second, found->second.settings.size(), KindOf(element.name), layers);
  }
  layers.push_back(&element);
  return {std::move(layers), out};
}

}  // namespace taut::mjcf
