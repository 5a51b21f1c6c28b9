#include "export/message_tree.h"
#include "base/brief.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace taut::exporting {
namespace {

using nlohmann::ordered_json;

std::string Quoted(const std::string& text) {
  return ordered_json(text).dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

void PutNumber(std::string& json, double x) { json += base::Shortest(x); }

void MessageTree::Add(std::string_view path, std::size_t channel) {
  const std::size_t slash = path.find('/');
  const std::string name(path.substr(0, slash));
  auto at = std::find_if(fields_.begin(), fields_.end(),
                         [&](const Field& field) { return field.name == name; });
  if (at == fields_.end()) {
    Field made;
    made.name = name, made.key = Quoted(name) + ":";
    fields_.push_back(std::move(made));
    at = fields_.end() - 1;
  }
  Field& field = *at;
  if (slash == path.npos) {
    field.channel = channel;
    return;
  }
  if (!field.inner) field.inner = std::make_unique<MessageTree>();
  field.inner->Add(path.substr(slash + 1), channel);
}

void MessageTree::Write(const Trace& trace, std::size_t row, std::string& json) const {
  json += '{';
  bool first = true;
  for (const Field& field : fields_) {
    if (!field.inner && !std::isfinite(trace.values[field.channel][row])) continue;
    if (!first) json += ',';
    first = false;
    json += field.key;
    if (field.inner) {
      field.inner->Write(trace, row, json);
    } else {
      PutNumber(json, trace.values[field.channel][row]);
    }
  }
  json += '}';
}

std::string MessageTree::Schema(const Trace& trace) const {
  ordered_json properties = ordered_json::object();
  for (const Field& field : fields_) {
    properties[field.name] =
        field.inner
            ? ordered_json::parse(field.inner->Schema(trace))
            : ordered_json{{"type", "number"}, {"description", trace.channels[field.channel].unit}};
  }
  const ordered_json schema{{"type", "object"}, {"properties", properties}};
  return schema.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace taut::exporting
