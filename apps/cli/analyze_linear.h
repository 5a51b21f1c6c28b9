/// Linear system of a robot about its rest state (`taut analyze --linear`, `--response`).
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.h"
#include "taut/spec.h"
#include "taut/start.h"
#include "taut/state_space.h"

namespace taut::cli {

struct LinearArguments {
  std::string file;                                            ///< HDF5 file to write; empty: none.
  std::vector<std::pair<std::string, std::string>> responses;  ///< Pairs of an input and an output.
  double from_hz = 0.1;
  std::optional<double> to_hz;  ///< Nothing: half the tick frequency.
  int points = 40;
  bool csv = false, json = false, tables = false;
  std::vector<std::string> again;  ///< Words of this command, for the suggested next command.
};

struct LinearResult {
  std::string file;
  std::string model;
  std::vector<std::string> notes;
  StateSpace system;
  std::vector<LinearMode> modes;
  struct Response {
    std::string input, output, unit;
    FrequencyResponse values;
  };
  std::vector<Response> responses;
};

/// Formats the verdict on the linear system and a summary of at most ten lines.
std::string LinearSummary(const LinearResult& result);
std::string LinearTables(const LinearResult& result, int most_modes);
std::string LinearJson(const LinearResult& result);
std::string ResponsesCsv(const LinearResult& result);

/// Prints the linear system of an experiment's robot about its rest state, near `from` if given,
/// and writes it if requested. Returns the exit status.
int Linear(const std::string& file, const ExperimentSpec& experiment,
           const std::optional<Pose>& from, const std::vector<std::string>& notes, int most_modes,
           const LinearArguments& args);

}  // namespace taut::cli
