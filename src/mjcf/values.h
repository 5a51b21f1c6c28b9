/// Values of an element's attributes, including default classes.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mjcf/element.h"
#include "taut/types.h"

namespace taut::mjcf {

/// Limit of errors with a "did you mean" hint. A hint compares a name with all known names, so a
/// file with many wrong names would take quadratic time.
inline constexpr std::size_t kMostHints = 10;

struct Pose {
  Vec3 p;
  Quat q;
};
Pose operator*(const Pose& a, const Pose& b);

/// Attributes of `<compiler>`.
struct CompilerSettings {
  bool degrees = true, global = false;
  std::string eulerseq = "xyz";
  enum class FromGeoms { kFalse, kTrue, kAuto } from_geoms = FromGeoms::kAuto;
  bool autolimits = true, autolimits_given = false, alignfree = false;
  double boundmass = 0, boundinertia = 0, settotalmass = -1;
  std::vector<double> inertia_groups{0, 5};
};

/// Element and the defaults that apply to it. Later items override earlier ones.
class Layers {
 public:
  Layers(std::vector<const Element*> layers, Diagnostics& out)
      : layers_(std::move(layers)), out_(&out) {}

  const Element& element() const { return *layers_.back(); }
  const std::vector<const Element*>& all() const { return layers_; }
  const Attribute* Find(std::string_view name) const;
  bool Has(std::string_view name) const { return Find(name) != nullptr; }
  /// Returns the text in the file, or `if_absent` if the attribute is missing.
  std::string Text(std::string_view name, const std::string& if_absent = "") const;

  /// Returns each number from the last layer that contains it. Example: `size="0.1"` on top of
  /// `size="0.2 0.3"` is 0.1 0.3.
  std::vector<double> Numbers(std::string_view name, std::vector<double> if_absent,
                              std::size_t least, std::size_t most) const;
  double Number(std::string_view name, double if_absent) const;
  int Whole(std::string_view name, int if_absent) const;
  bool Flag(std::string_view name, bool if_absent) const;
  /// Returns the range if it is enabled. It is enabled if `flag` is "true". If `flag` is "auto" or
  /// absent, it is enabled if the compiler's autolimits are on and the range is not empty. Reports
  /// an error for a range with a lower bound >= its upper bound.
  std::optional<std::pair<double, double>> Range(std::string_view flag, std::string_view range,
                                                 const CompilerSettings& settings) const;
  Pose ReadPose(const CompilerSettings& settings) const;
  std::optional<std::pair<Vec3, Vec3>> FromTo() const;

  void Error(MessageId id, std::string_view attribute, const std::string& what,
             const std::string& hint = {}) const;

 private:
  Quat ReadTurn(const CompilerSettings& settings) const;
  std::vector<const Element*> layers_;
  Diagnostics* out_;
};

/// Tree of default classes. Each class inherits from the class that encloses it.
class Defaults {
 public:
  void Add(const Element& element, Diagnostics& out) { Add(element, nullptr, out); }
  /// Returns the element with the defaults of its kind. They are from the element's class, or else
  /// from `child_class`. All actuators share one kind, `actuator`.
  Layers Over(const Element& element, const std::string& child_class, Diagnostics& out) const;
  /// Returns an identifier of the class that contains the setting; null for other elements.
  const void* ClassOf(const Element& setting) const {
    const auto found = class_of_.find(&setting);
    return found == class_of_.end() ? nullptr : found->second;
  }
  /// Reports a reference to a class that does not exist.
  void CheckClass(const Element& element, std::string_view attribute, Diagnostics& out) const;

 private:
  struct Class {
    const Class* in = nullptr;
    /// Number of settings inherited from `in`: those before this class in the file. As in MuJoCo,
    /// the class does not inherit settings that a later section adds to the outermost class.
    std::size_t inherited = 0;
    std::vector<const Element*> settings;
  };
  static void Collect(const Class& of, std::size_t count, const std::string& kind,
                      std::vector<const Element*>& found);
  void Add(const Element& element, const Class* in, Diagnostics& out);
  std::map<std::string, Class> classes_;
  std::map<const Element*, const Class*> class_of_;
  std::string main_ = "main";
};

/// Returns the shortest rotation from the z axis to v.
Quat FromZ(const Vec3& v);
Quat AboutAxis(const Vec3& axis, double angle_rad);

/// Returns the numbers in `text`. Returns nothing if an item is not a finite number.
std::optional<std::vector<double>> ToNumbers(const std::string& text);

}  // namespace taut::mjcf
