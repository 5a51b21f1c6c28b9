/// Attributes of an element, with those of its default classes below, and what they say.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mjcf/element.h"
#include "taut/types.h"

namespace taut::mjcf {

/// Number of errors with a "did you mean" hint. Each hint compares a name with all known names,
/// which would take quadratic time in a file with many wrong names.
inline constexpr std::size_t kMostHints = 10;

struct Pose {
  Vec3 p;
  Quat q;
};
Pose operator*(const Pose& a, const Pose& b);

/// Of `<compiler>`.
struct CompilerSettings {
  bool degrees = true, global = false;
  std::string eulerseq = "xyz";
  enum class FromGeoms { kFalse, kTrue, kAuto } from_geoms = FromGeoms::kAuto;
  bool autolimits = true, autolimits_given = false, alignfree = false;
  double boundmass = 0, boundinertia = 0, settotalmass = -1;
  std::vector<double> inertia_groups{0, 5};
};

/// An element over the defaults that hold for it; what is later in the list holds.
class Layers {
 public:
  Layers(std::vector<const Element*> layers, Diagnostics& out)
      : layers_(std::move(layers)), out_(&out) {}

  const Element& element() const { return *layers_.back(); }
  const std::vector<const Element*>& all() const { return layers_; }
  const Attribute* Find(std::string_view name) const;
  bool Has(std::string_view name) const { return Find(name) != nullptr; }
  /// As written; empty if it is not there.
  std::string Text(std::string_view name, const std::string& if_absent = "") const;

  /// Of each number that which the last layer has that has so many: `size="0.1"` over
  /// `size="0.2 0.3"` is 0.1 0.3.
  std::vector<double> Numbers(std::string_view name, std::vector<double> if_absent,
                              std::size_t least, std::size_t most) const;
  double Number(std::string_view name, double if_absent) const;
  int Whole(std::string_view name, int if_absent) const;
  bool Flag(std::string_view name, bool if_absent) const;
  /// The range if it limits anything: `flag` is "true", or it is `auto` or absent, the compiler's
  /// autolimits are on and the range is not empty. Complains about a range that does not rise.
  std::optional<std::pair<double, double>> Range(std::string_view flag, std::string_view range,
                                                 const CompilerSettings& settings) const;
  Pose ReadPose(const CompilerSettings& settings) const;
  std::optional<std::pair<Vec3, Vec3>> FromTo() const;

  void Error(std::string_view attribute, const std::string& what,
             const std::string& hint = {}) const;

 private:
  Quat ReadTurn(const CompilerSettings& settings) const;
  std::vector<const Element*> layers_;
  Diagnostics* out_;
};

/// Default classes, nested: each is that which it stands in, but for what it says.
class Defaults {
 public:
  void Add(const Element& element, Diagnostics& out) { Add(element, nullptr, out); }
  /// The element over the defaults of its kind, or of `actuator` for all actuators: of its own
  /// class, else of `child_class`.
  Layers Over(const Element& element, const std::string& child_class, Diagnostics& out) const;
  /// Complains about a class that does not exist.
  void CheckClass(const Element& element, std::string_view attribute, Diagnostics& out) const;

 private:
  struct Class {
    const Class* in = nullptr;
    /// How many of `in`'s own settings it inherits, those before it begins: what a later section
    /// adds to the outermost class does not reach it, as in MuJoCo.
    std::size_t inherited = 0;
    std::vector<const Element*> settings;
  };
  static void Collect(const Class& of, std::size_t count, const std::string& kind,
                      std::vector<const Element*>& found);
  void Add(const Element& element, const Class* in, Diagnostics& out);
  std::map<std::string, Class> classes_;
  std::string main_ = "main";
};

/// Turns z into v by the shortest way.
Quat FromZ(const Vec3& v);
Quat AboutAxis(const Vec3& axis, double angle_rad);

/// `text` as numbers; nothing if something in it is none, or not finite.
std::optional<std::vector<double>> ToNumbers(const std::string& text);

}  // namespace taut::mjcf
