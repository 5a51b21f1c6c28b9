/// Result of NTRT's builder for a structure: solids, bodies, cables and cable ends. NTRT's frame
/// and the files' units.
#pragma once

#include <vector>

#include "import_ntrt/ntrt_structure.h"

namespace taut::import_ntrt {

struct Solid {
  int builder = 0;
  int pair = -1;           ///< Of a rod or box; -1 for a sphere.
  int node = -1;           ///< Of a sphere: the node with its tag.
  int from = -1, to = -1;  ///< Nodes, as in `Built::same`; for a sphere both are its center.
  int body = 0;
  double mass_kg = 0.0;
};

/// Representation of a cable's end in a model.
enum class End {
  kNode,     ///< At its node.
  kSurface,  ///< On the sphere there, or else on the rod with the nearest center.
  kPoint,    ///< Elsewhere on its solid, by a rule that models do not have.
};
struct CableEnd {
  int node = 0;
  int body = 0;
  End kind = End::kNode;
  Vec3 point;
};
struct Cable {
  int builder = 0, pair = 0;
  CableEnd from, to;
  double rest_length = 0.0;
};

struct Built {
  std::vector<int> same;  ///< Per node: the first at the same place, which represents all there.
  std::vector<Solid> solids;
  std::vector<Cable> cables;
  std::vector<int> bodies_solids;  ///< Per body: number of solids.
  std::vector<double> mass_kg;     ///< Per body; 0: it is fixed.
};

/// Reports errors for structures that NTRT would not build.
Built BuildStructure(Model& model, Diagnostics& out);

}  // namespace taut::import_ntrt
