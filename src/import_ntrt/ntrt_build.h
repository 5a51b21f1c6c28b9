/// Result of NTRT's builder for a structure: solids, bodies, cables and cable ends. In NTRT's frame
/// and the units of the files.
#pragma once

#include <vector>

#include "import_ntrt/ntrt_structure.h"

namespace taut::import_ntrt {

struct Solid {
  int builder = 0;
  int pair = -1;           ///< Pair of a rod or box; -1 for a sphere.
  int node = -1;           ///< Node of a sphere, which has the builder's tag; -1 for others.
  int from = -1, to = -1;  ///< Nodes, as represented in `Built::same`. For a sphere, both are its
                           ///< center.
  int body = 0;
  double mass_kg = 0.0;
};

/// Location of a cable's end in a model.
enum class End {
  kNode,     ///< At the node.
  kSurface,  ///< On the sphere at the node, or else on the rod with the nearest center.
  kPoint,    ///< At another point of the solid, by a rule that models lack.
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
  std::vector<int> same;  ///< Per node: the first node at the same position, which represents all
                          ///< of them.
  std::vector<Solid> solids;
  std::vector<Cable> cables;
  std::vector<int> bodies_solids;  ///< Per body: number of solids.
  std::vector<double> mass_kg;     ///< Mass of each body; 0: fixed.
};

/// Builds the structure. Reports errors for structures that NTRT would not build.
Built BuildStructure(Model& model, Diagnostics& out);

}  // namespace taut::import_ntrt
