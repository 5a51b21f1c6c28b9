#include "trace/ros2_message.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <sstream>

#include "base/number_text.h"
#include "trace/csv_lines.h"

namespace taut::trace {
namespace {

constexpr std::uint32_t kMostElements = 64;
constexpr int kDeepest = 16;
constexpr std::size_t kMostNameBytes = 1000;
/// Limit of the fields and elements of a message: a constant, and a number for each of its bytes.
/// Types without fields take no bytes: nested lists of such types would never end.
constexpr std::size_t kFreeSteps = 1000, kStepsPerByte = 8;

struct Primitive {
  std::string_view name;
  std::size_t size;
  enum Kind { kSigned, kUnsigned, kFloat } kind;
};
constexpr Primitive kPrimitives[] = {
    {"bool", 1, Primitive::kUnsigned},   {"byte", 1, Primitive::kUnsigned},
    {"char", 1, Primitive::kUnsigned},   {"int8", 1, Primitive::kSigned},
    {"uint8", 1, Primitive::kUnsigned},  {"int16", 2, Primitive::kSigned},
    {"uint16", 2, Primitive::kUnsigned}, {"int32", 4, Primitive::kSigned},
    {"uint32", 4, Primitive::kUnsigned}, {"int64", 8, Primitive::kSigned},
    {"uint64", 8, Primitive::kUnsigned}, {"float32", 4, Primitive::kFloat},
    {"float64", 8, Primitive::kFloat},
};

const Primitive* FindPrimitive(std::string_view name) {
  const auto found = std::find_if(std::begin(kPrimitives), std::end(kPrimitives),
                                  [&](const Primitive& p) { return p.name == name; });
  return found == std::end(kPrimitives) ? nullptr : found;
}

/// Types are called pkg/msg/Name or pkg/Name.
std::string ShortName(const std::string& name) {
  const std::size_t first = name.find('/'), last = name.rfind('/');
  return first == last ? name : name.substr(0, first) + name.substr(last);
}

std::string PackageOf(const std::string& name) { return name.substr(0, name.find('/')); }

}  // namespace

std::optional<Ros2Message> Ros2Message::Parse(const std::string& name,
                                              const std::string& definition, std::string& why) {
  Ros2Message message;
  message.name_ = ShortName(name);
  std::string current = message.name_;
  message.types_[current];
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    const std::string_view text = Trim(line);
    if (text.empty()) continue;
    if (text.starts_with("====")) continue;
    if (text.starts_with("MSG:")) {
      current = ShortName(std::string(Trim(text.substr(4))));
      message.types_[current];
      continue;
    }
    std::istringstream words{std::string(text)};
    Field field;
    words >> field.type >> field.name;
    // Skip constants.
    if (field.name.empty() || field.name.find('=') != field.name.npos) continue;
    std::string next;
    words >> next;
    if (next.starts_with('=')) continue;
    if (std::max(field.name.size(), field.type.size()) > kMostNameBytes) {
      why = "a name of its definition has more than " + std::to_string(kMostNameBytes) + " bytes";
      return std::nullopt;
    }
    if (const std::size_t open = field.type.find('['); open != field.type.npos) {
      field.is_list = true;
      const std::string count = field.type.substr(open + 1, field.type.size() - open - 2);
      if (!count.empty() && !count.starts_with("<=")) {
        base::FromChars(count.data(), count.data() + count.size(), field.fixed);
      }
      field.type.resize(open);
    }
    field.type = field.type.substr(0, field.type.find("<="));
    if (FindPrimitive(field.type) == nullptr && field.type != "string" && field.type != "wstring") {
      const bool local = field.type.find('/') == field.type.npos;
      field.type = local ? PackageOf(current) + "/" + field.type : ShortName(field.type);
    }
    message.types_[current].push_back(std::move(field));
  }
  for (const auto& [type, fields] : message.types_) {
    for (const Field& field : fields) {
      if (FindPrimitive(field.type) != nullptr || field.type == "string") continue;
      if (field.type == "wstring" || !message.types_.contains(field.type)) {
        why = "the type " + field.type + " has no definition";
        return std::nullopt;
      }
    }
  }
  return message;
}

/// Position in a message; alignment counts from the byte after the four of the encoding.
class Ros2Message::Decoder {
 public:
  using Numbers = std::function<void(const std::string&, double)>;

  Decoder(const Ros2Message& of, std::string_view data, const Numbers& number, std::size_t& steps)
      : of_(of), data_(data), number_(number), steps_(steps) {}

  bool Run() {
    if (data_.size() < 4 || data_[0] != 0 || (data_[1] != 0 && data_[1] != 1)) return false;
    big_ = data_[1] == 0;
    data_.remove_prefix(4);
    std::string label;
    Struct(of_.name_, "", true, 0, label);
    return good_;
  }

 private:
  /// Counts a field or an element. Returns false if there are too many.
  bool Step() {
    if (steps_ == 0) good_ = false;
    if (good_) --steps_;
    return good_;
  }

  std::uint64_t Bits(std::size_t size) {
    at_ = (at_ + size - 1) / size * size;
    if (at_ + size > data_.size()) {
      good_ = false;
      return 0;
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = big_ ? size - 1 - i : i;
      bits |= std::uint64_t{static_cast<unsigned char>(data_[at_ + i])} << (8 * place);
    }
    at_ += size;
    return bits;
  }

  double Number(const Primitive& primitive) {
    const std::uint64_t bits = Bits(primitive.size);
    if (primitive.kind == Primitive::kFloat) {
      return primitive.size == 8 ? std::bit_cast<double>(bits)
                                 : double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
    }
    if (primitive.kind == Primitive::kUnsigned) return static_cast<double>(bits);
    const std::size_t unused = 64 - 8 * primitive.size;
    return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
  }

  std::string_view Text() {
    const std::uint64_t size = Bits(4);  // the size includes a terminating NUL
    if (!good_ || size > data_.size() - at_) {
      good_ = false;
      return {};
    }
    std::string_view text = data_.substr(at_, size);
    at_ += size;
    while (!text.empty() && text.back() == '\0') text.remove_suffix(1);
    return text;
  }
  /// Returns a text that becomes part of names.
  std::string Name() {
    const std::string_view text = Text();
    if (text.size() > kMostNameBytes) good_ = false;
    return std::string(text.substr(0, kMostNameBytes));
  }

  /// `label`: the text of the field that names a list's element.
  void Struct(const std::string& type, const std::string& path, bool shown, int depth,
              std::string& label) {
    if (depth > kDeepest) good_ = false;
    std::vector<std::string> names;  // elements of the list `name`
    for (const Field& field : of_.types_.at(type)) {
      if (!Step()) return;
      const std::string here = path.empty() ? field.name : path + "/" + field.name;
      if (field.is_list) {
        List(field, here, shown, depth, names);
      } else if (field.type == "string") {
        if (field.name == "child_frame_id") {
          label = Name();
        } else {
          Text();
        }
      } else {
        std::string unused;
        Value(field.type, here, shown && field.name != "header", depth, unused);
      }
    }
  }

  void Value(const std::string& type, const std::string& path, bool shown, int depth,
             std::string& label) {
    if (const Primitive* const primitive = FindPrimitive(type)) {
      const double value = Number(*primitive);
      if (good_ && shown) number_(path, value);
    } else {
      Struct(type, path, shown, depth + 1, label);
    }
  }

  void List(const Field& field, const std::string& path, bool shown, int depth,
            std::vector<std::string>& names) {
    const std::uint64_t count = field.fixed > 0 ? field.fixed : Bits(4);
    const Primitive* const primitive = FindPrimitive(field.type);
    const std::size_t least = primitive != nullptr ? primitive->size : 1;
    if (!good_ || count > (data_.size() - at_) / least) {
      good_ = false;
      return;
    }
    const bool few = count <= kMostElements && !(primitive != nullptr && primitive->size == 1);
    for (std::uint64_t i = 0; i < count && Step(); ++i) {
      if (field.type == "string") {
        if (field.name == "name") {
          names.push_back(Name());
        } else {
          Text();
        }
        continue;
      }
      const bool named = names.size() == count;
      if (primitive != nullptr || named) {
        std::string unused;
        Value(field.type, path + "/" + (named ? names[i] : std::to_string(i)), shown && few, depth,
              unused);
        continue;
      }
      Element(field.type, path, i, shown && few, depth);
    }
  }

  /// Decodes a struct of a list; one of its fields may contain its name.
  void Element(const std::string& type, const std::string& path, std::uint64_t index, bool shown,
               int depth) {
    std::vector<std::pair<std::string, double>> numbers;
    const Numbers keep = [&](const std::string& of, double value) {
      numbers.emplace_back(of, value);
    };
    Decoder inner(of_, data_, keep, steps_);
    inner.big_ = big_;
    inner.at_ = at_;
    std::string label;
    inner.Struct(type, "", true, depth + 1, label);
    at_ = inner.at_;
    good_ = good_ && inner.good_;
    if (!good_ || !shown) return;
    const std::string head = path + "/" + (label.empty() ? std::to_string(index) : label) + "/";
    for (const auto& [of, value] : numbers) number_(head + of, value);
  }

  const Ros2Message& of_;
  std::string_view data_;
  const Numbers& number_;
  std::size_t& steps_;  ///< Steps left for the whole message.
  std::size_t at_ = 0;
  bool big_ = false, good_ = true;
};

bool Ros2Message::Decode(std::string_view cdr,
                         const std::function<void(const std::string&, double)>& number) const {
  std::size_t steps = kFreeSteps + kStepsPerByte * cdr.size();
  return Decoder(*this, cdr, number, steps).Run();
}

}  // namespace taut::trace
