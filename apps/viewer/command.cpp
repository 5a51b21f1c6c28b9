#include "command.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "protocol_messages.h"

namespace taut::viewer {
namespace {

bool IsNumber(const nlohmann::json& value) {
  return value.is_number() && std::isfinite(value.get<double>());
}

bool IsInteger(const nlohmann::json& value) {
  return value.is_number() && std::fabs(value.get<double>()) <= 2147483647.0 &&
         value.get<double>() == std::floor(value.get<double>());
}

bool IsVec3(const nlohmann::json& value) {
  return value.is_array() && value.size() == 3 && IsNumber(value[0]) && IsNumber(value[1]) &&
         IsNumber(value[2]);
}

bool IsChoice(const nlohmann::json& value, std::string_view choices) {
  if (!value.is_string()) return false;
  const std::string text = value.get<std::string>();
  while (!choices.empty()) {
    const std::size_t bar = choices.find('|');
    if (choices.substr(0, bar) == text) return true;
    choices = bar == choices.npos ? "" : choices.substr(bar + 1);
  }
  return false;
}

bool Fits(const nlohmann::json& value, const MessageField& field) {
  switch (field.kind) {
    case FieldKind::kString:
      return value.is_string() && value.get_ref<const std::string&>().size() < 1000;
    case FieldKind::kNumber:
      return IsNumber(value);
    case FieldKind::kInteger:
      return IsInteger(value);
    case FieldKind::kBoolean:
      return value.is_boolean();
    case FieldKind::kVec3:
      return IsVec3(value);
    case FieldKind::kChoice:
      return IsChoice(value, field.choices);
  }
  return false;
}

/// Returns whether `json` has exactly the fields of messages of this type.
bool CheckFields(const nlohmann::json& json, const std::string& type, std::string& error) {
  bool known = false;
  std::size_t found = 1;  // the field "type" has been found already
  for (const MessageField& field : kClientFields) {
    if (type != field.message) continue;
    known = true;
    if (*field.name == '\0') continue;
    const auto at = json.find(field.name);
    if (at == json.end()) {
      if (field.optional) continue;
      error = fmt::format("{} needs \"{}\"", type, field.name);
      return false;
    }
    ++found;
    if (!Fits(*at, field)) {
      error = fmt::format("{}: \"{}\" has the wrong type", type, field.name);
      return false;
    }
  }
  if (!known) {
    error = fmt::format("there is no message \"{}\"", type.substr(0, 40));
  } else if (found != json.size()) {
    error = fmt::format("{} has an unknown field", type);
  }
  return known && found == json.size();
}

/// Checks the ranges of numbers; their types have been checked.
bool CheckRanges(const Command& command, std::string& error) {
  const auto within = [&](const char* what, double value, double least, double most) {
    if (value >= least && value <= most) return true;
    error = fmt::format("{}: {} must be within {:g} to {:g}, got {:g}", command.type, what, least,
                        most, value);
    return false;
  };
  if (command.type == "speed") {
    return command.value == 0 || within("factor", command.value, 0.001, 1000);
  }
  if (command.type == "push") return within("duration_s", command.value, 0.001, 1000);
  if (command.type == "open_shape") return within("number", command.count, 1, 100000);
  if (command.type == "step") return within("count", command.count, -1000, 1000);
  if (command.type == "want_series") {
    return within("points", command.points, 2, 10000) &&
           within("source", command.source, 0, kMaxComparedRuns);
  }
  return true;
}

}  // namespace

std::optional<Command> ParseCommand(std::string_view text, std::string& error) {
  if (text.size() > kMaxMessageBytes) {
    error = "the message is too long";
    return std::nullopt;
  }
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("type") || !json["type"].is_string()) {
    error = "a message must be a JSON object with a string \"type\"";
    return std::nullopt;
  }
  Command command;
  command.type = json["type"].get<std::string>();
  if (!CheckFields(json, command.type, error)) return std::nullopt;
  for (const auto& [key, value] : json.items()) {
    if (key == "node" || key == "name" || key == "cable" || key == "channel") {
      command.name = value.get<std::string>();
    } else if (key == "gain") {
      command.gain = value.get<std::string>();
    } else if (key == "mode" || key == "as") {
      command.mode = value.get<std::string>();
    } else if (key == "on") {
      command.on = value.get<bool>();
    } else if (key == "target_m" || key == "force_n") {
      command.vector = {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
    } else if (key == "value" || key == "factor" || key == "time_s" || key == "duration_s") {
      command.value = value.get<double>();
    } else if (key == "t0") {
      command.t0 = value.get<double>();
    } else if (key == "t1") {
      command.t1 = value.get<double>();
    } else if (key == "id") {
      command.id = static_cast<int>(value.get<double>());
    } else if (key == "source") {
      command.source = static_cast<int>(value.get<double>());
    } else if (key == "points") {
      command.points = static_cast<int>(value.get<double>());
    } else if (key == "count" || key == "number") {
      command.count = static_cast<int>(value.get<double>());
    }
  }
  if (!CheckRanges(command, error)) return std::nullopt;
  return command;
}

}  // namespace taut::viewer
