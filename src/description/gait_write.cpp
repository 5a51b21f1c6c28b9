#include "description/gait_parts.h"
#include "description/reader.h"
#include "taut/files.h"

namespace taut {
namespace description {
namespace {

/// In double quotes, as YAML reads it. Gaits have names and sentences only.
std::string InQuotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out + '"';
}

std::string List(const std::vector<std::string>& items) {
  std::string out;
  for (const std::string& item : items) out += (out.empty() ? "" : ", ") + item;
  return "[" + out + "]";
}

/// `[[inner, top], [outer_top_1]]`.
std::string Written(const CableMatch& match) {
  std::vector<std::string> sets;
  for (const std::vector<std::string>& set : match) sets.push_back(List(set));
  return List(sets);
}

std::string Pair(const char* key, double number) { return std::string(key) + ": " + Shown(number); }

template <class E>
std::string NameOf(E value, const Choices<E>& choices) {
  for (const auto& [name, choice] : choices) {
    if (choice == value) return name;
  }
  return {};
}

void Write(const SineGait& sine, std::string& out) {
  out += "sine:\n  " + Pair("frequency_hz", sine.frequency_hz) + "\n  waves:\n";
  for (const SineWave& wave : sine.waves) {
    out += "    - {name: " + wave.name + ", cables: " + Written(wave.cables) + ", " +
           Pair("amplitude_m_per_s", wave.amplitude_m_per_s) + ", " +
           Pair("phase_rad", wave.phase_rad) + ", " + Pair("offset_m_per_s", wave.offset_m_per_s) +
           ", " + Pair("phase_per_segment_rad", wave.phase_per_segment_rad);
    if (wave.frequency_hz) out += ", " + Pair("frequency_hz", *wave.frequency_hz);
    out += "}\n";
  }
}

void Write(const CpgGait& cpg, std::string& out) {
  out += "cpg:\n";
  out += "  " + Pair("frequency_hz", cpg.frequency_hz) + "\n";
  out += "  " + Pair("amplitude_m_per_s", cpg.amplitude_m_per_s) + "\n";
  out += "  " + Pair("convergence_per_s", cpg.convergence_per_s) + "\n";
  out += "  " + Pair("integrator_step_s", cpg.integrator_step_s) + "\n";
  out += "  symmetry: " + NameOf(cpg.symmetry, kSymmetries) + "\n";
  if (!cpg.order.empty()) out += "  order: " + List(cpg.order) + "\n";
  if (!cpg.inverted.empty()) out += "  inverted: " + Written(cpg.inverted) + "\n";
  if (cpg.feedback) {
    out += "  feedback: {" + Pair("gain_rad_per_n_s", cpg.feedback->gain_rad_per_n_s) + ", " +
           Pair("reference_n", cpg.feedback->reference_n) + "}\n";
  }
  out += std::string("  groups:") + (cpg.groups.empty() ? " []\n" : "\n");
  for (const CouplingGroup& group : cpg.groups) {
    out += "    - {name: " + group.name + ", " + Pair("weight_per_m", group.weight_per_m) + ", " +
           Pair("phase_rad", group.phase_rad) + "}\n";
  }
}

void Write(const TableGait& table, std::string& out) {
  out += "table:\n  interpolation: " + NameOf(table.linear, kInterpolations) + "\n";
  if (table.repeat_from_s) out += "  " + Pair("repeat_from_s", *table.repeat_from_s) + "\n";
  out += "  cables: " + List(table.cables) + "\n  rows:\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    out += "    - [" + Shown(table.time_s[i]);
    for (const double v : table.rows[i]) out += ", " + Shown(v);
    out += "]\n";
  }
}

}  // namespace
}  // namespace description

std::string GaitYaml(const GaitSpec& gait) {
  std::string out = "taut: 1\nkind: gait\nname: " + gait.name + "\n";
  if (!gait.description.empty())
    out += "description: " + description::InQuotes(gait.description) + "\n";
  if (gait.sine) description::Write(*gait.sine, out);
  if (gait.cpg) description::Write(*gait.cpg, out);
  if (gait.table) description::Write(*gait.table, out);
  return out;
}

std::string GaitTableText(const TableGait& table) {
  std::string out = "time_s";
  for (const std::string& cable : table.cables) out += "," + cable + "_m_per_s";
  out += '\n';
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    out += description::Shown(table.time_s[i]);
    for (const double v : table.rows[i]) out += "," + description::Shown(v);
    out += '\n';
  }
  return out;
}

bool SaveGait(const GaitSpec& gait, const std::string& path, Diagnostics& out) {
  return WriteWholeFile(path, GaitYaml(gait), out);
}

}  // namespace taut
