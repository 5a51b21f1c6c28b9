/// Reader of YAML files by tables of keys (keys.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "description/yaml/keys.h"
#include "description/yaml/reader.h"

namespace taut::description {

/// Fills `out` from a map. Reports unknown and missing keys and invalid values, then violated
/// conditions on several keys (`Check`). `path`: path of the map in the file. Fields of absent keys
/// keep their values, but required numbers become NaN. Sets the members `out.at` (position) and
/// `out.good` (no errors) if they exist.
template <class T>
void ReadMapping(const Value& value, const std::string& path, const Scope& scope, T& out);

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsNamed = false;
template <class T>
inline constexpr bool kIsNamed<Named<T>> = true;
template <class T>
inline constexpr bool kIsRaw = false;
template <class Form>
inline constexpr bool kIsRaw<Raw<Form>> = true;
template <class T>
inline constexpr bool kIsOverlay = false;
template <class T>
inline constexpr bool kIsOverlay<Overlay<T>> = true;

/// Reads one field, according to its type.
template <class T>
void ReadField(const Value& value, const std::string& path, const Key& key, const Scope& scope,
               T& out);

template <class T>
void ReadNamed(const Value& value, const std::string& path, const Key& key, const Scope& scope,
               Named<T>& out) {
  for (const Entry& entry : Entries(&value, path, scope)) {
    auto& item = out.items.emplace_back();
    item.good_name = !key.is_name || !ReadKey(entry, path, scope).empty();
    item.name = entry.key;
    item.name_at = entry.key_at;
    item.at = entry.value->at;
    if constexpr (requires { item.value.name = entry.key; }) item.value.name = entry.key;
    ReadField(*entry.value, path + "." + entry.key, {key.name}, scope, item.value);
  }
}

template <class T>
void ReadField(const Value& value, const std::string& path, const Key& key, const Scope& scope,
               T& out) {
  const auto whole = [&] {
    TAUT_ASSERT(std::isfinite(key.bound->least) && std::isfinite(key.bound->most));
    return ReadInteger(value, path, static_cast<int>(key.bound->least),
                       static_cast<int>(key.bound->most), scope);
  };
  const auto text = [&] {
    return key.is_name ? ReadName(value, path, scope) : ReadText(value, path, scope);
  };
  if constexpr (std::same_as<T, double>) {
    out = ReadNumber(value, path, *key.bound, scope);
  } else if constexpr (std::same_as<T, int> || std::same_as<T, std::uint64_t>) {
    const auto read = whole();
    if (read) out = static_cast<T>(*read);
  } else if constexpr (std::same_as<T, bool>) {
    out = ReadBool(value, path, scope).value_or(out);
  } else if constexpr (std::same_as<T, std::string>) {
    out = text();
  } else if constexpr (std::same_as<T, Placed>) {
    out = {text(), value.at};
  } else if constexpr (std::same_as<T, Vec3>) {
    out = key.is_direction ? ReadDirection(value, path, scope) : ReadVec3(value, path, scope);
    if (key.bound->above_least && !(out.x > 0.0 && out.y > 0.0 && out.z > 0.0)) {
      if (!std::isnan(out.x + out.y + out.z)) {
        scope.out.Error("value.not_three_positive", value.at,
                        path + " must be three positive numbers");
      }
      out = {NAN, NAN, NAN};
    }
  } else if constexpr (std::same_as<T, Quat>) {
    out = ReadRotation(value, path, scope);
  } else if constexpr (std::same_as<T, std::vector<std::string>>) {
    out = ReadNames(value, path, scope);
  } else if constexpr (std::same_as<T, std::vector<std::vector<std::string>>>) {
    out = ReadMatch(value, path, scope);
  } else if constexpr (std::same_as<T, std::pair<double, double>>) {
    const auto ends = ReadNumbers(value, path, 2, scope);
    out = ends ? std::pair((*ends)[0], (*ends)[1]) : std::pair<double, double>(NAN, NAN);
  } else if constexpr (std::same_as<T, std::vector<std::pair<double, double>>>) {
    out = ReadPoints(value, path, *key.bound, scope);
  } else if constexpr (std::same_as<T, std::vector<double>>) {
    for (const ValuePtr& item : Items(&value, path, scope)) {
      out.push_back(ReadNumber(*item, path, *key.bound, scope));
    }
  } else if constexpr (std::same_as<T, std::vector<Vec3>>) {
    for (const ValuePtr& item : Items(&value, path, scope)) {
      out.push_back(ReadVec3(*item, path, scope));
    }
  } else if constexpr (std::same_as<T, std::vector<Placed>>) {
    for (const ValuePtr& item : Items(&value, path, scope)) {
      out.push_back({ReadText(*item, path, scope), item->at});
    }
  } else if constexpr (std::same_as<T, std::optional<int>>) {
    out = whole();
  } else if constexpr (kIsOptional<T>) {
    ReadField(value, path, key, scope, out.emplace());
  } else if constexpr (kIsList<T>) {
    for (const ValuePtr& item : Items(&value, path, scope)) {
      ReadField(*item, path, {key.name}, scope, out.emplace_back());
    }
  } else if constexpr (kIsNamed<T>) {
    ReadNamed(value, path, key, scope, out);
  } else if constexpr (kIsRaw<T>) {
    out.value = &value;
  } else if constexpr (kIsOverlay<T>) {
    out.value = &value;
    typename T::Mapping unused{};
    ReadMapping(value, path, scope, unused);
  } else {
    if constexpr (requires { ReadShort(value, path, scope, out); }) {
      if (ReadShort(value, path, scope, out)) return;
    }
    ReadMapping(value, path, scope, out);
  }
}

class FileReader : public KeyVisitor<FileReader, false> {
 public:
  explicit FileReader(MapReader& map) : map_(map) { spelling = map.scope().spelling; }

  void Map(const char* what, const char* /*title*/, const char* /*meaning*/,
           const char* /*example*/ = nullptr) {
    if (*what) map_.Call(what);
  }
  template <class T>
  void On(const Key& key, T& field) {
    const auto read = [](const Value& value, const std::string& path, const Key& its_key,
                         const Scope& scope, void* its_field) {
      ReadField(value, path, its_key, scope, *static_cast<T*>(its_field));
    };
    if (!ReadInto(&field, key, read)) Spoil(field);
  }
  template <class T, class E>
  void On(const Key& key, T& field, const Choices<E>& choices) {
    const Value* value = Find(key);
    if (!value) return;
    const auto read = ReadChoice<E>(*value, map_.Path(key.name), choices, map_.scope());
    if (read) {
      field = *read;
    } else {
      not_chosen_.emplace_back(key.name);
    }
  }
  /// Reports a name that is not the valid alternative; the message contains the valid one.
  template <class OfName>
  void Spell(const Spellings& spellings, const OfName& of_name) {
    const char* right = spellings.names[std::max(0, spelling.index)];
    bool wrong = false;
    for (const char* name : spellings.names) {
      if (name == right || spelling.index < 0 || map_.Has(name)) map_.Know(name);
      if (name == right || !map_.Has(name)) continue;
      if (spelling.index < 0) {
        right = name;
      } else {
        map_.Error("key.wrong_quantity", name, map_.Path(name) + " has the wrong unit",
                   std::string(spelling.who) + " needs " + right);
        wrong = true;
      }
    }
    if (!wrong || map_.Has(right)) of_name(right);
  }
  void SpeltBy(const char* key, const Spelling& now) {
    spelling = now;
    const bool chosen = std::find(not_chosen_.begin(), not_chosen_.end(), key) == not_chosen_.end();
    if (!chosen) spelling.index = -1;
  }
  /// If several of these keys are present, ignores all, because the intended one is unknown.
  void OneOf(const std::vector<std::string>& keys) {
    const bool clear = !map_.ExactlyOne(keys).empty();
    if (!clear) ignored_.insert(ignored_.end(), keys.begin(), keys.end());
  }
  void EitherSide(const std::vector<std::string>& one, const std::vector<std::string>& other) {
    const auto first = [&](const std::vector<std::string>& keys) {
      return std::find_if(keys.begin(), keys.end(),
                          [&](const std::string& key) { return map_.Has(key); });
    };
    const auto here = first(one), there = first(other);
    if (here != one.end() && there != other.end()) {
      OneOf({*here, *there});
    } else if (here == one.end() && there == other.end()) {
      std::vector<std::string> all = one;
      all.insert(all.end(), other.begin(), other.end());
      OneOf(all);
    }
  }

 private:
  /// Type-erased reader of a field. It keeps the compiled code of each table small.
  using FieldReader = void (*)(const Value&, const std::string& path, const Key&, const Scope&,
                               void* field);

  /// Returns false if a required key is absent.
  bool ReadInto(void* field, const Key& key, FieldReader read) {
    const Value* value = Find(key);
    if (!value) return !key.needed;
    Scope scope = map_.scope();
    scope.spelling = spelling;
    read(*value, map_.Path(key.name), key, scope, field);
    return true;
  }
  const Value* Find(const Key& key) {
    map_.Know(key.name);
    if (std::find(ignored_.begin(), ignored_.end(), key.name) != ignored_.end()) return nullptr;
    return key.needed ? map_.Require(key.name) : map_.Find(key.name);
  }
  template <class T>
  static void Spoil(T& field) {
    if constexpr (std::same_as<T, double>) field = NAN;
    if constexpr (std::same_as<T, Vec3>) field = {NAN, NAN, NAN};
  }

  MapReader& map_;
  std::vector<std::string> ignored_, not_chosen_;
};

template <class T>
void ReadMapping(const Value& value, const std::string& path, const Scope& scope, T& out) {
  const std::size_t errors_before = scope.out.items().size();
  MapReader map(value, path, scope);
  FileReader io(map);
  Keys(io, out);
  map.RefuseOthers();
  if constexpr (requires { out.at = value.at; }) out.at = value.at;
  if constexpr (requires { Check(map, out); }) {
    map.CheckWith([&](const MapReader& all) { Check(all, out); });
  }
  if constexpr (requires { out.good = true; }) out.good = scope.out.items().size() == errors_before;
}

}  // namespace taut::description
