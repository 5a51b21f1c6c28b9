#include <cmath>
#include <filesystem>

#include "base/hash.h"
#include "description/reader.h"
#include "description/resolved.h"
#include "description/resolved_fields.h"
#include "taut/version.h"

namespace taut {
namespace description {
namespace {

/// In double quotes, as JSON and YAML both read it.
std::string Quoted(const std::string& text) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      out += "\\x";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    } else {
      out += c;
    }
  }
  out += '"';
  return out;
}

/// One line: `{name: "ground", point_m: [0, 0, 0]}`, or a single `key: value` of it.
class FlowWriter {
 public:
  template <class T>
  static std::string Text(const T& value) {
    if constexpr (std::same_as<T, bool>) {
      return value ? "true" : "false";
    } else if constexpr (std::integral<T>) {
      return std::to_string(value);
    } else if constexpr (std::floating_point<T>) {
      return Shown(value);
    } else if constexpr (std::same_as<T, std::string>) {
      return Quoted(value);
    } else if constexpr (std::same_as<T, Vec3>) {
      return Text(std::vector{value.x, value.y, value.z});
    } else if constexpr (std::same_as<T, Quat>) {
      return Text(std::vector{value.w, value.x, value.y, value.z});
    } else if constexpr (std::same_as<T, Inertia>) {
      return Text(std::vector{value.xx, value.yy, value.zz, value.xy, value.xz, value.yz});
    } else if constexpr (std::same_as<T, std::pair<double, double>>) {
      return Text(std::vector{value.first, value.second});
    } else {
      FlowWriter writer;
      Fields(writer, value);
      return "{" + writer.text_ + "}";
    }
  }
  template <class T>
  static std::string Text(const std::vector<T>& items) {
    std::string out;
    for (const T& item : items) {
      if (!out.empty()) out += ", ";
      out += Text(item);
    }
    return "[" + out + "]";
  }

  template <class T>
  void operator()(const char* key, const T& value) {
    Put(key, Text(value));
  }
  template <class T>
  void operator()(const char* key, const std::optional<T>& value) {
    if (value) Put(key, Text(*value));
  }
  template <class E>
  void operator()(const char* key, E value, const Choices<E>& choices) {
    for (const auto& [name, choice] : choices) {
      if (choice == value) Put(key, name);
    }
  }
  /// Infinity, which files do not have, is a limit that is not there.
  void Limit(const char* key, double value) {
    if (std::isfinite(value)) Put(key, Text(value));
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

/// A line for each key and for each item of a list.
class BlockWriter {
 public:
  explicit BlockWriter(std::string indent) : indent_(std::move(indent)) {}

  template <class... Rest>
  void operator()(const char* key, const Rest&... rest) {
    FlowWriter line;
    line(key, rest...);
    if (!line.text().empty()) text_ += indent_ + line.text() + "\n";
  }
  template <class T>
  void operator()(const char* key, const std::vector<T>& items) {
    text_ += indent_ + key + ":" + (items.empty() ? " []" : "") + "\n";
    for (const T& item : items) text_ += indent_ + "  - " + FlowWriter::Text(item) + "\n";
  }
  void operator()(const char* key, const RobotSpec& robot) {
    BlockWriter inner(indent_ + "  ");
    Fields(inner, robot);
    text_ += indent_ + key + ":\n" + inner.text_;
  }
  template <class T>
  void Later(const char* key, const std::vector<T>& items) {
    if (!items.empty()) (*this)(key, items);
  }
  template <class T>
  void Later(const char* key, const T& item) {
    (*this)(key, item);
  }
  const std::string& text() const { return text_; }

 private:
  std::string indent_, text_;
};

}  // namespace
}  // namespace description

std::string ResolvedYaml(const ExperimentSpec& experiment) {
  std::string out = "# Made by taut ";
  out += kVersion;
  out += " from";
  for (const std::string& file : experiment.files) {
    out += ' ';
    out += description::Quoted(std::filesystem::path(file).filename().string());
  }
  out += "\n# (inputs " + base::HashText(experiment.input_hash) + "); repeats that run.\n";
  out += "taut: 1\nkind: ";
  out += description::kResolvedKind;
  out += '\n';
  ExperimentSpec portable = experiment;
  if (portable.compare_with) {  // this text may be kept anywhere
    std::error_code failed;
    const auto path = std::filesystem::absolute(*portable.compare_with, failed);
    if (!failed) portable.compare_with = path.string();
  }
  description::BlockWriter writer("");
  description::Fields(writer, std::as_const(portable));
  return out + writer.text();
}

}  // namespace taut
