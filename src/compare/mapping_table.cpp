#include "compare/mapping_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>

namespace taut {
namespace {

using Json = MappingJson::Json;

constexpr int kMaxSkippedLines = 1'000'000, kMaxHeaderLines = 10;
constexpr ClockFormat kClockFormats[] = {ClockFormat::kNumber, ClockFormat::kTimeOfDay,
                                         ClockFormat::kIso8601, ClockFormat::kDayMonthYear,
                                         ClockFormat::kMonthDayYear};

/// Returns the position of a key's text in `choices`; nothing for other values.
std::optional<std::size_t> Choice(std::span<const std::string_view> choices, const Json& json) {
  const std::string text = json.is_string() ? json.get<std::string>() : "";
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end()) return std::nullopt;
  return static_cast<std::size_t>(found - choices.begin());
}

std::string Listed(std::span<const std::string_view> choices) {
  std::string list;
  for (const std::string_view each : choices) {
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ",
                        each == "\t" ? std::string_view("\\t") : each);
  }
  return list;
}

/// Returns a whole number from 0 to `most`; nothing for other values.
std::optional<int> Whole(const Json& json, int most) {
  const double number = json.is_number() ? json.get<double>() : -1.0;
  if (!(number >= 0 && number <= most && number == static_cast<int>(number))) return std::nullopt;
  return static_cast<int>(number);
}

void Header(const Json& json, TableLayout& table, MappingJson& values) {
  if (json.contains("skip_lines")) {
    const auto lines = Whole(json["skip_lines"], kMaxSkippedLines);
    if (!lines) {
      values.Error("mapping.bad_skip_lines", "table.skip_lines",
                   "must be a whole number of lines, at most 1000000");
    }
    table.skip_lines = lines.value_or(0);
  }
  if (json.contains("header")) {
    const Json& header = json["header"];
    const auto lines =
        header.is_boolean() ? int{header.get<bool>()} : Whole(header, kMaxHeaderLines);
    if (!lines) {
      values.Error("mapping.bad_header", "table.header",
                   "must be true, false or a number of lines, at most 10");
    }
    table.header_lines = lines.value_or(1);
  }
  if (!json.contains("merged_header")) return;
  if (!json["merged_header"].is_boolean()) {
    values.Error("mapping.bad_merged_header", "table.merged_header", "must be true or false");
  } else {
    table.merged_header = json["merged_header"].get<bool>();
  }
}

/// Reads separator, decimal mark and encoding.
void Text(const Json& json, TableLayout& table, MappingJson& values) {
  constexpr std::string_view kSeparators[] = {",", ";", "|", "\t", " "};
  constexpr std::string_view kDecimals[] = {".", ","};
  constexpr std::string_view kEncodings[] = {"utf-8", "windows-1252"};
  if (json.contains("separator")) {
    const auto at = Choice(kSeparators, json["separator"]);
    if (!at)
      values.Error("mapping.bad_separator", "table.separator",
                   "must be one of " + Listed(kSeparators));
    table.separator = kSeparators[at.value_or(0)][0];
  }
  if (json.contains("decimal")) {
    const auto at = Choice(kDecimals, json["decimal"]);
    if (!at)
      values.Error("mapping.bad_decimal", "table.decimal", "must be one of " + Listed(kDecimals));
    table.decimal = kDecimals[at.value_or(0)][0];
  }
  if (table.decimal == ',' && table.separator == ',') {
    values.Error("mapping.decimal_is_separator", "table.decimal", "is a comma, as is the separator",
                 "add \"separator\": \";\" or \"\\t\"");
  }
  if (json.contains("encoding")) {
    const auto at = Choice(kEncodings, json["encoding"]);
    if (!at)
      values.Error("mapping.bad_encoding", "table.encoding",
                   "must be one of " + Listed(kEncodings));
    if (at == 1) table.encoding = TextEncoding::kWindows1252;
  }
}

std::vector<std::string> Texts(const Json& table, const std::string& key, MappingJson& values) {
  if (!table.contains(key)) return {};
  const Json& list = table[key];
  if (!list.is_array() || list.empty() ||
      !std::all_of(list.begin(), list.end(), [](const Json& j) { return j.is_string(); })) {
    values.Error("mapping.bad_list", "table." + key, "must be a list of strings");
    return {};
  }
  return list.get<std::vector<std::string>>();
}

void Rows(const Json& json, TableLayout& table, MappingJson& values) {
  table.row_s = values.Number(json, "row_s", "table.time", 1.0);
  if (!(*table.row_s > 0)) {
    values.Error("mapping.bad_row_s", "table.time.row_s", "must be above 0");
  }
  for (const char* other : {"column", "unit", "format", "zero"}) {
    if (json.contains(other)) {
      values.Error("mapping.two_times", "table.time", fmt::format("has both row_s and {}", other));
    }
  }
}

void Clock(const Json& json, TableLayout& table, MappingJson& values) {
  table.offset_s = values.Number(json, "offset_s", "table.time", 0.0);
  if (json.contains("row_s")) return Rows(json, table, values);
  table.time_column = values.Text(json, "column", "table.time");
  if (json.contains("format")) {
    std::vector<std::string_view> names;
    for (const ClockFormat format : kClockFormats) names.push_back(ClockFormatName(format));
    const auto at = Choice(names, json["format"]);
    if (!at)
      values.Error("mapping.bad_clock", "table.time.format", "must be one of " + Listed(names));
    table.clock = kClockFormats[at.value_or(0)];
  }
  if (json.contains("unit")) {
    const std::string unit = values.Text(json, "unit", "table.time");
    if (!unit.empty()) table.unit_s = values.UnitIn(unit, "s", "table.time.unit");
    if (table.clock != ClockFormat::kNumber) {
      values.Error("mapping.unit_of_clock", "table.time.unit", "has no effect with this format",
                   "remove it");
    }
  }
  // A date is far from the start of a simulation.
  const bool has_date =
      table.clock != ClockFormat::kNumber && table.clock != ClockFormat::kTimeOfDay;
  if (has_date) table.zero.reset();
  if (json.contains("zero") && json["zero"] == "first") {
    table.zero.reset();
  } else if (json.contains("zero")) {
    if (!json["zero"].is_number()) {
      values.Error("mapping.bad_zero", "table.time.zero", "must be a number or \"first\"");
      return;
    }
    table.zero = json["zero"];
  }
}

}  // namespace

TableLayout ReadTableLayout(const Json& json, MappingJson& values) {
  TableLayout table;
  if (!values.IsObject(json, "table",
                       {"skip_lines", "header", "merged_header", "columns", "separator", "decimal",
                        "encoding", "ignore", "time", "names", "value"})) {
    return table;
  }
  Header(json, table, values);
  Text(json, table, values);
  table.columns = Texts(json, "columns", values);
  table.ignore = Texts(json, "ignore", values);
  table.name_columns = Texts(json, "names", values);
  if (json.contains("value")) table.value_column = values.Text(json, "value", "table");
  if (json.contains("names") != json.contains("value")) {
    values.Error(
        "mapping.names_without_value", "table",
        "must have both \"names\" and \"value\", or neither",
        "they select the columns of channel names and values, for tables with one value per row");
  }
  if (table.header_lines == 0 && table.columns.empty()) {
    values.Error("mapping.no_columns", "table.columns", "is missing",
                 "list the names of the columns, because the table has no header");
  }
  if (!json.contains("time")) {
    values.Error("mapping.no_time", "table.time", "is missing",
                 "expected {\"column\": \"t\", \"unit\": \"ms\"} or {\"row_s\": 1}");
  } else if (values.IsObject(json["time"], "table.time",
                             {"column", "unit", "format", "zero", "offset_s", "row_s"})) {
    Clock(json["time"], table, values);
  }
  return table;
}

}  // namespace taut
