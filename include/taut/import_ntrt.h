/// Import of YAML structures from NASA's Tensegrity Robotics Toolkit (NTRT) as taut models.
///
/// Functions do not throw or print. Threads: any number may import concurrently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

struct NtrtOptions {
  double length_unit_m = 0.0;  ///< Length unit of the files [m], > 0; the files do not define it.
  /// Reproduces NTRT's behavior that is probably unintended: a line that begins with `%` ends its
  /// file, and friction acts in one direction only.
  bool like_ntrt = false;
  std::string name;  ///< Model name; empty: the file name.
};

/// Counts of the structure that NTRT would build from the files.
struct NtrtCounts {
  int files = 0;
  int nodes = 0, pairs = 0;  ///< All nodes and pairs in the files, even if unused.
  int rods = 0, boxes = 0, spheres = 0;
  int bodies = 0;  ///< Solids that share a node form one body.
  int cables = 0;
  int ignored_pairs = 0;       ///< Pairs that match no builder.
  int duplicate_pairs = 0;     ///< Pairs with the same two nodes as another pair.
  int lines_with_percent = 0;  ///< Lines that begin with `%`, counted once per use of their file.
  int ends_with_tied_choice = 0;  ///< Cable ends that are equally near to several rods of a body.
  /// Cables whose pretension leaves no rest length; NTRT rejects them.
  int cables_without_rest_length = 0;
  double size_m = 0.0;   ///< Longest edge of the box around all nodes.
  double mass_kg = 0.0;  ///< Total mass of all bodies.
};

struct NtrtImport {
  std::string model_yaml;  ///< Model file in SI units, z up.
  NtrtCounts counts;
  std::vector<std::string> as_ntrt;  ///< Laws of NTRT that the model reproduces, one sentence each.
  std::vector<std::string> different;  ///< Differences between taut and NTRT.
  std::vector<std::string> dropped;    ///< File contents that a model cannot represent.
};

/// Reads an NTRT structure and all included files. Returns nothing and adds errors if no structure
/// remains under NTRT's rules. Adds warnings about readable input that is probably not intended.
std::optional<NtrtImport> ImportNtrt(const std::string& path, const NtrtOptions& options,
                                     Diagnostics& out);

}  // namespace taut
