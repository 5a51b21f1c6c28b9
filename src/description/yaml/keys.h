/// Declarative tables of the keys of the YAML formats. Each map of a format has a function `Keys`
/// with one line per key: its name, field, range and description, and whether it is required. The
/// suffix of the name is the unit. The initializer of the field is the default.
///
///   struct Spring { double stiffness_n_per_m = 0, damping_n_s_per_m = 1; };
///   template <class Io>
///   void Keys(Io& io, Like<Spring> auto& s) {
///     io.Map("spring", "event.spring", "A spring and a damper.");
///     io("stiffness_n_per_m", s.stiffness_n_per_m, kNeeded, Bound::kPositive, "Of the spring.");
///     io("damping_n_s_per_m", s.damping_n_s_per_m, Bound::kNonNegative, "Of the damper.");
///   }
///
/// Visitors of these tables:
///
/// - `FileReader` (read_keys.h) fills the fields from a file.
/// - `SchemaMaker` (schema.cpp) writes the JSON schema for editors and docs/formats/.
/// - `BlockWriter` (write_keys.h) writes resolved experiments.
/// - `ResolvedReader` (resolved_read.cpp) reads resolved experiments.
/// - `NumberList` (number_list.h) lists the numbers that studies may vary.
///
/// Conditions on several keys are in a function `Check(map, struct)` next to the table. The reader
/// calls it after it has read all keys.
///
/// A struct that occurs in files and in resolved experiments has one table for both, and
/// `Io::kResolved` distinguishes them. Example: `cable:` of a model is a `CableText`, which extends
/// `CableDef` by keys that only files have.
#pragma once

#include <algorithm>
#include <concepts>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "description/yaml/laws.h"
#include "description/yaml/reader.h"

namespace taut::description {

template <class T, class U>
concept Like = std::same_as<std::remove_const_t<T>, U>;
/// Matches a struct of resolved experiments (`Spec`) or its counterpart in files (`Text`).
template <class T, class Spec, class Text>
concept Either = Like<T, Spec> || Like<T, Text>;

// Attributes of a key. A key may also have a `Bound`, a description and choices.

namespace note {
struct Needed {};
struct ResolvedOnly {};
struct Later {};
struct IsName {};
struct IsDirection {};
struct Inherited {};
struct Limit {};
struct Fixed {};
struct Varied {};
struct AtStart {};
}  // namespace note
/// The key was added in a later version of the format. Files without the key have this value.
struct LaterThan {
  double value;
};
/// Example value, as JSON.
struct Example {
  const char* json;
};

inline constexpr note::Needed kNeeded;              ///< The key is required.
inline constexpr note::ResolvedOnly kResolvedOnly;  ///< Only in resolved experiments.
inline constexpr note::Later kLater;            ///< Absent from files of earlier versions of taut.
inline constexpr note::IsName kName;            ///< Text of letters, digits, _ and -.
inline constexpr note::IsDirection kDirection;  ///< Nonzero vector; stored with length 1.
inline constexpr note::Inherited kInherited;    ///< Without this key, another map determines the
                                                ///< value.
inline constexpr note::Limit kLimit;            ///< Infinite if absent.
inline constexpr note::Fixed kFixed;            ///< Number that studies do not vary.
inline constexpr note::Varied kVaried;    ///< List whose numbers studies vary, as key_1, key_2, ...
inline constexpr note::AtStart kAtStart;  ///< Number that describes an initial state.

/// Alternative names of a key, of which another key selects the valid one. Example: the amplitude
/// of a gait is amplitude_m_per_s or amplitude_m. `when`: condition of each name, for the
/// reference.
struct Spellings {
  static constexpr int kCount = 2;
  const char* names[kCount];
  const char* when[kCount];
};

/// Line of a table without its field. Contains only the data for readers, since each of them visits
/// hundreds of lines.
struct Key {
  const char* name = "";
  const Bound* bound = &Bound::kAny;  ///< Bound in the table; valid during the visit of the line.
  bool needed : 1 = false, later : 1 = false, is_name : 1 = false, is_direction : 1 = false;
  bool inherited : 1 = false, limit : 1 = false, fixed : 1 = false, varied : 1 = false;
  bool at_start : 1 = false;

  void Note(const char* /*meaning*/) {}
  void Note(const Bound& note) { bound = &note; }
  void Note(note::Needed) { needed = true; }
  void Note(note::ResolvedOnly) {}
  void Note(note::Later) { later = true; }
  void Note(LaterThan) { later = true; }
  void Note(note::IsName) { is_name = true; }
  void Note(note::IsDirection) { is_direction = true; }
  void Note(note::Inherited) { inherited = true; }
  void Note(note::Limit) { limit = true; }
  void Note(note::Fixed) { fixed = true; }
  void Note(note::Varied) { varied = true; }
  void Note(note::AtStart) { at_start = true; }
  void Note(Example) {}
  template <class E>
  void Note(const Choices<E>&) {}
};

/// Line of a table with descriptions, for writers of files and schemas.
struct KeyText : Key {
  const char* meaning = "";  ///< Description in sentences, without range and unit.
  const char* example = nullptr;
  double before =
      std::numeric_limits<double>::quiet_NaN();  ///< `LaterThan`: value that writers omit.

  using Key::Note;
  void Note(const char* text) { meaning = text; }
  void Note(LaterThan note) { later = true, before = note.value; }
  void Note(Example note) { example = note.json; }
};

template <class T>
inline constexpr bool kIsChoices = false;
template <class E>
inline constexpr bool kIsChoices<Choices<E>> = true;

/// Base class of visitors of key tables. Calls `Derived::On(key, field)`, or `On(key, field,
/// choices)` for enumerations. `key` has the type `Derived::Line`, which is `Key` or `KeyText`.
/// `kOfResolved`: whether the tables are of resolved experiments.
template <class Derived, bool kOfResolved>
class KeyVisitor {
 public:
  static constexpr bool kResolved = kOfResolved;
  using Line = Key;

  // Inlined, so that unused attributes have no cost.
  template <class T, class... Notes>
  [[gnu::always_inline]] void operator()(const char* name, T& field, const Notes&... notes) {
    if constexpr (kResolved || !(std::same_as<Notes, note::ResolvedOnly> || ...)) {
      typename Derived::Line key;
      key.name = name;
      (key.Note(notes), ...);
      auto& derived = static_cast<Derived&>(*this);
      if constexpr ((kIsChoices<Notes> || ...)) {
        (Choose(derived, key, field, notes), ...);
      } else {
        derived.On(key, field);
      }
    }
  }

  /// Visits a key with alternative names. `Derived::Spell` selects the names.
  template <class T, class... Notes>
  void operator()(const Spellings& spellings, T& field, const Notes&... notes) {
    static_cast<Derived&>(*this).Spell(spellings,
                                       [&](const char* name) { (*this)(name, field, notes...); });
  }
  template <class OfName>
  void Spell(const Spellings& spellings, const OfName& of_name) {
    of_name(spellings.names[std::max(0, spelling.index)]);
  }
  /// Selects the valid alternative name of all following keys and nested maps. `key`: the key that
  /// determines it.
  void SpeltBy(const char* /*key*/, const Spelling& now) { spelling = now; }

  Spelling spelling;

  // Further declarations of a table. `what`: name of the map in messages; if empty, its path in the
  // file. `title`: heading in the reference.
  void Map(const char* /*what*/, const char* /*title*/, const char* /*meaning*/,
           const char* /*example*/ = nullptr) {}
  void OneOf(const std::vector<std::string>& /*keys*/) {}  ///< Requires exactly one of these keys.
  /// Requires keys of one of the two sides, and none of the other side.
  void EitherSide(const std::vector<std::string>& /*one*/,
                  const std::vector<std::string>& /*other*/) {}
  void Rule(const char* /*json*/) {}  ///< Condition in the schema only; `Check` reports violations
                                      ///< with a better message.

 private:
  template <class T, class Note>
  static void Choose(Derived& derived, const auto& key, T& field, const Note& note) {
    if constexpr (kIsChoices<Note>) derived.On(key, field, note);
  }
};

// Field types of structs that contain parsed files.

/// Text with its position in the file.
struct Placed {
  std::string text;
  SourceRef at;
};

/// Map whose keys are free names of its items. Items with errors are kept, so that references to
/// them cause no further errors.
template <class T>
struct Named {
  struct Item {
    std::string name;
    SourceRef name_at, at;
    bool good_name = true;
    T value{};
  };
  std::vector<Item> items;
};

/// Value that other code converts later. `Form::kSchema`: JSON schema of the permitted values.
template <class Form>
struct Raw {
  using FormType = Form;
  const Value* value = nullptr;
};

/// List of numbers in a resolved experiment, written as one text, since it may be too long for a
/// YAML list.
template <class List>
struct Packed {
  List& list;
};
template <class List>
Packed(List&) -> Packed<List>;
template <class T>
inline constexpr bool kIsPacked = false;
template <class List>
inline constexpr bool kIsPacked<Packed<List>> = true;

template <class Number, class Use>
void EachNumber(Number& number, const Use& use) {
  if constexpr (std::same_as<std::remove_const_t<Number>, Vec3>) {
    use(number.x), use(number.y), use(number.z);
  } else if constexpr (requires { number.begin(); }) {
    for (auto& one : number) use(one);
  } else {
    use(number);
  }
}

/// Map that is checked when the file is read, and later replaces values of a model.
template <class T>
struct Overlay {
  using Mapping = T;
  const Value* value = nullptr;
};

}  // namespace taut::description
