/// Structures that NASA's NTRT describes in YAML, as models of taut.
///
/// Nothing here throws or prints. Threads: any number may import at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut {

struct NtrtOptions {
  double length_unit_m = 0.0;  ///< What 1 in the files is [m], > 0: they do not say.
  /// As NTRT does even where that is hardly meant: a line that begins with `%` ends its file, and
  /// friction acts along one direction only.
  bool like_ntrt = false;
  std::string name;  ///< Of the model; empty: that of the file.
};

/// What NTRT's builder makes of the files.
struct NtrtCounts {
  int files = 0;
  int nodes = 0, pairs = 0;  ///< All that are there, used or not.
  int rods = 0, boxes = 0, spheres = 0;
  int bodies = 0;  ///< Solids that share a node are one.
  int cables = 0;
  int ignored_pairs = 0;          ///< No builder matches them.
  int duplicate_pairs = 0;        ///< Between two nodes that another pair joins already.
  int lines_with_percent = 0;     ///< Lines that begin with `%`, a file as often as it is used.
  int ends_with_tied_choice = 0;  ///< Of cables: several rods of a body are equally near.
  int cables_without_rest_length = 0;  ///< Their pretension leaves none; NTRT refuses them.
  double size_m = 0.0;                 ///< Longest edge of the box around all nodes.
  double mass_kg = 0.0;                ///< Of all bodies.
};

struct NtrtImport {
  std::string model_yaml;  ///< A model file, z up, in SI.
  NtrtCounts counts;
  std::vector<std::string> as_ntrt;    ///< Laws of NTRT that the model has, a sentence each.
  std::vector<std::string> different;  ///< What taut does differently.
  std::vector<std::string> dropped;    ///< What of the files has no place in a model.
};

/// Reads an NTRT structure and all that it includes. Nothing if NTRT's rules leave no structure;
/// warnings where it can be read but is hardly meant.
std::optional<NtrtImport> ImportNtrt(const std::string& path, const NtrtOptions& options,
                                     Diagnostics& out);

}  // namespace taut
