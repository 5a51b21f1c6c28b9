/// Declarative tables of the keys of the YAML formats. Each map of a format has one function
/// `Keys`, which defines each key in one line: its name, the field that it fills, its range,
/// whether it is required, and its description. The suffix of the name gives the unit; the
/// initializer of the field is the default.
///
///   struct Spring { double stiffness_n_per_m = 0, damping_n_s_per_m = 1; };
///   template <class Io>
///   void Keys(Io& io, Like<Spring> auto& s) {
///     io.Map("spring", "event.spring", "A spring and a damper.");
///     io("stiffness_n_per_m", s.stiffness_n_per_m, kNeeded, Bound::kPositive, "Of the spring.");
///     io("damping_n_s_per_m", s.damping_n_s_per_m, Bound::kNonNegative, "Of the damper.");
///   }
///
/// Visitors walk these tables: `FileReader` (read_keys.h) fills the fields from a file,
/// `SchemaMaker` (schema.cpp) writes the JSON schema for editors and docs/formats/, `BlockWriter`
/// (write_keys.h) and `ResolvedReader` (resolved_read.cpp) write and read resolved experiments,
/// `NumberList` (number_list.h) lists the numbers that studies may vary. Conditions on several keys
/// are code: a function `Check(map, struct)` next to the table, which the reader calls after it has
/// read all keys.
///
/// A struct that occurs in files and in resolved experiments has one table for both: `cable:` of a
/// model is a `CableText`, which extends `CableDef` by the keys that only files have;
/// `Io::kResolved` distinguishes the two.
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
/// Matches a struct of a resolved experiment or its counterpart in files.
template <class T, class Spec, class Text>
concept Either = Like<T, Spec> || Like<T, Text>;

// Notes on a key, in addition to its `Bound`, its description and the choices of an enumeration.

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
/// The key was added to the format later; a file without it means this number.
struct LaterThan {
  double value;
};
/// Example value, as JSON.
struct Example {
  const char* json;
};

inline constexpr note::Needed kNeeded;              ///< Required key.
inline constexpr note::ResolvedOnly kResolvedOnly;  ///< Only in resolved experiments.
inline constexpr note::Later kLater;            ///< Absent from files of earlier versions of taut.
inline constexpr note::IsName kName;            ///< A text of letters, digits, _ and -.
inline constexpr note::IsDirection kDirection;  ///< A nonzero vector; stored with length 1.
inline constexpr note::Inherited kInherited;    ///< If absent, the value comes from elsewhere.
inline constexpr note::Limit kLimit;            ///< If absent, infinite.
inline constexpr note::Fixed kFixed;            ///< A number that studies do not vary.
inline constexpr note::Varied kVaried;    ///< A list whose numbers studies vary, as key_1, key_2.
inline constexpr note::AtStart kAtStart;  ///< A number that describes the start of something.

/// Alternative names of a key; another key of the file selects the valid one: the amplitude of a
/// gait is amplitude_m_per_s or amplitude_m. `when` gives the condition of each name, for the
/// reference.
struct Spellings {
  static constexpr int kCount = 2;
  const char* names[kCount];
  const char* when[kCount];
};

/// Line of a table without the field, reduced to the data that readers need, because they visit
/// hundreds of lines.
struct Key {
  const char* name = "";
  const Bound* bound = &Bound::kAny;  ///< Part of the table; valid during the visit of the line.
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

/// Line of a table with the texts for people, for visitors that write.
struct KeyText : Key {
  const char* meaning = "";  ///< Description in sentences, without range and unit.
  const char* example = nullptr;
  double before =
      std::numeric_limits<double>::quiet_NaN();  ///< `LaterThan`: this value is not written.

  using Key::Note;
  void Note(const char* text) { meaning = text; }
  void Note(LaterThan note) { later = true, before = note.value; }
  void Note(Example note) { example = note.json; }
};

template <class T>
inline constexpr bool kIsChoices = false;
template <class E>
inline constexpr bool kIsChoices<Choices<E>> = true;

/// Base class of the visitors of tables. Calls `Derived::On(key, field)`, for an enumeration with
/// its choices. The type of `key` is `Derived::Line`: `Key` or `KeyText`. `kOfResolved`: for
/// resolved experiments.
template <class Derived, bool kOfResolved>
class KeyVisitor {
 public:
  static constexpr bool kResolved = kOfResolved;
  using Line = Key;

  // Inline, so that notes that no visitor uses cost nothing.
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

  /// Visits a key with alternative names, under each name that `Derived::Spell` selects.
  template <class T, class... Notes>
  void operator()(const Spellings& spellings, T& field, const Notes&... notes) {
    static_cast<Derived&>(*this).Spell(spellings,
                                       [&](const char* name) { (*this)(name, field, notes...); });
  }
  template <class OfName>
  void Spell(const Spellings& spellings, const OfName& of_name) {
    of_name(spellings.names[std::max(0, spelling.index)]);
  }
  /// Selects the valid alternative name for all following keys and nested maps; `key` is the key
  /// that made the choice.
  void SpeltBy(const char* /*key*/, const Spelling& now) { spelling = now; }

  Spelling spelling;

  // Further declarations of a table. `what` is the name of the map in messages (if empty, its path
  // in the file); `title` is its heading in the reference.
  void Map(const char* /*what*/, const char* /*title*/, const char* /*meaning*/,
           const char* /*example*/ = nullptr) {}
  void OneOf(const std::vector<std::string>& /*keys*/) {}  ///< Exactly one of these keys.
  /// Keys of one side or of the other, at least one.
  void EitherSide(const std::vector<std::string>& /*one*/,
                  const std::vector<std::string>& /*other*/) {}
  void Rule(const char* /*json*/) {}  ///< For the schema only: a condition that `Check` reports
                                      ///< with a better message.

 private:
  template <class T, class Note>
  static void Choose(Derived& derived, const auto& key, T& field, const Note& note) {
    if constexpr (kIsChoices<Note>) derived.On(key, field, note);
  }
};

// Field types of structs that represent the contents of files.

/// Text with its position in the file.
struct Placed {
  std::string text;
  SourceRef at;
};

/// Map with free keys, which name the values. An item with an error is kept, so that valid
/// references to it cause no further errors.
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

/// Value that code reads later, when more than the file is known. `Form::kSchema` describes the
/// allowed values as members of a JSON schema.
template <class Form>
struct Raw {
  using FormType = Form;
  const Value* value = nullptr;
};

/// List of a resolved experiment, written as one text of numbers because it may be too long for a
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

/// Map that is checked when it is read, and later applied on top of the values of a model.
template <class T>
struct Overlay {
  using Mapping = T;
  const Value* value = nullptr;
};

}  // namespace taut::description
