#include "compare/log_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <unordered_map>

#include "base/input_file.h"
#include "compare/column_meaning.h"
#include "trace/clock_text.h"
#include "trace/csv_lines.h"
#include "trace/mat_variables.h"
#include "trace/table_cells.h"
#include "trace/text_encoding.h"

namespace taut {
namespace {

constexpr std::size_t kSampleLines = 400;
constexpr int kUsualHeaderLines = 3;
constexpr ClockFormat kClocks[] = {ClockFormat::kIso8601, ClockFormat::kTimeOfDay,
                                   ClockFormat::kDayMonthYear, ClockFormat::kMonthDayYear};

using Lines = std::vector<std::string>;
using Cells = std::vector<trace::TableCell>;

bool IsClock(const std::string& cell) {
  return std::any_of(std::begin(kClocks), std::end(kClocks), [&](ClockFormat format) {
    return trace::ParseClock(cell, format).has_value();
  });
}

bool IsValue(const std::string& cell, char decimal) {
  const auto number = trace::CellNumber(cell, decimal);
  return number ? std::isfinite(*number) : !trace::IsGapCell(cell) && IsClock(cell);
}

/// Returns the first lines and their encoding.
std::optional<Lines> Sample(const std::string& path, TextEncoding& encoding, Diagnostics& out) {
  Lines lines;
  bool is_utf8 = true;
  const auto add = [&](std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    is_utf8 = is_utf8 && trace::IsUtf8(line);
    lines.emplace_back(line);
    return lines.size() < kSampleLines;
  };
  if (!trace::ReadCsvLines(path, trace::CsvTail::kLine, add, out, encoding)) return std::nullopt;
  if (is_utf8 || encoding == TextEncoding::kWindows1252) return lines;
  encoding = TextEncoding::kWindows1252;
  return Sample(path, encoding, out);
}

/// Returns the number of cells that most of the last lines have.
std::size_t UsualCount(const std::vector<Cells>& table) {
  std::map<std::size_t, int> counts;
  const std::size_t from = table.size() / 2;
  for (std::size_t i = from; i < table.size(); ++i) ++counts[table[i].size()];
  std::size_t best = 0;
  for (const auto& [count, times] : counts) {
    if (best == 0 || times > counts[best]) best = count;
  }
  return best;
}

/// Returns whether a line is a row: it has as many cells as the others, or lacks empty cells at its
/// end, and at least half of its filled cells are numbers or times.
bool IsRow(const Cells& cells, std::size_t usual, char decimal) {
  if (cells.empty() || cells.size() > usual + 1 || cells.size() + 1 < usual) return false;
  std::size_t values = 0, texts = 0;
  for (const auto& cell : cells) {
    if (trace::IsGapCell(cell.text)) continue;
    ++(IsValue(cell.text, decimal) ? values : texts);
  }
  return values > 0 && values >= texts;
}

std::vector<Cells> Split(const Lines& lines, char separator) {
  std::vector<Cells> table;
  for (const std::string& line : lines) {
    table.push_back(trace::Trim(line).empty() ? Cells() : trace::SplitCells(line, separator));
  }
  while (!table.empty() && table.back().empty()) table.pop_back();
  return table;
}

struct Marks {
  char separator = ',', decimal = '.';
};

/// Returns the separator and the decimal mark with the most values in rows.
Marks GuessMarks(const Lines& lines) {
  Marks best;
  std::size_t most = 0;
  for (const char separator : {'\t', ';', ',', '|', ' '}) {
    const std::vector<Cells> table = Split(lines, separator);
    const std::size_t usual = UsualCount(table);
    for (const char decimal : {'.', ','}) {
      if (separator == decimal) continue;
      std::size_t values = 0;
      for (const Cells& cells : table) {
        if (!IsRow(cells, usual, decimal)) continue;
        for (const auto& cell : cells) values += IsValue(cell.text, decimal) ? 1u : 0u;
      }
      if (values > most) {
        most = values;
        best = {separator, decimal};
      }
    }
  }
  return best;
}

/// Returns whether a line names columns. A line with a single text above several columns is a
/// title, unless such lines name columns (`merged`).
bool IsHeader(const Cells& cells, std::size_t usual, char decimal, bool merged) {
  if (cells.size() + 1 < usual || cells.size() > usual + 1) return false;
  const auto texts = std::count_if(cells.begin(), cells.end(), [](const trace::TableCell& cell) {
    return !trace::IsGapCell(cell.text);
  });
  if (texts < (usual > 1 && !merged ? 2 : 1)) return false;
  return std::none_of(cells.begin(), cells.end(),
                      [&](const trace::TableCell& cell) { return IsValue(cell.text, decimal); });
}

/// Returns whether one cell of a header's upper line names several columns.
bool HasMergedCells(const Cells& upper, const Cells& lower) {
  std::size_t gaps = 0;
  bool named = false;
  for (std::size_t i = 0; i < std::min(upper.size(), lower.size()); ++i) {
    named = named || !upper[i].text.empty();
    if (named && upper[i].text.empty() && !lower[i].text.empty()) ++gaps;
  }
  return gaps > 0;
}

/// Returns the text after a key of lines such as "FREQUENCY<tab>100".
std::string After(const Lines& lines, std::string_view key) {
  for (const std::string& line : lines) {
    if (!line.starts_with(key) || line.size() <= key.size()) continue;
    const char next = line[key.size()];
    if (next == '\t' || next == ',') return std::string(trace::Trim(line.substr(key.size() + 1)));
  }
  return {};
}

/// Returns a rate above 0.
std::optional<double> RateIn(const std::string& text) {
  constexpr double kLeast_hz = 1e-3;
  auto value = trace::CellNumber(text, '.');
  if (!value) value = trace::CellNumber(text, ',');
  return value && *value >= kLeast_hz ? value : std::nullopt;
}

/// Returns names for the columns of a table without a header.
std::vector<std::string> Numbered(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= count; ++i) names.push_back(fmt::format("column {}", i));
  return names;
}

/// Reads the facts that known programs write above the header.
void ReadPreamble(const Lines& lines, std::size_t first_row, LogForm& form) {
  const std::string& first = lines.front();
  if (first.starts_with("LabVIEW Measurement")) {
    form.program = "LabVIEW";
    const std::string units = After(lines, "Y_Unit_Label");
    form.units.push_back("s");
    for (const auto& cell : trace::SplitCells(units, '\t')) form.units.push_back(cell.text);
  } else if (first.starts_with("Format Version")) {
    form.program = "OptiTrack";
    form.y_up = true;
    const Cells facts = trace::SplitCells(first, ',');
    for (std::size_t i = 1; i < facts.size(); ++i) {
      if (facts[i - 1].text == "Length Units") form.length_unit = KnownUnit(facts[i].text);
      if (facts[i - 1].text == "Export Frame Rate") form.rate_hz = RateIn(facts[i].text);
    }
    if (form.length_unit.empty()) form.doubts.push_back("the unit of lengths is unknown");
  } else if (first.starts_with("Trajectories") || first.starts_with("Segments") ||
             first.starts_with("Model Outputs")) {
    form.program = "Vicon";
    if (lines.size() > 1) form.rate_hz = RateIn(lines[1]);
  } else if (first.starts_with("NO_OF_FRAMES")) {
    form.program = "Qualisys";
    form.rate_hz = RateIn(After(lines, "FREQUENCY"));
    form.length_unit = "mm";
    if (form.layout.header_lines == 0 || first_row == 0) {
      std::vector<std::string> names;
      for (const auto& cell : trace::SplitCells(After(lines, "MARKER_NAMES"), '\t')) {
        for (const char* axis : {" X", " Y", " Z"}) names.push_back(cell.text + axis);
      }
      if (names.size() == form.names.size()) form.names = form.layout.columns = names;
    }
  }
}

/// Replaces characters that mappings refuse or use as patterns, and ends of lines.
void MakePlain(LogForm& form) {
  bool changed = false;
  for (std::string& name : form.names) {
    for (char& c : name) {
      if (c != '*' && c != '{' && c != '\r' && c != '\n' && c != '\t' && !base::IsControl(c))
        continue;
      c = '_';
      changed = true;
    }
  }
  if (changed) form.layout.columns = form.names;
}

/// Renames columns so that each name is unique.
void MakeUnique(LogForm& form) {
  std::unordered_map<std::string, int> seen;
  bool changed = false;
  for (std::string& name : form.names) {
    if (name.empty()) continue;
    int& times = seen[name];
    while (++times > 1) {
      const std::string wanted = fmt::format("{} ({})", name, times);
      if (!seen.emplace(wanted, 1).second) continue;
      name = wanted;
      changed = true;
      break;
    }
  }
  if (changed) form.layout.columns = form.names;
}

/// Returns whether cells such as "995" and "1.000" of a column are whole numbers with separators of
/// thousands.
bool MayHaveThousands(const std::vector<std::string>& cells) {
  bool whole = false, grouped = false;
  for (const std::string& cell : cells) {
    if (trace::IsGapCell(cell)) continue;
    const std::size_t mark = cell.find_first_of(".,");
    if (mark == cell.npos) {
      whole = true;
      continue;
    }
    if (mark == 0 || mark > 3 || cell[0] == '0' || cell.size() != mark + 4) return false;
    grouped = true;
  }
  return whole && grouped;
}

/// Returns the layout of a log in a MATLAB file, whose columns are its numeric vectors.
std::optional<LogForm> FormOfMat(const std::string& path, Diagnostics& out) {
  const auto variables = trace::ReadMatVariables(path, out);
  if (!variables) return std::nullopt;
  const trace::MatColumns columns = trace::ColumnsOf(*variables, 0);
  if (columns.values.empty()) {
    out.Error("log.no_vectors", {path}, "the file has no numeric vectors",
              "save the log as vectors: objects such as timetable cannot be read");
    return std::nullopt;
  }
  LogForm form;
  form.program = "MATLAB";
  form.names = columns.names;
  form.units.resize(form.names.size());
  const std::size_t rows = std::min(columns.values.front().size(), kSampleLines);
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<std::string>& row = form.rows.emplace_back();
    for (const auto& column : columns.values) row.push_back(fmt::format("{}", column[i]));
  }
  return form;
}

}  // namespace

std::optional<LogForm> RecognizeLog(const std::string& path, Diagnostics& out) {
  LogForm form;
  if (path.ends_with(".mcap")) {
    const auto trace = ReadTrace(path, out);
    if (!trace) return std::nullopt;
    form.program = "MCAP";
    form.is_trace = true;
    for (const ChannelInfo& channel : trace->channels) form.names.push_back(channel.name);
    form.units.resize(form.names.size());
    return form;
  }
  if (trace::IsMatFile(path)) return FormOfMat(path, out);
  const auto lines = Sample(path, form.layout.encoding, out);
  if (!lines) return std::nullopt;
  const auto without_rows = [&]() -> std::optional<LogForm> {
    out.Error("log.no_rows", {path}, "the file has no rows of numbers",
              "expected a text table, such as CSV");
    return std::nullopt;
  };
  if (lines->empty()) return without_rows();
  const Marks marks = GuessMarks(*lines);
  form.layout.separator = marks.separator;
  form.layout.decimal = marks.decimal;
  const std::vector<Cells> table = Split(*lines, marks.separator);
  const std::size_t usual = UsualCount(table);
  const bool is_motive = lines->front().starts_with("Format Version");
  const bool merged = lines->front().starts_with("Trajectories") ||
                      lines->front().starts_with("Segments") ||
                      lines->front().starts_with("Model Outputs");
  // Search backward for the last header: lines between rows, such as remarks, are reported below.
  std::size_t first = table.size();
  for (std::size_t i = table.size(); i-- > 0;) {
    if (IsRow(table[i], usual, marks.decimal)) {
      first = i;
    } else if (first < table.size() && IsHeader(table[i], usual, marks.decimal, merged)) {
      break;
    }
  }
  if (first == table.size()) return without_rows();
  std::size_t header = first;
  const std::size_t most = is_motive ? 10u : kUsualHeaderLines;
  while (header > 0 && first - header < most &&
         IsHeader(table[header - 1], usual, marks.decimal, merged)) {
    --header;
  }
  std::size_t skipped = 0, others = 0;
  for (std::size_t i = 0; i < header; ++i) {
    const bool row = IsRow(table[i], usual, marks.decimal);
    skipped += row && IsValue(table[i].front().text, marks.decimal) ? 1u : 0u;
  }
  if (skipped > 1) {
    form.doubts.push_back(
        fmt::format("{} rows of numbers before line {} are left out: the file has several headers",
                    skipped, header + 1));
  }
  for (std::size_t i = first; i < table.size(); ++i) {
    others += table[i].empty() || IsRow(table[i], usual, marks.decimal) ? 0u : 1u;
  }
  if (others > 0) {
    form.doubts.push_back(fmt::format("{} lines between the rows are not rows of numbers", others));
  }
  form.layout.skip_lines = static_cast<int>(header);
  form.layout.header_lines = static_cast<int>(first - header);
  for (std::size_t i = header; i + 1 < first; ++i) {
    if (HasMergedCells(table[i], table[first - 1])) form.layout.merged_header = true;
  }
  if (is_motive) form.layout.merged_header = false;
  for (std::size_t i = header; i < first; ++i) {
    trace::JoinHeader(table[i], form.layout.merged_header && i + 1 < first, form.names);
  }
  MakePlain(form);
  const std::size_t width = std::max(usual, form.names.size());
  if (header == first) form.names = form.layout.columns = Numbered(width);
  for (std::size_t i = first; i < table.size(); ++i) {
    if (!IsRow(table[i], usual, marks.decimal)) continue;
    std::vector<std::string>& row = form.rows.emplace_back();
    for (const auto& cell : table[i]) row.push_back(cell.text);
    row.resize(form.names.size());
  }
  for (std::size_t c = 0; c < form.names.size(); ++c) {
    std::vector<std::string> cells;
    for (const auto& row : form.rows) cells.push_back(row[c]);
    if (!MayHaveThousands(cells)) continue;
    form.doubts.push_back("numbers of \"" + form.names[c] + "\" may have separators of thousands");
  }
  ReadPreamble(*lines, first, form);
  form.units.resize(form.names.size());
  MakePlain(form);  // names from the lines above the header
  MakeUnique(form);
  return form;
}

}  // namespace taut
