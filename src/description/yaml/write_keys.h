/// Writers of YAML with tables of keys (keys.h), for resolved experiments and for files that people
/// edit.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "description/yaml/read_keys.h"
#include "taut/spec.h"

namespace taut::description {

/// Returns the text in double quotes, valid in JSON and YAML.
std::string Quoted(const std::string& text);
/// Returns the text without quotes if YAML permits this, otherwise in quotes.
std::string PlainOrQuoted(const std::string& text);

/// Returns all numbers of a long list as one quoted text.
template <class List>
std::string PackedText(const Packed<List>& packed) {
  std::string text = "\"";
  const auto put = [&text](double number) {
    if (text.size() > 1) text += ' ';
    text += Shown(number);
  };
  for (const auto& item : packed.list) EachNumber(item, put);
  return text + '"';
}

/// Writer of one line: a map `{name: "ground", point_m: [0, 0, 0]}`, or one `key: value` of it. In
/// files that people edit, omits empty texts and lists, and `Raw` values.
template <bool kOfResolved>
class FlowWriter : public KeyVisitor<FlowWriter<kOfResolved>, kOfResolved> {
 public:
  using Line = KeyText;

  explicit FlowWriter(const Spelling& spelt = {}) { this->spelling = spelt; }

  template <class T>
  static std::string Text(const T& value, const Spelling& spelt = {}) {
    if constexpr (std::same_as<T, bool>) {
      return value ? "true" : "false";
    } else if constexpr (std::integral<T>) {
      return std::to_string(value);
    } else if constexpr (std::floating_point<T>) {
      return Shown(value);
    } else if constexpr (std::same_as<T, std::string>) {
      return kOfResolved ? Quoted(value) : PlainOrQuoted(value);
    } else if constexpr (std::same_as<T, Vec3>) {
      return Text(std::vector{value.x, value.y, value.z});
    } else if constexpr (std::same_as<T, Quat>) {
      return Text(std::vector{value.w, value.x, value.y, value.z});
    } else if constexpr (std::same_as<T, Inertia>) {
      return Text(std::vector{value.xx, value.yy, value.zz, value.xy, value.xz, value.yz});
    } else if constexpr (std::same_as<T, std::pair<double, double>>) {
      return Text(std::vector{value.first, value.second});
    } else if constexpr (kIsPacked<T>) {
      return PackedText(value);
    } else {
      FlowWriter writer(spelt);
      Keys(writer, value);
      return "{" + writer.text_ + "}";
    }
  }
  template <class T>
  static std::string Text(const std::vector<T>& items, const Spelling& spelt = {}) {
    std::string out;
    for (const T& item : items) {
      if (!out.empty()) out += ", ";
      out += Text(item, spelt);
    }
    return "[" + out + "]";
  }

  /// Omits infinite limits, since files cannot contain infinity.
  template <class T>
  void On(const KeyText& key, const T& value) {
    if constexpr (std::same_as<T, double>) {
      if (key.limit && std::isinf(value)) return;
      if (value == key.before) return;
    }
    if constexpr (std::same_as<T, bool>) {
      if (key.later && !value) return;  // write a key of a later version only if it is true
    }
    if constexpr (requires { value.empty(); }) {
      if ((!kOfResolved || key.later) && value.empty()) return;
    }
    if constexpr (kIsOptional<T>) {
      if (value) Put(key.name, Text(*value, this->spelling));
    } else if constexpr (!kIsRaw<T>) {
      Put(key.name, Text(value, this->spelling));
    }
  }
  /// Omits a key of a later version if it has the default value, its first choice.
  template <class E>
  void On(const KeyText& key, E value, const Choices<E>& choices) {
    if (key.later && choices.front().second == value) return;
    for (const auto& [name, choice] : choices) {
      if (choice == value) Put(key.name, name);
    }
  }
  const std::string& text() const { return text_; }

 private:
  void Put(const char* key, const std::string& value) {
    if (!text_.empty()) text_ += ", ";
    text_ += key;
    text_ += ": ";
    text_ += value;
  }
  std::string text_;
};

/// Whether a map is written as a block of lines (true) or in one line (false).
template <bool kOfResolved, class T>
inline constexpr bool kIsBlock = requires(FlowWriter<kOfResolved>& io, const T& mapping) {
  Keys(io, mapping);
};
template <class T>
inline constexpr bool kIsBlock<true, T> = std::same_as<T, RobotSpec>;

/// Writer of a block, with one line per key and per list item.
template <bool kOfResolved>
class BlockWriter : public KeyVisitor<BlockWriter<kOfResolved>, kOfResolved> {
 public:
  using Line = KeyText;

  explicit BlockWriter(std::string indent, const Spelling& spelt = {})
      : indent_(std::move(indent)) {
    this->spelling = spelt;
  }

  template <class T, class... Choices>
  void On(const KeyText& key, const T& value, const Choices&... choices) {
    if constexpr (kIsRaw<T>) {
      return;
    } else if constexpr (!kOfResolved && kIsOptional<T>) {
      if (value) On(key, *value, choices...);
    } else if constexpr (kIsBlock<kOfResolved, T>) {
      BlockWriter inner(indent_ + "  ", this->spelling);
      Keys(inner, value);
      text_ += indent_ + key.name + ":\n" + inner.text_;
    } else {
      FlowWriter<kOfResolved> line(this->spelling);
      line.On(key, value, choices...);
      if (!line.text().empty()) text_ += indent_ + line.text() + "\n";
    }
  }
  template <class T>
  void On(const KeyText& key, const std::vector<T>& items) {
    if constexpr (!kOfResolved && !kIsBlock<kOfResolved, T>) {
      FlowWriter<kOfResolved> line(this->spelling);
      line.On(key, items);
      if (!line.text().empty()) text_ += indent_ + line.text() + "\n";
      return;
    }
    if ((!kOfResolved || key.later) && items.empty()) return;
    text_ += indent_ + key.name + ":" + (items.empty() ? " []" : "") + "\n";
    for (const T& item : items) {
      text_ += indent_ + "  - " + FlowWriter<kOfResolved>::Text(item, this->spelling) + "\n";
    }
  }
  const std::string& text() const { return text_; }

 private:
  std::string indent_, text_;
};

}  // namespace taut::description
