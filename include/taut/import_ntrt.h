/// Import of YAML structures of NASA's Tensegrity Robotics Toolkit (NTRT) as models of taut.
///
/// Functions do not throw or print. Threads: any number may import concurrently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

struct NtrtOptions {
  double length_unit_m = 0.0;  ///< Length unit of the files [m], > 0; files do not contain it.
  /// Reproduces NTRT's probably unintended behavior: a line that begins with `%` ends its file, and
  /// friction acts along one direction only.
  bool like_ntrt = false;
  std::string name;  ///< Name of the model; empty: the file's name.
};

/// Counts of the structure that NTRT would build from the files.
struct NtrtCounts {
  int files = 0;
  int nodes = 0, pairs = 0;  ///< All in the files, used or not.
  int rods = 0, boxes = 0, spheres = 0;
  int bodies = 0;  ///< Solids that share a node are one body.
  int cables = 0;
  int ignored_pairs = 0;               ///< Pairs that match no builder.
  int duplicate_pairs = 0;             ///< Pairs between two nodes that another pair connects.
  int lines_with_percent = 0;          ///< Lines that begin with `%`; a file counts once per use.
  int ends_with_tied_choice = 0;       ///< Cable ends with several equally near rods of a body.
  int cables_without_rest_length = 0;  ///< Pretension leaves no rest length; NTRT refuses them.
  double size_m = 0.0;                 ///< Longest edge of the box around all nodes.
  double mass_kg = 0.0;                ///< Total of all bodies.
};

struct NtrtImport {
  std::string model_yaml;  ///< Model file, z up, in SI.
  NtrtCounts counts;
  std::vector<std::string> as_ntrt;    ///< NTRT's laws that the model reproduces, a sentence each.
  std::vector<std::string> different;  ///< Differences between taut and NTRT.
  std::vector<std::string> dropped;    ///< Contents of the files without a counterpart in a model.
};

/// Reads an NTRT structure and all included files. Returns nothing, and adds errors, if NTRT's
/// rules leave no structure; adds warnings about readable but probably unintended input.
std::optional<NtrtImport> ImportNtrt(const std::string& path, const NtrtOptions& options,
                                     Diagnostics& out);

}  // namespace taut
