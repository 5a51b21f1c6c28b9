/// Tables of keys. What there is to say about a key of the formats stands in one line of a function
/// `Keys`, one such function a mapping: its name, the field that it fills, its range, whether it is
/// needed, what it means. The unit is that of the name, the default that of the field.
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
/// `SchemaMaker` (schema.cpp) writes the JSON schema that editors and docs/formats/ are made from,
/// `BlockWriter` (write_keys.h) and `ResolvedReader` (resolved_read.cpp) take them to resolved
/// experiments and back, `NumberList` (number_list.h) finds what studies may vary. What several
/// keys must fulfil together is code: a function `Check(map, struct)` beside the table, which the
/// reader calls when all keys are read.
///
/// A struct that both kinds of files know is one table, too: a model's `cable:` is a `CableText`,
/// which is a `CableDef` with what only files say; `Io::kResolved` tells which of the two is meant.
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
/// A struct of a resolved experiment, or what a file says instead.
template <class T, class Spec, class Text>
concept Either = Like<T, Spec> || Like<T, Text>;

// Notes on a key, besides its `Bound`, the choices of an enumeration, and its meaning.

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
/// Earlier versions of taut did not write it and meant this number.
struct LaterThan {
  double value;
};
/// An example, as JSON.
struct Example {
  const char* json;
};

inline constexpr note::Needed kNeeded;              ///< A file without it is wrong.
inline constexpr note::ResolvedOnly kResolvedOnly;  ///< Not in files that people write.
inline constexpr note::Later kLater;                ///< Earlier versions of taut did not write it.
inline constexpr note::IsName kName;                ///< A text of letters, digits, _ and -.
inline constexpr note::IsDirection kDirection;  ///< A vector of any length but zero; stored as 1.
inline constexpr note::Inherited kInherited;    ///< If absent, something else says what it is.
inline constexpr note::Limit kLimit;            ///< If absent, infinite.
inline constexpr note::Fixed kFixed;            ///< Not a number that studies vary.
inline constexpr note::Varied kVaried;    ///< A list whose numbers studies vary, as key_1, key_2.
inline constexpr note::AtStart kAtStart;  ///< A number that says where something begins.

/// The names of one key where another key of the file chooses which of them it has: the amplitude
/// of a gait is amplitude_m_per_s or amplitude_m. `when` says where, to readers of the reference.
struct Spellings {
  static constexpr int kCount = 2;
  const char* names[kCount];
  const char* when[kCount];
};

/// A line of a table, without the field: what readers want of it, who see hundreds of them.
struct Key {
  const char* name = "";
  const Bound* bound = &Bound::kAny;  ///< Of the table, as long as the line is visited.
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

/// The same with what is for people, and for those who write.
struct KeyText : Key {
  const char* meaning = "";  ///< Sentences, without range and unit.
  const char* example = nullptr;
  double before =
      std::numeric_limits<double>::quiet_NaN();  ///< Not written: what `LaterThan` says.

  using Key::Note;
  void Note(const char* text) { meaning = text; }
  void Note(LaterThan note) { later = true, before = note.value; }
  void Note(Example note) { example = note.json; }
};

template <class T>
inline constexpr bool kIsChoices = false;
template <class E>
inline constexpr bool kIsChoices<Choices<E>> = true;

/// A visitor of tables: `Derived::On(key, field)`, with the choices if there are any. What it gets
/// of a line is its `Derived::Line`, `Key` or `KeyText`. `kOfResolved`: whether it is about
/// resolved experiments.
template <class Derived, bool kOfResolved>
class KeyVisitor {
 public:
  static constexpr bool kResolved = kOfResolved;
  using Line = Key;

  // Inline, or what no visitor wants of a line would be handed on all the same.
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

  /// A key with several names: those that `Derived::Spell` asks for.
  template <class T, class... Notes>
  void operator()(const Spellings& spellings, T& field, const Notes&... notes) {
    static_cast<Derived&>(*this).Spell(spellings,
                                       [&](const char* name) { (*this)(name, field, notes...); });
  }
  template <class OfName>
  void Spell(const Spellings& spellings, const OfName& of_name) {
    of_name(spellings.names[std::max(0, spelling.index)]);
  }
  /// From here on, and in all that is below, keys with several names have those of `now`, as `key`
  /// says.
  void SpeltBy(const char* /*key*/, const Spelling& now) { spelling = now; }

  Spelling spelling;

  // What else a table may say. `what` is the mapping's name in messages, that of its place in the
  // file if empty; `title` its heading in the reference.
  void Map(const char* /*what*/, const char* /*title*/, const char* /*meaning*/,
           const char* /*example*/ = nullptr) {}
  void OneOf(const std::vector<std::string>& /*keys*/) {}  ///< Exactly one of these.
  /// Keys of the one side or of the other, one at least.
  void EitherSide(const std::vector<std::string>& /*one*/,
                  const std::vector<std::string>& /*other*/) {}
  void Rule(const char* /*json*/) {}  ///< For the schema: what `Check` has a better message for.

 private:
  template <class T, class Note>
  static void Choose(Derived& derived, const auto& key, T& field, const Note& note) {
    if constexpr (kIsChoices<Note>) derived.On(key, field, note);
  }
};

// Fields of structs that stand for what files say.

/// A text and where it stands.
struct Placed {
  std::string text;
  SourceRef at;
};

/// A map with free keys: names of what the values are. One that is wrong is kept for those who name
/// it, who have made no mistake.
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

/// A value that code reads, once more is known than the file. `Form::kSchema` is what it may be, as
/// members of a JSON schema.
template <class Form>
struct Raw {
  using FormType = Form;
  const Value* value = nullptr;
};

/// A list of a resolved experiment that may be too long for a list of YAML: numbers in one text.
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

/// A mapping that is checked when it is read, and read once more over what a model says.
template <class T>
struct Overlay {
  using Mapping = T;
  const Value* value = nullptr;
};

}  // namespace taut::description
