// Reader of `builders:`, which assigns a class and its parameters to items with a tag.
#include <cmath>

#include "description/yaml/yaml_tree.h"
#include "import_ntrt/read.h"

namespace taut::import_ntrt {
namespace {

enum class Least { kAny, kZero, kAboveZero };

struct Number {
  const char* name;
  double Parameters::*field;
  Least least = Least::kZero;
  double most = INFINITY;
};
struct Flag {
  const char* name;
  bool Parameters::*field;
};

const std::vector<Number> kRound{{"radius", &Parameters::radius, Least::kAboveZero}};
const std::vector<Number> kCrossSection{{"width", &Parameters::width, Least::kAboveZero},
                                        {"height", &Parameters::height, Least::kAboveZero}};
const std::vector<Number> kSolid{{"density", &Parameters::density},
                                 {"friction", &Parameters::friction},
                                 {"roll_friction", &Parameters::roll_friction},
                                 {"restitution", &Parameters::restitution, Least::kZero, 1.0}};
const std::vector<Number> kCable{{"stiffness", &Parameters::stiffness, Least::kAboveZero},
                                 {"damping", &Parameters::damping},
                                 {"pretension", &Parameters::pretension},
                                 {"history", &Parameters::history, Least::kAny},
                                 {"max_tension", &Parameters::max_tension, Least::kAboveZero},
                                 {"target_velocity", &Parameters::target_velocity},
                                 {"min_actual_length", &Parameters::min_actual_length},
                                 {"min_rest_length", &Parameters::min_rest_length},
                                 {"rotation", &Parameters::rotation, Least::kAny}};
const std::vector<Number> kMotor{{"radius", &Parameters::motor_radius, Least::kAboveZero},
                                 {"motor_friction", &Parameters::motor_friction},
                                 {"motor_inertia", &Parameters::motor_inertia, Least::kAboveZero},
                                 {"back_drivable", &Parameters::back_drivable, Least::kAny}};
const std::vector<Flag> kEnds{{"moveCablePointAToEdge", &Parameters::move_from_to_edge},
                              {"moveCablePointBToEdge", &Parameters::move_to_to_edge}};

struct Table {
  Class kind;
  std::vector<const std::vector<Number>*> numbers;
  bool has_flags = false;
};
const std::vector<Table> kTables{
    {Class::kRod, {&kRound, &kSolid}},
    {Class::kBox, {&kCrossSection, &kSolid}},
    {Class::kSphere, {&kRound, &kSolid}},
    {Class::kBasic, {&kCable}, true},
    {Class::kBasicContact, {&kCable}, true},
    {Class::kKinematic, {&kCable, &kMotor}},
    {Class::kKinematicContact, {&kCable, &kMotor}},
};

/// Reads a Boolean value by the rules of yaml-cpp.
bool ReadTruth(const Value& value, std::string_view what, Diagnostics& out) {
  for (const char* yes :
       {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON", "y", "Y"}) {
    if (value.text == yes) return true;
  }
  for (const char* no :
       {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF", "n", "N"}) {
    if (value.text == no) return false;
  }
  out.Error("ntrt.not_boolean", value.at, std::string(what) + " must be true or false");
  return false;
}

void CheckRange(double number, const Number& is, const SourceRef& at, Diagnostics& out) {
  const std::string name = is.name;
  if (is.least == Least::kAboveZero && number <= 0.0) {
    out.Error("ntrt.not_positive", at, name + " must be positive");
  } else if (is.least == Least::kZero && number < 0.0) {
    out.Error("ntrt.negative", at, name + " must not be negative");
  } else if (number > is.most) {
    out.Error("ntrt.out_of_range", at, name + " must be within 0..1");
  }
}

void ReadParameters(const Table& table, const Value* parameters, Builder& builder,
                    Diagnostics& out) {
  std::vector<std::string> known;
  for (const auto* numbers : table.numbers) {
    for (const Number& is : *numbers) known.emplace_back(is.name);
  }
  if (table.has_flags) {
    for (const Flag& is : kEnds) known.emplace_back(is.name);
  }
  for (const Entry& entry : MapOf(parameters, "parameters", out)) {
    builder.written[entry.key] = entry.key_at;
    bool found = false;
    for (const auto* numbers : table.numbers) {
      for (const Number& is : *numbers) {
        if (entry.key != is.name) continue;
        found = true;
        builder.is.*is.field = ReadPlain(*entry.value, is.name, out);
        CheckRange(builder.is.*is.field, is, entry.value->at, out);
      }
    }
    for (const Flag& is : kEnds) {
      if (!table.has_flags || entry.key != is.name) continue;
      found = true;
      builder.is.*is.field = ReadTruth(*entry.value, is.name, out);
    }
    if (found) continue;
    out.Error("ntrt.unknown_parameter", entry.key_at,
              std::string(NameOf(table.kind)) + " has no parameter \"" + entry.key + "\"",
              DidYouMean(entry.key, known));
  }
}

}  // namespace

void ReadBuilders(const Reading& in, const Value* builders) {
  for (const Entry& entry : MapOf(builders, "builders", in.out)) {
    Builder builder;
    builder.search = Split(entry.key);
    builder.at = entry.key_at;
    if (builder.search.empty()) {
      in.out.Error("ntrt.builder_without_tag", entry.key_at, "a builder needs a tag");
      continue;
    }
    MapOf(entry.value.get(), entry.key, in.out);
    // NTRT ignores unknown keys, so a misspelled `parameters` would silently select the defaults.
    OnlyKeys(*entry.value, {"class", "parameters"}, in.out);
    const Value* const kind = entry.value->Find("class");
    if (!kind) {
      in.out.Error("ntrt.builder_without_class", entry.key_at,
                   "the builder \"" + entry.key + "\" has no class", "such as class: tgRodInfo");
      continue;
    }
    std::vector<std::string> classes;
    const Table* table = nullptr;
    for (const Table& known : kTables) {
      classes.emplace_back(NameOf(known.kind));
      if (kind->text == NameOf(known.kind)) table = &known;
    }
    if (!table) {
      in.out.Error("ntrt.unknown_class", kind->at, "there is no class \"" + kind->text + "\"",
                   DidYouMean(kind->text, classes));
      continue;
    }
    builder.kind = table->kind;
    ReadParameters(*table, entry.value->Find("parameters"), builder, in.out);
    in.model.builders.push_back(std::move(builder));
  }
}

void AddDefaultBuilders(Model& model) {
  for (const auto& [tag, kind] :
       {std::pair("rod", Class::kRod), std::pair("string", Class::kBasic),
        std::pair("box", Class::kBox), std::pair("sphere", Class::kSphere)}) {
    Builder builder;
    builder.search = {tag};
    builder.kind = kind;
    model.builders.push_back(std::move(builder));
  }
}

}  // namespace taut::import_ntrt
